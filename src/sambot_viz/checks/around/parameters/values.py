"""Check parameter values of well-known nodes: types, words, ranges and frames."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator
from itertools import pairwise

import yaml

from sambot_viz.checks.around.files.parameters import Parameter, place_of
from sambot_viz.checks.around.parameters.known import KnownParameter
from sambot_viz.checks.around.parameters.node_parts import NodePart, parts_by_node
from sambot_viz.checks.around.parameters.ranges import out_of_range, wrong_signs
from sambot_viz.checks.around.parameters.text import (
    OPEN,
    REPLACED,
    WANTED,
    as_written,
    converted,
    fixed,
    instead,
    is_open,
    type_of,
)
from sambot_viz.checks.around.place import where
from sambot_viz.checks.around.surroundings import Surroundings
from sambot_viz.edits import exchange, together, write
from sambot_viz.errors import Fix, Place, Problem, nearest

_LIKENESS = 0.8
_OTHERS = "..."
"""Among the words of a parameter: it also knows others."""
_LINES = 3
"""Number of lines with equally many items that show the layout of a list."""
_KINDS = {
    "frame": "string",
    "section": "string",
    "sections": "strings",
    "sources": "string",
}
"""Kind of a parameter → the type of its value, where the names differ."""


def wrong_values(around: Surroundings) -> Iterator[Problem]:
    """Report values of another type, out of range, or with an unknown word."""
    for part in (part for parts in parts_by_node(around) for part in parts):
        exchanged = _exchanged(part)
        for parameter, known in part.known():
            if parameter in exchanged:
                yield from exchanged[parameter]
                continue
            kind = _KINDS.get(known.kind, known.kind)
            found = _type(parameter, kind, part.node, around)
            if found is None and known.counts:
                found = _count(parameter, known, part.node)
            yield from [found] if found else _value(parameter, known, part)


def _exchanged(part: NodePart) -> dict[Parameter, list[Problem]]:
    """Return each pair of lines with exchanged values, with its finding."""
    found: dict[Parameter, list[Problem]] = {}
    for (one, first), (two, second) in pairwise(part.known()):
        kinds, types = (first.kind, second.kind), (type_of(one.written),)
        types = (*types, type_of(two.written))
        is_next = two.place.line == one.place.line + 1
        if not is_next or kinds != types[::-1] or kinds == types or one in found:
            continue
        here, there = one.value_place, two.value_place
        said, other = one.fact.value, two.fact.value
        problem = Problem.at(
            here,
            "error",
            "parameter-type",
            f"{one.name} is {said}, and {two.name} is {other} "
            f"({where(two.place, here)}): each has the type of the other, and "
            f"{part.node} stops with an error",
            exchange(
                f"write {other} here and {said} there", (here, said), (there, other)
            ),
        )
        found |= {one: [problem], two: []}
    return found


def _type(
    parameter: Parameter, kind: str, node: str, around: Surroundings
) -> Problem | None:
    """Report a value of another type than the node declares."""
    written, file = parameter.written, parameter.place.file
    is_list, text = type_of(written) == "list", parameter.fact.value.strip()
    if kind not in WANTED or OPEN.search(text) or REPLACED.fullmatch(text):
        return None
    wanted, place = WANTED[kind], place_of(written, file)
    if type_of(written) == "none":
        return _finding(
            parameter,
            parameter.place,
            "empty",
            node,
            wanted,
            _filled(parameter, around),
        )
    if kind.endswith("s") and not is_list:
        fix = instead(written, file, f"[{text}]", f"write [{text}]")
        said = as_written(written)
        return _finding(parameter, place, said, node, wanted, fix)
    if is_list and not kind.endswith("s"):
        one = parameter.values[0] if len(parameter.values) == 1 else None
        better = one and converted(one, kind)
        hint = Fix(f"write {better or wanted}")
        said = "a list with one item" if one else "a list"
        return _finding(parameter, place, said, node, wanted, hint)
    items: list[yaml.Node] = written.value if is_list else [written]
    kind = kind.removesuffix("s") if is_list else kind
    wrong = [n for n in items if type_of(n) not in (kind, "list") and not is_open(n)]
    if not wrong:
        return None
    fixes = [fixed(item, kind, file) for item in wrong]
    fix = fixes[0] if len(fixes) == 1 else together(fixes[0].hint, *fixes)
    said = f"a list with {as_written(wrong[0])}" if is_list else as_written(wrong[0])
    said = said.replace("list with the text", "list with")
    return _finding(parameter, place_of(wrong[0], file), said, node, wanted, fix)


def _finding(
    parameter: Parameter, place: Place, said: str, node: str, wanted: str, fix: Fix
) -> Problem:
    return Problem.at(
        place,
        "error",
        "parameter-type",
        f"{parameter.name} is {said}, but {node} needs {wanted}: it stops "
        "with an error",
        fix,
    )


def _filled(parameter: Parameter, around: Surroundings) -> Fix:
    """Return what to write for an empty value."""
    if parameter.name != "robot_base_frame":
        return Fix("write a value, or delete this line")
    known, base = around.known, "base_link"
    if known is not None and base not in known.links:
        base = known.root
    return Fix(f"write robot_base_frame: {base}")


def _count(parameter: Parameter, known: KnownParameter, node: str) -> Problem | None:
    """Report a list with more or fewer items than the node accepts."""
    count = len(parameter.values)
    wanted = min(known.counts, key=lambda each: abs(each - count))
    missing = wanted - count
    if not count or not missing or OPEN.search(parameter.fact.value):
        return None
    filling = "false" if known.kind == "booleans" else "0.0"
    surplus = f"{-missing} values" if missing < -1 else "value"
    meaning = ": position, rotation, both velocities and acceleration, three each"
    odd = _odd_line(parameter, missing)
    if odd is not None:
        many = "fewer" if missing > 0 else "more"
        return _finding_of_line(parameter, odd, many, f"{count} values", node, wanted)
    return Problem.at(
        parameter.value_place,
        "error",
        "parameter-type",
        f"{parameter.name} has {count} values, but {node} needs {wanted}"
        + (meaning if known.kind == "booleans" else ""),
        f"add {', '.join([filling] * missing)} at the end of the list"
        if missing > 0
        else f"delete the last {surplus}",
    )


def _odd_line(parameter: Parameter, missing: int) -> Place | None:
    """Return the only line of a list that has the missing or surplus items."""
    items: list[yaml.Node] = (
        parameter.written.value
        if isinstance(parameter.written, yaml.SequenceNode)
        else []
    )
    places = [place_of(item, parameter.place.file) for item in items]
    counts = Counter(place.line for place in places)
    usual, often = Counter(counts.values()).most_common(1)[0]
    odd = [line for line, count in counts.items() if count != usual]
    if often < _LINES or len(odd) != 1 or counts[odd[0]] != usual - missing:
        return None
    return next(place for place in places if place.line == odd[0])


def _finding_of_line(
    parameter: Parameter, odd: Place, many: str, said: str, node: str, wanted: int
) -> Problem:
    fix = "write one more" if many == "fewer" else "delete one"
    return Problem.at(
        odd,
        "error",
        "parameter-type",
        f"{parameter.name} (line {parameter.place.line}) has {said}, but {node} needs "
        f"{wanted}: this line has {many} than the others",
        f"{fix} in this line, so that it has as many values as the others",
    )


def _value(
    parameter: Parameter, known: KnownParameter, part: NodePart
) -> Iterator[Problem]:
    """Report a value of the right type that makes no sense."""
    said, place = parameter.fact.value, parameter.value_place
    if OPEN.search(said):
        return
    if known.signed:
        yield from wrong_signs(parameter, known, part)
    if type_of(parameter.written) == "list":
        return
    if known.words and said not in known.words:
        yield from _word(parameter, known, part)
    elif known.kind == "frame" and said.startswith("/") and len(said) > 1:
        yield Problem.at(
            place,
            "warning",
            "frame-slash",
            f"{part.node} asks for the frame {said}, but no frame of ROS 2 begins with "
            "a slash: it never gets a transform",
            write(place, said, said[1:]),
        )
    elif known.kind in ("number", "integer") and not known.signed:
        yield from out_of_range(parameter, known, part)


def _word(
    parameter: Parameter, known: KnownParameter, part: NodePart
) -> Iterator[Problem]:
    """Report a text that is none of the words that a node knows."""
    said, place = parameter.fact.value, parameter.value_place
    words = [word for word in known.words if word != _OTHERS]
    lower = {word.lower(): word for word in words}
    # A class or a message may have its package before it.
    last = re.split(r"[/:.]", said)[-1].lower()
    near = lower.get(said.lower()) or lower.get(last) or nearest(said, words, _LIKENESS)
    if _OTHERS in known.words and (near is None or said in part.sections):
        return
    follows = "stops with an error" if known.strict else "does not use this value"
    allowed = f"{', '.join(words[:-1])} and {words[-1]}"
    yield Problem.at(
        place,
        "error" if known.strict else "warning",
        "parameter-value",
        f"{parameter.name} is {said}, but {part.node} knows only {allowed}: it "
        f"{follows}",
        write(place, said, near) if near else f"write one of {allowed}",
    )
