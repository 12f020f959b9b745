"""Properties that hold texts: free text, options, frames, topics, expressions.

RViz searches its filters with C++'s `std::regex`. Python's own `re` tries every way to
match: an expression of 20 characters can take longer than the age of the universe. RE2
has no backtracking; what it cannot express (look-ahead, back references) is refused.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import Any

from sambot_viz import limits
from sambot_viz.errors import nearest
from sambot_viz.rviz.properties.numbers import IntProperty
from sambot_viz.rviz.properties.property import Property, PropertyError, Report
from sambot_viz.rviz.yaml.yaml_nodes import Scalar

FIXED_FRAME = "<Fixed Frame>"
"""The value of a frame property that means the fixed frame, whatever that is."""


@dataclass(frozen=True, repr=False, eq=False)
class StringProperty(Property):
    """Any text."""

    default: str = ""

    def coerce(self, value: object) -> str:
        """Accept a text; see `checked_text` for the refused ones."""
        return checked_text(self.name, value)

    @property
    def _expected(self) -> str:
        return "a text"


def checked_text(name: str, value: object) -> str:
    """Check a text that a program or a browser sets.

    Raises:
        PropertyError: it is not a text, is longer than 1000 characters, or has half a
            surrogate pair, which no file can hold.
    """
    if not isinstance(value, str):
        raise PropertyError(name, value, "a text")
    if len(value) > limits.PAGE_TEXT.value:
        raise PropertyError(
            name, value, f"a text of at most {limits.PAGE_TEXT.value} characters"
        )
    if any("\ud800" <= character <= "\udfff" for character in value):
        raise PropertyError(name, value, "a text without half characters")
    return str(value)


class FileProperty(StringProperty):
    """The path of a file, as it was written."""


class RegexProperty(StringProperty):
    """A regular expression, searched anywhere; empty or broken it filters nothing."""

    @staticmethod
    def compiled(value: str) -> Pattern | None:
        """Return the expression; None when it filters nothing."""
        return compile_pattern(value) if value else None

    def _parse(self, node: Scalar, report: Report) -> str:
        size = len(node.text)
        if size > limits.PATTERN.value:
            report(
                node,
                f"the expression of '{self.name}' has {limits.PATTERN.said(size)}; it "
                "filters nothing",
                "write a shorter expression or leave it empty",
            )
        elif node.text and self.compiled(node.text) is None:
            report(
                node,
                f"'{self.name}' is not a regular expression that can be searched here: "
                f"{node.text[:200]}; it filters nothing",
                "fix the expression (look-ahead and back references are not supported) "
                "or leave it empty",
            )
        return node.text


@dataclass(frozen=True, repr=False, eq=False)
class EnumProperty(Property):
    """One of some texts; an unknown text is kept and means the first one."""

    default: str = ""

    def acting(self, value: object) -> str:
        """Return the option that a value acts as: itself, or the first option."""
        if value in self.options or not self.options:
            return str(value)
        return self.options[0]

    def coerce(self, value: object) -> str:
        """Take one of the options, and refuse everything else."""
        if isinstance(value, str) and value in self.options:
            return str(value)
        raise PropertyError(self.name, value, self._expected)

    def _parse(self, node: Scalar, report: Report) -> str:
        # RViz itself writes an empty Link Tree Style when it has no robot.
        known = (*self.options, self.default, "")
        if self.options and node.text not in known:
            used = f"it acts as {self.options[0]!r}, as in RViz"
            report_option(self, node, used, report)
        return node.text

    @property
    def _expected(self) -> str:
        return "one of " + ", ".join(repr(option) for option in self.options)


def report_option(prop: Property, node: Scalar, used: str, report: Report) -> None:
    """Report a text that is none of the options.

    Args:
        prop: the property.
        node: what the file has.
        used: what RViz takes for it.
        report: takes it.
    """
    near = nearest(node.text, prop.options) or ""
    expected = "one of " + ", ".join(map(repr, prop.options))
    report(
        node,
        f"'{prop.name}' is {node.text!r}, which is not {expected}; {used}",
        f"write {repr(near) if near else expected}",
        near,
    )


class EditableEnumProperty(StringProperty):
    """One of some texts, or any other that is typed."""


class PolicyProperty(EditableEnumProperty):
    """A policy of the quality of service; RViz takes other texts for the default."""

    def _parse(self, node: Scalar, report: Report) -> str:
        if node.text and node.text not in self.options:
            used = f"RViz takes {self.default!r} for it"
            report_option(self, node, used, report)
        return node.text


@dataclass(frozen=True, repr=False, eq=False)
class TfFrameProperty(Property):
    """The name of a frame, without the leading "/" of ROS 1; or "<Fixed Frame>"."""

    default: str = FIXED_FRAME

    @property
    def offers_fixed_frame(self) -> bool:
        """Return whether "<Fixed Frame>" is a choice."""
        return self.default == FIXED_FRAME

    def coerce(self, value: object) -> str:
        """Take the name of a frame, without the "/" of ROS 1."""
        return checked_text(self.name, value).removeprefix("/")

    def _parse(self, node: Scalar, report: Report) -> str:
        return node.text.removeprefix("/")

    @property
    def _expected(self) -> str:
        return "the name of a frame"


QOS_PROPERTIES: tuple[Property, ...] = (
    IntProperty(
        "Depth",
        default=5,
        minimum=1,
        help="How many messages wait in RViz's queue; kept for RViz: here as many wait "
        "as the display needs.",
        support="approximate",
    ),
    PolicyProperty(
        "History Policy",
        default="Keep Last",
        options=("System Default", "Keep Last", "Keep All"),
        help="Whether old messages are dropped from the queue; kept for RViz.",
        support="approximate",
    ),
    PolicyProperty(
        "Reliability Policy",
        default="Reliable",
        options=("System Default", "Reliable", "Best Effort"),
        help="Whether lost messages are sent again; it is compared with the "
        "publishers.",
        support="approximate",
    ),
    PolicyProperty(
        "Durability Policy",
        default="Volatile",
        options=("System Default", "Transient Local", "Volatile"),
        help="Whether messages sent before the start arrive; it is compared with the "
        "publishers.",
        support="approximate",
    ),
)
"""The quality of service below a topic, in RViz's order. The source subscribes."""

FILTER_SIZE = IntProperty(
    "Filter size",
    default=10,
    minimum=1,
    help="How many messages wait for their transform.",
)
"""One more child of the topics of displays that wait for transforms."""


@dataclass(frozen=True, repr=False, eq=False)
class TopicProperty(StringProperty):
    """The name of a topic, with its quality of service below it."""

    children: tuple[Property, ...] = QOS_PROPERTIES


_MEMORY = 1 << 17
"""Memory for one compiled expression [B]; larger ones are refused."""


class Pattern:
    """A compiled expression.

    Args:
        compiled: RE2's object.
    """

    def __init__(self, compiled: Any) -> None:
        self._compiled = compiled

    def matches(self, text: str) -> bool:
        """Return whether the expression matches anywhere in a text."""
        found = self._compiled.search(text.encode("utf-8", "replace"))
        return found is not None


@lru_cache(maxsize=64)
def compile_pattern(expression: str) -> Pattern | None:
    """Compile an expression for searching.

    Args:
        expression: in RE2's syntax, at most 1000 characters.

    Returns:
        None when it is not an expression, or one that RE2 cannot search.
    """
    if len(expression) > limits.PATTERN.value:
        return None
    # The import is late: most configs have no expression.
    import re2 as _re2  # pyright: ignore[reportMissingTypeStubs]

    re2: Any = _re2
    options = re2.Options()
    options.log_errors = False
    options.max_mem = _MEMORY
    try:
        return Pattern(re2.compile(expression, options))
    except (re2.error, UnicodeError):
        return None
