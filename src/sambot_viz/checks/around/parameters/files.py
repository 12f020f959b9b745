"""Report what ROS cannot read in the parameters of any node."""

from __future__ import annotations

from collections.abc import Iterator

import yaml

from sambot_viz.checks.around.files.parameters import Parameter
from sambot_viz.checks.around.parameters.node_parts import parts_by_node
from sambot_viz.checks.around.parameters.text import as_written, fixed, is_open, type_of
from sambot_viz.checks.around.place import where
from sambot_viz.checks.around.surroundings import Surroundings
from sambot_viz.edits import together
from sambot_viz.errors import Fix, Problem


def unreadable_parameters(around: Surroundings) -> Iterator[Problem]:
    """Report values that ROS cannot read, and duplicate parameters."""
    parts = (part for each in parts_by_node(around) for part in each)
    known = {id(parameter) for part in parts for parameter, _ in part.known()}
    for file in around.yaml_files:
        seen: dict[tuple[str, str], Parameter] = {}
        for parameter in file.parameters:
            first = seen.setdefault((parameter.node, parameter.name), parameter)
            if first.place != parameter.place and first.values != parameter.values:
                yield _twice(first, parameter)
            written = parameter.written
            if id(parameter) not in known and isinstance(written, yaml.SequenceNode):
                yield from _mixed(parameter, written.value)


def _twice(first: Parameter, second: Parameter) -> Problem:
    node = second.node.rpartition("/")[2]
    return Problem.at(
        second.place,
        "warning",
        "parameter-value",
        f"{second.name} is given to {node} twice: {first.fact.value} "
        f"({where(first.place, second.place)}) is not used",
        "delete one of the two lines",
    )


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
