"""One tree of links, as sdformat_urdf demands it: its root is the canonical link."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from sambot_viz.errors import did_you_mean, nearest
from sambot_viz.robot.findings import ModelFindings
from sambot_viz.robot.joint_graph import (
    children_of,
    copied_joint,
    links_below,
    report_depth,
    rings_of,
)
from sambot_viz.robot.parts import Joint
from sambot_viz.robot.sdf.joint_ends import JoinedLinks
from sambot_viz.robot.sdf.scopes import Frame, Scope, canonical_link
from sambot_viz.robot.sdf.unknown_frames import joint_is_missing
from sambot_viz.robot.sdf.values import trimmed
from sambot_viz.robot.sdf.wording import REFUSED
from sambot_viz.robot.xml.element import Element


def root_link(scope: Scope, findings: ModelFindings) -> Frame | None:
    """Return the canonical link: the one that the model names, or the first."""
    model = scope.model
    links = scope.of_kind("link")
    if not links:
        findings.reject(
            "robot-without-links",
            "the robot has no links",
            'add <link name="base_link"/> to the model',
            model,
        )
        return None
    root = canonical_link(scope)
    if root is not None:
        return root
    name = trimmed(model.get("canonical_link") or "")
    names = [link.name for link in links]
    near, one = did_you_mean(name, names), nearest(name, names, 0.75)
    findings.reject(
        "sdf-canonical-link-unknown",
        f'canonical_link="{name}" names no link of the model ({near}); {REFUSED}',
        f'write canonical_link="{one}"'
        if one
        else "name the link that all others hang from",
        model,
        "canonical_link",
    )
    return None


def check_tree(
    scope: Scope, root: Frame, ends: Sequence[JoinedLinks], findings: ModelFindings
) -> None:
    """Report what keeps the links from being one tree below the root.

    Args:
        scope: the names of the model.
        root: its canonical link.
        ends: the joints between links.
        findings: where the problems go.
    """
    joints = [Joint(e.joint.name, "fixed", e.parent, e.child) for e in ends]
    elements = {e.joint.name: e.joint.element for e in ends}
    holders: dict[str, list[Joint]] = {}
    for joint in joints:
        holders.setdefault(joint.child, []).append(joint)
    if root.name in holders:
        _report_root(scope, root, joints, elements, findings)
        return
    names = [link.name for link in scope.of_kind("link")]
    alone = [name for name in names if name not in holders and name != root.name]
    copied = copied_joint(holders, alone)
    for link, above in holders.items():
        if len(above) > 1 and copied is not None:
            _report_copied(above, *copied, elements, findings)
            return
        if len(above) > 1:
            _report_two_parents(link, above, elements, findings)
    # Links that a joint with a mistake leaves alone are no mistake of their own.
    if len(ends) < len(scope.of_kind("joint")):
        return
    holder = {link: above[0] for link, above in holders.items()}
    links = {link.name: link.element for link in scope.of_kind("link")}
    reached = links_below(root.name, children_of(joints))
    for ring in rings_of(links, holder):
        _report_ring(ring, elements, findings)
        reached |= {joint.child for joint in ring}
    reached |= {j.child for j in joints}
    for link, element in links.items():
        alone = link not in reached and link != root.name
        if alone and not joint_is_missing(scope.frames[link], scope, root):
            findings.reject(
                "root-not-unique",
                f"link {link} is not connected to {root.name}: no joint has it as "
                f"<child>, so there is more than one root link; {REFUSED}",
                f"add a joint whose child is {link}",
                element,
            )
    report_depth(root.name, joints, links, scope.model, findings)


def _report_root(
    scope: Scope,
    root: Frame,
    joints: Sequence[Joint],
    elements: Mapping[str, Element],
    findings: ModelFindings,
) -> None:
    """Report a canonical link that hangs from another one."""
    holder = {joint.child: joint for joint in reversed(joints)}
    joint, top, seen = holder[root.name], root.name, {root.name}
    while top in holder and (top := holder[top].parent) not in seen:
        seen.add(top)
    model = scope.model
    named = model.get("canonical_link") is not None
    if named and _is_exchanged(scope, joint, joints):
        findings.reject(
            "sdf-root-not-canonical",
            f"joint {joint.name} has {joint.parent} as its parent and {joint.child}, "
            f"the canonical_link (line {model.line_of('canonical_link')}), as its "
            f"child: they are exchanged; {REFUSED}",
            f"write <parent>{joint.child}</parent> and <child>{joint.parent}</child>",
            elements[joint.name],
        )
        return
    why = (
        f'canonical_link="{root.name}" must name the root'
        if named
        else f"without canonical_link the first link is the root, here {root.name}"
    )
    message = f"{why}; but {root.name} is the child of {joint.name}; {REFUSED}"
    if top in holder:
        findings.reject(
            "sdf-root-not-canonical",
            f"{message}, for these joints form a ring",
            f"delete the joint {joint.name}, or another joint of the ring",
            elements[joint.name],
        )
        return
    fix = f'write <model name="{model.get("name")}" canonical_link="{top}">'
    findings.reject(
        "sdf-root-not-canonical",
        message,
        fix if named else f"{fix}, or move {top} to the top",
        model if named else root.element,
        "canonical_link" if named else None,
    )


def _is_exchanged(scope: Scope, joint: Joint, joints: Sequence[Joint]) -> bool:
    """Return whether a part is the parent of the link that all others hang from."""
    part = scope.frames[joint.parent].element
    if part.find("visual") is None and part.find("collision") is None:
        # A link without a shape, such as base_footprint, may be the root.
        return False
    others = [other for other in joints if other is not joint]
    ends = {end for other in others for end in (other.parent, other.child)}
    return joint.parent not in ends and any(o.parent == joint.child for o in others)


def _report_copied(
    joints: Sequence[Joint],
    copied: Joint,
    meant: str,
    elements: Mapping[str, Element],
    findings: ModelFindings,
) -> None:
    """Report a joint that has the child of another one; its own is then alone."""
    other = next(joint for joint in joints if joint is not copied)
    element = elements[copied.name]
    findings.reject(
        "link-two-parents",
        f"link {copied.child} is the child of {copied.name} and of {other.name} (line "
        f"{elements[other.name].place.line}), and {meant} of no joint; {REFUSED}",
        f"write <child>{meant}</child> for {copied.name}",
        element.find("child") or element,
    )


def _report_two_parents(
    link: str,
    joints: Sequence[Joint],
    elements: Mapping[str, Element],
    findings: ModelFindings,
) -> None:
    listed = " and ".join(
        f"{j.name} (line {elements[j.name].place.line})" for j in joints
    )
    element = elements[joints[-1].name]
    findings.reject(
        "link-two-parents",
        f"link {link} is the child of more than one joint: {listed}; {REFUSED}",
        "a link can be the child of one joint only: delete or correct the other",
        element.find("child") or element,
    )


def _report_ring(
    ring: Sequence[Joint], elements: Mapping[str, Element], findings: ModelFindings
) -> None:
    last = max(ring, key=lambda joint: list(elements).index(joint.name))
    names = " → ".join([ring[0].parent, *(joint.child for joint in ring)])
    element = elements[last.name]
    findings.reject(
        "joint-ring",
        f"the joints form a ring that hangs from nothing: {names}; {REFUSED}",
        f"delete the joint {last.name}, or another joint of the ring",
        element.find("child") or element,
    )
