"""Decides which of two links or joints with one name should have another, and which."""

from __future__ import annotations

import re
from collections.abc import Iterator

from sambot_viz.edits import write_attribute
from sambot_viz.errors import Fix
from sambot_viz.robot.xml.element import Element

_ENDING = re.compile(r"_?(link|frame)$", re.IGNORECASE)
_PLAIN = "give one of the two another name"


def other_link(first: Element, second: Element, wanted: str, joint: Element) -> Fix:
    """Return the fix that gives one of two links the name that a joint expects.

    It renames the link beside the joint.

    Args:
        first: link with the name.
        second: link that repeats it.
        wanted: name that no link has.
        joint: joint whose child has that name.
    """
    beside = _nearer(joint, first, second)
    said = joint.get("name") or ""
    if beside is None:
        hint = f'write name="{wanted}" for one of the two: joint {said} expects it'
        return Fix(hint)
    return _renamed(beside, second, wanted, f": joint {said} expects it")


def _nearer(joint: Element, first: Element, second: Element) -> Element | None:
    """Return which of two links a joint expects, when the other has its own joint.

    Links are beside their joints in a file.
    """
    siblings = joint.parent.children if joint.parent is not None else []
    at = {id(element): n for n, element in enumerate(siblings)}
    name = second.get("name") or ""
    own = next((e for e in siblings if e.tag == "joint" and _child(e) == name), joint)
    far = [
        abs(at.get(id(link), 0) - at[id(joint)])
        - (abs(at.get(id(link), 0) - at[id(own)]) if own is not joint else 0)
        for link in (first, second)
    ]
    if first.place == second.place or far[0] == far[1]:
        return None
    return first if far[0] < far[1] else second


def other_joint(first: Element, second: Element, robot: Element) -> Fix:
    """Return the fix that gives one of two joints the name that belongs to its child.

    Args:
        first: joint with the name.
        second: joint that repeats it.
        robot: the <robot> that contains them.
    """
    name = second.get("name") or ""
    stems = [_stem(joint) for joint in (first, second)]
    here = [stem for stem in stems if stem and stem.lower() in name.lower()]
    made_by_macro = first.place == second.place
    if not here or stems[0] == stems[1] or not all(stems) or made_by_macro:
        return Fix(_PLAIN)
    owner = max(here, key=len)
    other, wrong = (stems[1], second) if owner == stems[0] else (stems[0], first)
    right = re.sub(re.escape(owner), other, name, count=1, flags=re.IGNORECASE)
    taken = {joint.get("name") for joint in robot.find_all("joint")}
    unmet = set(_used_joints(robot)) - taken
    if len(unmet) == 1:
        (only,) = unmet
        right = only if other.lower() in only.lower() else right
    if right in taken:
        return Fix(_PLAIN)
    return _renamed(wrong, second, right, f": its child is {_child(wrong)}")


def _stem(joint: Element) -> str:
    return _ENDING.sub("", _child(joint))


def _child(joint: Element) -> str:
    child = joint.find("child")
    return (child.get("link") if child is not None else None) or ""


def _used_joints(robot: Element) -> Iterator[str]:
    """Yield the joints named in the parts for Gazebo and ros2_control."""
    for part in robot.children:
        for element in part.iter() if part.tag in _USERS else ():
            if element.tag == "joint":
                yield element.get("name") or element.text.strip()
            elif element.tag.endswith("_joint"):
                yield element.text.strip()


_USERS = frozenset({"gazebo", "ros2_control", "transmission"})


def _renamed(wrong: Element, here: Element, right: str, why: str) -> Fix:
    old = wrong.get("name") or ""
    which = "" if wrong is here else f" for the one on line {wrong.place.line}"
    fix = write_attribute(wrong.place, "name", old, right)
    return Fix(f'write name="{right}"{which}{why}', fix.edits)
