"""Report nodes, arguments and values of a launch file that have no effect."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator

import yaml

from sambot_viz.checks.around.files.launch_values import SHARE
from sambot_viz.checks.around.files.parameters import flag
from sambot_viz.checks.around.gazebo.spawning import spawned_with
from sambot_viz.checks.around.launch_files.code import undefined_names
from sambot_viz.checks.around.launching.launch_file import NODES, LaunchFile
from sambot_viz.checks.around.launching.python_parts import Table
from sambot_viz.checks.around.place import rewritten, where
from sambot_viz.checks.around.surroundings import Surroundings
from sambot_viz.checks.launch_files import call_name
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
    """Report nodes that a launch file builds and does not add to the description.

    A misspelt name has another finding.
    """
    for launch, text in around.launch_texts():
        if undefined_names(launch.tree):
            continue
        described = next(launch.called("LaunchDescription"), None)
        for name, call in _assigned(launch) if described is not None else ():
            if described is None or launch.uses(name):
                continue
            # The author left out a name in a comment on purpose.
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
    """Yield the variables that get a node in generate_launch_description itself."""
    for function in launch.tree.body:
        if not isinstance(function, ast.FunctionDef):
            continue
        for node in function.body:
            value = node.value if isinstance(node, ast.Assign) else None
            target = node.targets[0] if isinstance(node, ast.Assign) else None
            if isinstance(value, ast.Call) and isinstance(target, ast.Name):
                if call_name(value.func) in _STARTED and not target.id.startswith("_"):
                    yield target.id, value


def bridges_as_parameters(around: Surroundings) -> Iterator[Problem]:
    """Report a list of topics in the parameters of a bridge."""
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
                right = f"{{'config_file': {ast.unparse(node)}}}"
                right = f"[{right}]" if node is call.given("parameters") else right
                given_path = launch.values.said(item) or ""
                path = given_path.removeprefix(SHARE).partition("/")[2]
                if around.shown(given_path) in lists:
                    yield Problem.at(
                        launch.place(node),
                        "error",
                        "launch-bridge-config",
                        f"{path} is a list of topics and no parameters: "
                        "parameter_bridge stops with an error",
                        rewritten(node, launch.shown, right),
                    )


def times_as_text(around: Surroundings) -> Iterator[Problem]:
    """Report use_sim_time of a node with a text as its value."""
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
    """Report a spawner that reads the model from a topic without a model."""
    published = {topic: place for topic, place in _descriptions(around) if topic}
    if len(published) < len(dict(_descriptions(around))) or not published:
        return
    certain = around.simulates_only_known
    for launch in around.launches:
        for fact in spawned_with(launch, "topic"):
            topic, place = fact.value, fact.place
            name = topic.rpartition("/")[2]
            # Another launch file may start all of them in a namespace.
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
    """Yield the topics that carry the model; None for an uncertain one."""
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
