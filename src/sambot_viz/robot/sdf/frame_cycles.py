"""Frames whose poses depend on each other in a ring, which ROS refuses."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence

from sambot_viz.robot.findings import ModelFindings
from sambot_viz.robot.sdf.fields import text_in
from sambot_viz.robot.sdf.habits import origin_in_place_of_pose
from sambot_viz.robot.sdf.scopes import Frame
from sambot_viz.robot.sdf.wording import REFUSED
from sambot_viz.robot.xml.element import Element


def report_cycles(frames: Sequence[Frame], findings: ModelFindings) -> None:
    """Report each ring of frames once, and break it so that all poses are defined."""
    for ring in _rings(frames, lambda frame: frame.base):
        _report(ring, findings)
        ring[0].base = None
    for ring in _rings(frames, lambda frame: frame.attached):
        names = " to ".join(frame.name for frame in [*ring, ring[0]])
        findings.reject(
            "sdf-pose-cycle",
            f"these frames are attached to each other: {names}; {REFUSED}",
            "attach one of them to a link",
            ring[0].element,
            "attached_to",
        )


def _rings(
    frames: Iterable[Frame], following: Callable[[Frame], Frame | None]
) -> list[list[Frame]]:
    """Return the rings that frames form, each once."""
    rings: list[list[Frame]] = []
    done: set[Frame] = set()
    for start in frames:
        path: dict[Frame, None] = {}
        here: Frame | None = start
        while here is not None and here not in done and here not in path:
            path[here] = None
            here = following(here)
        if here is not None and here in path:
            names = list(path)
            rings.append(names[names.index(here) :])
        done |= path.keys()
    return rings


def _report(ring: list[Frame], findings: ModelFindings) -> None:
    """Report a ring at the joint that starts it, otherwise at its first frame."""
    joint = next((f for f in ring if f.kind == "joint" and _is_implicit(f)), None)
    if joint is not None and len(ring) == 2:
        _report_joint(joint, findings)
        return
    frame = joint or ring[0]
    if len(ring) == 1:
        message = f"the pose of the {frame.kind} {frame.name} counts from itself"
    else:
        at = ring.index(frame)
        turned = [*ring[at:], *ring[:at], frame]
        message = "these poses wait for each other: " + " counts from ".join(
            one.name for one in turned
        )
    holder = _holder(frame) if len(ring) == 1 else None
    findings.reject(
        "sdf-pose-cycle",
        f"{message}; {REFUSED}",
        f'write relative_to="{holder}"'
        if holder
        else "let one of them count from a frame outside the ring: write another "
        "relative_to",
        frame.element.find("pose") or frame.element,
    )


def _holder(link: Frame) -> str | None:
    """Return the joint that holds a link, unless the joint is relative to the link."""
    model = link.element.parent
    for joint in model.find_all("joint") if model is not None else ():
        pose = joint.find("pose")
        base = pose.get("relative_to") if pose is not None else None
        if text_in(joint, "child") == link.name and base not in (None, link.name):
            return joint.get("name")
    return None


def _is_implicit(joint: Frame) -> bool:
    """Return whether a joint is relative to its child only for lack of another name."""
    pose = joint.element.find("pose")
    return pose is None or not (pose.get("relative_to") or pose.get("frame"))


def _report_joint(joint: Frame, findings: ModelFindings) -> None:
    """Report a joint without relative_to whose child counts from the joint."""
    if origin_in_place_of_pose(joint.element):
        return
    parent = text_in(joint.element, "parent") or "the_parent_link"
    child = text_in(joint.element, "child")
    pose = joint.element.find("pose")
    findings.reject(
        "sdf-pose-cycle",
        f"without relative_to the pose of a joint counts from its child link {child}, "
        f"and {child}'s pose counts from {joint.name}: each waits for the other; "
        f"{REFUSED}",
        f'write <pose relative_to="{parent}">{_numbers(pose)}</pose>',
        pose or joint.element,
    )


def _numbers(pose: Element | None) -> str:
    """Return the numbers of a pose; a joint without one is where its parent is."""
    text = "" if pose is None else " ".join(pose.text.split())
    return text or "0 0 0 0 0 0"
