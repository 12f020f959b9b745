"""Report optical frames of cameras whose axes are those of no camera."""

from __future__ import annotations

import math
from collections.abc import Iterator

from sambot_viz.checks.around.files.gazebo import SENSOR_FRAMES, facts, sensors
from sambot_viz.checks.clues import guess
from sambot_viz.checks.rule import Subject
from sambot_viz.edits import overwrite_attribute
from sambot_viz.errors import Fix, Problem
from sambot_viz.geometry import Vector3

_OPTICAL = (-math.pi / 2, 0.0, -math.pi / 2)
"""The rotation of an optical frame in the frame of its camera [rad]: z forward, x to
the right and y down (REP 103)."""
_SAID = "-1.5708 0 -1.5708"
_NEAR = 0.01
_CAMERAS = ("camera", "depth", "rgbd", "thermal")
_FRAMES = (*SENSOR_FRAMES, "optical_frame_id")


def optical_frames(subject: Subject) -> Iterator[Problem]:
    """Report fixed joints that have the quarter turns of an optical frame, but others.

    Its clues are the name of the frame, and a camera that has it as its frame.
    """
    robot = subject.robot
    used = {
        fact.value
        for _, sensor in sensors(robot.gazebo)
        if (sensor.get("type") or "").startswith(_CAMERAS)
        for fact in facts(sensor, *_FRAMES)
    }
    for joint in robot.joints.values():
        frame, origin = joint.child, joint.origin
        named = "optical" in frame.lower()
        if joint.type != "fixed" or not _is_slip(origin.rpy):
            continue
        if named or (frame in used and "camera" in joint.parent.lower()):
            where = f'rpy="{_SAID}"'
            if robot.language == "sdf":
                x, y, z = origin.xyz
                where = f"<pose>{x:g} {y:g} {z:g} {_SAID}</pose>"
            yield guess(
                origin.place or joint.place,
                "optical-frame",
                f"z of the optical frame {frame} does not look forward from "
                f"{joint.parent}, with x to the right and y down, as that of a camera: "
                "its points are drawn beside where they are",
                Fix(f"write {where}", overwrite_attribute(origin.place, "rpy", _SAID)),
                {"quarter turns"} | ({"name"} if named else {"camera"}),
            )


def _is_slip(rpy: Vector3) -> bool:
    """Return whether angles are those of an optical frame in another order, or sign."""
    if all(
        math.isclose(a, b, abs_tol=_NEAR) for a, b in zip(rpy, _OPTICAL, strict=True)
    ):
        return False
    sizes = [abs(angle) for angle in _OPTICAL]
    pairs = zip(sorted(map(abs, rpy)), sorted(sizes), strict=True)
    return all(math.isclose(a, b, abs_tol=_NEAR) for a, b in pairs)
