"""The rows of single links and joints of a RobotModel."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

from sambot_viz.displays.display import DisplayContext, EntryList, numbers
from sambot_viz.displays.robot_model.link_overlays import WITH_AXIS
from sambot_viz.displays.robot_model.robot_entries import RobotEntries
from sambot_viz.displays.scene.nodes import position_of
from sambot_viz.geometry import Matrix, wxyz_from_matrix
from sambot_viz.robot.model import Robot
from sambot_viz.robot.parts import Joint, Link

FrameOf = Callable[[str], str]
_MOST_NAMES = 12


def robot_lists(
    context: DisplayContext, entries: RobotEntries, robot: Robot, frame_of: FrameOf
) -> tuple[EntryList, ...]:
    """Return the links and joints of a robot, in RViz's alphabetic order."""
    children = _child_joints(robot)
    links = EntryList(
        "Links",
        "link",
        sorted(robot.links),
        entries.link,
        entries.set_link,
        lambda name: _link_facts(context, robot, name, frame_of, children),
        lambda name: _link_rows(robot.links[name]),
    )
    joints = EntryList(
        "Joints",
        "joint",
        sorted(robot.joints),
        entries.joint,
        entries.set_joint,
        lambda name: _joint_facts(context, robot.joints[name], frame_of),
        lambda name: _joint_rows(robot, robot.joints[name]),
    )
    return (links, joints) if robot.joints else (links,)


def collision_note(robot: Robot) -> str:
    """Name the links without a collision shape; "" when all have one."""
    bare = [name for name in sorted(robot.links) if not robot.links[name].collisions]
    if len(bare) == len(robot.links):
        return "No link of this robot has a collision shape."
    rest = len(bare) - _MOST_NAMES
    shown = ", ".join(bare[:_MOST_NAMES]) + (f" and {rest} more" if rest > 0 else "")
    return f"Without a collision shape: {shown}" if bare else ""


def _child_joints(robot: Robot) -> dict[str, list[str]]:
    children: dict[str, list[str]] = {}
    for joint in sorted(robot.joints.values(), key=lambda joint: joint.name):
        children.setdefault(joint.parent, []).append(joint.name)
    return children


def _link_rows(link: Link) -> Sequence[str]:
    """List the rows of a link: without geometry it has neither a box nor an Alpha."""
    rows = ("Show Trail", "Show Axes")
    return ("Value", "Alpha", *rows) if link.visuals or link.collisions else rows


def _joint_rows(robot: Robot, joint: Joint) -> Sequence[str]:
    rows = ["Show Axes"]
    child = robot.links[joint.child]
    if child.visuals or child.collisions:
        rows.insert(0, "Value")
    if joint.type in WITH_AXIS:
        rows.append("Show Joint Axis")
    return rows


def _pose_facts(T: Matrix | None) -> dict[str, str]:
    if T is None:
        return {"Position": "no transform"}
    w, x, y, z = wxyz_from_matrix(T)
    return {"Position": numbers(position_of(T)), "Orientation": numbers((x, y, z, w))}


def _pose(context: DisplayContext, frame: str) -> Matrix | None:
    fixed = context.fixed_frame
    if not context.nodes.connected(frame):
        return None
    return context.tree.lookup(fixed, frame).matrix


def _link_facts(
    context: DisplayContext,
    robot: Robot,
    name: str,
    frame_of: FrameOf,
    children: Mapping[str, Sequence[str]],
) -> Mapping[str, str]:
    facts = _pose_facts(_pose(context, frame_of(name)))
    above = next((j.name for j in robot.joints.values() if j.child == name), None)
    facts["Parent joint"] = above or "none: it is the root link"
    below = children.get(name, ())
    facts["Child joints"] = ", ".join(below) or "none"
    link = robot.links[name]
    if not link.visuals and not link.collisions:
        facts["Geometry"] = "none"
    elif not link.visuals:
        facts["Geometry"] = "collision, but nothing visible"
    elif not link.collisions:
        facts["Geometry"] = "visible, but no collision"
    return facts


def _joint_facts(
    context: DisplayContext, joint: Joint, frame_of: FrameOf
) -> Mapping[str, str]:
    above = _pose(context, frame_of(joint.parent))
    facts = _pose_facts(None if above is None else above @ joint.origin.matrix)
    facts["Type"] = joint.type
    facts["Parent link"], facts["Child link"] = joint.parent, joint.child
    if joint.limit is not None:
        facts["Lower Limit"] = numbers((joint.limit.lower,))
        facts["Upper Limit"] = numbers((joint.limit.upper,))
    if joint.type in WITH_AXIS:
        facts["Joint Axis"] = numbers(joint.axis)
    return facts
