"""Values written as text directly in an element, where SDF has an element for each.

libsdformat ignores such a text without a message, and uses its defaults.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from itertools import groupby

from sambot_viz.robot.findings import tag_text
from sambot_viz.robot.sdf.habits import Habit, effect_of_default
from sambot_viz.robot.sdf.script_colours import SCRIPT_COLOURS
from sambot_viz.robot.sdf.values import trimmed
from sambot_viz.robot.sdf.wording import described
from sambot_viz.robot.slips.units import without_units
from sambot_viz.robot.xml.element import Element

_NUMBER = re.compile(r"[+-]?(?:\d+\.?\d*|\.\d+)(?:e[+-]?\d+)?", re.IGNORECASE)
_FILE = re.compile(r"\S*(?:://|\.\w{2,4}$)\S*")
_AXES = {"x": "1 0 0", "y": "0 1 0", "z": "0 0 1"}
_LAYOUTS = {
    "box": ("size size size",),
    "cylinder": ("radius length",),
    "sphere": ("radius",),
    "axis": ("xyz xyz xyz",),
    "axis2": ("xyz xyz xyz",),
    "limit": ("lower upper", "lower upper effort", "lower upper effort velocity"),
    "dynamics": ("damping", "damping friction"),
    "inertia": ("ixx ixy ixz iyy iyz izz", "ixx iyy izz"),
    "inertial": ("mass",),
}
"""Tag → element for each number of the text."""

_DELETE = "delete it, or write it into the element it belongs to"
_CHILDREN = {
    "box": "size",
    "cylinder": "radius",
    "sphere": "radius",
    "mesh": "uri",
    "axis": "xyz",
    "axis2": "xyz",
    "limit": "lower",
    "dynamics": "damping",
    "inertia": "ixx",
    "inertial": "mass",
    "velocity_decay": "linear",
    "material": "diffuse",
    "geometry": "box",
}
"""Tag → element that the text is most likely meant for."""


def loose_text(element: Element) -> str:
    """Return the text directly in an element that should only contain elements."""
    text = " ".join(trimmed(element.text).split())
    return text if len(text) <= 60 else f"{text[:60]}…"


def text_not_read(element: Element) -> Habit | None:
    """Explain a text directly in an element; None when there is none.

    Args:
        element: an element of SDF that should have no text.
    """
    text = loose_text(element)
    if not text:
        return None
    owner = "" if element.get("name") else f" of {described(element)}"
    message = f"the text {text} directly in {tag_text(element)}{owner} is not read"
    if element.children:
        return Habit(message, _DELETE)
    effect = effect_of_default(element.tag)
    return Habit(f"{message}; {effect}" if effect else message, _hint(element, text))


def _hint(element: Element, text: str) -> str:
    inside = _inside(element.tag, text)
    if inside is None and element.tag in _CHILDREN:
        is_shape = element.tag == "geometry" and text.lower() in _LAYOUTS
        child = text.lower() if is_shape else _CHILDREN[element.tag]
        inside = f"<{child}>…</{child}>"
    if inside is None:
        return _DELETE
    return f"write <{element.tag}>{inside}</{element.tag}>"


def _inside(tag: str, text: str) -> str | None:
    """Write a text as SDF's elements, or return None when the meaning is unsure."""
    if tag == "material":
        return _colour(text)
    if tag == "geometry":
        return _shape(text)
    if tag == "mesh":
        return f"<uri>{text}</uri>" if _FILE.fullmatch(text) else None
    if tag in ("axis", "axis2") and text.lower() in _AXES:
        text = _AXES[text.lower()]
    for numbers in _readings(text):
        if tag == "cylinder" and len(numbers) == 1:
            return f"<radius>{numbers[0]}</radius><length>…</length>"
        if tag == "box" and len(numbers) == 1:
            numbers *= 3
        for layout in _LAYOUTS.get(tag, ()):
            names = layout.split()
            if len(names) == len(numbers):
                return _as_elements(names, numbers)
    return None


def _as_elements(names: list[str], numbers: list[str]) -> str:
    pairs = zip(names, numbers, strict=True)
    return "".join(
        f"<{name}>{' '.join(number for _, number in group)}</{name}>"
        for name, group in groupby(pairs, lambda pair: pair[0])
    )


def _readings(text: str) -> Iterator[list[str]]:
    """Yield the numbers of a text: with separating commas, then with decimal commas.

    A text with any other content yields nothing.
    """
    for other in dict.fromkeys((text, re.sub(r"(?<=\d),(?=\d)", ".", text))):
        numbers = re.split(r"[\s,;]+", without_units(other).strip(" ,;"))
        if all(map(_NUMBER.fullmatch, numbers)):
            yield numbers


def _colour(text: str) -> str | None:
    rgba = SCRIPT_COLOURS.get(text.lower())
    for numbers in _readings(text):
        if len(numbers) in (3, 4) and all(0 <= float(one) <= 1 for one in numbers):
            rgba = rgba or " ".join([*numbers, "1"][:4])
    return f"<ambient>{rgba}</ambient><diffuse>{rgba}</diffuse>" if rgba else None


def _shape(text: str) -> str | None:
    for tag in ("sphere", "box", "mesh"):
        single = tag == "box" and all(len(n) == 1 for n in _readings(text))
        inside = None if single else _inside(tag, text)
        if inside is not None:
            return f"<{tag}>{inside}</{tag}>"
    return None
