"""Say what is wrong with a misspelt name, and what to write."""

from __future__ import annotations

from typing import NamedTuple

from sambot_viz.edits import move_before, rename_attribute, rename_element
from sambot_viz.errors import Fix
from sambot_viz.robot.findings import tag_text
from sambot_viz.robot.slips.misspelt import CALL, Slip
from sambot_viz.robot.slips.needs_xacro import OWN_TAGS, missing_prefix
from sambot_viz.robot.xml.element import Element

_SHORT = 60
"""The longest text that a hint repeats [characters]."""


class SlipWords(NamedTuple):
    """The parts of a problem."""

    code: str
    message: str
    hint: str | Fix


def slip_in_words(slip: Slip, refused: bool) -> SlipWords:
    """Return code, message and hint for a slip.

    Args:
        slip: what is wrong.
        refused: ROS refuses the model because of it.
    """
    effect = ", so it refuses the model" if refused else ""
    if slip.attribute is not None:
        return _attribute(slip, slip.attribute, effect)
    if slip.parents:
        return _misplaced(slip, effect)
    element, right = slip.element, slip.right
    if right.startswith(CALL):
        is_macro = element.tag not in OWN_TAGS
        problem = missing_prefix(element.tag, is_macro, element.place)
        hint = Fix(problem.hint, problem.edits)
        return SlipWords(problem.code, f"{problem.message}{effect}", hint)
    message = (
        f"{tag_text(element)} {_inside(element)}is not known; did you mean "
        f"<{right}>? ROS ignores it{effect}"
    )
    hint = f"write {_renamed(element, right)}"
    fix = rename_element(element.place, element.tag, right, hint)
    return SlipWords("element-misspelt", message, fix)


def _renamed(element: Element, right: str) -> str:
    """Return what to write for an element that gets another name."""
    text = " ".join(element.text.split())
    if element.children or len(text) > _SHORT:
        return f"<{right} …> and </{right}>"
    if not text:
        return f"<{right} …/>"
    values = "".join(f' {name}="{v}"' for name, v in element.attributes.items())
    return f"<{right}{values}>{text}</{right}>"


def _attribute(slip: Slip, attribute: str, effect: str) -> SlipWords:
    element, right = slip.element, slip.right
    value = element.attributes[attribute]
    message = (
        f"the attribute {attribute} of {tag_text(element)} {_inside(element)}is not "
        f"known; did you mean {right}? ROS ignores it{effect}"
    )
    value = _completed(right, value)
    hint = f'write {right}="{value}"'
    fix = rename_attribute(element.place, attribute, right, value, hint)
    return SlipWords("attribute-misspelt", message, fix)


def _completed(name: str, value: str) -> str:
    """Return the value as the right attribute needs it."""
    return f"{value} 1" if name == "rgba" and len(value.split()) == 3 else value


def _misplaced(slip: Slip, effect: str) -> SlipWords:
    element, parent = slip.element, slip.element.parent
    inside = f"<{parent.tag}>" if parent is not None else "the file"
    tag, it, mean, belongs = tag_text(element), "it", "means", "it belongs"
    if slip.behind:
        tag += f" and {len(slip.behind)} more behind it"
        it, mean, belongs = "them", "mean", "they belong"
    message = (
        f"{tag} {mean} nothing in {inside}, where ROS ignores {it}{effect}; {belongs} "
        f"in {_alternatives(slip.parents)}"
    )
    is_next = parent is not None and slip.target is parent.parent is not None
    edits = move_before(element.place, parent.place) if parent and is_next else ()
    return SlipWords("element-misplaced", message, Fix(_remedy(slip), edits))


def _remedy(slip: Slip) -> str:
    tag = f"<{slip.element.tag}>"
    last = slip.behind[-1] if slip.behind else None
    if slip.target is not None:
        target = slip.target
        if last is not None:
            return (
                f"move </{target.tag}> down, behind the last of them (<{last.tag}> on "
                f"line {last.place.line})"
            )
        if _is_around(target, slip.element):
            out_of = slip.element.parent.tag if slip.element.parent is not None else ""
            return f"move {tag} out of <{out_of}>, directly into {tag_text(target)}"
        where = f"{tag_text(target)} (line {target.place.line})"
        return f"move {tag} into {where}"
    if slip.around:
        begin = "".join(f"<{around}>" for around in slip.around)
        end = "".join(f"</{around}>" for around in reversed(slip.around))
        if last is not None:
            return f"write {begin} before {tag} and {end} behind </{last.tag}>"
        return f"write {begin} before it and {end} behind it"
    return f"delete {tag}, or move it there"


def _is_around(outer: Element, inner: Element) -> bool:
    element = inner.parent
    while element is not None:
        if element is outer:
            return True
        element = element.parent
    return False


def _inside(element: Element) -> str:
    """Name what an element is in, when it has no name of its own: "in <joint …> "."""
    parent = element.parent
    if parent is None or element.get("name"):
        return ""
    while not parent.get("name") and parent.parent is not None:
        parent = parent.parent
    return f"in {tag_text(parent)} "


def _alternatives(names: tuple[str, ...]) -> str:
    shown = [f"<{name}>" for name in names]
    if len(shown) == 1:
        return shown[0]
    return f"{', '.join(shown[:-1])} or {shown[-1]}"
