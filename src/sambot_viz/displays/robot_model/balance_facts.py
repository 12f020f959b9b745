"""The facts about the mass of a robot, and about its stability."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence

from sambot_viz.displays.display import DisplayContext, Status, numbers
from sambot_viz.frames import LookupRefused
from sambot_viz.geometry import PlainPose, Vector3
from sambot_viz.meshes.asset import Asset
from sambot_viz.meshes.mesh import Mesh
from sambot_viz.robot.balance.balance import WORLD, Balance, Tipping, balance
from sambot_viz.robot.model import Robot
from sambot_viz.robot.parts import MeshFile

_MOST_NAMES = 6
_DECIMALS = 4
_SIDES = (
    "front",
    "front left",
    "left",
    "rear left",
    "rear",
    "rear right",
    "right",
    "front right",
)
"""Counter-clockwise from the x axis of the root link: forward, as in REP 103."""
_UNKNOWN = "unknown: no link has a mass"


def weigh(
    context: DisplayContext, robot: Robot, frame_of: Callable[[str], str]
) -> Balance | None:
    """Weigh a robot as it is drawn now.

    Args:
        context: has its frames, and its mesh files as far as they are read.
        robot: the robot.
        frame_of: the frame of a link.

    Returns:
        None where no link has a mass.
    """
    root = frame_of(robot.root)
    poses: dict[str, PlainPose] = {}
    for link in robot.links:
        try:
            T_root_link = context.tree.drawn(root, frame_of(link)).matrix
        except LookupRefused:
            continue
        poses[link] = PlainPose.of_matrix(T_root_link)

    def mesh_of(shape: MeshFile) -> Mesh | None:
        if shape.path is None:
            return None
        asset = Asset("mesh", shape.path, robot.file_roots)
        content = context.assets.content(asset)
        return content if isinstance(content, Mesh) else None

    return balance(robot, poses, mesh_of)


def balance_facts(robot: Robot, found: Balance | None) -> Mapping[str, str]:
    """Return the rows of a robot's balance; the same ones at all times."""
    if found is None:
        return {"Total Mass": _UNKNOWN}
    mass = f"{found.mass:.5g} kg"
    if assumed := _assumed(robot):
        each = "" if len(assumed) == 1 else " each"
        mass += f", with SDF's 1 kg{each} for {_listed(assumed)} without <inertial>"
    if found.massless:
        mass += f", without {_listed(found.massless)}, whose mass is not given"
    return {
        "Total Mass": mass,
        "Center of Mass": f"{_place(found.center)} m in {robot.root}",
        "Stands On": _stands_on(found),
        "Tips Over At": _tips_over(found),
    }


def balance_status(found: Balance | None) -> Status:
    """Return the status that says whether a robot stands."""
    if found is None:
        return Status("Warn", "No link of this robot has a mass")
    tipping = found.tipping
    if tipping is None or tipping.margin >= 0.0:
        return Status("Ok", "OK")
    sides = _sides(tipping)
    return Status("Warn", f"The robot falls over {sides} in this pose")


def _assumed(robot: Robot) -> Sequence[str]:
    """Return the links of an SDF that do not say their mass."""
    if robot.language != "sdf":
        return ()
    # A missing element has no place in the file.
    links = robot.links.values()
    return [link.name for link in links if link.inertial and not link.inertial.place]


def _place(point: Vector3) -> str:
    """Write a point, to a tenth of a millimetre: a panel is narrow."""
    return numbers([round(value, _DECIMALS) for value in point])


def _stands_on(found: Balance) -> str:
    if found.fixed:
        return f"the link {WORLD}, which holds it"
    if found.support is None:
        return "nothing: no link has a shape that is known"
    return _listed(found.support.links)


def _tips_over(found: Balance) -> str:
    tipping, support = found.tipping, found.support
    if found.fixed:
        return f"nothing tips it over: it is fixed to {WORLD}"
    if support is None:
        return "unknown"
    if tipping is None:
        what = "a line" if len(support.polygon) == 2 else "a point"
        return f"0 °: what it stands on is {what}"
    sides = _sides(tipping)
    millimetres = f"{abs(tipping.margin) * 1000:.4g} mm"
    if tipping.margin < 0.0:
        return f"falls over {sides}: {millimetres} beyond what it stands on"
    return f"{math.degrees(tipping.angle):.4g} ° {sides}, {millimetres} from the edge"


def _sides(tipping: Tipping) -> str:
    """Return where it falls, such as "to the front left or front right"."""
    eighths = [
        round(math.atan2(y, x) / (math.pi / 4)) % len(_SIDES)
        for x, y in tipping.directions
    ]
    *sides, last = dict.fromkeys(_SIDES[eighth] for eighth in sorted(eighths))
    return f"to the {', '.join(sides)}{' or ' if sides else ''}{last}"


def _listed(names: Sequence[str]) -> str:
    rest = len(names) - _MOST_NAMES
    more = f" and {rest} more" if rest > 0 else ""
    return ", ".join(names[:_MOST_NAMES]) + more
