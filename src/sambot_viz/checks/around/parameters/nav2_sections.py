"""Check sections of Nav2's nodes in parameter files, and their clocks."""

from __future__ import annotations

from collections.abc import Iterator

from sambot_viz.checks.around.files.parameters import YamlFile
from sambot_viz.checks.around.parameters.known import known_parameters
from sambot_viz.checks.around.place import where
from sambot_viz.checks.around.running.known import known_nodes
from sambot_viz.checks.around.surroundings import Surroundings
from sambot_viz.edits import write
from sambot_viz.errors import Place, Problem, nearest
from sambot_viz.robot.slips.vocabulary import is_one_slip

_COSTMAPS = ("local_costmap", "global_costmap")
_NODES = frozenset(
    """
    amcl behavior_server bt_navigator collision_monitor controller_server
    map_saver map_server planner_server smoother_server velocity_smoother
    waypoint_follower
    """.split()
)
_LIKENESS = 0.85
_LONG = 6
"""Length from which a name is similar to hardly any other."""


def unread_sections(around: Surroundings) -> Iterator[Problem]:
    """Report unknown names of nodes, whose parameters Nav2 does not read."""
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


def misspelt_nodes(around: Surroundings) -> Iterator[Problem]:
    """Report misspelt names of well-known nodes outside Nav2."""
    running = {node.name for node in around.running.nodes}
    names = {*known_parameters().nodes, *known_nodes().names} - _NODES
    # robot1 and robot2 may be two robots.
    known = [n for n in names if len(n) >= _LONG and n.replace("_", "").isalpha()]
    for file in around.yaml_files:
        for node, place in file.nodes.items():
            near = next((name for name in known if is_one_slip(node, name)), None)
            others = {*names, *running, *_NODES}
            if near is None or node in others or near in file.nodes:
                continue
            if any(map(str.isdigit, node)):
                continue
            if not around.said_elsewhere(node):
                above = _above(file, node, place)
                yield Problem.at(
                    above,
                    "warning",
                    "nav2-node-name",
                    f"no node is called {node}, but probably {near} is meant: nobody "
                    "reads these parameters",
                    write(above, node, near, hint=f"write {near}:"),
                )


def _inner_name(node: str) -> str | None:
    """Return the costmap that two names mean, one of which is wrong."""
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


def _above(file: YamlFile, node: str, place: Place) -> Place:
    """Return the line with the name of a node."""
    return file.keys.get(node, place)


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
