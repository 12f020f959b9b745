"""Properties that hold vectors."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

from sambot_viz.rviz.properties.number_text import (
    float32,
    float_text,
    parse_float,
    parse_german,
)
from sambot_viz.rviz.properties.numbers import finite_numbers
from sambot_viz.rviz.properties.property import Property, PropertyError, Report, silent
from sambot_viz.rviz.yaml.nodes import Map, Node, Scalar


@dataclass(frozen=True)
class VectorProperty(Property):
    """Three finite numbers, saved under X, Y and Z."""

    default: tuple[float, ...] = (0.0, 0.0, 0.0)
    keys: tuple[str, ...] = ("X", "Y", "Z")

    def read(self, node: Node | None, report: Report = silent) -> Any:
        """Read the components, which must all be there."""
        if node is None or (isinstance(node, Scalar) and node.null):
            return None
        texts = [_component(node, key) for key in self.keys]
        parts = [None if t is None else _vector_part(t) for t in texts]
        known = [part for part in parts if part is not None]
        if len(known) == len(self.keys):
            return tuple(known)
        report(
            node,
            f"'{self.name}' is not {self._expected}; RViz ignores it, and so do we",
            f"write {{{', '.join(f'{key}: 0' for key in self.keys)}}} with numbers",
        )
        return None

    def coerce(self, value: object) -> tuple[float, ...]:
        """Take a finite number for each key, or a text such as "1; 2; 3"."""
        if isinstance(value, str):
            texts = value.split(";")
            value = [parse_float(text) for text in texts]
        parts = finite_numbers(value, len(self.keys))
        if parts is None:
            raise PropertyError(self.name, value, self._expected)
        return parts

    def write(self, value: Any) -> str:
        """Return the text RViz shows, such as "0.1; 0.0001; 1000"."""
        return "; ".join(f"{part:.6g}" for part in value)

    def components(self, value: Any) -> dict[str, str]:
        """Return each key with the text of its number."""
        return {
            key: float_text(part) for key, part in zip(self.keys, value, strict=True)
        }

    def agrees(self, first: Any, second: Any) -> bool:
        """Return whether two vectors are the same in the 32 bits that RViz keeps."""
        return [float32(part) for part in first] == [float32(part) for part in second]

    @property
    def _expected(self) -> str:
        return f"a map of {len(self.keys)} numbers ({', '.join(self.keys)})"


def _component(node: Node, key: str) -> str | None:
    return node.text(key) if isinstance(node, Map) else None


def _vector_part(text: str) -> float | None:
    value = parse_float(text)
    value = parse_german(text) if value is None else value
    return value if value is not None and math.isfinite(float32(value)) else None
