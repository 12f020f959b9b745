"""The types of properties RViz has (spec/rviz-core.md §1.3)."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, SupportsFloat, cast

from sambot_viz.rviz.color import Rgb, color_text, parse_color
from sambot_viz.rviz.nodes import Node, Scalar
from sambot_viz.rviz.number import (
    INT_LIMIT,
    float32,
    float_text,
    parse_float,
    parse_german,
    parse_int,
)
from sambot_viz.rviz.property import Property, PropertyError, Report, silent

FIXED_FRAME = "<Fixed Frame>"
"""What a frame property says when it means the fixed frame, whatever that is."""

_FALSE = frozenset({"", "0", "false"})
_MEANT_FALSE = frozenset({"no", "off", "n"})
_MEANT_TRUE = frozenset({"1", "true", "yes", "on", "y"})


@dataclass(frozen=True)
class GroupProperty(Property):
    """A container: it has children and no value."""

    @property
    def has_value(self) -> bool:
        """It has none."""
        return False

    def write(self, value: Any) -> str:
        """There is nothing to write."""
        del value
        return ""


@dataclass(frozen=True)
class BoolProperty(Property):
    """True or false.

    RViz takes "", "0" and "false" for false and all else for true; "no" and "off" are
    taken here as they are meant, with a warning (§12, 13).
    """

    default: bool = False

    def coerce(self, value: object) -> bool:
        """See `Property.coerce`."""
        # numpy's booleans are no bool, but they look like one.
        if isinstance(value, bool) or str(value) in ("True", "False"):
            return bool(value)
        raise PropertyError(self.name, value, self._expected)

    def write(self, value: Any) -> str:
        """See `Property.write`."""
        return "true" if value else "false"

    def _parse(self, node: Scalar, report: Report) -> bool:
        return read_bool(node, report, self.name)

    @property
    def _expected(self) -> str:
        return "true or false"


def read_bool(node: Scalar, report: Report, name: str) -> bool:
    """A boolean by RViz's rule, with a report of what RViz reads otherwise."""
    text = node.text.lower()
    if text in _FALSE:
        return False
    if text in _MEANT_FALSE:
        report(
            node,
            f"'{name}' is {node.text!r}, which RViz reads as true; here it is false",
            "write false",
        )
        return False
    if text not in _MEANT_TRUE:
        report(
            node,
            f"'{name}' is {node.text!r}, which RViz reads as true",
            "write true or false",
        )
    return True


@dataclass(frozen=True)
class _NumberProperty(Property):
    """What integers and floats share: limits."""

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
        return clamped


@dataclass(frozen=True)
class IntProperty(_NumberProperty):
    """An integer of 32 bits, clamped to its limits.

    A whole number written as a float ("10.0") is taken as such; RViz reads it as 0 and
    clamps that (§12, 14).
    """

    default: int = 0
    minimum: int | None = None
    maximum: int | None = None

    def coerce(self, value: object) -> int:
        """See `Property.coerce`."""
        number = _number(value)
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
            )
        return int(self._within(value, node, report))

    @property
    def _expected(self) -> str:
        return f"a whole number{self._range}"


@dataclass(frozen=True)
class FloatProperty(_NumberProperty):
    """A finite number, clamped to its limits.

    Infinite ones are clamped too; where there is no limit the default holds, because
    nothing can be drawn with them.
    """

    default: float = 0.0
    minimum: float | None = None
    maximum: float | None = None

    def coerce(self, value: object) -> float:
        """See `Property.coerce`."""
        number = _number(value)
        if number is not None:
            return float(self._clamped(number))
        raise PropertyError(self.name, value, self._expected)

    def write(self, value: Any) -> str:
        """See `Property.write`."""
        return float_text(value)

    def show(self, value: Any) -> str:
        """See `Property.show`."""
        return f"{value:.6g}"

    def agrees(self, first: Any, second: Any) -> bool:
        """See `Property.agrees`; RViz keeps 32 bits."""
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
                )
        if value is None or math.isnan(value) or math.isinf(self._clamped(value)):
            return self._default_stays(node, report)
        return float(self._within(value, node, report))

    @property
    def _expected(self) -> str:
        return f"a number{self._range}"


@dataclass(frozen=True)
class StringProperty(Property):
    """Any text."""

    default: str = ""

    def coerce(self, value: object) -> str:
        """See `Property.coerce`."""
        return checked_text(self.name, value)

    @property
    def _expected(self) -> str:
        return "a text"


def checked_text(name: str, value: object) -> str:
    """A text that can be saved.

    Raises:
        PropertyError: it is no text, or has half a surrogate pair, which no file holds.
    """
    if not isinstance(value, str):
        raise PropertyError(name, value, "a text")
    if any("\ud800" <= character <= "\udfff" for character in value):
        raise PropertyError(name, value, "a text without half characters")
    return str(value)


@dataclass(frozen=True)
class FileProperty(StringProperty):
    """The path of a file, as it was written."""


@dataclass(frozen=True)
class RegexProperty(StringProperty):
    """A regular expression, searched anywhere; empty or broken it filters nothing."""

    @staticmethod
    def compiled(value: str) -> re.Pattern[str] | None:
        """The expression; None when it filters nothing."""
        try:
            return re.compile(value) if value else None
        except re.error:
            return None

    def _parse(self, node: Scalar, report: Report) -> str:
        if node.text and self.compiled(node.text) is None:
            report(
                node,
                f"'{self.name}' is no regular expression: {node.text}; it filters "
                "nothing, as in RViz",
                "mend the expression or leave it empty",
            )
        return node.text


@dataclass(frozen=True)
class EnumProperty(Property):
    """One of some texts; an unknown text is kept and means the first one."""

    default: str = ""

    def meaning(self, value: object) -> str:
        """The option a value acts as: itself, or the first option."""
        if value in self.options or not self.options:
            return str(value)
        return self.options[0]

    def number(self, value: object) -> int:
        """The option number; 0 for an unknown text, as in RViz."""
        return self.options.index(str(value)) if value in self.options else 0

    def coerce(self, value: object) -> str:
        """See `Property.coerce`."""
        if isinstance(value, str) and value in self.options:
            return str(value)
        raise PropertyError(self.name, value, self._expected)

    def _parse(self, node: Scalar, report: Report) -> str:
        if self.options and node.text not in (*self.options, self.default):
            report(
                node,
                f"'{self.name}' is {node.text!r}, which is not {self._expected}; it "
                f"acts as {self.options[0]!r}, as in RViz",
                f"write {self._expected}",
            )
        return node.text

    @property
    def _expected(self) -> str:
        return "one of " + ", ".join(repr(option) for option in self.options)


@dataclass(frozen=True)
class EditableEnumProperty(StringProperty):
    """One of some texts, or any other that is typed."""


@dataclass(frozen=True)
class TfFrameProperty(Property):
    """The name of a frame, without the leading "/" of ROS 1; or "<Fixed Frame>"."""

    default: str = FIXED_FRAME

    @property
    def offers_fixed_frame(self) -> bool:
        """Whether "<Fixed Frame>" is a choice."""
        return self.default == FIXED_FRAME

    def coerce(self, value: object) -> str:
        """See `Property.coerce`."""
        return checked_text(self.name, value).removeprefix("/")

    def _parse(self, node: Scalar, report: Report) -> str:
        return node.text.removeprefix("/")

    @property
    def _expected(self) -> str:
        return "the name of a frame"


@dataclass(frozen=True)
class ColorProperty(Property):
    """A colour, (r, g, b) with integers from 0 to 255."""

    default: Rgb = (0, 0, 0)

    def coerce(self, value: object) -> Rgb:
        """See `Property.coerce`; a text such as "1; 2; 3" or "white" will do."""
        parsed = parse_color(value) if isinstance(value, str) else None
        if parsed is not None:
            return parsed
        parts = _numbers(value, 3)
        if parts is None:
            raise PropertyError(self.name, value, self._expected)
        r, g, b = (min(255, max(0, round(part))) for part in parts)
        return (r, g, b)

    def write(self, value: Any) -> str:
        """See `Property.write`."""
        return color_text(value)

    def _parse(self, node: Scalar, report: Report) -> Rgb | None:
        color = parse_color(node.text)
        return self._default_stays(node, report) if color is None else color

    @property
    def _expected(self) -> str:
        return "a colour such as '160; 160; 164'"


@dataclass(frozen=True)
class VectorProperty(Property):
    """Three finite numbers, saved under X, Y and Z."""

    default: tuple[float, ...] = (0.0, 0.0, 0.0)
    keys: tuple[str, ...] = ("X", "Y", "Z")

    def read(self, node: Node | None, report: Report = silent) -> Any:
        """See `Property.read`; all components must be there (§1.3)."""
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
        """See `Property.coerce`; a text such as "1; 2; 3" will do."""
        if isinstance(value, str):
            texts = value.split(";")
            value = [parse_float(text) for text in texts]
        parts = _numbers(value, len(self.keys))
        if parts is None:
            raise PropertyError(self.name, value, self._expected)
        return parts

    def write(self, value: Any) -> str:
        """The text RViz shows, such as "0.1; 0.0001; 1000"."""
        return "; ".join(f"{part:.6g}" for part in value)

    def components(self, value: Any) -> dict[str, str]:
        """See `Property.components`."""
        return {
            key: float_text(part) for key, part in zip(self.keys, value, strict=True)
        }

    def agrees(self, first: Any, second: Any) -> bool:
        """See `Property.agrees`."""
        return [float32(part) for part in first] == [float32(part) for part in second]

    @property
    def _expected(self) -> str:
        return f"a map of {len(self.keys)} numbers ({', '.join(self.keys)})"


@dataclass(frozen=True)
class QuaternionProperty(VectorProperty):
    """Four finite numbers, xyzw, saved under X, Y, Z and W."""

    default: tuple[float, ...] = (0.0, 0.0, 0.0, 1.0)
    keys: tuple[str, ...] = ("X", "Y", "Z", "W")


def _component(node: Node, key: str) -> str | None:
    return None if not hasattr(node, "entries") else cast(Any, node).text(key)


def _vector_part(text: str) -> float | None:
    value = parse_float(text)
    value = parse_german(text) if value is None else value
    return value if value is not None and math.isfinite(float32(value)) else None


def _number(value: object) -> float | None:
    """A finite number; booleans are none, numpy's numbers are."""
    if isinstance(value, (bool, str, bytes)) or not hasattr(value, "__float__"):
        return None
    try:
        number = float(cast(SupportsFloat, value))
    except (TypeError, ValueError, OverflowError):
        # Arrays look like numbers and are none.
        return None
    return number if math.isfinite(float32(number)) else None


def _numbers(value: object, count: int) -> tuple[float, ...] | None:
    """The finite numbers of a sequence or array of that length."""
    if isinstance(value, (str, bytes)) or not hasattr(value, "__len__"):
        return None
    found = [_number(part) for part in cast("Sequence[object]", value)]
    known = tuple(part for part in found if part is not None)
    return known if len(known) == len(found) == count else None


QOS_PROPERTIES: tuple[Property, ...] = (
    IntProperty(
        "Depth",
        default=5,
        minimum=1,
        help="How many messages wait in the queue.",
        support="none",
    ),
    EditableEnumProperty(
        "History Policy",
        default="Keep Last",
        options=("System Default", "Keep Last", "Keep All"),
        help="Whether old messages are dropped from the queue.",
        support="none",
    ),
    EditableEnumProperty(
        "Reliability Policy",
        default="Reliable",
        options=("System Default", "Reliable", "Best Effort"),
        help="Whether lost messages are sent again.",
        support="none",
    ),
    EditableEnumProperty(
        "Durability Policy",
        default="Volatile",
        options=("System Default", "Transient Local", "Volatile"),
        help="Whether messages sent before the start arrive.",
        support="none",
    ),
)
"""The quality of service below a topic, in RViz's order (§1.7); kept for RViz."""

FILTER_SIZE = IntProperty(
    "Filter size",
    default=10,
    minimum=1,
    help="How many messages wait for their transform.",
    support="none",
)
"""One more child of the topics of displays that wait for transforms (§1.7)."""


@dataclass(frozen=True)
class TopicProperty(StringProperty):
    """The name of a topic, with its quality of service below it."""

    children: tuple[Property, ...] = QOS_PROPERTIES
