"""The kinds of values in a lesson's file; each reads YAML and knows its place."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import yaml

from sambot_viz.checks.around.files.parameters import flag, pairs
from sambot_viz.errors import did_you_mean
from sambot_viz.geometry import finite
from sambot_viz.lessons.reading.report import LessonReport
from sambot_viz.text import text


@dataclass(frozen=True, slots=True)
class ValueKind:
    """A kind of value.

    Attributes:
        words: description for messages, such as "a number".
        read: returns the value; None after a problem, or for a value of another kind.
    """

    words: str
    read: Callable[[yaml.Node, LessonReport], Any]


def read_value(kind: ValueKind, key: str, node: yaml.Node, report: LessonReport) -> Any:
    """Return a value; None after a problem."""
    before = len(report.findings.problems)
    value = kind.read(node, report)
    if value is None and len(report.findings.problems) == before:
        report.wrong_value(
            node, f"'{key}' is {_shown(node)}", f"write {kind.words} for {key}"
        )
    return value


def _shown(node: yaml.Node) -> str:
    if isinstance(node, yaml.MappingNode):
        return "a map"
    if isinstance(node, yaml.SequenceNode):
        texts = [i.value for i in node.value if isinstance(i, yaml.ScalarNode)]
        return f"[{text(', '.join(texts), 60)}]"
    written = text(node.value, 60)
    return f"'{written}'" if written else "empty"


def _text(node: yaml.Node, _report: LessonReport) -> str | None:
    is_text = isinstance(node, yaml.ScalarNode) and node.value.strip()
    return node.value if is_text else None


def _number(node: yaml.Node, _report: LessonReport) -> float | None:
    if not isinstance(node, yaml.ScalarNode):
        return None
    try:
        return finite(float(node.value))
    except ValueError:
        return None


def _count(node: yaml.Node, report: LessonReport) -> int | None:
    number = _number(node, report)
    whole = number is not None and number == int(number) and number >= 0
    return int(number) if number is not None and whole else None


def _flag(node: yaml.Node, _report: LessonReport) -> bool | None:
    return flag(node.value) if isinstance(node, yaml.ScalarNode) else None


def _texts(node: yaml.Node, report: LessonReport) -> tuple[str, ...] | None:
    """Return one text, or a list of texts, as a tuple."""
    items: list[yaml.Node] = (
        node.value if isinstance(node, yaml.SequenceNode) else [node]
    )
    found = [_text(item, report) for item in items]
    return tuple(t for t in found if t) if found and all(found) else None


def map_of(kind: ValueKind, words: str) -> ValueKind:
    """Return the kind of a map whose values are all of one kind, as pairs.

    Args:
        kind: of each value.
        words: description for messages.
    """

    def read(
        node: yaml.Node, report: LessonReport
    ) -> tuple[tuple[str, Any], ...] | None:
        found = [
            (k.value, read_value(kind, k.value, v, report)) for k, v in pairs(node)
        ]
        return tuple(pair for pair in found if pair[1] is not None) or None

    return ValueKind(words, read)


TEXT = ValueKind("a text", _text)
TEXTS = ValueKind("a text, or a list of texts", _texts)
NUMBER = ValueKind("a number", _number)
COUNT = ValueKind("a whole number from 0 on", _count)
FLAG = ValueKind("true or false", _flag)
VALUES = map_of(TEXTS, "a map of names to values")


def numbers(count: int) -> ValueKind:
    """Return the kind of a list of a given length."""

    def read(node: yaml.Node, report: LessonReport) -> tuple[float, ...] | None:
        items: list[yaml.Node] = (
            node.value if isinstance(node, yaml.SequenceNode) else []
        )
        found = [_number(item, report) for item in items]
        known = tuple(number for number in found if number is not None)
        return known if len(known) == len(found) == count else None

    example = ", ".join(["0.1", "0", "0.2", "1"][:count])
    return ValueKind(f"{count} numbers, such as [{example}]", read)


def one_of(*words: str) -> ValueKind:
    """Return the kind of a text from a list of words."""
    some = some_of(*words)

    def read(node: yaml.Node, report: LessonReport) -> str | None:
        found = some.read(node, report) if isinstance(node, yaml.ScalarNode) else None
        return found[0] if found else None

    return ValueKind(some.words, read)


def some_of(*words: str) -> ValueKind:
    """Return the kind of one text, or a list of texts, from a list of words."""

    def read(node: yaml.Node, report: LessonReport) -> tuple[str, ...] | None:
        texts = _texts(node, report)
        for word in texts or ():
            if word not in words:
                near = did_you_mean(word, words)
                report.wrong_value(node, f"'{word}' is not a word that fits", near)
                return None
        return texts

    return ValueKind(" or ".join(words), read)


def all_of(kind: ValueKind, words: str) -> ValueKind:
    """Return the kind of a list whose items are all of one kind.

    Args:
        kind: of each item.
        words: description for messages.
    """

    def read(node: yaml.Node, report: LessonReport) -> tuple[Any, ...] | None:
        if not isinstance(node, yaml.SequenceNode) or not node.value:
            return None
        items: list[yaml.Node] = node.value
        found = [read_value(kind, "the item", item, report) for item in items]
        return tuple(item for item in found if item is not None)

    return ValueKind(words, read)


VECTOR = numbers(3)
