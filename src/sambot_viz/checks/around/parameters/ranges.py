"""Check numbers of well-known nodes: their ranges and their signs."""

from __future__ import annotations

from collections.abc import Iterator

import yaml

from sambot_viz.checks.around.files.parameters import Parameter, place_of
from sambot_viz.checks.around.parameters.known import KnownParameter
from sambot_viz.checks.around.parameters.node_parts import NodePart
from sambot_viz.checks.around.parameters.text import instead, number_of
from sambot_viz.checks.around.place import where
from sambot_viz.checks.rule import number
from sambot_viz.edits import exchange, together, write
from sambot_viz.errors import Fix, Problem


def out_of_range(
    parameter: Parameter, known: KnownParameter, part: NodePart
) -> Iterator[Problem]:
    """Report a number out of its range, or above the parameter that limits it."""
    value = number_of(parameter.fact.value)
    if value is None:
        return
    least = number(known.low)
    low = f"more than {least}" if known.above else f"at least {least}"
    high, other = f"at most {number(known.high)}", part.given.get(known.at_most)
    if value > known.high or value < known.low or (known.above and value == known.low):
        wanted = high if value > known.high else low
        yield Problem.at(
            parameter.value_place,
            "error" if known.strict else "info",
            "parameter-value",
            f"{parameter.name} is {parameter.fact.value}, but "
            + (
                f"{part.node} takes only {wanted}: it stops with an error"
                if known.strict
                else f"it is usually {wanted}"
            ),
            _in_range(parameter, known, value) or f"write {wanted}",
        )
    elif other is not None and value > _number(other, value):
        here, there = parameter.value_place, other.value_place
        one, two = parameter.fact.value, other.fact.value
        hint = f"write {two} here and {one} there, or correct one of them"
        yield Problem.at(
            here,
            "warning",
            "parameter-value",
            f"{parameter.name} is {one}, which is more than {other.name}, {two} "
            f"({where(other.place, here)})",
            exchange(hint, (here, one), (there, two)),
        )


def _number(parameter: Parameter, otherwise: float) -> float:
    found = parameter.fact.number
    return otherwise if found is None else found


def _in_range(parameter: Parameter, known: KnownParameter, value: float) -> Fix | None:
    """Return the frequency for a period, if the number is one."""
    if "frequency" not in parameter.name or not 0 < value < known.low:
        return None
    right, said = f"{float(f'{1 / value:.2g}'):.1f}", parameter.fact.value
    hint = f"write {right}, if {said} is the time between two [s]"
    return write(parameter.value_place, said, right, hint=hint)


def wrong_signs(
    parameter: Parameter, known: KnownParameter, part: NodePart
) -> Iterator[Problem]:
    """Report a limit with the other sign, alone or in a list."""
    written, file = parameter.written, parameter.place.file
    items = written.value if isinstance(written, yaml.SequenceNode) else [written]
    wrong = [
        (item, item.value)
        for item in items
        if isinstance(item, yaml.ScalarNode)
        and (value := number_of(item.value)) is not None
        and not known.low <= value <= known.high
    ]
    if not wrong:
        return
    sign = "negative" if known.high == 0 else "positive"
    right = [_negated(text) for _, text in wrong]
    hint = f"write {' and '.join(right)}"
    yield Problem.at(
        place_of(wrong[0][0], file),
        "error" if known.strict else "warning",
        "parameter-value",
        f"{parameter.name} has {wrong[0][1]}, but {part.node} needs {sign} numbers "
        "there: it "
        + ("stops with an error" if known.strict else "does not move as it should"),
        together(
            hint,
            *(
                instead(item, file, each, hint)
                for (item, _), each in zip(wrong, right, strict=True)
            ),
        ),
    )


def _negated(text: str) -> str:
    return text[1:] if text.startswith("-") else f"-{text.lstrip('+')}"
