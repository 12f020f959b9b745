"""Report values in Python launch files of a kind that launch does not accept."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator

from sambot_viz.checks.around.launch_files.joins import OPTION
from sambot_viz.checks.around.launching.actions import Action, Expression, Joined
from sambot_viz.checks.around.launching.launch_file import NODES, LaunchFile
from sambot_viz.checks.around.launching.python_parts import Call, Listing, Table
from sambot_viz.checks.around.place import bracketed, rewritten
from sambot_viz.checks.around.running.bridge_entries import bare
from sambot_viz.checks.around.running.system import RunningNode
from sambot_viz.checks.around.surroundings import Surroundings
from sambot_viz.checks.launch_files import call_name
from sambot_viz.edits import write
from sambot_viz.errors import Fix, Place, Problem, nearest
from sambot_viz.robot.slips.vocabulary import is_one_slip

_CODE = "launch-code"
_STOPS = "ros2 launch stops with it"
_ACTIONS = {
    "LaunchDescription": ("initial_entities", 0),
    "GroupAction": ("actions", 0),
    "TimerAction": ("actions", 1),
}
"""Call → its argument that is a list of actions."""
_LISTS = {
    "parameters": _STOPS,
    "remappings": _STOPS,
    "arguments": "the program gets each of its letters as an argument",
    "cmd": "each of its letters is a word of the command",
}
"""Argument of a node or a program that is a list → the effect of another kind."""
_WORDS = frozenset({"arguments", "cmd"})
_PROGRAMS = ("ExecuteProcess", "ExecuteLocal")
_SHORT = 3
"""Length up to which a name may be one letter from many others."""
_SUBSTITUTION = re.compile(r"\$\(\s*(find|find-pkg-share|var|arg)\s+([\w.-]+)\s*\)")
_IN_PYTHON = {
    "find": "FindPackageShare",
    "find-pkg-share": "FindPackageShare",
    "var": "LaunchConfiguration",
    "arg": "LaunchConfiguration",
}


def arguments_without_list(around: Surroundings) -> Iterator[Problem]:
    """Report parameters, remappings and arguments that are not lists."""
    for launch in around.launches:
        for call in launch.called(*NODES, *_PROGRAMS):
            for argument, follows in _LISTS.items():
                given = call.given(argument)
                what = None if given is None else _no_list(call, argument)
                if given is None or what is None or _is_iterable(given, launch):
                    continue
                plain = ast.unparse(given)
                is_whole = argument == "cmd" and call.given("shell") is not None
                pairs = plain if is_whole else _pairs(given, argument)
                owner = "a node" if call.name in NODES else "a program"
                hint = f"write {argument}=[{pairs}]"
                yield Problem.at(
                    launch.place(given),
                    "error",
                    "launch-no-list",
                    f"{argument} of {owner} is a list, but this is {what}: {follows}",
                    bracketed(given, launch.shown, hint)
                    if pairs == plain
                    else rewritten(given, launch.shown, f"[{pairs}]", hint),
                )


def _no_list(call: Call, argument: str) -> str | None:
    """Return the kind of an argument that is not a list; None for a possible list."""
    value = call.value(argument)
    if argument in _WORDS:
        return "a text" if isinstance(value, str) else None
    if isinstance(value, Table):
        return "a dict"
    return "a text" if isinstance(value, (str, Joined)) else None


def _is_iterable(given: ast.expr, launch: LaunchFile) -> bool:
    """Return whether an argument is {…}.items(), which launch goes through."""
    made = launch.origin(given)
    return isinstance(made, ast.Call) and call_name(made.func) == "items"


def _pairs(given: ast.expr, argument: str) -> str:
    """Write the items of the list."""
    if argument == "remappings" and isinstance(given, ast.Dict):
        both = zip(given.keys, given.values, strict=True)
        known = [(ast.unparse(key), ast.unparse(value)) for key, value in both if key]
        return ", ".join(f"({old}, {new})" for old, new in known)
    if argument in _WORDS and isinstance(given, ast.Constant):
        return ", ".join(repr(word) for word in str(given.value).split())
    return ast.unparse(given)


def remappings_without_pairs(around: Surroundings) -> Iterator[Problem]:
    """Report remappings that are not tuples of two names."""
    for launch in around.launches:
        for call in launch.called():
            given = call.given("remappings")
            parts = [node for _, node in call.listing("remappings").items]
            is_pair = len(parts) == 2 and isinstance(given, ast.Tuple)
            if given and is_pair and all(isinstance(p, ast.Constant) for p in parts):
                yield _no_pair(launch, given, f"[{ast.unparse(given)}]")
                continue
            for node in parts:
                if isinstance(node, (ast.List, ast.Set)) and len(node.elts) == 2:
                    inner = ", ".join(ast.unparse(part) for part in node.elts)
                    yield _no_pair(launch, node, f"({inner})")
                elif isinstance(node, (ast.List, ast.Constant, ast.Dict)):
                    yield _no_pair(launch, node, None)


def _no_pair(launch: LaunchFile, node: ast.expr, right: str | None) -> Problem:
    return Problem.at(
        launch.place(node),
        "error",
        _CODE,
        f"remappings are a list of tuples of two names, and this is none: {_STOPS}",
        Fix("write ('FROM', 'TO')")
        if right is None
        else rewritten(node, launch.shown, right),
    )


def reversed_remappings(around: Surroundings) -> Iterator[Problem]:
    """Report a remapping to a name of the node, from one that it does not use."""
    nodes = {node.place: node for node in around.running.started if node.endpoints}
    for launch in around.launches:
        for call in launch.called():
            node = nodes.get(call.place)
            own = {bare(end.written) for end in node.endpoints} if node else set[str]()
            for item, pair in call.listing("remappings").items:
                parts = item.items if isinstance(item, Listing) else ()
                if len(parts) != 2 or not isinstance(pair, ast.Tuple) or node is None:
                    continue
                old, new = (launch.values.said(part) or "" for part, _ in parts)
                if not old or bare(old) in own:
                    continue
                if bare(new) not in own:
                    yield from _misspelt(node, old, own, launch.place(parts[0][1]))
                    continue
                right = ", ".join(ast.unparse(part) for part in reversed(pair.elts))
                yield Problem.at(
                    launch.place(pair),
                    "warning",
                    _CODE,
                    f"{node.name} uses no name {old}, but {new}: a remapping is from "
                    "the name in the node to the new one, and this one has no effect",
                    rewritten(pair, launch.shown, f"({right})"),
                )


def _misspelt(
    node: RunningNode, old: str, own: set[str], place: Place
) -> Iterator[Problem]:
    """Report a remapping from a misspelt name of the node."""
    near = [name for name in own if is_one_slip(bare(old), name)]
    is_word = near and not any(map(str.isdigit, old + near[0]))
    if len(near) == 1 and is_word and len(near[0]) > _SHORT:
        right = old.replace(bare(old), near[0])
        yield Problem.at(
            place,
            "warning",
            _CODE,
            f"{node.name} uses no name {old}, but {right}: this has no effect",
            write(place, old, right),
        )


def lists_of_actions(around: Surroundings) -> Iterator[Problem]:
    """Report an action in place of a list of actions, and a list in place of one."""
    for launch in around.launches:
        for call in launch.called(*_ACTIONS):
            given = call.given(*_ACTIONS[call.name])
            value = call.value(*_ACTIONS[call.name])
            if given is not None and isinstance(value, Action):
                cause = f"{call.name} takes a list of actions, and this is one action"
                yield Problem.at(
                    launch.place(given),
                    "error",
                    _CODE,
                    f"{cause}: {_STOPS}",
                    bracketed(given, launch.shown, "write it in square brackets"),
                )
            elif given is not None and isinstance(value, Listing):
                yield from _no_actions(value, launch)


def _no_actions(listing: Listing, launch: LaunchFile) -> Iterator[Problem]:
    """Report the items of a list that are not actions."""
    for item, node in listing.items:
        if isinstance(item, Listing) and isinstance(node, (ast.List, ast.Tuple)):
            yield Problem.at(
                launch.place(node),
                "error",
                _CODE,
                f"this is a list in a list of actions: {_STOPS}",
                "write its actions without the inner brackets",
            )
        elif isinstance(item, str) and isinstance(node, ast.Constant):
            yield Problem.at(
                launch.place(node),
                "error",
                _CODE,
                f"this is a text in a list of actions: {_STOPS}",
                f"write {item} without quotation marks, or delete it"
                if item.isidentifier()
                else "delete it",
            )


def plain_substitutions(around: Surroundings) -> Iterator[Problem]:
    """Report $(find …) and similar substitutions in texts of a Python launch file."""
    for launch in around.launches:
        documents = {
            id(step.value)
            for step in ast.walk(launch.tree)
            if isinstance(step, ast.Expr) and isinstance(step.value, ast.Constant)
        }
        for node in ast.walk(launch.tree):
            text = node.value if isinstance(node, ast.Constant) else None
            if not isinstance(text, str) or id(node) in documents or "\n" in text:
                continue
            found = _SUBSTITUTION.search(text)
            if found is None or not isinstance(node, ast.Constant):
                continue
            if OPTION.fullmatch(text):
                # An option and its value in one text have another finding.
                continue
            parts = [repr(part) for part in (text[: found.start()],) if part]
            parts.append(f"{_IN_PYTHON[found[1]]}('{found[2]}')")
            parts += [repr(part) for part in (text[found.end() :],) if part]
            written = parts[0] if len(parts) == 1 else f"[{', '.join(parts)}]"
            yield Problem.at(
                launch.place(node),
                "warning",
                _CODE,
                f"launch replaces {found[0]} in launch files of XML and YAML only: "
                "here it stays as it is",
                f"write {written}",
            )


def misspelt_time(around: Surroundings) -> Iterator[Problem]:
    """Report misspelt use_sim_time among the parameters of a node."""
    right = "use_sim_time"
    for launch in around.launches:
        for call in launch.called():
            tables = [t for t, _ in call.listing("parameters").items]
            pairs = [p for t in tables if isinstance(t, Table) for p in t.pairs]
            keys: list[Expression] = [pair.key for pair in pairs]
            for pair in pairs:
                key = pair.key if isinstance(pair.key, str) else ""
                if right in keys or not nearest(key, [right], 0.85) or key == right:
                    continue
                yield Problem.at(
                    launch.place(pair.key_node),
                    "warning",
                    "launch-time-text",
                    f"no node has a parameter {key}, but each has {right}: the node "
                    "uses the time of the computer",
                    rewritten(pair.key_node, launch.shown, f"'{right}'"),
                )
