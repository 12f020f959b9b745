"""Read the known nodes from the table nodes.txt."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import cache
from pathlib import Path
from typing import NamedTuple

SENSOR, SYSTEM = "gz.sensor", "gz.system"
"""The package name for a sensor or a system of Gazebo."""
_TABLE = Path(__file__).parents[2] / "vocabularies" / "nodes.txt"


class NodeRow(NamedTuple):
    """A line about a known node.

    Attributes:
        verb: "publishes", "subscribes", "transform", "part", or a word with its own
            code.
        words: its other words, such as a topic and its type.
        unless: the parameter and the value that exclude it; else empty.
        when: the parameter and the value that it requires; else empty.
        everywhere: the default of that parameter is the same in all distributions.
    """

    verb: str
    words: tuple[str, ...]
    unless: tuple[str, str] = ("", "")
    when: tuple[str, str] = ("", "")
    everywhere: bool = False

    @property
    def switch(self) -> tuple[str, str]:
        """The parameter and the value that switch it; empty without a condition."""
        name, value = self.when
        return (name, "false" if value == "true" else "true") if name else self.unless

    @property
    def is_seldom(self) -> bool:
        """True for a topic that few users need."""
        return self.words[-1:] == ("seldom",)

    @property
    def latched(self) -> str:
        """The frequency of messages for later subscribers: "once", "often" or ""."""
        last = self.words[-1] if self.words else ""
        return last if last in ("once", "often") else ""


class KnownNode(NamedTuple):
    """A node of a well-known package.

    Attributes:
        package: its package.
        programs: its executables, and the class of the same component.
        name: its default name.
        rows: its publishers, subscriptions, transforms and parts.
    """

    package: str
    programs: tuple[str, ...]
    name: str
    rows: tuple[NodeRow, ...]

    def does(self, verb: str) -> bool:
        """Return whether it has a row with this verb."""
        return any(row.verb == verb for row in self.rows)


class KnownLaunch(NamedTuple):
    """A launch file of a well-known package.

    Attributes:
        parameters: the launch argument that names the file with the parameters.
        nodes: the package and the program of each node.
        sim_time: the default of its argument use_sim_time; empty without that.
    """

    parameters: str
    nodes: tuple[tuple[str, str], ...]
    sim_time: str = ""


class KnownNodes(NamedTuple):
    """The table of known nodes, launch files and displays.

    Attributes:
        nodes: package and program → the node.
        names: default name of a node → the node.
        launches: package and file → the launch file.
        displays: class of a display of RViz → the type that it subscribes to.
        tools: class of a tool of RViz → the type that it publishes.
        tool_topics: class of a tool → its topic, and those that it had in ROS 1.
        packages: the packages of the nodes.
    """

    nodes: Mapping[tuple[str, str], KnownNode]
    names: Mapping[str, KnownNode]
    launches: Mapping[tuple[str, str], KnownLaunch]
    displays: Mapping[str, str]
    tools: Mapping[str, str]
    tool_topics: Mapping[str, Sequence[str]]
    packages: frozenset[str]


@cache
def known_nodes() -> KnownNodes:
    """Return the table of known nodes."""
    nodes: list[KnownNode] = []
    rows: list[NodeRow] = []
    launches: dict[tuple[str, str], KnownLaunch] = {}
    displays: dict[str, str] = {}
    tools: dict[str, str] = {}
    tool_topics: dict[str, Sequence[str]] = {}
    for line in reversed(_TABLE.read_text("utf-8").splitlines()):
        words = line.split()
        match words:
            case ["node", package, programs, *rest]:
                given = tuple(programs.split(","))
                name = rest[0] if rest else given[0]
                nodes.append(KnownNode(package, given, name, tuple(rows[::-1])))
                rows.clear()
            case ["launch", package, file, parameters, *started]:
                both = tuple(_halves(each) for each in started)
                argument, _, clock = parameters.strip("-").partition(",use_sim_time=")
                launches[package, file] = KnownLaunch(argument, both, clock)
            case ["display", kind, message]:
                displays[kind] = message
            case ["tool", kind, message, *topics]:
                tools[kind] = message
                tool_topics[kind] = topics
            case [verb, *rest] if line[0] == " ":
                rows.append(_row(verb, rest))
            case _:
                pass
    nodes.reverse()
    return KnownNodes(
        {(node.package, program): node for node in nodes for program in node.programs},
        {n.name: n for n in reversed(nodes) if n.package not in (SENSOR, SYSTEM)},
        launches,
        displays,
        tools,
        tool_topics,
        frozenset(node.package for node in nodes) | {p for p, _ in launches},
    )


def _halves(text: str) -> tuple[str, str]:
    package, _, program = text.partition("/")
    return package, program


def _row(verb: str, words: list[str]) -> NodeRow:
    given: dict[str, tuple[str, str]] = {}
    everywhere = words[-1:] == ["everywhere"]
    for condition in ("unless", "when"):
        if condition in words:
            at = words.index(condition)
            name, _, value = words[at + 1].partition("=")
            given[condition], words = (name, value), words[:at]
    return NodeRow(verb, tuple(words), **given, everywhere=everywhere)
