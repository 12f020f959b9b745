"""Read an SDF document into links and joints, as sdformat_urdf does.

In ROS, the frame with a link's name is at its joint, not at the link's place in SDF.
The reader moves the shapes, so that the picture is right. Refusals by ROS become
errors. Reading continues to the end, to report all errors together.
"""

from __future__ import annotations

from sambot_viz.robot.findings import ModelFindings
from sambot_viz.robot.parts import Joint, RobotTree
from sambot_viz.robot.sdf.away_from_joint import warn_of_links_away_from_joints
from sambot_viz.robot.sdf.check_elements import check_elements
from sambot_viz.robot.sdf.gazebo_only import note_gazebo_only
from sambot_viz.robot.sdf.joint_ends import JoinedLinks, read_ends
from sambot_viz.robot.sdf.joints import JointMotion, MotionReader
from sambot_viz.robot.sdf.links import SdfLinkReader, origin_of
from sambot_viz.robot.sdf.scopes import Frame, read_scopes
from sambot_viz.robot.sdf.sdf_frames import FramePoses
from sambot_viz.robot.sdf.shapes import FindMesh
from sambot_viz.robot.sdf.the_model import find_model
from sambot_viz.robot.sdf.tree import check_tree, root_link
from sambot_viz.robot.sdf.values import trimmed
from sambot_viz.robot.xml.element import Element


def read_sdf(
    document: Element,
    written: Element,
    findings: ModelFindings,
    find_mesh: FindMesh,
) -> RobotTree | None:
    """Read a document.

    Args:
        document: its root element, <sdf>.
        written: root element before xacro, with the macro calls.
        findings: receives problems; `findings.rejected` is set if ROS refuses it.
        find_mesh: mesh name → file.

    Returns:
        The robot, or None when ROS refuses it.
    """
    found = find_model(document, findings)
    if found is None:
        return None
    model, version = found
    check_elements(model, version, findings)
    scope = read_scopes(model, written, version, findings)
    frames = FramePoses(scope, version, findings)
    ends = read_ends(scope, findings)
    root = root_link(scope, findings)
    if root is not None:
        check_tree(scope, root, ends, findings)
    note_gazebo_only(model, findings)
    holders = {e.child: e.joint for e in reversed(ends)}
    reader = SdfLinkReader(frames, findings, find_mesh)
    links = {
        link.name: reader.read(link, holders.get(link.name, link))
        for link in scope.of_kind("link")
    }
    motions = MotionReader(frames, version, findings)
    motion = {joint.name: motions.read(joint) for joint in scope.of_kind("joint")}
    if findings.rejected or root is None:
        return None
    warn_of_links_away_from_joints(scope, ends, findings)
    above = {name: holders.get(name, scope.frames[name]) for name in links}
    joints = {
        e.joint.name: _joint(e, motion[e.joint.name], frames, above[e.parent])
        for e in ends
    }
    return RobotTree(trimmed(model.get("name") or ""), root.name, links, joints)


def _joint(
    ends: JoinedLinks, motion: JointMotion, frames: FramePoses, parent: Frame
) -> Joint:
    """Build a joint; its origin is relative to its parent link's place in ROS."""
    joint = ends.joint
    pose = joint.element.find("pose")
    place = pose.place if pose is not None else None
    return Joint(
        joint.name,
        motion.type,
        ends.parent,
        ends.child,
        origin_of(frames.between(parent, joint), place),
        motion.axis,
        motion.limit,
        place=joint.element.place,
        dynamics=motion.dynamics,
    )
