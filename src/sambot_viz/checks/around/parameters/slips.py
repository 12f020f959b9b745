"""Report slips in parameter files without knowledge of the node."""

from __future__ import annotations

import re
from collections.abc import Iterator
from itertools import pairwise
from typing import Any

import yaml

from sambot_viz.checks.around.files.parameters import (
    Parameter,
    each_mapping,
    pairs,
    place_of,
)
from sambot_viz.checks.around.parameters.known import ParameterBlock
from sambot_viz.checks.around.parameters.node_parts import NodePart, parts_by_node
from sambot_viz.checks.around.place import moved, where
from sambot_viz.checks.around.surroundings import Surroundings
from sambot_viz.edits import write
from sambot_viz.errors import Place, Problem
from sambot_viz.robot.slips.vocabulary import is_one_slip

_KEY = "ros__parameters"
_DECIMAL_COMMA = re.compile(r"-?\d+,\d+")
_TRUTH = ("true", "false")
WORDS = frozenset({"rue", "tree", "tue"})
"""Real words that are similar to true or false."""
_ALL = 10_000
"""More entries than a level has."""
_LONG = 4


def parameters_of_nobody(around: Surroundings) -> Iterator[Problem]:
    """Report parameters without the name of a node above them."""
    for file in around.yaml_files:
        for above, node in each_mapping(file.root, left_out=(_KEY,)):
            keys = (key for key, _ in pairs(node) if key.value == _KEY)
            places = [place_of(key, file.shown) for key in keys]
            level = list(pairs(node))
            for (key, value), (below, _) in pairwise(level):
                if _KEY in (key.value, below.value) and _is_empty(value):
                    yield _beside(key, below, file.shown)
                    places.clear()
            if places and not above:
                yield _nameless(places[0], "at the top, below no node")
            elif len(places) > 1:
                yield _nameless(places[1], f"below {above} a second time")


def _nameless(place: Place, what: str) -> Problem:
    return Problem.at(
        place,
        "error",
        "parameters-key",
        f"{_KEY} is {what}: the name of the node above it is missing, or not at the "
        "level above; the node that the file is for stops, or has no parameters",
        "write the name of the node and a colon above this line, two blanks further "
        "to the left",
    )


def _is_empty(node: yaml.Node) -> bool:
    return isinstance(node, yaml.ScalarNode) and not node.value and not node.style


def _beside(key: yaml.ScalarNode, below: yaml.ScalarNode, shown: str) -> Problem:
    """Report a key beside an empty key that should be above it."""
    place = place_of(below, shown)
    return Problem.at(
        place,
        "error",
        "parameters-key",
        f"{below.value} is beside {key.value} "
        f"({where(place_of(key, shown), place)}), not below it: the node that the file "
        "is for stops, or has no parameters",
        moved(place, 2, _ALL if key.value == _KEY else 1),
    )


def texts_for_values(around: Surroundings) -> Iterator[Problem]:
    """Report misspelt true and false, and numbers with a comma."""
    parts = (part for each in parts_by_node(around) for part in each)
    known = {id(parameter) for part in parts for parameter, _ in part.known()}
    for parameter in around.parameters:
        written: Any = parameter.written
        plain = isinstance(written, yaml.ScalarNode) and not written.style
        text = parameter.fact.value
        if id(parameter) in known or not plain or text.lower() in (*_TRUTH, *WORDS):
            continue
        near = [word for word in _TRUTH if is_one_slip(text.lower(), word)]
        if _DECIMAL_COMMA.fullmatch(text):
            near = [text.replace(",", ".")]
        if near and len(text) >= min(_LONG, len(near[0])):
            yield Problem.at(
                parameter.value_place,
                "warning",
                "parameter-type",
                f"{parameter.name} is the text {text}, but probably {near[0]} is "
                "meant: a node that needs that stops with an error",
                write(parameter.value_place, text, near[0]),
            )


def incomplete_nodes(around: Surroundings) -> Iterator[Problem]:
    """Report nodes, and their entries, without a required parameter."""
    given = {(p.node.rpartition("/")[2], p.name) for p in around.parameters}
    for part, *_ in parts_by_node(around):
        block = part.block or ParameterBlock()
        meant = {block.meant(name, part.given) for name in part.given}
        for known in (each for each in block.parameters.values() if each.needed):
            for name, first in _entries(known.name, part).items():
                if name in meant or (part.node, name) in given:
                    continue
                *above, entry, last = ["", part.node, *name.split(".")]
                is_entry = "*" in known.name
                of = f"each of the {above[-1]}" if is_entry else "its class"
                yield Problem.at(
                    first.place,
                    # A controller may get more from files that are not here.
                    "error" if is_entry else "warning",
                    "parameter-value",
                    f"{entry} has no {last}, which {of} needs: {part.node} stops with "
                    "an error",
                    f"add {last} to {entry}",
                )


def _entries(name: str, part: NodePart) -> dict[str, Parameter]:
    """Return the names that a pattern with * matches here, each with its first line."""
    found: dict[str, Parameter] = {}
    before, star, after = name.partition("*")
    for other, parameter in part.given.items():
        if star and other.startswith(before):
            entry, dot, _ = other.removeprefix(before).partition(".")
            if not dot:
                continue
            found.setdefault(f"{before}{entry}{after}", parameter)
        elif not star:
            found.setdefault(name, parameter)
    return found
