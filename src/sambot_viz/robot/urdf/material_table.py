"""Materials by name and order, as urdfdom resolves them."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

from sambot_viz.edits import write_attribute
from sambot_viz.errors import Fix, did_you_mean, nearest
from sambot_viz.geometry import Rgba
from sambot_viz.robot.findings import ModelFindings
from sambot_viz.robot.parts import Material
from sambot_viz.robot.slips.colour_range import in_unit_range
from sambot_viz.robot.urdf.attributes import BadNumber, read_numbers
from sambot_viz.robot.xml.element import Element

_BLACK: Rgba = (0.0, 0.0, 0.0, 1.0)
_COLOURS = {
    "red": "1 0 0 1",
    "green": "0 1 0 1",
    "blue": "0 0 1 1",
    "yellow": "1 1 0 1",
    "orange": "1 0.5 0 1",
    "white": "1 1 1 1",
    "black": "0 0 0 1",
}
FindTexture = Callable[[str, Element], "Path | None"]
"""Texture file name as written and its element → the file, or None."""


class _Known(NamedTuple):
    material: Material
    element: Element


class MaterialTable:
    """Resolves material names as urdfdom does, in the order of the file.

    Global materials are known everywhere; an inline one is known from its visual on;
    the first definition of a name wins for the whole robot.
    """

    def __init__(self, findings: ModelFindings, find_texture: FindTexture) -> None:
        self._findings = findings
        self._undefined: set[str] = set()
        self._find_texture = find_texture
        self._known: dict[str, _Known] = {}

    def add_global(self, element: Element) -> None:
        """Take a <material> that is a child of <robot>."""
        name = element.get("name")
        if name is None:
            self._findings.warn(
                "material-without-name",
                "this <material> has no name, so nothing can use it",
                'write <material name="…">',
                element,
            )
            return
        if name in self._known:
            first = self._known[name].element
            self._findings.reject(
                "material-duplicate",
                f"material '{name}' is defined on line {first.place.line} and again "
                "here; ROS refuses the model",
                "delete one, or give it another name",
                element,
            )
            return
        material = self._defined(name, element)
        if material is None and element.find("color") is None:
            self._findings.warn(
                "material-without-colour",
                f"material '{name}' has neither a colour nor a texture; ROS shows it "
                "black",
                'write <color rgba="0.5 0.5 0.5 1"/> inside it',
                element,
            )
        self._known[name] = _Known(material or Material(name, _BLACK), element)

    def of_visual(self, element: Element) -> Material | None:
        """Find the material for a <material> in a visual; None is RViz's red."""
        name = element.get("name") or ""
        inline = self._defined(name, element)
        if not name:
            return inline
        known = self._known.get(name)
        if known is not None:
            self._report_redefined(name, inline, known, element)
            return known.material
        if inline is None:
            self._report_undefined(name, element)
            return None
        self._known[name] = _Known(inline, element)
        return inline

    def _report_redefined(
        self, name: str, inline: Material | None, known: _Known, element: Element
    ) -> None:
        if inline is None or inline == known.material:
            return
        self._findings.warn(
            "material-redefined",
            f"material '{name}' is defined here differently than on line "
            f"{known.element.place.line}; ROS uses the first definition everywhere",
            "give one of the two another name",
            element,
            cause=f"material '{name}'",
        )

    def _report_undefined(self, name: str, element: Element) -> None:
        if element.find("color") is not None or name in self._undefined:
            return
        self._undefined.add(name)
        known = [other for other in self._known if other]
        near, one = did_you_mean(name, known), nearest(name, known, likeness=0.75)
        meant = f'write <material name="{one}"/>, or ' if one else ""
        self._findings.warn(
            "material-undefined",
            f"material '{name}' is not defined up to here ({near}); RViz shows shapes "
            "with it red",
            f'{meant}write <material name="{name}"><color rgba="{_guess(name)}"/>'
            "</material>, here or at the top of the file",
            element,
        )

    def _defined(self, name: str, element: Element) -> Material | None:
        """Return the element's own definition, or None for a mere reference."""
        color = element.find("color")
        texture = element.find("texture")
        rgba = self._rgba(name, color) if color is not None else None
        file = texture.get("filename") if texture is not None else None
        if file is None or texture is None:
            return Material(name, rgba) if rgba is not None else None
        return Material(name, rgba, file, self._find_texture(file, texture))

    def _rgba(self, name: str, color: Element) -> Rgba | None:
        text = color.get("rgba")
        if text is None:
            wrong = next(iter(color.attributes), None)
            have = f" (it has {wrong})" if wrong else ""
            self._findings.warn(
                "color-without-rgba",
                f"<color> of material '{name}' has no rgba{have}; ROS cannot "
                "use the colour",
                'write rgba="1 0 0 1"',
                color,
            )
            return None
        count = len(text.split())
        if "," not in text and count in (1, 2, 3, 5, 6) and _all_numbers(text, count):
            self._findings.warn(
                "color-count",
                f"rgba=\"{text}\" of material '{name}' has {count} numbers, four are "
                "needed; ROS shows black without a message",
                f'write rgba="{_four(text)}"',
                color,
                "rgba",
            )
            return _BLACK
        return self._four_numbers(name, text, color)

    def _four_numbers(self, name: str, text: str, color: Element) -> Rgba | None:
        try:
            r, g, b, a = read_numbers(text, 4)
        except BadNumber as bad:
            self._findings.error(
                "color-malformed",
                f"rgba=\"{text}\" of material '{name}' {bad.reason}; ROS cannot "
                "use the colour",
                _better_colour(color, text, bad),
                color,
                "rgba",
            )
            return None
        if all(0.0 <= part <= 1.0 for part in (r, g, b, a)):
            return (r, g, b, a)
        looks, better = in_unit_range((r, g, b, a))
        self._findings.error(
            "color-range",
            f"rgba=\"{text}\" of material '{name}' leaves the range 0 to 1{looks}; ROS "
            "cannot use the colour",
            write_attribute(color.place, "rgba", text, better)
            if better is not None
            else "write four numbers from 0 to 1",
            color,
            "rgba",
        )
        return None


def _better_colour(color: Element, text: str, bad: BadNumber) -> str | Fix:
    """Suggest a replacement for an unreadable colour."""
    if bad.right:
        return write_attribute(color.place, "rgba", text, bad.right)
    if bad.hint.startswith('write "'):
        return bad.hint.replace("write ", "write rgba=", 1)
    parts = text.replace(",", " ").replace(";", " ").split()
    if len(parts) == 3 and _all_numbers(" ".join(parts), 3):
        return write_attribute(color.place, "rgba", text, _four(" ".join(parts)))
    return (
        "write four numbers from 0 to 1 with blanks between them, such as "
        'rgba="1 0 0 1"'
    )


def _guess(name: str) -> str:
    """Return an rgba that fits the name of the material."""
    found = (rgba for word, rgba in _COLOURS.items() if word in name.lower())
    return next(found, "0.5 0.5 0.5 1")


def _all_numbers(text: str, count: int) -> bool:
    try:
        read_numbers(text, count)
    except BadNumber:
        return False
    return True


def _four(text: str) -> str:
    parts = text.split()
    if len(parts) == 1:
        parts = parts * 3
    return " ".join([*parts, *["0"] * (3 - len(parts)), "1"][:4])
