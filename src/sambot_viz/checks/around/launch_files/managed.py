"""Compare the nodes of lifecycle managers with the nodes that start."""

from __future__ import annotations

import ast
from collections.abc import Iterator, Sequence

import yaml

from sambot_viz.checks.around.files.parameters import place_of
from sambot_viz.checks.around.launching.python_parts import place_in
from sambot_viz.checks.around.place import where
from sambot_viz.checks.around.running.system import GivenParameter, RunningNode
from sambot_viz.checks.around.surroundings import Surroundings
from sambot_viz.edits import write
from sambot_viz.errors import Place, Problem, nearest

_CODE = "lifecycle-node"
_MANAGER = ("nav2_lifecycle_manager", "node_names")
"""The package of the manager, and its parameter."""
_LIKENESS = 0.75
_OF_NAV2 = "nav2_"
_PLAIN = frozenset({"nav2_lifecycle_manager", "nav2_rviz_plugins", "nav2_costmap_2d"})
"""Packages of Nav2 whose nodes start without a manager, or in another node."""


def unmanaged_nodes(around: Surroundings) -> Iterator[Problem]:
    """Report a name in the list of a lifecycle manager that no node has.

    The node that is meant starts, and no manager has it in its list.
    """
    managers = [(n, p) for n, p in _managers(around) if n.starts != "no"]
    names = {node.name or node.executable for node in around.running.nodes}
    done: set[Place] = set()
    for manager, given in managers:
        beside = [p for n, p in managers if n.launch == manager.launch]
        free = _free(manager, beside, around)
        lost = [name for name in given.values or () if name not in names]
        if any(each.values is None for each in beside):
            continue
        is_whole = around.running.is_whole and "" not in names
        for name in lost:
            is_only = is_whole and len(lost) == len(free) == 1
            near = nearest(name, free, _LIKENESS) or (min(free) if is_only else None)
            place = _place_of(name, given, manager, around)
            if near is None or place in done:
                continue
            done.add(place)
            yield Problem.at(
                place,
                "warning",
                _CODE,
                f"{manager.name} waits for the node {name}, which no launch file "
                f"starts, and {near} ({where(free[near].place, place)}) is in no such "
                "list: the manager activates none of its nodes",
                write(place, name, near),
            )


def _managers(around: Surroundings) -> Iterator[tuple[RunningNode, GivenParameter]]:
    package, name = _MANAGER
    for node in around.running.nodes:
        given = node.parameter(name) if node.package == package else None
        if given is not None:
            yield node, given


def _free(
    manager: RunningNode, lists: Sequence[GivenParameter], around: Surroundings
) -> dict[str, RunningNode]:
    """Return the nodes of Nav2 that start with a manager and are in no list there."""
    listed = {name for given in lists for name in given.values or ()}
    is_launched = manager.launch in around.running.launches
    return {
        node.name: node
        for node in around.running.started
        if node.package.startswith(_OF_NAV2) and node.package not in _PLAIN
        if node.name and node.name not in listed
        if node.launch == manager.launch or not is_launched
    }


def _place_of(
    name: str, given: GivenParameter, manager: RunningNode, around: Surroundings
) -> Place:
    """Return the place of a name in the list of a manager."""
    for parameter in around.parameters:
        if parameter.value_place == given.place:
            items: list[yaml.Node] = (
                parameter.written.value
                if isinstance(parameter.written, yaml.SequenceNode)
                else [parameter.written]
            )
            for item in items:
                if item.value == name:
                    return place_of(item, given.place.file)
    trees = (x.tree for x in around.launches if x.shown == manager.place.file)
    lists = (n for tree in trees for n in ast.walk(tree) if isinstance(n, ast.List))
    for item in (item for each in lists for item in each.elts):
        if isinstance(item, ast.Constant) and item.value == name:
            return place_in(manager.place.file, item)
    return given.place
