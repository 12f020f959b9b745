"""Misspelt names and values among the parameters of well-known nodes."""

from __future__ import annotations

import re
from collections.abc import Container, Iterator

from sambot_viz.checks.around.files.parameters import Parameter
from sambot_viz.checks.around.navigation import filters
from sambot_viz.checks.around.surroundings import Surroundings
from sambot_viz.checks.vocabulary import vocabulary
from sambot_viz.edits import write
from sambot_viz.errors import Problem, nearest

_LIKENESS = 0.8
_NUMBER = re.compile(r"\d+")
_COSTMAPS = ("local_costmap", "global_costmap")
_SAME_NODE = {"recoveries_server": "behavior_server"}
_VALUES = {
    "data_type": ("LaserScan", "PointCloud2"),
    "laser_model_type": ("beam", "likelihood_field", "likelihood_field_prob"),
}
"""Parameter of Nav2 → the only values that it may have."""


def misspelt_parameters(around: Surroundings) -> Iterator[Problem]:
    """Report names that a node does not read, where the one meant is missing."""
    names = {one.node for one in filters(around)}
    for file in around.yaml_files:
        for node in file.nodes:
            kind = "filter" if node in names else _kind(node)
            given = file.of(node)
            for parameter in given.values() if kind else ():
                right = meant_name(parameter.name, given, kind)
                if right is not None:
                    yield _misspelt(parameter, right)


def _misspelt(parameter: Parameter, right: str) -> Problem:
    wrong = parameter.name.rpartition(".")[2]
    node = parameter.node.rpartition("/")[2]
    return Problem.at(
        parameter.place,
        "warning",
        "parameter-unknown",
        f"{node} has no parameter {wrong}, but {right}, which is not given: it does "
        "not read this line",
        write(parameter.place, wrong, right),
    )


def _kind(node: str) -> str:
    name = node.rpartition("/")[2]
    return "costmap" if name in _COSTMAPS else _SAME_NODE.get(name, name)


def meant_name(name: str, given: Container[str], kind: str) -> str | None:
    """Return the parameter that was meant by one that a node does not have.

    Args:
        name: as the file has it, with the names of plugins before it.
        given: the names of all parameters of the node.
        kind: of the node, as the vocabulary calls it.

    Returns:
        The last part of its name; None for a known name, for one like no other, and
        where the other one is given too.
    """
    head, dot, last = name.rpartition(".")
    known = vocabulary("parameters").get(kind + "." * name.count("."), ())
    shape = _NUMBER.sub("N", last) if kind == "filter" else last
    if not known or shape in known:
        return None
    near = nearest(shape, known, _LIKENESS)
    if near is None or _NUMBER.sub("", near) == _NUMBER.sub("", shape):
        return None
    digits = _NUMBER.search(last)
    right = near.replace("N", digits[0] if digits else "0")
    return None if f"{head}{dot}{right}" in given else right


def unknown_values(around: Surroundings) -> Iterator[Problem]:
    """Report values that are almost one of the few that a parameter may have."""
    for parameter in around.parameters:
        known = _VALUES.get(parameter.name.rpartition(".")[2], ())
        said = parameter.fact.value
        near = nearest(said, known, _LIKENESS) if said not in known else None
        if near is not None:
            yield Problem.at(
                parameter.value_place,
                "error",
                "parameter-value",
                f"{parameter.name} is {said}, but Nav2 knows only {' and '.join(known)}"
                f": {parameter.node.rpartition('/')[2]} stops with an error",
                write(parameter.value_place, said, near),
            )
