"""Check which sensors robot_localization uses."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, NamedTuple

from sambot_viz.checks.around.files.parameters import Parameter, place_of
from sambot_viz.checks.around.parameters.copied_inputs import found_copies
from sambot_viz.checks.around.parameters.known import known_parameters
from sambot_viz.checks.around.parameters.navigation import StateFilter, filters
from sambot_viz.checks.around.parameters.text import instead, type_of
from sambot_viz.checks.around.surroundings import Surroundings
from sambot_viz.edits import together, write
from sambot_viz.errors import Problem

_NUMBERED = re.compile(r"(odom|imu|pose|twist)(\d+)(.*)")
_USED = {"odom": (6, 7, 11), "imu": (5, 11), "pose": (0, 1, 5), "twist": (6, 7, 11)}
"""Kind of sensor → the values that filters usually use, by their numbers."""
_GROUPS = (
    "position",
    "orientation",
    "linear velocity",
    "angular velocity",
    "linear acceleration",
)
"""What the rows of three values of a configuration are."""
_ROW = 3
_PATTERNS = (({0}, {0, 1}, {0, 1, 2}), ({2}, {0, 1, 2}))
"""Which values of a row are usually used together: of distances, and of angles."""


class _SensorMessage(NamedTuple):
    """The message of a kind of sensor, and the rows of values that it has."""

    name: str
    rows: frozenset[int]


_MESSAGES: Mapping[str, _SensorMessage] = {
    "odom": _SensorMessage("nav_msgs/Odometry", frozenset({0, 1, 2, 3})),
    "imu": _SensorMessage("sensor_msgs/Imu", frozenset({1, 3, 4})),
    "pose": _SensorMessage(
        "geometry_msgs/PoseWithCovarianceStamped", frozenset({0, 1})
    ),
    "twist": _SensorMessage(
        "geometry_msgs/TwistWithCovarianceStamped", frozenset({2, 3})
    ),
}


def inputs_without_config(around: Surroundings) -> Iterator[Problem]:
    """Report sensors of a filter that uses none of their values."""
    said = {text for launch in around.launches for text in launch.strings}
    given = {(p.node, p.name) for p in around.parameters}
    for one in filters(around):
        if not any(name.endswith("_config") for name in one.given):
            # Another file may set the values.
            continue
        block = known_parameters().nodes["filter"]
        meant = {block.meant(name, one.given) for name in one.given}
        meant |= {f"{copy.new}_config" for copy in found_copies(around)}
        for kind, used in _USED.items():
            for parameter in one.inputs(kind):
                wanted = f"{parameter.name}_config"
                if (parameter.node, wanted) in given or wanted in said | meant:
                    continue
                yield Problem.at(
                    parameter.place,
                    "warning",
                    "ekf-config",
                    f"{one.node} has no {wanted} for {parameter.name}, and without it "
                    "uses no value of that sensor",
                    f"add {wanted}: [{', '.join(_values(used))}]",
                )


def _values(used: Sequence[int]) -> list[str]:
    return ["true" if n in used else "false" for n in range(15)]


def values_without_source(around: Surroundings) -> Iterator[Problem]:
    """Report values of a sensor's configuration that its message does not have."""
    for one in filters(around):
        for kind, message in _MESSAGES.items():
            for parameter in one.inputs(kind):
                config = one.given.get(f"{parameter.name}_config")
                if config is not None:
                    yield from _without_source(one, config, kind, message)


def _without_source(
    one: StateFilter, config: Parameter, kind: str, message: _SensorMessage
) -> Iterator[Problem]:
    written: Any = config.written
    # A list of another length has a finding of its own, and its rows are shifted.
    is_whole = len(config.values) == len(_GROUPS) * _ROW
    items = list(written.value) if is_whole else []
    on = {n for n, item in enumerate(items) if item.value.lower() == "true"}
    rows = {n // _ROW for n in on}
    odd = [row for row in sorted(rows - message.rows) if row < len(_GROUPS)]
    if items and not on and all(type_of(item) == "boolean" for item in items):
        said, is_used = "uses no value", False
    elif odd:
        groups = " and ".join(_GROUPS[row] for row in odd)
        said, is_used = f"uses {groups}", bool(rows & message.rows)
        said += f", which {message.name} does not have"
    else:
        return
    first = items[odd[0] * _ROW] if odd else items[0]
    place, file = place_of(first, config.place.file), config.place.file
    if meant := _meant_rows(on, odd, message):
        yield _exchanged(one, config, meant, message)
        return
    usual = _values(_USED[kind])
    wrong = [items[n] for n in sorted(on) if n // _ROW in odd]
    hint = "write false for these values"
    off = together(hint, *(instead(item, file, "false", hint) for item in wrong))
    others = [_GROUPS[row] for row in sorted(message.rows)]
    yield Problem.at(
        place,
        # What is left is used as it is meant.
        "info" if is_used else "warning",
        "ekf-config",
        f"{config.name} {said}"
        + (
            f": {one.node} uses only the others"
            if is_used
            else f", and nothing else: {one.node} does not use this sensor at all"
            if odd
            else f": {one.node} does not use this sensor at all"
        ),
        off
        if is_used
        else f"use {', '.join(others[:-1])} or {others[-1]}, such as "
        f"[{', '.join(usual)}]",
    )


def _meant_rows(
    on: set[int], odd: Sequence[int], message: _SensorMessage
) -> dict[int, int]:
    """Return row without a source → the row beside it that it is meant for.

    That row is empty, and its values are usually used like these: of three angles, all
    or only the last; of three distances, the first two, or the first, or all. Empty
    where it is not certain for each row.
    """
    found: dict[int, int] = {}
    for row in odd:
        pattern = {n % _ROW for n in on if n // _ROW == row}
        beside = [
            other
            for other in (row - 1, row + 1)
            if other in message.rows - found.keys()
            and not on & set(range(other * _ROW, other * _ROW + _ROW))
            and pattern in _PATTERNS[other % 2]
        ]
        if len(beside) == 1:
            found[row] = beside[0]
    return found if len(set(found.values())) == len(odd) else {}


def _exchanged(
    one: StateFilter,
    config: Parameter,
    meant: Mapping[int, int],
    message: _SensorMessage,
) -> Problem:
    """Report rows of values that are one row too high or too low."""
    written: Any = config.written
    items, file = list(written.value), config.place.file
    row, other = next(iter(meant.items()))
    both = [(one, two) for pair in meant.items() for one, two in (pair, pair[::-1])]
    hint = (
        f"exchange these three values with those of {_GROUPS[other]}, the row "
        f"{'below' if other > row else 'above'}"
    )
    changes = [
        instead(items[to * _ROW + n], file, items[at * _ROW + n].value, hint)
        for at, to in both
        for n in range(_ROW)
        if items[at * _ROW + n].value != items[to * _ROW + n].value
    ]
    return Problem.at(
        place_of(items[row * _ROW], file),
        "warning",
        "ekf-config",
        f"{config.name} uses {_GROUPS[row]}, which {message.name} does not have, and "
        f"nothing of {_GROUPS[other]}, the row beside it: {one.node} does not use what "
        "is meant",
        together(hint, *changes),
    )


def gaps_in_numbers(around: Surroundings) -> Iterator[Problem]:
    """Report sensors that a filter does not read, because a lower number is missing."""
    said = {text for launch in around.launches for text in launch.strings}
    for one in filters(around):
        for kind in _MESSAGES:
            numbers = {int(p.name.removeprefix(kind)) for p in one.inputs(kind)}
            missing = next(n for n in range(len(numbers) + 1) if n not in numbers)
            above = sorted(n for n in numbers if n > missing)
            lower = f"{kind}{missing}"
            elsewhere = any(p.name == lower for p in around.parameters)
            if above and not elsewhere and lower not in said:
                yield _gap(one, kind, missing, above[0])


def _gap(one: StateFilter, kind: str, missing: int, number: int) -> Problem:
    own = [
        (parameter, match[3])
        for name, parameter in one.given.items()
        if (match := _NUMBERED.fullmatch(name))
        and (match[1], match[2]) == (kind, str(number))
    ]
    first = next(parameter for parameter, rest in own if not rest)
    why = (
        "counts from 0"
        if missing == 0
        else f"reads {kind}0, {kind}1 and so on, up to the first that is missing"
    )
    hint = f"write {kind}{missing} for {kind}{number}, in all its lines"
    return Problem.at(
        first.place,
        "warning",
        "ekf-config",
        f"{one.node} does not read {kind}{number}, because there is no "
        f"{kind}{missing}: it {why}",
        together(
            hint,
            *(write(p.place, p.name, f"{kind}{missing}{rest}") for p, rest in own),
        ),
    )
