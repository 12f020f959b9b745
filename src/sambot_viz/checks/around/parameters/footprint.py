"""Check the footprint of Nav2: its syntax, and its size against the shapes."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import pairwise

import yaml

from sambot_viz import limits
from sambot_viz.checks.around.files.parameters import Parameter, YamlFile
from sambot_viz.checks.around.parameters.navigation import is_open
from sambot_viz.checks.around.parameters.node_parts import parts_by_node
from sambot_viz.checks.around.parameters.polygon import NUMBER, distance, polygon_of
from sambot_viz.checks.around.parameters.text import type_of
from sambot_viz.checks.around.surroundings import Surroundings
from sambot_viz.checks.clues import severity
from sambot_viz.errors import Problem

_GAP = r"[\s,]*"
_CORNER = rf"\[{_GAP}{NUMBER}[\s,]+{NUMBER}{_GAP}\]{_GAP}"
_CORNERS = re.compile(rf"{_GAP}\[{_GAP}(?:{_CORNER}){{3,}}\]{_GAP}")
_WORD = re.compile(r"[^\s,\[\]]+")
_NONE = frozenset({"", "[]"})


def unreadable_footprints(around: Surroundings) -> Iterator[Problem]:
    """Report footprints that Nav2 cannot read."""
    for part in (part for parts in parts_by_node(around) for part in parts):
        for parameter, known in part.known():
            if known.kind == "footprint" and not is_readable(parameter):
                yield _unreadable(parameter, part.node)


def is_readable(footprint: Parameter) -> bool:
    """Return whether Nav2 can read a footprint; True without one."""
    if type_of(footprint.written) == "list":
        return not footprint.written.value
    text = footprint.fact.value
    if text.strip() in _NONE or is_open(text) or len(text) > limits.BUILD_FILE.value:
        return True
    return _CORNERS.fullmatch(text) is not None


def _unreadable(parameter: Parameter, node: str) -> Problem:
    is_list = type_of(parameter.written) == "list"
    if is_list:
        words = list(_words(parameter.written))
        cause = f"the footprint is a list, but {node} reads it as one text"
        follows = "the node stops with an error"
    else:
        words = _WORD.findall(parameter.fact.value)
        cause = f"{node} cannot read the footprint: {_cause(parameter.fact.value)}"
        follows = "it takes the robot for a circle with robot_radius"
    return Problem.at(
        parameter.value_place,
        "error" if is_list else "warning",
        "footprint-text",
        f"{cause}; {follows}",
        _hint(words),
    )


def _cause(text: str) -> str:
    odd = _odd(_WORD.findall(text))
    if odd is not None:
        return f"{odd} is not a number"
    if "[" not in text and "]" not in text:
        return "the corners have no brackets"
    surplus = text.count("[") - text.count("]")
    if surplus:
        return f"a {']' if surplus > 0 else '['} is missing"
    return "it is not a list of corners with two numbers each"


def _odd(words: Sequence[str]) -> str | None:
    return next((w for w in words if not re.fullmatch(NUMBER, w)), None)


def _hint(words: Sequence[str]) -> str:
    odd = _odd(words)
    if odd is not None:
        return f"write a length in metres in place of {odd}"
    if len(words) < 6 or len(words) % 2:
        return 'write at least three corners, such as "[ [0.2, 0.1], [0.2, -0.1], … ]"'
    pairs = zip(words[::2], words[1::2], strict=True)
    return f'write "[ {", ".join(f"[{x}, {y}]" for x, y in pairs)} ]"'


def _words(node: yaml.Node) -> Iterator[str]:
    """Yield the numbers in a list of lists."""
    if isinstance(node, yaml.ScalarNode):
        yield from _WORD.findall(node.value)
    elif isinstance(node, yaml.SequenceNode):
        for item in node.value[:1000]:
            if isinstance(item, yaml.ScalarNode):
                yield from _WORD.findall(item.value)
            elif isinstance(item, yaml.SequenceNode):
                yield from (
                    str(i.value) for i in item.value if isinstance(i, yaml.ScalarNode)
                )


def footprints(around: Surroundings) -> Iterator[Problem]:
    """Report footprints that are too small or much too large for the robot.

    Files that contradict each other may be for several robots.
    """
    given = [one for file in around.yaml_files for one in _given(file)]
    sizes: dict[str, set[str]] = {}
    for node, _, said in given:
        sizes.setdefault(node, set()).add(said.fact.value)
    several = any(len(values) > 1 for values in sizes.values())
    clues = {"size"} if several else {"size", "only one"}
    for _, frame, said in given:
        if frame in around.robot.links:
            # Import late: only this comparison needs numpy.
            from sambot_viz.checks.around.parameters.footprint_size import compare

            for problem in compare(around.robot, frame, said):
                yield replace(problem, severity=severity(clues))


def _given(file: YamlFile) -> Iterator[tuple[str, str, Parameter]]:
    """Yield each costmap with its base frame, and its footprint or radius."""
    for node in file.nodes:
        given = file.of(node)
        base, said = given.get("robot_base_frame"), counted_footprint(given)
        if said is not None and node.endswith("costmap"):
            yield node, base.fact.value if base else "base_link", said


def counted_footprint(given: Mapping[str, Parameter]) -> Parameter | None:
    """Return the parameter that counts: a footprint overrides a radius.

    None without a parameter, or when Nav2 cannot read it.
    """
    footprint = given.get("footprint")
    if footprint is not None and not is_readable(footprint):
        return None
    if footprint is not None and re.search(r"\d", footprint.fact.value):
        return footprint
    return given.get("robot_radius")


def inscribed_radius(given: Mapping[str, Parameter]) -> float | None:
    """Return the distance from the base to the nearest side of a footprint [m].

    None without a footprint, or when it is unreadable.
    """
    said = counted_footprint(given)
    if said is None or said.fact.number is not None:
        return said.fact.number if said is not None else None
    polygon = polygon_of(said.fact.value) or []
    sides = pairwise([*polygon, *polygon[:1]])
    return min((distance((0.0, 0.0), a, b) for a, b in sides), default=None)
