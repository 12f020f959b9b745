"""A demand of a step: one condition, or several alternatives."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import MISSING, dataclass, fields
from typing import Any, cast

import yaml

from sambot_viz.checks.around.files.parameters import flag, pairs
from sambot_viz.errors import RobotError, SourceError
from sambot_viz.lessons.conditions.condition import (
    Condition,
    Unmet,
    UnmetError,
    of_problem,
)
from sambot_viz.lessons.conditions.kinds import KINDS
from sambot_viz.lessons.reading.records import read_record
from sambot_viz.lessons.reading.report import LessonReport
from sambot_viz.lessons.reading.values import ValueKind
from sambot_viz.lessons.work import Work

_COMMON = ("only", "hidden", "says")


@dataclass(frozen=True, slots=True)
class Demand:
    """A condition with the properties that all kinds share.

    Attributes:
        conditions: alternatives; one of them must hold.
        only: track of the demand; empty for all tracks.
        hidden: whether the expected value stays hidden until the last hint.
        says: message in place of the expected value when the demand fails.
    """

    conditions: tuple[Condition, ...]
    only: str = ""
    hidden: bool = False
    says: str = ""

    def unmet(self, work: Work) -> Sequence[Unmet]:
        """Return the unmet parts; of several conditions, those of the nearest one.

        Raises:
            RobotError: the model cannot be read.
        """
        faults = [_unmet(condition, work) for condition in self.conditions]
        return min(faults, key=len)

    @property
    def subject(self) -> str:
        """The subject of a met demand, such as "joint: left_wheel_joint"."""
        first = self.conditions[0]
        kind = next(name for name, cls in KINDS.items() if type(first) is cls)
        words, names = kind.replace("-", " "), ", ".join(_names_in(first))
        return f"{words}: {names}" if names else words


def _names_in(condition: Any) -> Iterator[str]:
    """Yield the names that a condition needs; of alternative names, the first."""
    for one in fields(condition):
        value: Any = getattr(condition, one.name) if one.default is MISSING else ""
        several = cast(
            "tuple[Any, ...]", value if isinstance(value, tuple) else (value,)
        )
        if several and isinstance(several[0], str) and several[0]:
            yield several[0]


def _unmet(condition: Condition, work: Work) -> list[Unmet]:
    try:
        return list(condition.unmet(work))
    except UnmetError as error:
        return [error.unmet]
    except SourceError as error:
        return [Unmet(str(error), "a recording that can be read")]


def _read_demand(node: yaml.Node, report: LessonReport) -> Demand | None:
    kinds = [(k, v) for k, v in pairs(node) if k.value not in _COMMON]
    if len(kinds) != 1:
        report.wrong_value(
            node,
            "a condition has one kind",
            f"write one of {', '.join(KINDS)} with its keys below it",
        )
        return None
    key, value = kinds[0]
    if key.value == "any":
        items: list[yaml.Node] = getattr(value, "value", [])
        rows = items if isinstance(value, yaml.SequenceNode) else []
        found = [_read_demand(item, report) for item in rows]
        inner = [c for demand in found if demand for c in demand.conditions]
        conditions = tuple(inner) if len(inner) == len(found) else ()
    else:
        conditions = _read_condition(key, value, report)
    common = {k.value: v for k, v in pairs(node) if k.value in _COMMON}
    texts = {
        k: v.value if isinstance(v, yaml.ScalarNode) else "" for k, v in common.items()
    }
    hidden = flag(texts.get("hidden", "no"))
    if hidden is None:
        report.wrong_value(common["hidden"], "'hidden' is not a flag", "write true")
        return None
    if not conditions:
        return None
    return Demand(conditions, texts.get("only", ""), hidden, texts.get("says", ""))


def _read_condition(
    key: yaml.ScalarNode, value: yaml.Node, report: LessonReport
) -> tuple[Condition, ...]:
    if key.value not in KINDS:
        report.unknown(key, "kind", "the table of conditions", [*KINDS, "any"])
        return ()
    if isinstance(value, yaml.ScalarNode) and not value.value:
        # A kind without keys, such as "- no-errors:", is valid if it needs none.
        value = yaml.MappingNode("map", [], key.start_mark, key.end_mark)
    of = f"the condition {key.value}"
    read = read_record(KINDS[key.value], of, value, report)
    return () if read is None else (read,)


DEMAND = ValueKind("a condition, such as link: {name: base_link}", _read_demand)


def explained(error: RobotError) -> Unmet:
    """Say why a model cannot be read, without the fix."""
    errors = (p for p in error.problems if p.severity == "error")
    problem = next(errors, error.problems[0])
    return of_problem(
        problem, "a model that can be read", before="the model cannot be read: "
    )
