"""Find sensors of a filter with the number or the kind of another one."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator, Sequence
from functools import lru_cache
from typing import NamedTuple

from sambot_viz.checks.around.files.parameters import Parameter
from sambot_viz.checks.around.parameters.navigation import filters
from sambot_viz.checks.around.place import where
from sambot_viz.checks.around.running.bridge_entries import bare
from sambot_viz.checks.around.surroundings import Surroundings
from sambot_viz.edits import together, write
from sambot_viz.errors import Fix, Place, Problem

_NUMBERED = re.compile(r"(odom|imu|pose|twist)(\d+)(.*)")
_KINDS = {
    "Odometry": "odom",
    "Imu": "imu",
    "PoseWithCovarianceStamped": "pose",
    "TwistWithCovarianceStamped": "twist",
}
"""Type of a topic → the kind of sensor that has it."""


class CopiedInput(NamedTuple):
    """Lines that are given a second time, and are meant for another sensor.

    Attributes:
        first: the first of those that they replace.
        lines: the lines.
        old: the sensor that they name, such as odom0.
        new: the sensor that is meant.
    """

    first: Parameter
    lines: tuple[Parameter, ...]
    old: str
    new: str


def copied_inputs(around: Surroundings) -> Iterator[Problem]:
    """Report sensors whose lines have the number of another sensor."""
    for one in found_copies(around):
        line, *more = one.lines
        at, node = line.place, line.node.rpartition("/")[2]
        hint = f"write {one.new} for {one.old} in line {at.line}"
        hint += " and the lines that belong to it" if more else ""
        fixes = (
            write(p.place, p.name, p.name.replace(one.old, one.new, 1))
            for p in one.lines
        )
        yield Problem.at(
            at,
            "warning",
            "ekf-config",
            f"{line.name} is given to {node} twice, and only this one is used "
            f"in place of {one.first.fact.value} ({where(one.first.place, at)}): it is "
            f"meant for {one.new}",
            together(hint, *fixes),
        )


@lru_cache(maxsize=1)
def found_copies(around: Surroundings) -> tuple[CopiedInput, ...]:
    """Return the lines of sensors with the number of another one."""
    kinds = {
        bare(end.topic): _KINDS[end.message]
        for node in around.running.started
        for end in node.endpoints
        if end.publishes and end.message in _KINDS
    }
    nodes = {(one.file, one.node) for one in filters(around)}
    return tuple(
        copy
        for file in around.yaml_files
        for node in file.nodes
        if (file.shown, node) in nodes
        for copy in _copies([p for p in file.parameters if p.node == node], kinds)
    )


def is_copied(around: Surroundings, place: Place) -> bool:
    """Return whether a place is in one of these lines."""
    lines = (line for one in found_copies(around) for line in one.lines)
    return any(_same_line(line.place, place) for line in lines)


def _same_line(one: Place, other: Place) -> bool:
    return (one.file, one.line) == (other.file, other.line)


def _copies(given: Sequence[Parameter], kinds: dict[str, str]) -> Iterator[CopiedInput]:
    names = {parameter.name for parameter in given}
    seen: dict[str, Parameter] = {}
    sensor, done = "", 0
    for at, parameter in enumerate(given):
        found = _NUMBERED.fullmatch(parameter.name)
        if found is None or at < done:
            continue
        old, rest = f"{found[1]}{found[2]}", found[3]
        first = seen.setdefault(parameter.name, parameter)
        again = first is not parameter and first.values != parameter.values
        if not rest and again:
            kind = kinds.get(bare(parameter.fact.value), found[1])
            lines = tuple(_following(given[at:], old))
            sensor, done = _free_input(kind, names), at + len(lines)
            yield CopiedInput(first, lines, old, sensor)
        elif not rest:
            sensor = old
        elif again and sensor not in ("", old) and f"{sensor}{rest}" not in names:
            yield CopiedInput(first, (parameter,), old, sensor)


def _following(given: Sequence[Parameter], sensor: str) -> Iterator[Parameter]:
    """Yield the first parameters, as far as they are of a sensor."""
    for parameter in given:
        found = _NUMBERED.fullmatch(parameter.name)
        if found is None or f"{found[1]}{found[2]}" != sensor:
            return
        yield parameter


def as_other_sensor(
    around: Surroundings, name: str, place: Place, message: str
) -> Fix | None:
    """Return the fix that calls a sensor of a filter after the type of its topic.

    Args:
        around: the packages.
        name: of the sensor, such as odom1.
        place: the line with its topic.
        message: the type of the topic, without its package.

    Returns:
        None for another parameter than a sensor of a filter, and another type.
    """
    kind = _KINDS.get(message)
    for one in filters(around) if kind is not None else ():
        given = one.given.get(name)
        if kind is None or given is None or not _same_line(given.place, place):
            continue
        new = _free_input(kind, one.given)
        own = [p for n, p in one.given.items() if re.match(rf"{name}(_|$)", n)]
        fixes = (write(p.place, p.name, p.name.replace(name, new, 1)) for p in own)
        return together(f"write {new} for {name}, in all its lines", *fixes)
    return None


def _free_input(kind: str, names: Collection[str]) -> str:
    """Return the name for another sensor of a kind: a number without a topic.

    Args:
        kind: "odom", "imu", "pose" or "twist".
        names: the parameters of the filter.
    """
    found = (_NUMBERED.fullmatch(name) for name in names)
    numbers = {int(match[2]) for match in found if match and match[1] == kind}
    lacking = (n for n in sorted(numbers) if f"{kind}{n}" not in names)
    return f"{kind}{next(lacking, max(numbers, default=-1) + 1)}"
