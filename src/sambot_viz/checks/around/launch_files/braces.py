"""Report texts with variables in braces, and no f before the quotation mark."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator

from sambot_viz.checks.around.launch_files.imports import modules
from sambot_viz.checks.around.launching.launch_file import LaunchFile
from sambot_viz.checks.around.place import where
from sambot_viz.checks.around.surroundings import Surroundings
from sambot_viz.checks.launch_files import call_name
from sambot_viz.edits import source_of, write_between
from sambot_viz.errors import Fix, Problem

_BRACED = re.compile(r"(?<![${])\{([A-Za-z_]\w*)\}(?!\})")
_LITERAL = re.compile(r"(['\"])[^'\"\\]*\1")
_JOINS = frozenset({"join", "PathJoinSubstitution", "get_package_share_directory"})
_NODES = frozenset(
    "ComposableNode ExecuteProcess LifecycleNode LogInfo Node TextSubstitution".split()
)
_LATER = ".substitutions"
"""Modules whose values launch finds after Python has put the texts together."""
_OUTSIDE = frozenset({"format", "format_map", "replace", "safe_substitute"})
"""Functions that put values into a text."""


def missing_prefixes(around: Surroundings) -> Iterator[Problem]:
    """Report texts for launch that name a variable of the file in braces."""
    for launch in around.launches:
        for node in _plain_texts(launch):
            names = braced_names(str(node.value), launch)
            if not names:
                continue
            made = launch.origin(ast.Name(names[0]))
            at = where(launch.place(made), launch.shown)
            yield Problem.at(
                launch.place(node),
                "warning",
                "launch-code",
                f"'{node.value}' has no f before its quotation mark, so it keeps its "
                f"braces in place of the value of {names[0]} ({at})",
                _prefixed(node, names, launch),
            )


def braced_names(text: str, launch: LaunchFile) -> list[str]:
    """Return the variables of a launch file that a text has in braces."""
    named = (match[1] for match in _BRACED.finditer(text))
    return [name for name in named if launch.is_variable(name)]


def _plain_texts(launch: LaunchFile) -> Iterator[ast.Constant]:
    """Yield the texts in paths and in arguments of nodes that no call formats."""
    met: set[int] = set()
    waiting: list[ast.AST] = [call.node for call in launch.called(*_JOINS)]
    for call in launch.called(*_NODES):
        waiting += [k.value for k in call.node.keywords]
    while waiting:
        node = waiting.pop()
        if id(node) in met or isinstance(node, (ast.JoinedStr, ast.Dict)):
            continue
        met.add(id(node))
        if isinstance(node, ast.Constant) and isinstance(node.value, str):
            yield node
        formats = isinstance(node, ast.Call) and call_name(node.func) in _OUTSIDE
        waiting += () if formats else ast.iter_child_nodes(node)


def _prefixed(node: ast.Constant, names: list[str], launch: LaunchFile) -> Fix:
    place, hint = launch.place(node), "write f before it"
    source = source_of(launch.shown)
    made = (launch.origin(ast.Name(name)) for name in names)
    calls = (call_name(each.func) for each in made if isinstance(each, ast.Call))
    if any((modules().get(call or "") or "").endswith(_LATER) for call in calls):
        return Fix(f"write the text and {names[0]} in a list, one behind the other")
    if source is None:
        return Fix(hint)
    begin = source.offset(place)
    written = _LITERAL.match(source.text, begin)
    if written is None or written[0][1:-1] != node.value:
        return Fix(hint)
    return write_between(place, place, "f", hint)
