"""Check mimic joints that joint_state_publisher cannot compute."""

from __future__ import annotations

from collections.abc import Mapping

from sambot_viz.errors import did_you_mean
from sambot_viz.robot.joint import Joint
from sambot_viz.robot.mimic import mimic_chain
from sambot_viz.robot.urdf.findings import UrdfFindings
from sambot_viz.robot.xml.element import Element


def check_mimics(
    joints: Mapping[str, Joint], elements: Mapping[str, Element], findings: UrdfFindings
) -> None:
    """Report unknown, immovable and circular mimic joints, which urdfdom accepts."""
    reported: set[str] = set()
    for name, joint in joints.items():
        if joint.mimic is None or name in reported:
            continue
        element = elements[name].find("mimic") or elements[name]
        leader = joints.get(joint.mimic.joint)
        if leader is None:
            near = did_you_mean(joint.mimic.joint, joints)
            findings.error(
                "mimic-joint-unknown",
                f"joint {name} mimics '{joint.mimic.joint}', which does not exist "
                f"({near}); joint_state_publisher would crash",
                "correct the name, or delete <mimic>",
                element,
                "joint",
                cause=f"joint {joint.mimic.joint}",
            )
        elif not leader.movable:
            findings.warn(
                "mimic-joint-immovable",
                f"joint {name} mimics {leader.name}, which is {leader.type} and has "
                "no position; joint_state_publisher would crash",
                "mimic a revolute, continuous or prismatic joint",
                element,
                "joint",
            )
        else:
            reported |= _report_ring(joint, joints, element, findings)


def _report_ring(
    joint: Joint, joints: Mapping[str, Joint], element: Element, findings: UrdfFindings
) -> set[str]:
    """Report the ring that a joint's mimic chain runs into, if the joint is in it."""
    ring = mimic_chain(joint, joints).ring
    if not ring or ring[0] is not joint:
        return set()
    chain = [member.name for member in ring]
    names = " → ".join([*chain, joint.name])
    what = (
        f"joint {joint.name} mimics itself"
        if len(chain) == 1
        else f"these joints mimic each other in a ring: {names}"
    )
    findings.error(
        "mimic-ring",
        f"{what}; joint_state_publisher would stop",
        "delete the <mimic> of one of them",
        element,
        "joint",
    )
    return set(chain)
