"""SDF's notation in URDF files, which ROS ignores without a message."""

from __future__ import annotations

from sambot_viz.robot.findings import ModelFindings, tag_text
from sambot_viz.robot.urdf.attributes import BadNumber, read_numbers
from sambot_viz.robot.xml.element import Element

_WITH_ORIGIN = ("joint", "visual", "collision", "inertial")
_OF_ROBOT = frozenset("plugin sensor static self_collide light".split())
_OF_LINK = frozenset(
    "plugin sensor self_collide gravity kinematic enable_wind light".split()
)
_ONLY_SDF = frozenset("pose size radius length uri ambient diffuse".split())


def report_sdf_habits(robot: Element, findings: ModelFindings) -> None:
    """Warn of SDF elements in a URDF, with URDF's notation.

    Args:
        robot: the <robot> element.
        findings: receives the warnings.
    """
    for part in robot.children:
        if part.tag in _OF_ROBOT and _is_sdf(part):
            _report_simulated(part, "<gazebo>", "", findings)
        elif part.tag == "joint":
            _report_pose(part, findings)
        elif part.tag == "link":
            _check_link(part, robot, findings)


def is_model_of_sdf(group: Element) -> bool:
    """Return whether links are in a <model> and in SDF's notation."""
    inside = list(group.iter()) if group.tag == "model" else []
    if any(e.tag == "origin" or e.get("link") is not None for e in inside):
        return False
    return any(
        e.tag in _ONLY_SDF or (e.tag in ("parent", "child") and e.text.strip())
        for e in inside
    )


def _is_sdf(element: Element) -> bool:
    """Return whether an element is not a sensor of URDF.

    A URDF sensor has no type, or names a link or joint as its parent, in iDynTree's
    reading.
    """
    if element.tag != "sensor":
        return True
    parent = element.find("parent")
    named = parent is not None and {"link", "joint"} & parent.attributes.keys()
    return element.get("type") is not None and not named


def _check_link(link: Element, robot: Element, findings: ModelFindings) -> None:
    for child in link.children:
        if child.tag in _OF_LINK and _is_sdf(child):
            name = link.get("name") or "…"
            around = f'<gazebo reference="{name}">'
            _report_simulated(child, around, f" of link {name}", findings)
        elif child.tag in _WITH_ORIGIN:
            _report_pose(child, findings)
        elif child.tag == "pose":
            _report_pose_of_link(child, link, robot, findings)


def _report_simulated(
    element: Element, around: str, owner: str, findings: ModelFindings
) -> None:
    """Warn of elements for the simulator outside <gazebo>."""
    findings.warn(
        "urdf-sdf-habit",
        f"{tag_text(element)}{owner} is SDF: in URDF neither ROS nor Gazebo reads it "
        "there",
        f"write {around} before it and </gazebo> behind it"
        if not owner
        else f"move it out of the link, into {around} directly in <robot>",
        element,
    )


def _report_pose(part: Element, findings: ModelFindings) -> None:
    pose = part.find("pose")
    if pose is None:
        return
    has_origin = part.find("origin") is not None
    findings.warn(
        "urdf-sdf-habit",
        f"<pose> in {tag_text(part)} is SDF: URDF has <origin>, and ROS ignores <pose>",
        "delete it: <origin> is there" if has_origin else f"write {_as_origin(pose)}",
        pose,
    )


def _report_pose_of_link(
    pose: Element, link: Element, robot: Element, findings: ModelFindings
) -> None:
    joint = next(
        (
            joint.get("name")
            for joint in robot.find_all("joint")
            if (end := joint.find("child")) is not None
            and end.get("link") == link.get("name")
        ),
        None,
    )
    findings.warn(
        "urdf-sdf-habit",
        f"<pose> in {tag_text(link)} is SDF: in URDF the joint says where its child "
        "link is, and ROS ignores <pose>",
        f"delete it, and write {_as_origin(pose)} into joint {joint}"
        if joint
        else "delete it",
        pose,
    )


def _as_origin(pose: Element) -> str:
    """Write a <pose> in URDF's notation."""
    numbers = pose.text.split()
    try:
        read_numbers(pose.text, 6)
    except BadNumber:
        numbers = ["…"] * 6
    return f'<origin xyz="{" ".join(numbers[:3])}" rpy="{" ".join(numbers[3:])}"/>'
