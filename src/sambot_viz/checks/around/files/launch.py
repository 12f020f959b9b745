"""What a Python launch file starts, and which files, nodes and topics it names."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

from sambot_viz.checks.around.files.gazebo import Fact, Generation
from sambot_viz.checks.around.files.launch_values import (
    SHARE,
    LaunchValues,
    keyword,
    values_for,
)
from sambot_viz.checks.around.files.parameters import flag
from sambot_viz.checks.launch_files import call_name, parse_python
from sambot_viz.errors import Place

NODES = frozenset({"Node", "LifecycleNode"})
"""Actions that start a node."""

_PACKAGES: dict[str, Generation] = {
    "gazebo_ros": "classic",
    "ros_gz_sim": "gz",
    "ros_gz_bridge": "gz",
    "ros_ign_gazebo": "gz",
    "ros_ign_bridge": "gz",
}
_PROGRAMS: dict[str, Generation] = {
    "gazebo": "classic",
    "gzserver": "classic",
    "gzclient": "classic",
    "gz sim": "gz",
    "ign gazebo": "gz",
}
_SIMULATORS = (
    *_PROGRAMS,
    "GzServer",
    "gz_sim.launch.py",
    "gz_server.launch.py",
    "ign_gazebo.launch.py",
    "gazebo.launch.py",
)
_ACTIONS: dict[str, Generation] = {"GzServer": "gz", "RosGzBridge": "gz"}
_LISTS = frozenset({"arguments", "cmd", "parameters", "remappings"})
"""Arguments that are lists of several texts, and not the parts of one."""
_OPTION = re.compile(r"--?[a-z][\w-]*(=\S*)?|\d+", re.IGNORECASE)
"""An option of a program, or the number that one has."""


@dataclass(frozen=True, slots=True)
class LaunchNode:
    """A node that a launch file starts.

    Attributes:
        package: its package; empty when it is not known.
        executable: the program.
        name: the name it gets, or None for the program's own.
        files: its parameter files, as paths in packages.
        sim_time: what it is told for use_sim_time, or None.
        arguments: its arguments, as far as they are known.
        arguments_known: all of them are.
        remappings: topic → topic.
        complete: all its parameters are understood.
        place: its line.
    """

    package: str
    executable: str
    name: str | None
    files: tuple[Fact, ...]
    sim_time: Fact | None
    arguments: tuple[str, ...]
    arguments_known: bool
    remappings: tuple[tuple[str, str], ...]
    complete: bool
    place: Place


@dataclass(frozen=True, slots=True)
class Start:
    """Something of one Gazebo that a launch file starts.

    Attributes:
        generation: which Gazebo.
        what: its name.
        place: its line.
    """

    generation: Generation
    what: str
    place: Place

    @property
    def simulates(self) -> bool:
        """True for the simulator itself; a bridge or a spawned robot is none."""
        return self.what.startswith(_SIMULATORS)


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

    def place(self, node: ast.expr) -> Place:
        """Return the place of an expression."""
        return Place(self.shown, node.lineno, node.col_offset + 1)

    @cached_property
    def calls(self) -> list[ast.Call]:
        """All calls, from top to bottom."""
        found = [node for node in ast.walk(self.tree) if isinstance(node, ast.Call)]
        return sorted(found, key=lambda call: (call.lineno, call.col_offset))

    @cached_property
    def values(self) -> LaunchValues:
        """The texts in the file."""
        return LaunchValues(self.tree, self.calls)

    @cached_property
    def strings(self) -> frozenset[str]:
        """All texts in quotation marks."""
        return frozenset(
            node.value
            for node in ast.walk(self.tree)
            if isinstance(node, ast.Constant) and isinstance(node.value, str)
        )

    @cached_property
    def _used(self) -> frozenset[str]:
        return frozenset(
            node.id
            for node in ast.walk(self.tree)
            if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Load)
        )

    def uses(self, variable: str) -> bool:
        """Tell whether the value of a variable is used."""
        return variable in self._used

    @cached_property
    def actions(self) -> list[ast.Call]:
        """The calls without a condition, whose variable is used where there is one."""
        unused = {
            id(node.value)
            for node in ast.walk(self.tree)
            if isinstance(node, ast.Assign)
            and all(
                isinstance(t, ast.Name) and not self.uses(t.id) for t in node.targets
            )
        }
        return [
            call
            for call in self.calls
            if keyword(call, "condition") is None and id(call) not in unused
        ]

    @cached_property
    def nodes(self) -> list[LaunchNode]:
        """The nodes that are always started."""
        return [self._node(c) for c in self.actions if call_name(c.func) in NODES]

    def _node(self, call: ast.Call) -> LaunchNode:
        text = self.values.text
        files: list[Fact] = []
        sim_time: Fact | None = None
        complete = True
        for item in self.values.items(keyword(call, "parameters")):
            if isinstance(item, ast.Dict):
                sim_time = self._sim_time(item) or sim_time
                continue
            path = text(item)
            complete = complete and path is not None
            if path is not None:
                files.append(Fact(path, self.place(item)))
        named = keyword(call, "name")
        arguments = keyword(call, "arguments")
        said = tuple(self.values.texts(arguments))
        return LaunchNode(
            text(keyword(call, "package")) or "",
            text(keyword(call, "executable")) or "",
            None if named is None else text(named),
            tuple(files),
            sim_time,
            said,
            arguments is None or len(said) == len(self.values.items(arguments)),
            tuple(self._remappings(call)),
            complete and (named is None or text(named) is not None),
            self.place(call),
        )

    def _sim_time(self, given: ast.Dict) -> Fact | None:
        for value in values_for(given, "use_sim_time"):
            text = self.values.text(value)
            if text is None or (
                flag(text) is False and not self.values.is_declared(value)
            ):
                # Another launch file, which includes this one, may say true.
                return None
            return Fact(text, self.place(value))
        return None

    def _remappings(self, call: ast.Call) -> Iterator[tuple[str, str]]:
        for item in self.values.items(keyword(call, "remappings")):
            if isinstance(item, ast.Tuple) and len(item.elts) == 2:
                old, new = (self.values.text(part) for part in item.elts)
                if old is not None and new is not None:
                    yield old, new

    @cached_property
    def starts(self) -> list[Start]:
        """What of Gazebo is always started."""
        return [start for call in self.actions for start in self._starts(call)]

    @cached_property
    def may_start(self) -> frozenset[Generation]:
        """The generations of Gazebo that are started at least sometimes."""
        every = (start for call in self.calls for start in self._starts(call))
        return frozenset(start.generation for start in every)

    def _starts(self, call: ast.Call) -> Iterator[Start]:
        name, place = call_name(call.func), self.place(call)
        if name in _ACTIONS:
            yield Start(_ACTIONS[name], name, place)
        elif name in NODES:
            package = self.values.text(keyword(call, "package")) or ""
            program = self.values.text(keyword(call, "executable")) or ""
            if package in _PACKAGES:
                yield Start(_PACKAGES[package], f"{program} of {package}", place)
        elif name == "IncludeLaunchDescription":
            path = self.values.text(keyword(call, "launch_description_source", 0)) or ""
            package = path.removeprefix(SHARE).partition("/")[0]
            if path.startswith(SHARE) and package in _PACKAGES:
                file = path.rpartition("/")[2]
                yield Start(_PACKAGES[package], f"{file} of {package}", place)
        elif name == "ExecuteProcess":
            words = " ".join(self.values.texts(keyword(call, "cmd"))).split()
            for program in (" ".join(words[:1]), " ".join(words[:2])):
                if program in _PROGRAMS:
                    yield Start(_PROGRAMS[program], program, place)

    @cached_property
    def paths(self) -> list[Fact]:
        """All paths in the share folders of packages, such as package://p/config."""
        found: dict[tuple[str, int], Fact] = {}
        lists = {id(self.values.joined(call)) for call in self.calls}
        lists |= {
            id(given.value)
            for call in self.calls
            for given in call.keywords
            if given.arg in _LISTS
        }
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
    options = [word for word in words if _OPTION.fullmatch(word)]
    paths = [word for word in words if word not in options]
    return paths[0] if options and len(paths) == 1 else text


def read_launch(text: str, path: str, shown: str) -> LaunchFile | None:
    """Read a launch file; None when it is not Python."""
    tree = parse_python(text)
    return None if tree is None else LaunchFile(path, shown, tree)
