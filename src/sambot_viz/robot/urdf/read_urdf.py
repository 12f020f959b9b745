"""Read the elements of a URDF into links and joints, as urdfdom does.

An invalid joint, name or tree rejects the model; an invalid shape drops the remaining
shapes of its link; an invalid material drops its colour. Reading always continues to
the end, so that all errors are reported together.
"""

from __future__ import annotations

from sambot_viz.robot.findings import ModelFindings, tag_text
from sambot_viz.robot.parts import RobotTree
from sambot_viz.robot.urdf.joints import check_mimics
from sambot_viz.robot.urdf.link_tree import build_tree
from sambot_viz.robot.urdf.links import FindMesh, LinkReader
from sambot_viz.robot.urdf.material_table import FindTexture, MaterialTable
from sambot_viz.robot.urdf.robot_parts import RobotParts, read_parts
from sambot_viz.robot.urdf.sdf_habits import is_model_of_sdf, report_sdf_habits
from sambot_viz.robot.xml.element import Element

_OTHER_ROOTS = {
    "SDF": "an SDF file whose <sdf> is in capital letters",
    "world": "an SDF world of Gazebo",
    "model": "a Gazebo model",
    "mujoco": "a MuJoCo model",
    "COLLADA": "a COLLADA mesh",
    "launch": "a launch file",
    "package": "a package manifest",
    "html": "a web page",
}
_OTHER_HINTS = {
    "SDF": "write <sdf> in small letters",
    "model": 'put it into <sdf version="1.8">, then it is an SDF file',
    "world": "open the file of the robot",
}


def read_urdf(
    document: Element,
    findings: ModelFindings,
    find_mesh: FindMesh,
    find_texture: FindTexture,
    expanded: bool,
) -> RobotTree | None:
    """Read a document.

    Args:
        document: root element.
        findings: receives problems; `findings.rejected` is set if ROS refuses it.
        find_mesh: mesh name → file.
        find_texture: texture name → file.
        expanded: whether the document comes from xacro.

    Returns:
        The robot, or None when nothing can be drawn.
    """
    robot = _robot_element(document, findings)
    if robot is None:
        return None
    _check_version(robot, findings)
    report_sdf_habits(robot, findings)
    materials = MaterialTable(findings, find_texture)
    for element in robot.find_all("material"):
        materials.add_global(element)
    parts = read_parts(robot, LinkReader(findings, materials, find_mesh), findings)
    if not parts.links and not parts.nameless and not parts.is_fragment:
        _report_no_links(robot, findings)
        return None
    name = _robot_name(parts, findings, expanded)
    check_mimics(parts.joints, parts.joint_elements, findings)
    tree = build_tree(parts, findings)
    if tree is None:
        return None
    return RobotTree(name, tree.root, tree.links, tree.joints)


def _robot_element(document: Element, findings: ModelFindings) -> Element | None:
    if document.tag == "robot":
        return document
    inner = document.find("robot")
    if inner is not None:
        findings.warn(
            "robot-not-root",
            f"<robot> is inside <{document.tag}>; joint_state_publisher accepts "
            "this, but robot_state_publisher and RViz need <robot> as the root",
            f"delete <{document.tag}> and </{document.tag}>",
            inner,
        )
        return inner
    kind = _OTHER_ROOTS.get(document.tag, "not a robot description")
    more = (
        _OTHER_HINTS.get(document.tag, "export URDF, or convert the file first")
        if document.tag in _OTHER_ROOTS
        else "the root element must be <robot>"
    )
    findings.reject(
        "root-not-robot",
        f"this is {kind} (<{document.tag}> on line {document.place.line}), not URDF",
        more,
        document,
    )
    return None


def _check_version(robot: Element, findings: ModelFindings) -> None:
    version = robot.get("version")
    if version is None or version in ("1.0", "1.00"):
        return
    findings.reject(
        "robot-version",
        f'version="{version}" of <robot> is not supported; ROS knows only 1.0 and '
        "refuses the model",
        'delete the attribute, or write version="1.0"',
        robot,
        "version",
    )


def _robot_name(parts: RobotParts, findings: ModelFindings, expanded: bool) -> str:
    robot = parts.robot
    name = robot.get("name")
    if name:
        return name
    hint = 'write <robot name="my_robot">'
    if name is not None:
        findings.warn("robot-name-empty", "the robot's name is empty", hint, robot)
        return ""
    if expanded or parts.is_fragment:
        findings.warn(
            "robot-without-name",
            "<robot> has no name, so this is probably a file for xacro:include; it "
            "is drawn here, but ROS refuses it on its own",
            f"open the file that includes it, or {hint}",
            robot,
        )
    else:
        findings.reject(
            "robot-without-name",
            "<robot> has no name; ROS refuses the model",
            hint,
            robot,
        )
    return "robot"


def _report_no_links(robot: Element, findings: ModelFindings) -> None:
    inside = next(
        (e for e in robot.iter() if e.tag == "link" and e.parent is not robot), None
    )
    group = inside.parent if inside is not None else None
    if group is not None and is_model_of_sdf(group):
        sdf = robot.find("sdf")
        name = tag_text(robot)
        findings.reject(
            "links-not-direct",
            f"the <model> of SDF is inside {name}; ROS reads this as URDF, which has "
            "no <model>",
            "delete <robot> and </robot>: then it is an SDF file"
            if sdf is not None
            else f'write <sdf version="1.8"> for {name} and </sdf> for </robot>',
            robot,
        )
        return
    if inside is not None and group is not None and group.tag not in _NOT_GROUPS:
        findings.reject(
            "links-not-direct",
            f"the links are inside {tag_text(group)}; links and joints must be "
            "directly inside <robot>, so ROS finds none",
            f"delete <{group.tag}> and </{group.tag}>",
            group,
        )
        return
    findings.reject(
        "robot-without-links",
        "the robot has no links; a file with only macros or properties is meant to be "
        "included by another file",
        'open the file that includes it, or add <link name="base_link"/>',
        robot,
    )


_NOT_GROUPS = frozenset({"joint", "xacro:macro", "transmission", "gazebo"})
