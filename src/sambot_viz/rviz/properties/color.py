"""Read and write colours as RViz does.

In a file "r; g; b" with integers 0 to 255, a name of SVG 1.0, or "#" and hex digits as
Qt understands them; in the program always (r, g, b) with integers 0 to 255.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Any, TypeAlias

from sambot_viz.rviz.properties.numbers import finite_numbers
from sambot_viz.rviz.properties.property import Property, PropertyError, Report
from sambot_viz.rviz.yaml.yaml_nodes import Scalar

Rgb: TypeAlias = tuple[int, int, int]

_TRIPLE = re.compile(r"\s*([+-]?\d+)\s*;\s*([+-]?\d+)\s*;\s*([+-]?\d+)\s*(?:;.*)?")
_OTHER_TRIPLE = re.compile(r"\W*(\d{1,3})[\s,;/]+(\d{1,3})[\s,;/]+(\d{1,3})\W*")
"""Matches three numbers with signs between them that RViz does not know."""
_HEX = re.compile(r"#([0-9a-fA-F]+)")


def color_text(color: Rgb) -> str:
    """Return the text RViz saves, such as "160; 160; 164"."""
    return "; ".join(str(part) for part in color)


def parse_color(text: str) -> Rgb | None:
    """Read a colour.

    Args:
        text: "r; g; b" (each clamped to 0…255, further parts ignored), a colour name
            in any case, or "#rgb", "#rrggbb", "#aarrggbb", "#rrrgggbbb",
            "#rrrrggggbbbb".

    Returns:
        The colour, or None when RViz would keep the old one.
    """
    triple = _TRIPLE.fullmatch(text)
    if triple:
        r, g, b = (min(255, max(0, int(part[:12]))) for part in triple.groups())
        return (r, g, b)
    stripped = text.strip()
    if stripped.startswith("#"):
        return _parse_hex(stripped)
    return _named(stripped.lower().replace(" ", ""))


def _named(name: str) -> Rgb | None:
    """Look up one of the 147 colour keywords of SVG 1.0, which are Qt's names."""
    # Imported here: most files name no colour, and `check` starts without Pillow.
    from PIL import ImageColor

    # Pillow has one name more, of CSS 4, that RViz does not know.
    if name not in ImageColor.colormap or name == "rebeccapurple":
        return None
    r, g, b = ImageColor.getrgb(name)[:3]
    return (r, g, b)


def _parse_hex(text: str) -> Rgb | None:
    match = _HEX.fullmatch(text)
    digits = match.group(1) if match else ""
    if len(digits) == 8:
        digits = digits[2:]  # The alpha comes first and RViz ignores it.
    size = len(digits) // 3
    if size not in (1, 2, 3, 4) or len(digits) != 3 * size:
        return None
    r, g, b = (
        int(digits[i : i + size], 16) * 255 // (16**size - 1)
        for i in range(0, 3 * size, size)
    )
    return (r, g, b)


@dataclass(frozen=True, repr=False, eq=False)
class ColorProperty(Property):
    """A colour, (r, g, b) with integers from 0 to 255."""

    default: Rgb = (0, 0, 0)

    def coerce(self, value: object) -> Rgb:
        """Take three numbers, or a text such as "1; 2; 3" or "white"."""
        parsed = parse_color(value) if isinstance(value, str) else None
        if parsed is not None:
            return parsed
        parts = finite_numbers(value, 3)
        if parts is None:
            raise PropertyError(self.name, value, self._expected)
        r, g, b = (min(255, max(0, round(part))) for part in parts)
        return (r, g, b)

    def write(self, value: Any) -> str:
        """Return the text "r; g; b"."""
        return color_text(value)

    def _parse(self, node: Scalar, report: Report) -> Rgb | None:
        color = parse_color(node.text)
        if color is None:
            meant = _OTHER_TRIPLE.fullmatch(node.text)
            right = "; ".join(meant.groups()) if meant else ""
            return self._default_stays(node, report, right)
        return color

    @property
    def _expected(self) -> str:
        return "a colour such as '160; 160; 164'"
