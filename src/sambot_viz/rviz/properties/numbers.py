"""Booleans, integers, floats and vectors."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, SupportsFloat, cast

from sambot_viz.errors import nearest
from sambot_viz.rviz.properties.number_text import (
    INT_LIMIT,
    float32,
    float_text,
    parse_float,
    parse_german,
    parse_int,
)
from sambot_viz.rviz.properties.property import Property, PropertyError, Report, silent
from sambot_viz.rviz.yaml.yaml_nodes import Map, Node, Scalar

_FALSE = frozenset({"", "0", "false"})
_MEANT_FALSE = frozenset({"no", "off", "n"})
_MEANT_TRUE = frozenset({"1", "true", "yes", "on", "y"})


@dataclass(frozen=True, repr=False, eq=False)
class BoolProperty(Property):
    """True or false.

    RViz takes "", "0" and "false" for false and all else for true; "no" and "off" are
    taken here as they are meant, with a warning.
    """

    default: bool = False

    def coerce(self, value: object) -> bool:
        """Take a bool, also one of numpy's."""
        # numpy's booleans are not of type bool, but are written like them.
        if isinstance(value, bool) or str(value) in ("True", "False"):
            return bool(value)
        raise PropertyError(self.name, value, self._expected)

    def write(self, value: Any) -> str:
        """Return the text "true" or "false"."""
        return "true" if value else "false"

    def _parse(self, node: Scalar, report: Report) -> bool:
        return read_bool(node, report, self.name)

    @property
    def _expected(self) -> str:
        return "true or false"


def read_bool(node: Scalar, report: Report, name: str) -> bool:
    """Return a boolean by RViz's rule, with a report of what RViz reads otherwise."""
    text = node.text.lower()
    if text in _FALSE:
        return False
    if text in _MEANT_FALSE:
        report(
            node,
            f"'{name}' is {node.text!r}, which RViz reads as true; here it is false",
            "write false",
            "false",
        )
        return False
    if text not in _MEANT_TRUE:
        near = nearest(text, ("true", "false"), 0.7) or ""
        report(
            node,
            f"'{name}' is {node.text!r}, which RViz reads as true",
            f"write {near or 'true or false'}",
            near,
        )
    return True


class _NumberProperty(Property):
    """Base of integers and floats: limits."""

    @property
    def _range(self) -> str:
        low, high = self.minimum, self.maximum
        if low is not None and high is not None:
            return f" from {self.write(low)} to {self.write(high)}"
        if low is not None:
            return f" of at least {self.write(low)}"
        return "" if high is None else f" of at most {self.write(high)}"

    def _clamped(self, value: Any) -> Any:
        if self.minimum is not None and value < self.minimum:
            return self.minimum
        if self.maximum is not None and value > self.maximum:
            return self.maximum
        return value

    def _within(self, value: Any, node: Scalar, report: Report) -> Any:
        clamped = self._clamped(value)
        if clamped != value:
            report(
                node,
                f"'{self.name}' is {node.text}, but must be {self._expected}; "
                f"{self.write(clamped)} is used, as in RViz",
                f"write {self._expected}",
            )
        acting = self.acting(clamped)
        if acting != clamped:
            limit = self.write(acting)
            report(
                node,
                f"'{self.name}' is {node.text}, which acts as {limit} here",
                f"write at most {limit}",
            )
        return clamped


@dataclass(frozen=True, repr=False, eq=False)
class IntProperty(_NumberProperty):
    """An integer of 32 bits, clamped to its limits.

    A whole number written as a float ("10.0") is taken as such; RViz reads it as 0 and
    clamps that.
    """

    default: int = 0
    minimum: int | None = None
    maximum: int | None = None

    def coerce(self, value: object) -> int:
        """Take a whole number of 32 bits, clamped to the limits."""
        number = finite_number(value)
        if number is not None and number.is_integer() and abs(number) < INT_LIMIT:
            return int(self._clamped(int(number)))
        raise PropertyError(self.name, value, self._expected)

    def _parse(self, node: Scalar, report: Report) -> int | None:
        value = parse_int(node.text)
        if value is None:
            number = parse_float(node.text)
            if number is None or not number.is_integer() or abs(number) >= INT_LIMIT:
                return self._default_stays(node, report)
            value = int(number)
            seen = self._clamped(0)
            report(
                node,
                f"'{self.name}' is {node.text}, which RViz reads as {seen}; here it is "
                f"{value}",
                f"write {value}",
                str(value),
            )
        return int(self._within(value, node, report))

    @property
    def _expected(self) -> str:
        return f"a whole number{self._range}"


@dataclass(frozen=True, repr=False, eq=False)
class FloatProperty(_NumberProperty):
    """A finite number, clamped to its limits.

    Infinite ones are clamped too; without a limit the default is used, because
    nothing can be drawn with them.
    """

    default: float = 0.0
    minimum: float | None = None
    maximum: float | None = None

    def coerce(self, value: object) -> float:
        """Take a finite number, clamped to the limits."""
        number = finite_number(value)
        if number is not None:
            return float(self._clamped(number))
        raise PropertyError(self.name, value, self._expected)

    def write(self, value: Any) -> str:
        """Return the number as RViz saves it."""
        return float_text(value)

    def show(self, value: Any) -> str:
        """Return the number with six digits."""
        return f"{value:.6g}"

    def agrees(self, first: Any, second: Any) -> bool:
        """Return whether two numbers are the same in the 32 bits that RViz keeps."""
        return float32(first) == float32(second)

    def _parse(self, node: Scalar, report: Report) -> float | None:
        value = parse_float(node.text)
        if value is None:
            value = parse_german(node.text)
            if value is not None:
                report(
                    node,
                    f"'{self.name}' is {node.text}, which RViz reads as "
                    f"{self.write(self._clamped(0.0))}; here it is {value:g}",
                    "write the number with a point",
                    f"{value:g}",
                )
        if value is None or math.isnan(value) or math.isinf(self._clamped(value)):
            return self._default_stays(node, report)
        return float(self._within(value, node, report))

    @property
    def _expected(self) -> str:
        return f"a number{self._range}"


def finite_number(value: object) -> float | None:
    """Return a finite number; booleans are not, numpy's numbers are."""
    if isinstance(value, (bool, str, bytes)) or not hasattr(value, "__float__"):
        return None
    try:
        number = float(cast(SupportsFloat, value))
    except (TypeError, ValueError, OverflowError):
        # Arrays have the methods of numbers, too.
        return None
    return number if math.isfinite(float32(number)) else None


def finite_numbers(value: object, count: int) -> tuple[float, ...] | None:
    """Return the finite numbers of a sequence or array of that length."""
    if isinstance(value, (str, bytes)) or not hasattr(value, "__len__"):
        return None
    found = [finite_number(part) for part in cast("Sequence[object]", value)]
    known = tuple(part for part in found if part is not None)
    return known if len(known) == len(found) == count else None


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
