"""Check parameters that launch files themselves give to well-known nodes."""

from __future__ import annotations

import ast
from collections.abc import Callable, Iterator
from typing import NamedTuple

import yaml

from sambot_viz.checks.around.files.parameters import read_yaml
from sambot_viz.checks.around.launching.launch_file import LaunchFile
from sambot_viz.checks.around.launching.python_parts import Call, Table
from sambot_viz.checks.around.parameters.declared import declared_parameters
from sambot_viz.checks.around.parameters.known import ParameterBlock, known_parameters
from sambot_viz.checks.around.parameters.text import OPEN, WANTED, converted, type_of
from sambot_viz.checks.around.place import rewritten
from sambot_viz.checks.around.running.known import known_nodes
from sambot_viz.checks.around.surroundings import Surroundings
from sambot_viz.edits import write, write_attribute
from sambot_viz.errors import Fix, Place, Problem
from sambot_viz.robot.xml.element import Element

_OWN_RULES = frozenset({"use_sim_time", "robot_description"})
"""Parameters with separate rules."""
_TYPES = {"bool": "boolean", "int": "integer", "float": "number", "str": "string"}


class _GivenValue(NamedTuple):
    """A parameter in a launch file.

    Attributes:
        name: its name.
        kind: the type of its value; empty for an unknown type.
        text: the value.
        place: of the value.
        name_place: of the name.
        fix: returns the fix that writes another value.
    """

    name: str
    kind: str
    text: str
    place: Place
    name_place: Place
    fix: Callable[[str], Fix]


def launched_parameters(around: Surroundings) -> Iterator[Problem]:
    """Report parameters with another name or type than the node declares."""
    for launch in around.launches:
        for call in launch.called():
            package = launch.text(call, "package") or ""
            program = launch.text(call, "executable") or ""
            block = _known(package, program, around)
            yield from _wrong(block, program, _in_call(launch, call))
    for root in (root for package in around.packages for root in package.frontends):
        for node in root.iter():
            package, program = node.get("pkg") or "", node.get("exec") or ""
            block = _known(package, program, around)
            yield from _wrong(block, program, _in_element(node))


def _known(package: str, program: str, around: Surroundings) -> ParameterBlock | None:
    """Return the parameters of a program in a well-known package or one of these."""
    known = known_nodes().nodes.get((package, program))
    if known is not None:
        return known_parameters().nodes.get(known.name)
    return declared_parameters(around).programs.get((package, program))


def _wrong(
    block: ParameterBlock | None, program: str, found: Iterator[_GivenValue]
) -> Iterator[Problem]:
    given = list(found) if block is not None else []
    names = {one.name for one in given}
    for one in given:
        if one.name not in _OWN_RULES and block is not None:
            yield from _of_block(one, block, names, program)


def _of_block(
    one: _GivenValue, block: ParameterBlock, names: set[str], program: str
) -> Iterator[Problem]:
    known, near = block.find(one.name), block.meant(one.name, names)
    if near is not None:
        yield Problem.at(
            one.name_place,
            "warning",
            "parameter-unknown",
            f"{program} has no parameter {one.name}, but {near}, which is not given: "
            "it does not read this one",
            write(one.name_place, one.name, near),
        )
    if known is None or known.kind not in WANTED or known.kind.endswith("s"):
        return
    if one.kind and one.kind != known.kind:
        better = converted(one.text, known.kind)
        yield Problem.at(
            one.place,
            "error",
            "parameter-type",
            f"{one.name} is {one.text}, but {program} needs {WANTED[known.kind]}: it "
            "stops with an error",
            f"write {WANTED[known.kind]}" if better is None else one.fix(better),
        )


def _in_call(launch: LaunchFile, call: Call) -> Iterator[_GivenValue]:
    for table, _ in call.listing("parameters").items:
        for pair in table.pairs if isinstance(table, Table) else ():
            node, name = pair.node, pair.key
            value = node.value if isinstance(node, ast.Constant) else None
            kind = _TYPES.get(type(value).__name__, "")

            def fix(right: str, node: ast.expr = node) -> Fix:
                python = {"true": "True", "false": "False"}.get(right, right)
                return rewritten(node, launch.shown, python)

            if isinstance(name, str):
                there = launch.place(pair.key_node)
                yield _GivenValue(
                    name, kind, str(value), launch.place(node), there, fix
                )


def _in_element(node: Element) -> Iterator[_GivenValue]:
    for param in node.find_all("param"):
        name, value = param.get("name"), param.get("value")
        if not name or value is None or OPEN.search(value) or param.get("sep"):
            continue
        read = read_yaml(value, "", "")
        scalar = read is not None and isinstance(read.root, yaml.ScalarNode)
        kind = str(type_of(read.root)) if read is not None and scalar else ""
        kind = _TYPES.get(param.get("type") or "", kind)
        place = param.place

        def fix(right: str, param: Element = param, value: str = value) -> Fix:
            if param.place.file.endswith((".yaml", ".yml")):
                return Fix(f"write {right}")
            return write_attribute(param.place, "value", value, right)

        yield _GivenValue(name, kind, value, place, place, fix)
