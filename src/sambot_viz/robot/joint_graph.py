"""Chains and rings of links, for all model languages."""

from __future__ import annotations

import difflib
from collections.abc import Iterable, Mapping, Sequence

from sambot_viz import limits
from sambot_viz.robot.findings import ModelFindings
from sambot_viz.robot.parts import Joint
from sambot_viz.robot.xml.element import Element


def children_of(joints: Iterable[Joint]) -> dict[str, list[str]]:
    """Return link → its child links."""
    children: dict[str, list[str]] = {}
    for joint in joints:
        children.setdefault(joint.parent, []).append(joint.child)
    return children


def links_below(root: str, children: Mapping[str, list[str]]) -> set[str]:
    """Return a link and all links below it."""
    reached: set[str] = set()
    stack = [root]
    while stack:
        link = stack.pop()
        if link not in reached:
            reached.add(link)
            stack.extend(children.get(link, ()))
    return reached


def rings_of(links: Iterable[str], holder: Mapping[str, Joint]) -> list[list[Joint]]:
    """Return the rings of links, each as the joints that lead back to its first link.

    Args:
        links: names of all links.
        holder: link → the joint whose child it is.
    """
    rings: list[list[Joint]] = []
    done: set[str] = set()
    for start in links:
        path: list[str] = []
        link = start
        while link in holder and link not in done:
            done.add(link)
            path.append(link)
            link = holder[link].parent
        if link in path:
            ring = path[path.index(link) :]
            if len(ring) > 1:
                rings.append([holder[name] for name in reversed(ring)])
    return rings


def copied_joint(
    holders: Mapping[str, Sequence[Joint]], alone: Sequence[str]
) -> tuple[Joint, str] | None:
    """Return a joint whose child is a copy from another joint, and the intended child.

    Args:
        holders: link → the joints whose child it is.
        alone: links that are not the child of any joint, without the root.

    Returns:
        None unless there is one link of each kind, and one joint's name resembles the
        lone link more.
    """
    twice = [joints for joints in holders.values() if len(joints) > 1]
    if len(twice) != 1 or len(alone) != 1 or len(twice[0]) != 2:
        return None
    link = alone[0]
    other, best = sorted(twice[0], key=lambda joint: _likeness(joint.name, link))
    if _likeness(best.name, link) <= _likeness(other.name, link):
        return None
    joints = [joint for above in holders.values() for joint in above]
    if best.parent in links_below(link, children_of(joints)):
        return None
    return best, link


def exchanged_joint(
    joints: Iterable[Joint], links: Iterable[str], main: str
) -> Joint | None:
    """Return the joint whose parent and child must swap to make one tree.

    Args:
        joints: joints of a model in which a link is the child of two joints.
        links: names of all links.
        main: the root to keep.

    Returns:
        None unless there is exactly one.
    """
    all_joints, names = list(joints), set(links)
    found: list[Joint] = []
    for joint in all_joints:
        ends = [
            (j.child, j.parent) if j is joint else (j.parent, j.child)
            for j in all_joints
        ]
        children = [child for _, child in ends]
        if len(set(children)) < len(children) or names - set(children) != {main}:
            continue
        below: dict[str, list[str]] = {}
        for parent, child in ends:
            below.setdefault(parent, []).append(child)
        if links_below(main, below) == names:
            found.append(joint)
    return found[0] if len(found) == 1 else None


def _likeness(joint: str, link: str) -> float:
    one, other = joint.replace("joint", ""), link.replace("link", "")
    return difflib.SequenceMatcher(None, one, other).ratio()


def report_depth(
    root: str,
    joints: Iterable[Joint],
    elements: Mapping[str, Element],
    document: Element,
    findings: ModelFindings,
) -> None:
    """Warn of a chain that is too long for a browser, which nests one call per link.

    Args:
        root: the root link.
        joints: joints of one tree.
        elements: link → its element.
        document: takes the place of a missing link element.
        findings: receives the warning.
    """
    children = children_of(joints)
    level, depth = [root], 0
    while level and depth <= limits.CHAIN.value:
        depth += 1
        level = [child for link in level for child in children.get(link, ())]
    if level:
        findings.warn(
            "chain-too-long",
            f"a chain of joints has more than {limits.CHAIN.value} links (the first "
            f"one beyond is {level[0]}): a browser cannot draw so long a chain, and "
            "the view stays empty",
            "connect links to one that is nearer to the root",
            elements.get(level[0], document),
        )
