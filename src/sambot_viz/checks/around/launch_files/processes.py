"""Check which processes launch files start twice, and for which they wait."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from sambot_viz.checks.around.launch_files.order import ListedAction, listed_actions
from sambot_viz.checks.around.launching.launch_file import NODES, LaunchFile
from sambot_viz.checks.around.launching.python_parts import Call, Listing
from sambot_viz.checks.around.place import rewritten, where
from sambot_viz.checks.around.surroundings import Surroundings
from sambot_viz.checks.launch_files import call_name
from sambot_viz.edits import source_of, write_between
from sambot_viz.errors import Fix, Place, Problem

_PROCESSES = NODES | {"ComposableNodeContainer", "ExecuteLocal", "ExecuteProcess"}
_OTHERS = frozenset(
    "DeclareLaunchArgument GroupAction GzServer IncludeLaunchDescription "
    "LaunchDescription LogInfo OpaqueFunction RegisterEventHandler RosGzBridge "
    "SetEnvironmentVariable SetParameter TimerAction".split()
)
"""Actions that start no process, or that start others."""
_LISTS = {
    "GroupAction": ("actions", 0),
    "OnExecutionComplete": ("on_completion", None),
    "OnProcessExit": ("on_exit", None),
    "OnProcessStart": ("on_start", None),
    "TimerAction": ("actions", None),
}
"""Action or handler → its argument with the actions that it starts."""


def targets_without_process(around: Surroundings) -> Iterator[Problem]:
    """Report handlers that wait for an action that is not a process."""
    for launch in around.launches:
        for call in launch.called("OnProcessExit", "OnProcessIO", "OnProcessStart"):
            target = call.given("target_action")
            made = None if target is None else launch.origin(target)
            name = call_name(made.func) if isinstance(made, ast.Call) else ""
            if target is None or name not in _OTHERS:
                continue
            inner = [c for c in launch.called(name or "") if c.node is made]
            names = [n for c in inner for n in _started(launch, c)]
            yield Problem.at(
                launch.place(target),
                "error",
                "launch-code",
                f"{call.name} waits for a process, and {ast.unparse(target)} is a "
                f"{name} ({where(launch.place(made or target), launch.shown)}): ros2 "
                "launch stops with it",
                rewritten(target, launch.shown, names[0].id)
                if len(names) == 1
                else Fix("write a node or an ExecuteProcess there"),
            )


def started_again(around: Surroundings) -> Iterator[Problem]:
    """Report processes of the description that a timer or a handler starts too."""
    for launch in around.launches:
        entries = [
            (entry, _name_of(entry))
            for entry in listed_actions(launch)
            if isinstance(entry.action, ast.Call)
            and call_name(entry.action.func) in _PROCESSES
        ]
        inside = [
            (name, call)
            for call in launch.in_use
            if call.name in _LISTS and call.given("condition") is None
            for name in _started(launch, call)
        ]
        for entry, own in entries:
            others = [pair for pair in inside if pair[0].id == own]
            if own is not None and others:
                yield _again(launch, entry, own, *others[0])


def _again(
    launch: LaunchFile, entry: ListedAction, own: str, name: ast.Name, call: Call
) -> Problem:
    there = where(launch.place(name), launch.shown)
    return Problem.at(
        launch.place(entry.written),
        "error",
        "launch-code",
        f"{own} is started here and by {call.name} ({there}), and launch starts an "
        "action only once: ros2 launch stops at the second time",
        _without(launch, entry, f"delete {own} here"),
    )


def _started(launch: LaunchFile, call: Call) -> Iterator[ast.Name]:
    """Yield the variables with processes that an action or a handler starts."""
    value = call.value(*_LISTS[call.name]) if call.name in _LISTS else None
    given = call.given(*_LISTS[call.name]) if call.name in _LISTS else None
    nodes = [node for _, node in value.items] if isinstance(value, Listing) else [given]
    for node in nodes:
        made = launch.origin(node) if isinstance(node, ast.Name) else None
        is_call = isinstance(made, ast.Call) and call_name(made.func) in _PROCESSES
        if isinstance(node, ast.Name) and is_call:
            yield node


def _name_of(entry: ListedAction) -> str | None:
    """Return the variable that the description names; None for another expression."""
    match entry.written:
        case ast.Name(id=name):
            return name
        case ast.Expr(value=ast.Call(args=[ast.Name(id=name)])):
            return name
        case _:
            return None


def _without(launch: LaunchFile, entry: ListedAction, hint: str) -> Fix:
    """Return the fix that deletes the line of an entry."""
    source, line = source_of(launch.shown), entry.written.lineno
    text = "" if source is None else source.text.split("\n")[line - 1]
    code = text.partition("#")[0].strip().removesuffix(",")
    if source is None or code != ast.unparse(entry.written):
        return Fix(hint)
    begin, end = Place(launch.shown, line, 1), Place(launch.shown, line + 1, 1)
    return write_between(begin, end, "", hint)
