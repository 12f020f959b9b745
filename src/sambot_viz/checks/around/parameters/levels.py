"""Check the levels of lines in parameter files: groups, entries and empty keys."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

import yaml

from sambot_viz.checks.around.files.parameters import (
    Parameter,
    YamlFile,
    each_mapping,
    pairs,
    place_of,
)
from sambot_viz.checks.around.parameters.known import ParameterBlock
from sambot_viz.checks.around.parameters.node_parts import (
    NodePart,
    names_in,
    parts_by_node,
)
from sambot_viz.checks.around.parameters.text import type_of
from sambot_viz.checks.around.place import moved, where
from sambot_viz.checks.around.surroundings import Surroundings
from sambot_viz.edits import source_of, write_between
from sambot_viz.errors import Fix, Place, Problem

_KEY = "ros__parameters"
Level = Sequence[tuple[yaml.ScalarNode, yaml.Node]]
"""The keys and values of a mapping."""


def values_beside_parameters(around: Surroundings) -> Iterator[Problem]:
    """Report values of a node that are beside ros__parameters, not below it."""
    for file in around.yaml_files:
        for _, node in each_mapping(file.root, left_out=(_KEY,)):
            level = list(pairs(node))
            names = [key.value for key, _ in level]
            if _KEY not in names:
                continue
            at = names.index(_KEY)
            _, inner = level[at]
            first = next((key for key, _ in pairs(inner)), None)
            odd = [n for n, each in enumerate(level) if _has_values(*each)]
            if first is None or not odd or _KEY in names[at + 1 :]:
                continue
            key, place = level[odd[0]][0], place_of(level[odd[0]][0], file.shown)
            blanks = first.start_mark.column - key.start_mark.column
            fix = Fix(f"move these lines below {_KEY}:")
            if odd[0] == at + 1 and odd == list(range(odd[0], odd[-1] + 1)):
                fix = moved(place, blanks, len(odd)) if blanks > 0 else fix
            yield Problem.at(
                place,
                "error",
                "parameters-key",
                f"{key.value} is beside {_KEY} "
                f"({where(place_of(level[at][0], file.shown), place)}), not below it: "
                "the node that the file is for stops, or does not read it",
                fix,
            )


def _has_values(key: yaml.ScalarNode, node: yaml.Node) -> bool:
    """Return whether a key beside ros__parameters has values, and is no node."""
    if key.value == _KEY or key.value == "<<":
        return False
    if not isinstance(node, yaml.MappingNode):
        return type_of(node) != "none"
    keys = {k.value for _, each in each_mapping(node) for k, _ in pairs(each)}
    return bool(keys) and _KEY not in keys


def lines_at_other_levels(around: Surroundings) -> Iterator[Problem]:
    """Report entries beside their empty key, and lines inside of another group."""
    files = {file.shown: file for file in around.yaml_files}
    for part in (part for parts in parts_by_node(around) for part in parts):
        block = part.block or ParameterBlock()
        again = _given_before(part, files) if part.is_known else {}
        for name, parameter in part.given.items():
            file = files[parameter.place.file]
            is_own = "." not in name or name.partition(".")[0] in block.groups
            if type_of(parameter.written) == "none" and is_own:
                beside = [*_beside_key(name, parameter, part, block, file)]
                is_known = block.find(name) is not None
                yield from beside or ([] if is_known else [_empty(parameter)])
            elif name in again and "." in name and is_own:
                yield from _without_group(again[name], name, part, block)
            elif part.is_known and "." in name and block.find(name) is None:
                yield from _inside_group(name, parameter, part, block)


def _given_before(
    part: NodePart, files: Mapping[str, YamlFile]
) -> dict[str, tuple[Parameter, Parameter]]:
    """Return the parameters that a group of the file gives a second time."""
    found: dict[str, tuple[Parameter, Parameter]] = {}
    for name, last in part.given.items():
        if part.section or not last.above:
            continue
        same = [p for p in files[last.place.file].parameters if p.above == last.above]
        twice = [p for p in same if p.name == last.name]
        if len(twice) > 1:
            found[name] = (twice[-2], twice[-1])
    return found


def _without_group(
    both: tuple[Parameter, Parameter], name: str, part: NodePart, block: ParameterBlock
) -> Iterator[Problem]:
    """Report lines that follow those of a group, without the name of theirs."""
    parameter, group = both[1], name.rpartition(".")[0]
    other = _absent_group(parameter, name, part, block)
    if other is None:
        return
    yield _missing_group(parameter, group, other, part)


def _beside_key(
    name: str,
    parameter: Parameter,
    part: NodePart,
    block: ParameterBlock,
    file: YamlFile,
) -> Iterator[Problem]:
    """Report the lines beside an empty key that belong below it."""
    levels = (list(pairs(node)) for _, node in each_mapping(file.root))
    level, at = next(
        (level, n)
        for level in levels
        for n, (_, value) in enumerate(level)
        if value is parameter.written
    )
    key, count = level[at][0], 0
    for below, _ in level[at + 1 :]:
        if not _belongs(name, below.value, part, block):
            break
        count += 1
    if not count:
        return
    below = place_of(level[at + 1][0], file.shown)
    blanks = key.start_mark.column - level[at + 1][0].start_mark.column + 2
    yield Problem.at(
        below,
        "error",
        "parameters-key",
        f"{level[at + 1][0].value} is beside {key.value} "
        f"({where(parameter.place, below)}), not below it, and {key.value} is empty: "
        f"{part.node} stops",
        moved(below, blanks, count),
    )


def _empty(parameter: Parameter) -> Problem:
    return Problem.at(
        parameter.place,
        "warning",
        "parameter-type",
        f"{parameter.name} is empty: ROS reads no parameters from a file with an empty "
        "value, and the node does not start",
        "write a value, or delete this line",
    )


def _belongs(name: str, below: str, part: NodePart, block: ParameterBlock) -> bool:
    """Return whether a line is for the empty key before it."""
    above, dot, key = name.rpartition(".")
    beside = f"{above}{dot}{below}"
    if block.find(beside) is not None or beside in block.groups:
        return False
    if block.find(f"{name}.{below}") is not None:
        return True
    named = {each for one, _ in part.lists() for each in names_in(one)}
    for known in block.parameters.values():
        if known.name not in part.given:
            named.update(*known.own)
    return not dot and key in named and below not in named


def _inside_group(
    name: str, parameter: Parameter, part: NodePart, block: ParameterBlock
) -> Iterator[Problem]:
    """Report a line inside a group that the node has above it, or in another group."""
    group, _, last = name.rpartition(".")
    keys = [k for k in parameter.above if k.value == group.rpartition(".")[2]]
    if group.partition(".")[0] not in block.groups or not keys:
        return
    file, column = parameter.place.file, keys[-1].start_mark.column
    line = Place(file, parameter.place.line, _column(parameter, last))
    other = _absent_group(parameter, name, part, block)
    if block.find(last) is not None and last not in part.given:
        cause = f"{last} is inside {group}, but belongs beside it"
        fix = moved(line, column + 1 - (line.column or 1))
    elif other is not None:
        yield _missing_group(parameter, group, other, part)
        return
    else:
        return
    yield Problem.at(
        line,
        "warning",
        "parameter-unknown",
        f"{cause}: {part.node} does not read it",
        fix,
    )


def _absent_group(
    parameter: Parameter, name: str, part: NodePart, block: ParameterBlock
) -> str | None:
    """Return the only group that is not in the file and could have a line."""
    last, kind = name.rpartition(".")[2], type_of(parameter.written)
    absent = block.groups - {given.partition(".")[0] for given in part.given}
    inside = ((g, block.find(f"{g}.{last}")) for g in absent)
    others = [g for g, known in inside if known is not None and known.kind == kind]
    first = min(others, default=None)
    # scale_linear_turbo is seldom without scale_linear.
    is_clear = first is not None and all(each.startswith(first) for each in others)
    return first if is_clear else None


def _missing_group(
    parameter: Parameter, group: str, other: str, part: NodePart
) -> Problem:
    last = parameter.name.rpartition(".")[2]
    at = Place(parameter.place.file, parameter.place.line, 1)
    blanks = " " * parameter.above[-1].start_mark.column
    return Problem.at(
        parameter.place,
        "warning",
        "parameter-unknown",
        f"{last} is inside {group}: the line {other}: is missing above it, and "
        f"{part.node} does not read it as {other}.{last}",
        write_between(
            at, at, f"{blanks}{other}:\n", f"add a line {other}: above this one"
        ),
    )


def _column(parameter: Parameter, last: str) -> int:
    """Return the column of the key of a parameter."""
    source = source_of(parameter.place.file)
    lines = source.text.split("\n") if source is not None else []
    line = lines[parameter.place.line - 1] if lines else ""
    return max(0, line.find(last)) + 1
