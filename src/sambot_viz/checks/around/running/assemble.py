"""Assemble what the launch files of packages start."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace

from sambot_viz.checks.around.files.launch_values import SHARE
from sambot_viz.checks.around.files.parameters import YamlFile, controller_types
from sambot_viz.checks.around.running.bridge_entries import entries_of_file
from sambot_viz.checks.around.running.endpoints import with_endpoints
from sambot_viz.checks.around.running.evaluation import LaunchEvaluation
from sambot_viz.checks.around.running.known import KnownNode, known_nodes
from sambot_viz.checks.around.running.parameter_files import parameters_for
from sambot_viz.checks.around.running.simulated import possible_node
from sambot_viz.checks.around.running.system import (
    GivenParameter,
    RunningNode,
    RunningSystem,
    UnknownStart,
)
from sambot_viz.checks.around.workspace import Package
from sambot_viz.errors import Place

Find = Callable[[str], Package | None]


def system_of(
    files: Sequence[tuple[Package, str]],
    packages: Sequence[Package],
    find: Find,
    *,
    simulated: Iterable[RunningNode] = (),
    arguments: Mapping[str, str] | None = None,
    displays: bool = False,
    left_out: Collection[str] = (),
) -> RunningSystem:
    """Return the system that launch files start.

    A launch file that another one includes does not start a second time. The user may
    start nodes by hand that have parameters in the packages, but get them from no
    launch file.

    Args:
        files: the launch files, each with its package.
        packages: the packages whose parameters count.
        find: returns an available package by its name.
        simulated: the sensors and plugins that Gazebo runs for a robot.
        arguments: of the command line, for each of the launch files.
        displays: read the configs of RViz for the topics of its displays.
        left_out: parameter files of other robots.
    """
    followed: dict[tuple[Package, str], LaunchEvaluation] = {}
    for package, path in files:
        followed[package, path] = LaunchEvaluation(find, arguments)
        followed[package, path].run(package, path)
    included = {file for one in followed.values() for file in one.included}
    # Files that include each other all start.
    roots = [file for file in followed if file not in included] or list(followed)
    nodes: list[RunningNode] = []
    unknown: list[UnknownStart] = []
    for root in roots:
        nodes += followed[root].nodes
        unknown += followed[root].unknown
    read = [
        (each, file)
        for each in packages
        for file in each.yaml_files
        if file.shown not in left_out
    ]
    nodes += _controllers(nodes, [file for _, file in read])
    nodes += _by_hand(nodes, read)
    nodes += simulated
    return RunningSystem(
        tuple(package.shown(path) for package, path in roots),
        tuple(with_endpoints(node, find, displays=displays) for node in nodes),
        tuple(dict.fromkeys(unknown)),
        frozenset(name for one in followed.values() for name in one.declared),
        tuple(dict.fromkeys(path for root in roots for path in followed[root].paths)),
        {key: at for root in roots for key, at in followed[root].unclear.items()},
    )


def _controllers(
    nodes: Iterable[RunningNode], files: Sequence[YamlFile]
) -> Iterator[RunningNode]:
    """Yield the controllers that spawners start."""
    types = controller_types(files)
    for node in nodes:
        known = known_nodes().nodes.get((node.package, node.executable))
        for name in node.arguments if known and known.does("spawns") else ():
            declared = types.get(name or "")
            if name is not None and declared is not None:
                kind = declared.fact.value
                given = [p for f in files for p in parameters_for(f, name, None)]
                yield replace(
                    node,
                    package=kind.partition("/")[0],
                    executable=kind,
                    name=name,
                    parameters=tuple(given),
                    arguments=(),
                )


def _by_hand(
    nodes: Sequence[RunningNode], files: Iterable[tuple[Package, YamlFile]]
) -> Iterator[RunningNode]:
    """Yield nodes and bridges with parameters that no launch file gives them."""
    started = {node.name: node for node in nodes}
    served = {n.name for n in nodes if any(each.given_at for each in n.parameters)}
    named = {each.value for node in nodes for each in node.parameters}
    for package, file in files:
        for key, place in file.keys.items():
            above, _, name = key.strip("/").rpartition("/")
            known = known_nodes().names.get(name)
            if known is None or name in served:
                continue
            space = "/" if "*" in above else f"/{above}"
            given = tuple(parameters_for(file, name, space))
            node = started.get(name)
            if node is None:
                yield _alone(known, name, space, given, place)
            elif node.starts != "no":
                yield replace(node, starts="unknown", parameters=given)
        path = f"{SHARE}{package.name}/{file.path}"
        if path not in named and any(entries_of_file(file)):
            place = Place(file.shown, 1)
            config = GivenParameter("config_file", (path,), place)
            known = known_nodes().names["ros_gz_bridge"]
            yield _alone(known, known.name, "/", (config,), place)


def _alone(
    known: KnownNode,
    name: str,
    namespace: str,
    given: tuple[GivenParameter, ...],
    place: Place,
) -> RunningNode:
    program = known.programs[0]
    return possible_node(known.package, program, name, namespace, given, place)
