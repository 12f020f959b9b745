"""Find what a Python launch file starts, and the names in it."""

from __future__ import annotations

import ast
import re
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass
from typing import NamedTuple

from sambot_viz import limits
from sambot_viz.cached import cached_property
from sambot_viz.checks.around.files.gazebo import Fact
from sambot_viz.checks.around.files.launch_values import SHARE
from sambot_viz.checks.around.files.parameters import flag
from sambot_viz.checks.around.launching.actions import FromFile, LaunchArgument
from sambot_viz.checks.around.launching.python_calls import CALLS
from sambot_viz.checks.around.launching.python_parts import (
    Call,
    Table,
    as_text,
    place_in,
)
from sambot_viz.checks.around.launching.python_values import PythonValues
from sambot_viz.checks.launch_files import (
    Import,
    call_name,
    imports_in,
    parse_python,
)
from sambot_viz.errors import Place

NODES = frozenset({"Node", "LifecycleNode"})
"""Actions that start a node."""

_LISTS = frozenset({"arguments", "cmd", "launch_arguments", "parameters", "remappings"})
"""Arguments that are lists of texts, not the parts of one text."""
_JOINS = frozenset({"join", "PathJoinSubstitution"})
_WRAPPERS = frozenset({"Path", "str", "ParameterValue"})
_OPTION = re.compile(r"--?[a-z][\w-]*(=\S*)?|\d+", re.IGNORECASE)
"""An option of a program, or the number after one."""


class LaunchNode(NamedTuple):
    """A node that a launch file starts.

    Attributes:
        executable: the program; empty when it is unknown.
        name: the name it gets, or None for the program's own.
        files: its parameter files, as paths in packages.
        sim_time: its value of use_sim_time, or None.
        arguments: its known arguments.
        place: its line.
    """

    executable: str
    name: str | None
    files: tuple[Fact, ...]
    sim_time: Fact | None
    arguments: tuple[str, ...]
    place: Place


@dataclass(frozen=True)
class LaunchFile:
    """A Python launch file.

    Attributes:
        path: relative to the package.
        shown: the path as the user would write it.
        tree: the file, read as Python.
    """

    path: str
    shown: str
    tree: ast.Module

    def place(self, node: ast.expr | ast.stmt) -> Place:
        """Return the place of an expression."""
        return place_in(self.shown, node)

    @cached_property
    def values(self) -> PythonValues:
        """The values in the file; a launch argument has its default."""
        found = PythonValues(self.tree, self.shown, CALLS)
        for call in found.calls:
            name = found.text(call.given("name", 0))
            default = call.given("default_value", 1)
            if call.name == "DeclareLaunchArgument" and name and default is not None:
                found.declare(name, as_text(found.of(default)))
        return found

    @cached_property
    def imports(self) -> tuple[Import, ...]:
        """The names that it imports."""
        return tuple(imports_in(self.tree))

    @property
    def calls(self) -> list[Call]:
        """All calls, from top to bottom."""
        return self.values.calls

    def text(self, call: Call, name: str, position: int | None = None) -> str | None:
        """Return the text of an argument; None for an uncertain or missing one."""
        return self.values.text(call.given(name, position))

    @cached_property
    def _set(self) -> dict[str, ast.expr | None]:
        """Variable → its expression, None for one that has several."""
        found: dict[str, ast.expr | None] = {}
        set_at: list[str] = []
        for node in ast.walk(self.tree):
            match node:
                case ast.Assign(targets=[ast.Name(id=name), *_], value=value):
                    found[name] = value
                case ast.AnnAssign(target=ast.Name(id=name), value=value):
                    found[name] = value
                case ast.Name(id=name, ctx=ast.Store()) | ast.arg(arg=name):
                    set_at.append(name)
                case _:
                    pass
        several = (name for name, times in Counter(set_at).items() if times > 1)
        return found | dict.fromkeys(found.keys() & several)

    def is_variable(self, name: str) -> bool:
        """Return whether a name is a variable with only one value."""
        return self._set.get(name) is not None

    def assigned(self, node: ast.expr) -> ast.expr:
        """Return the expression inside variables."""
        for _ in range(limits.YAML_DEPTH.value):
            inner = self._set.get(node.id) if isinstance(node, ast.Name) else None
            if inner is None:
                return node
            node = inner
        return node

    def origin(self, node: ast.expr) -> ast.expr:
        """Return the expression inside variables and a ParameterValue."""
        for _ in range(limits.YAML_DEPTH.value):
            node = self.assigned(node)
            match node:
                case ast.Call(args=[inner, *_]) if call_name(node.func) in _WRAPPERS:
                    node = inner
                case _:
                    return node
        return node

    def named(self, text: str) -> str | None:
        """Return the variable that holds a text, or None."""
        said = ((name, self.values.text(node)) for name, node in self._set.items())
        return next((name for name, value in said if value == text), None)

    def called(self, *actions: str) -> Iterator[Call]:
        """Yield the calls of actions, by default of those that start a node."""
        names = frozenset(actions) or NODES
        return (call for call in self.calls if call.name in names)

    @cached_property
    def strings(self) -> frozenset[str]:
        """All texts in quotation marks."""
        return frozenset(
            node.value
            for node in ast.walk(self.tree)
            if isinstance(node, ast.Constant) and isinstance(node.value, str)
        )

    @cached_property
    def said(self) -> frozenset[str]:
        """The texts that are neither names of launch arguments nor parts of paths."""
        naming = {
            id(part)
            for call in self.called(*_JOINS)
            for given in call.node.args
            for part in (given.elts if isinstance(given, ast.List) else (given,))
        }
        for call in self.called("DeclareLaunchArgument", "LaunchConfiguration"):
            for given in (call.given("name", 0), call.given("variable_name", 0)):
                naming.add(id(given))
            about = call.given("description")
            naming |= {id(node) for node in ast.walk(about)} if about else set()
        for call in self.called("IncludeLaunchDescription"):
            table = call.value("launch_arguments")
            pairs = table.pairs if isinstance(table, Table) else ()
            naming |= {id(pair.key_node) for pair in pairs}
        return frozenset(
            node.value
            for node in ast.walk(self.tree)
            if isinstance(node, ast.Constant) and isinstance(node.value, str)
            if id(node) not in naming
        )

    @cached_property
    def _used(self) -> frozenset[str]:
        return frozenset(
            node.id
            for node in ast.walk(self.tree)
            if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Load)
        )

    def uses(self, variable: str) -> bool:
        """Return whether the file uses the value of a variable."""
        return variable in self._used

    @cached_property
    def in_use(self) -> list[Call]:
        """The calls without a variable, or with a variable that the file uses."""
        unused = {
            id(node.value)
            for node in ast.walk(self.tree)
            if isinstance(node, ast.Assign)
            and all(
                isinstance(t, ast.Name) and not self.uses(t.id) for t in node.targets
            )
        }
        return [call for call in self.calls if id(call.node) not in unused]

    @cached_property
    def certain(self) -> list[Call]:
        """Those of them without a condition."""
        return [call for call in self.in_use if call.given("condition") is None]

    @cached_property
    def nodes(self) -> list[LaunchNode]:
        """The nodes that always start."""
        return [self._node(call) for call in self.certain if call.name in NODES]

    def _node(self, call: Call) -> LaunchNode:
        said = self.values.said
        files: list[Fact] = []
        sim_time: Fact | None = None
        for item, node in call.listing("parameters").items:
            if isinstance(item, Table):
                sim_time = self._sim_time(item) or sim_time
                continue
            # The names in a rewritten file may be different.
            path = None if isinstance(item, FromFile) else said(item)
            if path is not None:
                files.append(Fact(path, self.place(node)))
        named = call.given("name")
        arguments = [said(item) for item, _ in call.listing("arguments").items]
        return LaunchNode(
            self.text(call, "executable") or "",
            None if named is None else self.values.text(named),
            tuple(files),
            sim_time,
            tuple(text for text in arguments if text is not None),
            call.place,
        )

    def _sim_time(self, given: Table) -> Fact | None:
        said = self.values.said
        for _, value, _, node in (p for p in given.pairs if p.key == "use_sim_time"):
            text, declared = said(value), True
            if isinstance(value, LaunchArgument):
                declared = said(value.name) in self.values.defaults
            if text is None or (flag(text) is False and not declared):
                # Another launch file that includes this one may set true.
                return None
            return Fact(text, self.place(node))
        return None

    @cached_property
    def paths(self) -> list[Fact]:
        """All paths in share folders of packages, such as package://p/config."""
        found: dict[tuple[str, int], Fact] = {}
        lists: set[int] = set()
        for call in self.calls:
            lists |= {id(k.value) for k in call.node.keywords if k.arg in _LISTS}
            if call.name in _JOINS:
                lists |= {id(part) for part in call.node.args}
        for node in ast.walk(self.tree):
            built = isinstance(node, (ast.Call, ast.BinOp, ast.JoinedStr, ast.List))
            if not built or id(node) in lists:
                continue
            text = _without_options(self.values.text(node) or "")
            if text.startswith(SHARE) and ".." not in text:
                found.setdefault((text, node.lineno), Fact(text, self.place(node)))
        return sorted(found.values(), key=lambda fact: fact.place.line)


def _without_options(text: str) -> str:
    """Return the path among options such as "-r -v 4", or the text as it is."""
    words = text.split()
    paths = [word for word in words if word.startswith(SHARE)]
    has_options = any(_OPTION.fullmatch(word) for word in words)
    return paths[0] if has_options and len(paths) == 1 else text


def read_launch(text: str, path: str, shown: str) -> LaunchFile | None:
    """Read a launch file; None when it is not Python."""
    tree = parse_python(text)
    return None if tree is None else LaunchFile(path, shown, tree)
