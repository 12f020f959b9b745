"""Read values in parameter files as ROS does, and convert them to other types."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from typing import Any, Literal

import yaml

from sambot_viz.checks.around.files.parameters import flag, place_of
from sambot_viz.edits import source_of, write_between
from sambot_viz.errors import Fix, Place

Type = Literal["number", "integer", "boolean", "string", "list", "none"]

_TRUTH = re.compile("true|false|yes|no|on|off|y|n", re.IGNORECASE)
_INTEGER = re.compile(r"[-+]?(?:\d+|0x[0-9a-fA-F]+)")
_COMMA = re.compile(r"([-+]?\d+),(\d{1,2}|\d{4,})")
_WITH_UNIT = re.compile(r"([-+]?(?:\d+\.?\d*|\.\d+)) ?([a-zA-Z%°]\w{0,3})(?:/s)?")
_UNITS = {
    "cm": 0.01,
    "mm": 0.001,
    "ms": 0.001,
    "deg": math.pi / 180,
    "°": math.pi / 180,
}
"""Unit → its size in metres, seconds or radians."""
OPEN = re.compile(r"[$<{}~]|null", re.IGNORECASE)
REPLACED = re.compile(r"[A-Z]+(?:_[A-Z]+)+")
"""A value that a launch file replaces."""

WANTED: Mapping[str, str] = {
    "number": "a number with a decimal point",
    "integer": "a whole number",
    "boolean": "true or false without quotation marks",
    "string": "one text",
    "numbers": "a list of numbers with decimal points",
    "integers": "a list of whole numbers",
    "booleans": "a list of true and false",
    "strings": "a list of texts",
}
_WRITTEN: Mapping[Type, str] = {
    "integer": "the whole number",
    "number": "the number",
    "boolean": "the truth value",
}


def is_open(node: yaml.Node) -> bool:
    """Return whether a launch file replaces a value."""
    return not isinstance(node, yaml.ScalarNode) or bool(OPEN.search(node.value))


def fixed(item: yaml.Node, kind: str, file: str) -> Fix:
    """Return what to write for one value of another type."""
    text: str = item.value.strip()
    words = text.split()
    if kind == "boolean" and len(words) > 1 and all(map(_TRUTH.fullmatch, words)):
        better = ", ".join(words)
        source, end = source_of(file), item.end_mark
        behind = Place(file, end.line + 1, end.column + 1)
        if source is not None:
            begin = source.offset(place_of(item, file))
            raw = source.text[begin : source.offset(behind)]
            right = re.sub(r"(\S)(?=\s)", r"\1,", raw)
            return instead(item, file, right, f"write {better}: a comma is missing")
    better = converted(text, kind)
    if better is None:
        return Fix(f"write {WANTED[kind]}")
    marks = " without quotation marks"
    more = marks if type_of(item) == "string" and text == better else ""
    return instead(item, file, better, f"write {better}{more}")


def converted(text: str, kind: str) -> str | None:
    """Return the value as another type, without a trailing comma or unit."""
    bare = text.rstrip(",; ")
    if kind == "string":
        is_other = _TRUTH.fullmatch(text) or number_of(text) is not None
        return f'"{text}"' if is_other else text
    if kind == "boolean":
        truth = {"1": True, "0": False}.get(bare, flag(bare))
        return None if truth is None else str(truth).lower()
    unit = _WITH_UNIT.fullmatch(bare)
    if unit is not None and unit[2] in _UNITS:
        bare = f"{float(unit[1]) * _UNITS[unit[2]]:.6g}"
    for pattern, right in ((_COMMA, r"\1.\2"), (_WITH_UNIT, r"\1")):
        if pattern.fullmatch(bare):
            bare = pattern.sub(right, bare)
    if number_of(bare) is None:
        return None
    is_whole = _INTEGER.fullmatch(bare) is not None and "x" not in bare
    if kind == "number":
        return f"{bare}.0" if is_whole else bare
    return f"{float(bare):g}" if float(bare).is_integer() else None


def as_written(node: yaml.Node) -> str:
    """Return a value with the word for its type."""
    kind, text = type_of(node), str(node.value).strip()
    return f"{_WRITTEN[kind]} {text}" if kind in _WRITTEN else f'the text "{text}"'


def instead(node: yaml.Node, file: str, right: str, hint: str) -> Fix:
    """Return the fix that writes another value; no fix for a list."""
    if not isinstance(node, yaml.ScalarNode):
        return Fix(hint)
    end: Any = node.end_mark
    behind = Place(file, end.line + 1, end.column + 1)
    return write_between(place_of(node, file), behind, right, hint)


def type_of(node: yaml.Node) -> Type:
    """Return the type that ROS gives a value."""
    if not isinstance(node, yaml.ScalarNode):
        return "list"
    text: str = node.value
    if node.style or text == "":
        return "string" if node.style else "none"
    if _TRUTH.fullmatch(text):
        return "boolean"
    if _INTEGER.fullmatch(text):
        return "integer"
    return "string" if number_of(text) is None else "number"


def number_of(text: str) -> float | None:
    """Read a number as YAML has it; None for other text."""
    if "_" in text:
        return None
    try:
        return float(text.lower().replace(".inf", "inf").replace(".nan", "nan"))
    except ValueError:
        return None
