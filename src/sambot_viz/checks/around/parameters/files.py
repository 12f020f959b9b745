"""Report what ROS cannot read in the parameters of any node."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

import yaml

from sambot_viz.checks.around.files.parameters import Parameter, pairs, place_of
from sambot_viz.checks.around.parameters.copied_inputs import is_copied
from sambot_viz.checks.around.parameters.known import known_parameters
from sambot_viz.checks.around.parameters.node_parts import parts_by_node
from sambot_viz.checks.around.parameters.text import as_written, fixed, is_open, type_of
from sambot_viz.checks.around.place import where
from sambot_viz.checks.around.surroundings import Surroundings
from sambot_viz.edits import source_of, together, write, write_between
from sambot_viz.errors import Fix, Place, Problem


def unreadable_parameters(around: Surroundings) -> Iterator[Problem]:
    """Report values that ROS cannot read, and duplicate parameters."""
    parts = (part for each in parts_by_node(around) for part in each)
    known = {id(parameter) for part in parts for parameter, _ in part.known()}
    for file in around.yaml_files:
        others = [p for p in file.parameters if not is_copied(around, p.place)]
        for same in _given_again(others):
            yield from _entry(same) if len(same) > 1 else [_twice(*same[0])]
        for parameter in file.parameters:
            written = parameter.written
            if isinstance(written, yaml.SequenceNode):
                items: list[yaml.Node] = written.value
                yield from _mappings(parameter, items)
                yield from () if id(parameter) in known else _mixed(parameter, items)


_Pair = tuple[Parameter, Parameter]
"""Two places that give one parameter."""


def _given_again(parameters: Iterable[Parameter]) -> list[list[_Pair]]:
    """Return the parameters that are given twice, those of neighbouring lines as one.

    Returns:
        For each place of several lines, the pairs of parameters in its order.
    """
    seen: dict[tuple[str, str], Parameter] = {}
    found: list[list[_Pair]] = []
    for parameter in parameters:
        first = seen.setdefault((parameter.node, parameter.name), parameter)
        if first.place == parameter.place:
            continue
        last = found[-1][-1][1] if found else None
        is_next = last is not None and last.place.line + 1 == parameter.place.line
        if is_next and last is not None and last.above == parameter.above:
            found[-1].append((first, parameter))
        else:
            found.append([(first, parameter)])
    return [same for same in found if any(a.values != b.values for a, b in same)]


def _entry(same: list[_Pair]) -> Iterator[Problem]:
    """Report lines that give values of a group a second time."""
    one = same[0][1]
    if not one.above or one.above != same[0][0].above:
        yield from (_twice(*pair) for pair in same)
        return
    group = one.above[-1]
    names = [pair[1].name.rpartition(".")[2] for pair in same]
    yield Problem.at(
        one.place,
        "warning",
        "parameter-value",
        f"{', '.join(names[:-1])} and {names[-1]} are in {group.value} "
        f"({where(place_of(group, one.place.file), one.place)}) a second time, and "
        "only these are used: the line with the name of another group is missing above",
        f"write the name of that group and a colon above this line, with "
        f"{group.start_mark.column} blanks before it",
    )


def _mappings(parameter: Parameter, items: list[yaml.Node]) -> Iterator[Problem]:
    """Report names with values in a list, which ROS reads as one list of values."""
    mappings = [item for item in items if isinstance(item, yaml.MappingNode)]
    values = [[value for _, value in pairs(item)] for item in mappings]
    # Only behind a scalar ROS takes the next name for a value.
    mixed = [v for each in values for v in each[:-1] if isinstance(v, yaml.ScalarNode)]
    if not mixed:
        return
    types = {type_of(value) for each in values for value in each}
    first = place_of(mappings[0], parameter.place.file)
    fixes = [_named(item, parameter.place.file) for item in mappings]
    hint = fixes[0].hint
    yield Problem.at(
        first,
        "error" if types - {"string", "list"} else "warning",
        "parameter-type",
        f"{parameter.name} is a list whose items have names and values: the parameters "
        "of ROS 2 have no such lists, and "
        + (
            "the node does not start"
            if types - {"string", "list"}
            else "the names become values"
        ),
        together(hint, *fixes),
    )


def _named(item: yaml.Node, file: str) -> Fix:
    """Return the fix that gives an item of a list its name as a key."""
    hint = "write a name of its own and a colon for the - of each item"
    (key, value), *more = pairs(item)
    begin, end = key.start_mark, value.end_mark
    source = source_of(file)
    lines = source.text.split("\n") if source is not None else [""]
    line = lines[begin.line] if begin.line < len(lines) else ""
    alone = line[: begin.column].strip() == "-" and begin.line == end.line
    if key.value != "name" or not isinstance(value, yaml.ScalarNode) or not alone:
        return Fix(hint)
    if not more or more[0][0].start_mark.line == begin.line:
        return Fix(hint)
    at = Place(file, begin.line + 1, line.index("-") + 1)
    behind = Place(file, end.line + 1, end.column + 1)
    hint = f"write {value.value}: for - name: {value.value}, and so for each item"
    return write_between(at, behind, f"{value.value}:", hint)


def _twice(first: Parameter, second: Parameter) -> Problem:
    node = second.node.rpartition("/")[2]
    return Problem.at(
        second.place,
        "warning",
        "parameter-value",
        f"{second.name} is given to {node} twice: {first.fact.value} "
        f"({where(first.place, second.place)}) is not used",
        _inner_plugin(first, second) or "delete one of the two lines",
    )


def _inner_plugin(first: Parameter, second: Parameter) -> Fix | None:
    """Return the fix for the plugin inside of a plugin, which has another name."""
    classes = known_parameters().classes
    outer, inner = (classes.get(each.fact.value) for each in (first, second))
    if outer is None or inner is None:
        return None
    names = [
        name
        for name, known in outer.block.parameters.items()
        if known.kind == "string" and known.base == inner.base
    ]
    last = second.name.rpartition(".")[2]
    return write(second.place, last, names[0]) if len(names) == 1 else None


def _mixed(parameter: Parameter, items: list[yaml.Node]) -> Iterator[Problem]:
    """Report a list whose items have several types."""
    types = {type_of(item): item for item in reversed(items)}
    if len(types) < 2 or any(is_open(item) for item in items):
        return
    one, two, *_ = [as_written(item) for item in reversed(types.values())]
    fix = Fix("write items of one type")
    if types.keys() == {"integer", "number"}:
        whole = [item for item in items if type_of(item) == "integer"]
        fixes = [fixed(item, "number", parameter.place.file) for item in whole]
        fix = together(fixes[0].hint, *fixes)
    yield Problem.at(
        parameter.value_place,
        "error",
        "parameter-type",
        f"{parameter.name} is a list with {one} and {two}: ROS reads only lists with "
        "items of one type, and the node does not start",
        fix,
    )
