"""Report parameters in files that their node does not get, or does not read."""

from __future__ import annotations

import ast
import posixpath
from collections.abc import Iterator

from sambot_viz.checks.around.files.gazebo import facts
from sambot_viz.checks.around.files.parameters import YamlFile, pairs
from sambot_viz.checks.around.place import where
from sambot_viz.checks.around.running.includes import installed_as
from sambot_viz.checks.around.running.known import known_nodes
from sambot_viz.checks.around.running.system import GivenFile, RunningNode
from sambot_viz.checks.around.surroundings import Surroundings
from sambot_viz.checks.around.workspace import Package
from sambot_viz.edits import write
from sambot_viz.errors import Fix, Place, Problem, nearest


def unread_parameters(around: Surroundings) -> Iterator[Problem]:
    """Report parameter files that name none of the nodes that get them."""
    files = {file.shown: file for file in around.yaml_files}
    given: dict[tuple[str, Place], list[tuple[RunningNode, GivenFile]]] = {}
    for node in around.running.started:
        for each in node.files:
            given.setdefault((each.shown, each.place), []).append((node, each))
    for (shown, place), users in given.items():
        file, node = files.get(shown), users[0][0]
        if file is None or not file.nodes or any(each.is_read for _, each in users):
            continue
        # Another rule checks the choice of another launch file.
        is_named = posixpath.basename(shown) in _text_of(around, place.file)
        empty = {key.value for key, _ in pairs(file.root)} - {*file.keys}
        if node.name in empty or "" in file.nodes:
            # The file names it, or could: other rules check the values below its name.
            continue
        alone = len({node.path for node, _ in users}) == 1
        if alone and is_named and node.starts == "yes" and _is_called(node):
            yield _unread(around, node, place, file)


def _text_of(around: Surroundings, shown: str) -> str:
    """Return the text of a launch file; empty for others."""
    for package in around.packages:
        for path in package.launch_paths:
            if package.shown(path) == shown:
                return package.text(path) or ""
    return ""


def _is_called(node: RunningNode) -> bool:
    """Return whether a node has a known name, and parameters that only it uses."""
    known = known_nodes().nodes.get((node.package, node.executable))
    is_container = node.executable.startswith("component_container")
    named = known is not None or node.name not in ("", node.executable)
    return named and not is_container


def _unread(
    around: Surroundings, node: RunningNode, given: Place, file: YamlFile
) -> Problem:
    own = [key for key in file.nodes if key.rpartition("/")[2] == node.name]
    near = next(iter(own), None) or nearest(node.name, file.nodes, likeness=0.0)
    key = near or next(iter(file.nodes))
    bare, written = key.rpartition("/")[2], file.keys.get(key, file.nodes[key])
    name = node.path.removeprefix("/")
    # A launch file of another package starts it under this name.
    if own or node.place == given:
        return Problem.at(
            written,
            "warning",
            "launch-parameters-unread",
            f"the node {name}, which is given this file ({where(given, written)}), "
            f"reads none of its parameters: they are for {key}",
            write(written, bare, f"/**/{bare}" if own else node.name),
        )
    hint = f"write name='{bare}' for the node, or {node.name}: in the file"
    return Problem.at(
        given,
        "warning",
        "launch-parameters-unread",
        f"the node {name} reads none of these parameters: they are for {key} "
        f"({where(file.nodes[key], given)})",
        _renamed(around, node, bare, hint),
    )


def _renamed(around: Surroundings, node: RunningNode, right: str, hint: str) -> Fix:
    """Return the fix that gives a node another name, where a text says its name."""
    for launch in around.launches:
        for call in launch.called() if launch.shown == node.place.file else ():
            given = call.given("name")
            if call.place == node.place and isinstance(given, ast.Constant):
                return write(launch.place(given), node.name, right, hint=hint)
    return write(node.place, node.name, right, hint=hint)


def parameters_left_out(around: Surroundings) -> Iterator[Problem]:
    """Report a node that does not get the file with its parameters."""
    running = around.running
    used = {each.shown for node in running.started for each in node.files}
    said = {text for launch in around.launches for text in launch.strings}
    plugins = {
        fact.value for p in around.plugins for fact in facts(p.element, "parameters")
    }
    known = known_nodes()
    for node in running.started:
        if node.files or not node.parameters_known or node.starts != "yes":
            continue
        if not node.name or (node.arguments and node.name not in known.names):
            continue
        files = [
            (package, file)
            for package in around.packages
            for file in package.yaml_files
            if node.name in {key.rpartition("/")[2] for key in file.nodes}
        ]
        if len(files) != 1:
            continue
        ((package, file),) = files
        name = posixpath.basename(file.path)
        if file.shown in used or any(name in text for text in plugins):
            continue
        if not running.is_whole and any(name in text for text in said):
            continue
        if not _gives(node, file):
            yield _left_out(around, node, file, package)


def _gives(node: RunningNode, file: YamlFile) -> bool:
    """Return whether a launch file itself sets the parameters that a file has."""
    keys = (key for key in file.nodes if key.rpartition("/")[2] == node.name)
    names = {name for key in keys for name in file.of(key)} - {"use_sim_time"}
    given = {each.name for each in node.parameters if not each.given_at}
    return not names or not names.isdisjoint(given)


def _left_out(
    around: Surroundings, node: RunningNode, file: YamlFile, package: Package
) -> Problem:
    key = next(k for k in file.nodes if k.rpartition("/")[2] == node.name)
    launches = (one for one in around.launches if one.shown == node.place.file)
    launch = next(launches, None)
    share = launch.named(f"package://{package.name}") if launch is not None else None
    share = share or f"get_package_share_directory('{package.name}')"
    named = (around.named(f.value) for one in around.launches for f in one.paths)
    paths = (each[1] for each in named if each is not None and each[0] is package)
    fitting = (path for path in paths if installed_as(package, path) == file.path)
    return Problem.at(
        node.place,
        "warning",
        "launch-parameters-missing",
        f"no node is given the parameters for {node.name} "
        f"({where(file.nodes[key], node.place)}): it runs with its defaults",
        f"add os.path.join({share}, '{next(fitting, file.path)}') to its parameters",
    )
