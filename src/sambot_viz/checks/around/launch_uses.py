"""Nodes, arguments and values of a launch file that do not reach what they are for."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from functools import cache
from typing import NamedTuple

import yaml

from sambot_viz.checks.around.files.launch_values import SHARE
from sambot_viz.checks.around.files.parameters import flag
from sambot_viz.checks.around.launch_code import undefined_names
from sambot_viz.checks.around.launch_file import NODES, LaunchFile
from sambot_viz.checks.around.launching.python_parts import Table
from sambot_viz.checks.around.misspelt import is_misspelt
from sambot_viz.checks.around.place import where
from sambot_viz.checks.around.spawning import spawned_with
from sambot_viz.checks.around.surroundings import Surroundings
from sambot_viz.checks.around.words import meant_word
from sambot_viz.checks.around.workspace import Package
from sambot_viz.checks.launch_files import call_name
from sambot_viz.checks.vocabulary import vocabulary
from sambot_viz.edits import write
from sambot_viz.errors import Place, Problem, nearest

_STARTED = frozenset(
    {
        "DeclareLaunchArgument",
        "ExecuteProcess",
        "GzServer",
        "IncludeLaunchDescription",
        "LifecycleNode",
        "Node",
        "RosGzBridge",
    }
)
_TOPIC, _PUBLISHER = "robot_description", "robot_state_publisher"


def unused_actions(around: Surroundings) -> Iterator[Problem]:
    """Report nodes that are built and are nowhere in the description.

    Where a name is misspelt, that is the finding.
    """
    for launch, text in around.launch_texts():
        if undefined_names(launch.tree):
            continue
        described = next(launch.called("LaunchDescription"), None)
        for name, call in _assigned(launch) if described is not None else ():
            if described is None or launch.uses(name):
                continue
            # A name in a comment is left out on purpose.
            if re.search(rf"#.*\b{name}\b", text):
                continue
            what = call_name(call.func)
            follows = (
                "the argument does not exist"
                if what == "DeclareLaunchArgument"
                else "it does not start"
            )
            yield Problem.at(
                launch.place(call),
                "warning",
                "launch-node-unused",
                f"{name} is built here, but it is not in the LaunchDescription "
                f"({where(described.place, launch.shown)}): {follows}",
                f"add {name} to that list",
            )


def _assigned(launch: LaunchFile) -> Iterator[tuple[str, ast.Call]]:
    """The variables that get a node in generate_launch_description itself."""
    for function in launch.tree.body:
        if not isinstance(function, ast.FunctionDef):
            continue
        for node in function.body:
            value = node.value if isinstance(node, ast.Assign) else None
            target = node.targets[0] if isinstance(node, ast.Assign) else None
            if isinstance(value, ast.Call) and isinstance(target, ast.Name):
                if call_name(value.func) in _STARTED and not target.id.startswith("_"):
                    yield target.id, value


class _Program(NamedTuple):
    """A program that a launch file starts.

    Attributes:
        package: its package.
        name: the program.
        place: where that is written.
        package_place: where the package is.
    """

    package: str
    name: str
    place: Place
    package_place: Place


def _programs(around: Surroundings) -> Iterator[_Program]:
    """Give the programs of nodes whose names are known."""
    for launch in around.launches:
        for call in launch.in_use:
            given, package = call.given("executable"), call.given("package")
            name = launch.text(call, "executable") if call.name in NODES else None
            if given is not None and name is not None:
                place = launch.place(given)
                there = call.place if package is None else launch.place(package)
                yield _Program(launch.text(call, "package") or "", name, place, there)
    for root in (root for package in around.packages for root in package.frontends):
        for node in root.iter():
            name, package = node.get("exec"), node.get("pkg")
            if node.tag == "node" and name and package and "$" not in name + package:
                yield _Program(package, name, node.place, node.place)


def unknown_programs(around: Surroundings) -> Iterator[Problem]:
    """Report programs that a well-known package does not have."""
    for package, program, place, package_place in _programs(around):
        here = next((p for p in around.packages if p.name == package), None)
        own = None if here is None else _own_programs(here)
        every = vocabulary("launch_programs").get(package, ())
        known = every if own is None else tuple(own)
        if program in known:
            continue
        near = meant_word(known, program, 0.6)
        elsewhere = owners().get(program, "") if known and own is None else ""
        if elsewhere and program not in dict(w.split("=") for w in known if "=" in w):
            yield _of_another(package_place, package, program, elsewhere)
            continue
        if near is None and own is None:
            continue
        listed_at = own.get(near or "") if own is not None else None
        there = f"; it has {near} ({where(listed_at, place)})" if listed_at else ""
        certain = own is None or is_misspelt(program, near or "")
        yield Problem.at(
            place,
            "error",
            "launch-program-unknown",
            f"the package {package} has no program {program}{there}: ros2 launch "
            "stops with it",
            write(place, program, near)
            if near and certain
            else _other_program(program, near),
        )


@cache
def owners() -> dict[str, str]:
    """Return program → the one well-known package that has it."""
    found: dict[str, str] = {}
    for package, programs in vocabulary("launch_programs").items():
        for program in programs:
            found[program] = "" if program in found else package
    return found


def _of_another(place: Place, said: str, program: str, package: str) -> Problem:
    return Problem.at(
        place,
        "error",
        "launch-program-unknown",
        f"the package {said} has no program {program}, which is in {package}: ros2 "
        "launch stops with it",
        write(place, said, package),
    )


def _other_program(program: str, near: str | None) -> str:
    other = f", or write {near}" if near else ""
    return f"add a line {program} = … to console_scripts in setup.py{other}"


def _own_programs(package: Package) -> dict[str, Place] | None:
    """The programs that setup.py installs; None when that is not certain."""
    setup = package.setup if package.cmake is None else None
    if setup is None or not setup.installs_only_known or setup.given("scripts"):
        return None
    if setup.scripts.known is None or len(setup.programs) != len(setup.scripts.items):
        return None
    if any((entry.target or "").startswith("lib/") for entry in setup.data_files):
        return None
    return {program.name: setup.place(program.node) for program in setup.programs}


def bridges_as_parameters(around: Surroundings) -> Iterator[Problem]:
    """Report a list of topics that is given to a bridge as its parameters."""
    lists = {
        file.shown
        for file in around.yaml_files
        if isinstance(file.root, yaml.SequenceNode)
    }
    for launch in around.launches:
        for call in launch.certain:
            if launch.text(call, "executable") != "parameter_bridge":
                continue
            for item, node in call.listing("parameters").items:
                given_path = launch.values.said(item) or ""
                path = given_path.removeprefix(SHARE).partition("/")[2]
                if around.shown(given_path) in lists:
                    yield Problem.at(
                        launch.place(node),
                        "error",
                        "launch-bridge-config",
                        f"{path} is a list of topics and no parameters: "
                        "parameter_bridge stops with an error",
                        f"write {{'config_file': {ast.unparse(node)}}}",
                    )


def times_as_text(around: Surroundings) -> Iterator[Problem]:
    """Report use_sim_time that is given to a node as a text."""
    for launch in around.launches:
        for call in launch.certain:
            for item, _ in call.listing("parameters").items:
                if call.name in NODES and isinstance(item, Table):
                    yield from _time_as_text(item, launch)


def _time_as_text(given: Table, launch: LaunchFile) -> Iterator[Problem]:
    for value in (pair.node for pair in given.pairs if pair.key == "use_sim_time"):
        text = value.value if isinstance(value, ast.Constant) else None
        truth = flag(text) if isinstance(text, str) else None
        if truth is not None:
            yield Problem.at(
                launch.place(value),
                "error",
                "launch-time-text",
                f"use_sim_time is the text '{text}', but nodes need {truth} without "
                "quotation marks: the node stops with an error",
                write(launch.place(value), ast.unparse(value), str(truth)),
            )


def spawned_topics(around: Surroundings) -> Iterator[Problem]:
    """Report a robot that is spawned from a topic on which no model is published."""
    published = {topic: place for topic, place in _descriptions(around) if topic}
    if len(published) < len(dict(_descriptions(around))) or not published:
        return
    certain = around.simulates_only_known
    for launch in around.launches:
        for fact in spawned_with(launch, "topic"):
            topic, place = fact.value, fact.place
            name = topic.rpartition("/")[2]
            # All may be started in a namespace by another launch file.
            if f"/{topic.strip('/')}".endswith(tuple(published)):
                continue
            if name == _TOPIC:
                if not topic.startswith("/"):
                    continue
            elif not certain and not nearest(name, [_TOPIC], 0.8):
                continue
            right, publisher = next(iter(published.items()))
            yield Problem.at(
                place,
                "warning",
                "launch-spawn-topic",
                f"the robot is to come from the topic {topic}, but "
                f"{_PUBLISHER} ({where(publisher, place)}) publishes it as "
                f"{right}: it does not appear",
                write(place, topic, right),
            )


def _descriptions(around: Surroundings) -> Iterator[tuple[str | None, Place]]:
    """The topics on which the model is published; None for one that is not certain."""
    for launch in around.launches:
        pushed = any(launch.called("PushRosNamespace", "PushROSNamespace"))
        for call in launch.called():
            if launch.text(call, "executable") == _PUBLISHER:
                space = launch.text(call, "namespace")
                space = "" if call.given("namespace") is None else space
                known = space is not None and not pushed
                known = known and call.given("remappings") is None
                topic = f"/{space}/{_TOPIC}".replace("//", "/") if known else None
                yield topic, call.place
