"""Read which parameters the nodes of the packages declare, with their types."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator, Mapping
from functools import lru_cache
from typing import NamedTuple

from sambot_viz.checks.around.parameters.known import (
    KnownParameter,
    ParameterBlock,
    known_parameters,
)
from sambot_viz.checks.around.surroundings import Surroundings
from sambot_viz.checks.around.workspace import Package
from sambot_viz.checks.launch_files import call_name, parse_python

_SOURCES = (".py", ".cpp", ".hpp")
_WORD = "declare_parameter"
_OPEN = re.compile(
    r"dynamic_typing|allow_undeclared_parameters|"
    r"automatically_declare_parameters_from_overrides"
)
"""Calls with which a node accepts parameters of any name or type."""
_NODE = re.compile(
    r"(?:__init__|create_node|\bNode|make_shared<[\w:]*Node>)\s*\(\s*(?:self\s*,\s*)?"
    r"['\"](\w+)['\"]"
)
_CPP = re.compile(
    r"declare_parameter\s*(?:<\s*(?P<kind>[\w:<> ]+?)\s*>)?\s*\(\s*"
    r"\"(?P<name>[\w.]+)\"\s*(?:,\s*(?P<value>\"|[^,;)]*))?"
)
_CPP_KINDS = {
    "bool": "boolean",
    "double": "number",
    "float": "number",
    "int": "integer",
    "int64_t": "integer",
    "std::string": "string",
}
_LITERALS = {
    "boolean": re.compile(r"true|false"),
    "integer": re.compile(r"-?\d+"),
    "number": re.compile(r"-?\d*\.\d*f?"),
    "string": re.compile(r"\""),
}
_PYTHON_KINDS = {
    "bool": "boolean",
    "int": "integer",
    "float": "number",
    "str": "string",
    "BOOL": "boolean",
    "INTEGER": "integer",
    "DOUBLE": "number",
    "STRING": "string",
}
"""Name of a class of Python, or of a type of rclpy → the type of a parameter."""
_ANY = "any"


class DeclaredParameters(NamedTuple):
    """The parameters that the sources of the packages declare.

    Attributes:
        nodes: name of a node → its parameters.
        programs: package and program → the parameters of its node.
    """

    nodes: Mapping[str, ParameterBlock]
    programs: Mapping[tuple[str, str], ParameterBlock]


@lru_cache(maxsize=1)
def declared_parameters(around: Surroundings) -> DeclaredParameters:
    """Return the parameters that nodes of these packages certainly declare."""
    nodes: dict[str, ParameterBlock] = {}
    programs: dict[tuple[str, str], ParameterBlock] = {}
    for package in around.packages:
        named = {path: name for name, path in _programs(package)}
        for path in package.ending(*_SOURCES):
            text = package.text(path) or ""
            block = _declared(text, path) if _WORD in text else None
            if block is None or path.endswith("launch.py"):
                continue
            for name in _NODE.findall(text):
                nodes[name] = block | nodes.get(name, block)
            key = package.name, named.get(path, path.rpartition("/")[2])
            programs[key] = block | programs.get(key, block)
    return DeclaredParameters(nodes, programs)


def _programs(package: Package) -> Iterator[tuple[str, str]]:
    """Yield the programs of a package, with the source of each."""
    for program in package.setup.programs if package.setup is not None else ():
        yield program.name, f"{program.module.replace('.', '/')}.py"
    for command in package.cmake.commands if package.cmake is not None else ():
        if command.name == "add_executable":
            for word in command.words[1:]:
                yield command.words[0].text, word.text


def _declared(text: str, path: str) -> ParameterBlock | None:
    """Return the declared parameters of a source; None where others are possible."""
    if _OPEN.search(text):
        return None
    found = _in_python(text) if path.endswith(".py") else _in_cpp(text)
    if found is None:
        return None
    names = {name: KnownParameter(name, kind) for name, kind in found.items()}
    return ParameterBlock(names, is_whole=False) | known_parameters().common


def _in_cpp(text: str) -> dict[str, str] | None:
    found = list(_CPP.finditer(text))
    if len(found) != text.count(_WORD):
        return None
    return {each["name"]: _cpp_kind(each) for each in found}


def _cpp_kind(found: re.Match[str]) -> str:
    kind, value = found["kind"], (found["value"] or "").strip()
    if kind is None:
        kinds = (k for k, literal in _LITERALS.items() if literal.fullmatch(value))
        return next(kinds, _ANY)
    item = kind.removeprefix("std::vector<").removesuffix(">").strip()
    of_item = _CPP_KINDS.get(item, _ANY)
    return f"{of_item}s" if item != kind and of_item != _ANY else of_item


def _in_python(text: str) -> dict[str, str] | None:
    tree = parse_python(text)
    found: dict[str, str] = {}
    for node in ast.walk(tree) if tree is not None else ():
        if not isinstance(node, ast.Call) or not call_name(node.func).startswith(_WORD):
            continue
        if call_name(node.func) == _WORD:
            both = [_pair(node.args)]
        else:
            both = list(_listed(node))
        for name, kind in both:
            if name is None:
                return None
            found[name] = kind
    return found if tree is not None else None


def _listed(call: ast.Call) -> Iterator[tuple[str | None, str]]:
    """Yield the parameters of declare_parameters(namespace, parameters)."""
    named = {keyword.arg: keyword.value for keyword in call.keywords}
    both = [*call.args, *(named.get(n) for n in ("namespace", "parameters"))]
    space, listed, *_ = [each for each in both if each is not None] + [None, None]
    is_top = isinstance(space, ast.Constant) and space.value == ""
    if not is_top or not isinstance(listed, ast.List):
        yield None, _ANY
        return
    for item in listed.elts:
        yield _pair(item.elts) if isinstance(item, ast.Tuple) else (None, _ANY)


def _pair(given: list[ast.expr]) -> tuple[str | None, str]:
    """Return the name and the type of a parameter, from a name and its default."""
    name, value, *_ = [*given, None, None]
    if not isinstance(name, ast.Constant) or not isinstance(name.value, str):
        return None, _ANY
    return name.value, _python_kind(value)


def _python_kind(value: ast.expr | None) -> str:
    match value:
        case ast.UnaryOp(operand=operand):
            return _python_kind(operand)
        case ast.Constant(value=literal):
            return _PYTHON_KINDS.get(type(literal).__name__, _ANY)
        case ast.Attribute(attr=attribute):
            return _PYTHON_KINDS.get(attribute, _ANY)
        case ast.List(elts=[*items]) if items:
            kinds = {_python_kind(item) for item in items}
            kind = kinds.pop()
            return _ANY if kinds or kind == _ANY or kind[-1] == "s" else f"{kind}s"
        case _:
            return _ANY
