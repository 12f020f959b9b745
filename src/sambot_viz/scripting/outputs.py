"""Files of a shown robot: a picture, or a page in one file."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from sambot_viz import limits
from sambot_viz.errors import JointError, UsageError
from sambot_viz.export.chromium import Chromium
from sambot_viz.export.page_file import PERIOD, ViewState, page_file
from sambot_viz.export.view_picture import LONGEST_WAIT, png, snapshot
from sambot_viz.joints import JointState
from sambot_viz.robot.model import Robot
from sambot_viz.server.server import Server
from sambot_viz.session import Session
from sambot_viz.session.robot.motion_recorder import MotionSample, Past

Size = tuple[int, int]
"""Width and height [pixels]."""
Numbers = Sequence[Any] | npt.NDArray[Any]
Motion = tuple[Numbers, Numbers | Mapping[str, Numbers]]
"""Times (T,) [s], and positions (T, N) in the order of `Robot.joint_names` or joint →
(T,) [rad or m]."""


def picture_of(server: Server, size: Size) -> bytes:
    """Return the 3D view as a PNG file, as `Visualizer.snapshot` says."""
    width, height = _checked(size)
    server.sessions.require_open()
    session = server.sessions.shared
    if session is None:
        raise UsageError("a picture is taken of a shared session, not of private ones")
    # The camera looks at all that is drawn.
    with session.looked_at(), Chromium() as chromium:
        server.sessions.wait_for_meshes(LONGEST_WAIT)
        with session.lock:
            view = session.document_view
            near = view.view.gives_nearness
            camera = view.camera if near else view.camera_on_robot(width, height)
        return png(snapshot(server, chromium, width, height, camera))


def _checked(size: Size) -> Size:
    try:
        width, height = map(int, size)
    except (TypeError, ValueError):
        raise UsageError(f"{size!r} is not a width and a height [pixels]") from None
    if not (
        1 <= width <= limits.PICTURE_SIDE.value
        and 1 <= height <= limits.PICTURE_SIDE.value
    ):
        raise UsageError(
            f"{size}: each side must be 1 to {limits.PICTURE_SIDE.value:,} pixels"
        )
    return width, height


def page_of(
    session: Session,
    opened: Robot | None,
    *,
    sweep: bool,
    motion: Motion | None,
    look: str,
) -> bytes:
    """Return the view of a session as one HTML file; see `Visualizer.export`.

    Args:
        session: the session.
        opened: the robot whose joints give the order of the columns of a motion.
        sweep: whether each joint moves to its limits and back.
        motion: another motion in place of that.
        look: "rviz" or "studio".
    """
    shown = session.copy()
    with session.looked_at():
        first = ViewState.at_first(
            session.document_view, session.robot.model is not None
        )
    if motion is None:
        moves = "sweep" if shown.recorded is None else "recording"
        return page_file(shown, first, moves if sweep else "none", look=look)
    joints = session.robot.joints
    if opened is None or joints is None:
        raise JointError("there is no robot yet that could move")
    past = _motion_of(opened, joints, motion)
    return page_file(shown, first, "past", past, look)


def _motion_of(robot: Robot, joints: JointState, motion: Motion) -> Past:
    """Return a motion in steps of `PERIOD`, linear between the positions given."""
    try:
        times, given = motion
        t = np.asarray(times, np.float64)
    except (TypeError, ValueError):
        raise UsageError("a motion is a pair: times (T,) [s], and positions") from None
    if t.ndim != 1 or t.size == 0 or not np.isfinite(t).all() or (np.diff(t) < 0).any():
        raise UsageError("the times of a motion are numbers [s] that grow")
    t = t - t[0]
    if t[-1] > limits.MOTION.value:
        raise UsageError(f"a motion lasts {limits.MOTION.value:,} s at most")
    if not isinstance(given, Mapping):
        given = _columns(robot, given, t.size)
    for name in given:
        joints.checked(name, 0.0)
    steps = [*np.arange(0.0, t[-1], PERIOD).tolist(), float(t[-1])]
    tracks = {
        name: np.interp(steps, t, _column(name, values, t.size)).tolist()
        for name, values in given.items()
    }
    rows = [dict(zip(tracks, row, strict=True)) for row in _rows(tracks, len(steps))]
    samples = [MotionSample(at, row, {}) for at, row in zip(steps, rows, strict=True)]
    return MotionSample(0.0, {**joints.positions, **rows[0]}, {}), samples


def _rows(tracks: Mapping[str, list[float]], count: int) -> Iterator[tuple[float, ...]]:
    """Yield the positions of each step; a motion of no joints has empty ones."""
    return iter(zip(*tracks.values(), strict=True)) if tracks else iter([()] * count)


def _columns(robot: Robot, given: Numbers, count: int) -> dict[str, Numbers]:
    names, array = robot.joint_names, _floats("positions", given)
    if array.shape != (count, len(names)):
        raise JointError(
            f"the positions of a motion have the shape ({count}, {len(names)}), in the "
            f"order of joint_names, not {array.shape}"
        )
    return {name: array[:, i] for i, name in enumerate(names)}


def _column(name: str, values: Numbers, count: int) -> npt.NDArray[np.float64]:
    array = _floats(f"joint '{name}'", values)
    if array.shape != (count,):
        raise JointError(
            f"joint '{name}' needs {count} positions, one for each time, not the shape "
            f"{array.shape}"
        )
    return array


def _floats(what: str, values: Numbers) -> npt.NDArray[np.float64]:
    try:
        array = np.asarray(values, np.float64)
    except (TypeError, ValueError):
        raise JointError(f"{what}: these are not all numbers") from None
    if not np.isfinite(array).all():
        raise JointError(f"{what}: not all positions are finite numbers")
    return array
