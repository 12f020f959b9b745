"""Names within the parameters of Nav2: of nodes, layers and sensors."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from sambot_viz.checks.around.files.parameters import Parameter, YamlFile
from sambot_viz.checks.around.place import where
from sambot_viz.checks.around.surroundings import Surroundings
from sambot_viz.checks.vocabulary import vocabulary
from sambot_viz.edits import write
from sambot_viz.errors import Place, Problem, nearest

_COSTMAPS = ("local_costmap", "global_costmap")
_NODES = frozenset(
    """
    amcl behavior_server bt_navigator collision_monitor controller_server
    map_saver map_server planner_server smoother_server velocity_smoother
    waypoint_follower
    """.split()
)
_LIKENESS = 0.85
_SOURCES, _PLUGIN = ".observation_sources", ".plugin"
_LISTS = ("plugins", "filters", "checker_plugin")
_SLASHED = frozenset({"robot_base_frame", "global_frame", "local_frame"})


def unread_sections(around: Surroundings) -> Iterator[Problem]:
    """Report names of nodes that Nav2 does not have, so that nothing is read."""
    for file in around.yaml_files:
        names = {node.rpartition("/")[2] for node in file.nodes}
        known = names & {*_NODES, *_COSTMAPS}
        for node, place in file.nodes.items() if len(known) > 1 else ():
            inner = _inner_name(node)
            if inner is not None:
                yield Problem.at(
                    _above(file, node, place),
                    "warning",
                    "nav2-node-name",
                    f"{inner} reads its parameters below {inner}: and again {inner}:, "
                    f"but this is {node.replace('/', ': and ')}: it uses its defaults",
                    f"write {inner}:",
                )
                continue
            if node in _COSTMAPS:
                yield Problem.at(
                    _above(file, node, place),
                    "warning",
                    "nav2-node-name",
                    f"{node} reads its parameters below {node}: and again {node}:, and "
                    "here the name is only once: it uses its defaults",
                    f"write a line {node}: below it, and two blanks more before each "
                    "line that follows",
                )
            near = nearest(node.lower(), _NODES, _LIKENESS)
            if near is None or near in names or node in _NODES:
                continue
            if not around.said_elsewhere(node):
                yield Problem.at(
                    _above(file, node, place),
                    "warning",
                    "nav2-node-name",
                    f"Nav2 has no node {node}, but {near}: nobody reads these "
                    "parameters",
                    write(_above(file, node, place), node, near, hint=f"write {near}:"),
                )


def _inner_name(node: str) -> str | None:
    """Return the costmap that is meant by two names of which one is not its name."""
    outer, slash, inner = node.rpartition("/")
    outer = outer.rpartition("/")[2]
    if not slash or outer == inner:
        return None
    if outer in _COSTMAPS:
        near = nearest(inner, _COSTMAPS, _LIKENESS)
        return outer if near == outer else None
    return inner if inner in _COSTMAPS and _is_like(outer, inner) else None


def _is_like(one: str, other: str) -> bool:
    return nearest(one, [other], _LIKENESS) is not None


def unknown_plugins(around: Surroundings) -> Iterator[Problem]:
    """Report plugins of Nav2 that are almost one of its classes."""
    known = {
        f"{package}/{name}": f"{package}{{}}{name}"
        for package, names in vocabulary("nav2_plugins").items()
        for name in names
    }
    for parameter in around.parameters:
        said = parameter.fact.value
        joint = "::" if "::" in said else "/"
        name = said.replace("::", "/")
        if parameter.name.rpartition(".")[2] != "plugin" or name in known:
            continue
        near = nearest(name, known, _LIKENESS)
        if near is None or name.count("/") != 1 or around.said_elsewhere(said):
            continue
        node = parameter.node.rpartition("/")[2]
        yield Problem.at(
            parameter.value_place,
            "error",
            "nav2-plugin",
            f"Nav2 has no plugin {said}: {node} stops with an error",
            write(parameter.value_place, said, known[near].format(joint)),
        )


def _above(file: YamlFile, node: str, place: Place) -> Place:
    """The line with the name of a node."""
    return file.keys.get(node, place)


def unknown_sections(around: Surroundings) -> Iterator[Problem]:
    """Report layers, plugins and sensors that are listed under another name."""
    for file in around.yaml_files:
        for node in file.nodes:
            given = file.of(node)
            for parameter in given.values():
                if parameter.name.endswith(_SOURCES):
                    yield from _sources(parameter, given)
            yield from _plugins(given)


def _sources(parameter: Parameter, given: Mapping[str, Parameter]) -> Iterator[Problem]:
    head = parameter.name.removesuffix("observation_sources")
    sections: dict[str, Place] = {}
    for name, below in given.items():
        section, dot, _ = name.removeprefix(head).partition(".")
        if name.startswith(head) and dot:
            sections.setdefault(section, below.place)
    named = " ".join(parameter.values).split()
    left = [section for section in sections if section not in named]
    for name in named:
        near = left[0] if len(left) == 1 else nearest(name, left)
        if name not in sections and near is not None:
            yield Problem.at(
                parameter.value_place,
                "warning",
                "nav2-section",
                f"observation_sources names {name}, but the section is called {near} "
                f"({where(sections[near], parameter.place)}): the sensor is not used",
                write(parameter.value_place, name, near),
            )


def _plugins(given: Mapping[str, Parameter]) -> Iterator[Problem]:
    lists = [p for p in given.values() if p.name.endswith(_LISTS)]
    named = {name for one in lists for name in one.values}
    left = {
        name.removesuffix(_PLUGIN): parameter.place
        for name, parameter in given.items()
        if name.endswith(_PLUGIN) and name.removesuffix(_PLUGIN) not in named
    }
    for one in lists if len(left) == 1 else ():
        for name in one.values:
            if f"{name}{_PLUGIN}" in given:
                continue
            ((near, place),) = left.items()
            yield Problem.at(
                one.value_place,
                "error",
                "nav2-section",
                f"{one.name} names {name}, but the section is called {near} "
                f"({where(place, one.place)}): {one.node.rpartition('/')[2]} stops "
                "with an error",
                write(one.value_place, name, near),
            )


def frames_with_slash(around: Surroundings) -> Iterator[Problem]:
    """Report frames that begin with a slash, as in ROS 1."""
    for parameter in around.parameters:
        name = parameter.fact.value
        if parameter.name in _SLASHED and name.startswith("/") and len(name) > 1:
            node = parameter.node.rpartition("/")[2]
            yield Problem.at(
                parameter.value_place,
                "warning",
                "frame-slash",
                f"{node} asks for the frame {name}, but no frame of ROS 2 begins with "
                "a slash: it never gets a transform",
                write(parameter.value_place, name, name[1:]),
            )


def odd_clocks(around: Surroundings) -> Iterator[Problem]:
    """Report the one node of a file that does not use simulated time."""
    for file in around.yaml_files:
        told = [p for p in file.parameters if p.name == "use_sim_time"]
        off = [p for p in told if p.flag is False]
        on = [p for p in told if p.flag is True]
        if len(off) == 1 and len(on) > 1 and not around.said_elsewhere(off[0].node):
            other = on[0]
            yield Problem.at(
                off[0].value_place,
                "warning",
                "sim-time-off",
                f"{off[0].node} uses the time of the computer, but {other.node} "
                f"({where(other.place, off[0].place)}) and all others in this file "
                "use simulated time: its transforms never fit",
                write(off[0].value_place, off[0].fact.value, "true"),
            )
