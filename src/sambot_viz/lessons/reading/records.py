"""YAML maps as dataclasses: one declaration gives each field its kind."""

from __future__ import annotations

from dataclasses import MISSING, field, fields
from typing import Any, TypeVar

import yaml

from sambot_viz.checks.around.files.parameters import pairs
from sambot_viz.lessons.reading.report import LessonReport
from sambot_viz.lessons.reading.values import ValueKind, read_value

T = TypeVar("T")


def given(kind: ValueKind, default: Any = MISSING, key: str = "") -> Any:
    """Declare a field that a file may contain.

    Args:
        kind: kind of its value.
        default: value if the file does not contain it; without one it is required.
        key: its name in the file, if that differs.
    """
    return field(default=default, metadata={"kind": kind, "key": key})


def keys_of(record: type[Any]) -> dict[str, tuple[str, ValueKind, bool]]:
    """Return key in the file → field name, kind, and whether it is required."""
    return {
        one.metadata["key"] or one.name: (
            one.name,
            one.metadata["kind"],
            one.default is MISSING,
        )
        for one in fields(record)
        if "kind" in one.metadata
    }


def read_record(
    record: type[T], of: str, node: yaml.Node, report: LessonReport, **known: Any
) -> T | None:
    """Read a map as a dataclass.

    Args:
        record: the class, with fields from `given` and from `known`.
        of: name of the map in messages, such as "a step".
        node: the map.
        report: receives the problems.
        known: values of other fields.

    Returns:
        None after a problem.
    """
    if not isinstance(node, yaml.MappingNode):
        report.wrong_value(node, f"{of} is not a map of keys", "write key: value")
        return None
    keys, values, good = keys_of(record), dict(known), True
    for key, value in pairs(node):
        if key.value not in keys:
            report.unknown(key, "key", of, keys)
            good = False
            continue
        name, kind, _ = keys[key.value]
        if name in values:
            report.wrong_value(key, f"'{key.value}' is there twice", "delete one")
            good = False
            continue
        values[name] = read_value(kind, key.value, value, report)
        good = good and values[name] is not None
    for key, (name, kind, needed) in keys.items():
        if needed and name not in values:
            report.missing(node, key, of, kind.words)
            good = False
    return record(**values) if good else None
