"""Finds the intended frame for a pose whose frame does not exist.

It offers only names that make no ring: a link cannot be relative to itself, nor to a
frame that is relative to the link.
"""

from __future__ import annotations

from typing import NamedTuple

from sambot_viz.edits import write_attribute
from sambot_viz.errors import Fix, nearest
from sambot_viz.robot.sdf.fields import text_in
from sambot_viz.robot.sdf.scopes import OWN, Frame, Scope
from sambot_viz.robot.sdf.values import trimmed
from sambot_viz.robot.sdf.wording import REFUSED, described
from sambot_viz.robot.slips.vocabulary import is_one_slip
from sambot_viz.robot.xml.element import Element

_LIKENESS = 0.8
"""Required similarity to a frame's name, where a joint may have been deleted."""


class FrameWords(NamedTuple):
    """The parts of a problem."""

    message: str
    hint: str | Fix


def unknown_frame(
    name: str, at: Element, attribute: str, scope: Scope, root: Frame | None
) -> FrameWords:
    """Report that a frame does not exist, and suggest the intended one.

    Args:
        name: value of the attribute.
        at: element with the attribute, such as a <pose>.
        attribute: its name.
        scope: names of the model.
        root: link at the top of the tree.
    """
    message = (
        f'{attribute}="{name}" of {described(at)}: there is no link, joint or frame '
        f"called {name}"
    )
    if (own := scope.without_own(name)) is not None:
        return FrameWords(
            f"{message}: {scope.model.get('name')} is the model itself, in which its "
            f"own names have no prefix; {REFUSED}",
            write_attribute(at.place, attribute, name, own),
        )
    if any(joint.element.get("type") == name for joint in scope.of_kind("joint")):
        return FrameWords(
            f"{message}: the joint has it as its type; {REFUSED}",
            "exchange the name and the type of that joint",
        )
    owner = _owner(at, scope)
    if owner is not None and root is not None and joint_is_missing(owner, scope, root):
        joint = (
            f'<joint name="{name}" type="fixed"><parent>{root.name}</parent>'
            f'<child>{owner.name}</child><pose {attribute}="{root.name}"/></joint>'
        )
        return FrameWords(
            f"{message}, and no joint has {owner.name} as its <child>; {REFUSED}",
            f"add {joint} with its real place, or delete the link {owner.name}",
        )
    names = [*_free_names(owner, scope), OWN]
    holder = _holder(owner, scope) if owner is not None else None
    if holder is not None:
        # The joints of other links may have similar names, but are elsewhere.
        joints = {joint.name for joint in scope.of_kind("joint")} - {holder.name}
        near = [other for other in names if other not in joints]
        meant = next((n for n in near if is_one_slip(name, n)), None)
        if meant is None and _is_zero(at) and holder.name in names:
            # A link at its joint is relative to it.
            meant = holder.name
        meant = meant or nearest(name, near)
        names = names if meant is None else [meant]
    else:
        meant = _own_link(at, name) or nearest(name, names)
    words = f"did you mean '{meant}'?" if meant else _listed(names)
    return FrameWords(
        f"{message} ({words}); {REFUSED}",
        write_attribute(at.place, attribute, name, meant, hint=f"write {meant}")
        if meant
        else "name one of these, or delete it",
    )


def _own_link(at: Element, name: str) -> str | None:
    """Return the link around a shape or a sensor, where its name ends as this does."""
    around = at.parent
    while around is not None and around.tag != "link":
        around = around.parent
    link = "" if around is None else around.get("name") or ""
    return link if name and link.endswith(f"_{name.lstrip('_')}") else None


def joint_is_missing(link: Frame, scope: Scope, root: Frame) -> bool:
    """Return whether a link is relative to a missing joint, and has no other joint.

    Args:
        link: the frame, of any kind.
        scope: names of the model.
        root: link at the top of the tree.
    """
    name = _base_name(link)
    if link.kind != "link" or link is root or not name or scope.find(name) is not None:
        return False
    ends = [text_in(joint.element, "child") for joint in scope.of_kind("joint")]
    if link.name in ends or any(scope.find(end) is None for end in ends):
        return False
    others = _free_names(link, scope)
    return not any(is_one_slip(name, n) for n in others) and not nearest(
        name, [n for n in others if scope.frames[n].kind != "joint"], _LIKENESS
    )


def _is_zero(at: Element) -> bool:
    """Return whether a pose equals that of its base frame."""
    return at.tag == "pose" and not at.text.replace(".", " ").strip("0 \t\r\n")


def _listed(names: list[str]) -> str:
    shown = ", ".join(f"'{name}'" for name in names[:8])
    return f"known: {shown}" + (", …" if names[8:] else "")


def _owner(at: Element, scope: Scope) -> Frame | None:
    element = at.parent if at.tag == "pose" else at
    return next((f for f in scope.frames.values() if f.element is element), None)


def _holder(link: Frame, scope: Scope) -> Frame | None:
    """Return the joint whose child a link is."""
    if link.kind != "link":
        return None
    joints = scope.of_kind("joint")
    return next((j for j in joints if text_in(j.element, "child") == link.name), None)


def _free_names(owner: Frame | None, scope: Scope) -> list[str]:
    """Return the names of the frames that do not count from an owner's pose."""
    below: dict[Frame, bool] = {} if owner is None else {owner: True}
    for frame in scope.frames.values():
        path: list[Frame] = []
        here: Frame | None = frame
        while here is not None and here not in below:
            below[here] = False
            path.append(here)
            here = scope.find(_base_name(here) or _usual_base(here))
        ends = here is not None and below[here]
        below.update(dict.fromkeys(path, ends))
    return [name for name, frame in scope.frames.items() if not below[frame]]


def _base_name(frame: Frame) -> str:
    pose = frame.element.find("pose")
    if pose is None or frame.kind == "model":
        return ""
    return trimmed(pose.get("relative_to") or pose.get("frame") or "")


def _usual_base(frame: Frame) -> str:
    """Return the name that counts where the pose says none."""
    if frame.kind == "joint":
        return text_in(frame.element, "child")
    return trimmed(frame.element.get("attached_to") or "")
