"""Check arguments of the actions in launch files, by name and by type."""

from __future__ import annotations

import ast
import posixpath
from collections.abc import Iterator, Mapping

from sambot_viz.checks.around.files.launch_values import SHARE
from sambot_viz.checks.around.launching.launch_file import NODES, LaunchFile
from sambot_viz.checks.around.launching.python_parts import Call
from sambot_viz.checks.around.place import rewritten
from sambot_viz.checks.around.surroundings import Surroundings
from sambot_viz.checks.vocabulary import vocabulary
from sambot_viz.edits import together, write_between
from sambot_viz.errors import Fix, Place, Problem

_FILES = {"RosGzBridge": "config_file", "GzServer": "world_sdf_file"}
"""Action → its argument that is the path of a file."""
_NEEDED = {
    "Command": "command",
    "DeclareLaunchArgument": "name",
    "ExecuteProcess": "cmd",
    "FindPackageShare": "package",
    "IfCondition": "predicate_expression",
    "IncludeLaunchDescription": "launch_description_source",
    "LaunchConfiguration": "variable_name",
    "LifecycleNode": "executable",
    "Node": "executable",
    "PathJoinSubstitution": "substitutions",
    "PythonLaunchDescriptionSource": "launch_file_path",
    "RegisterEventHandler": "event_handler",
    "UnlessCondition": "predicate_expression",
}
"""Call → its required argument."""
_DICTS = ("parameters", "launch_arguments")
"""Arguments that have dicts, by themselves or in a list."""
_ENDINGS = (".yaml", ".yml", ".sdf", ".world", ".rviz")


def calls_without_argument(around: Surroundings) -> Iterator[Problem]:
    """Report calls without an argument that they need."""
    for launch in around.launches:
        for call in launch.called(*_NEEDED):
            name = _NEEDED[call.name]
            node = call.node
            words = vocabulary("launch_calls")[call.name]
            # An unknown keyword may misspell this one.
            others = {k.arg for k in node.keywords}.difference(words) - {None}
            given = any(k.arg in (name, None) for k in node.keywords)
            if given or others or (node.args and call.name not in NODES):
                continue
            yield Problem.at(
                call.place,
                "error",
                "launch-code",
                f"{call.name} has no {name}, which it needs: ros2 launch stops with it",
                f"write {name} into its brackets",
            )


def sets_for_dicts(around: Surroundings) -> Iterator[Problem]:
    """Report commas between the names and the values of parameters."""
    for launch, text in around.launch_texts():
        lines, found = text.splitlines(), dict[int, ast.Set]()
        for call in launch.calls:
            given = [node for name in _DICTS if (node := call.given(name))]
            for node in (step for each in given for step in ast.walk(each)):
                inner = launch.origin(node) if isinstance(node, ast.Name) else node
                if isinstance(inner, ast.Set):
                    found[id(inner)] = inner
        for node in found.values():
            yield from _set_for_dict(node, launch, lines)


def _set_for_dict(
    node: ast.Set, launch: LaunchFile, lines: list[str]
) -> Iterator[Problem]:
    keys, values = node.elts[::2], node.elts[1::2]
    texts = [key.value for key in keys if isinstance(key, ast.Constant)]
    names = [text for text in texts if isinstance(text, str)]
    if not len(keys) == len(values) == len(names):
        return
    pairs = [f"'{name}': …" for name in names]
    hint = f"write {', '.join(pairs)} with a colon"
    fixes: list[Fix] = []
    for key in keys:
        line, column = key.end_lineno or 1, key.end_col_offset or 0
        after = lines[line - 1].encode()[column:].decode()
        begin, end = (Place(launch.shown, line, column + n) for n in (1, 2))
        if after[:1] == ",":
            fixes.append(write_between(begin, end, ":", hint))
    yield Problem.at(
        launch.place(node),
        "error",
        "launch-code",
        f"a comma makes this a set of values, not a dict: {names[0]} gets no value, "
        "and ros2 launch stops or takes the set for the path of a file",
        together(hint, *fixes) if len(fixes) == len(keys) else Fix(hint),
    )


def paths_from_the_root(around: Surroundings) -> Iterator[Problem]:
    """Report a slash before a part of a path, where os.path.join starts again."""
    for launch in around.launches:
        for call in launch.called("join"):
            path = launch.values.text(call.node) or ""
            for part in call.node.args[1:]:
                said = part.value if isinstance(part, ast.Constant) else None
                if not isinstance(said, str) or said[:1] != "/":
                    continue
                if around.text(path) is None or not path.startswith(SHARE):
                    continue
                place, bare = launch.place(part), said.lstrip("/")
                yield Problem.at(
                    place,
                    "warning",
                    "launch-file-missing",
                    f"os.path.join drops what is before {said}, because that begins "
                    f"with a slash: the path is {said} of the computer",
                    rewritten(
                        part,
                        launch.shown,
                        f"'{bare}'",
                        f"write '{bare}' without the slash",
                    ),
                )


def paths_of_no_text(around: Surroundings) -> Iterator[Problem]:
    """Report a dict or a list among the parts of a path, mostly a bracket too far."""
    for launch in around.launches:
        for call in launch.called("join"):
            parts = call.node.args
            if not ast.unparse(call.node.func).endswith("path.join"):
                continue
            odd = (p for p in parts if isinstance(p, (ast.Dict, ast.List, ast.Set)))
            part = next(odd, None)
            if part is None:
                continue
            kind = type(part).__name__.lower()
            yield Problem.at(
                launch.place(part),
                "error",
                "launch-code",
                f"os.path.join takes texts, and this is a {kind}: ros2 launch stops",
                _closed_before(part, call.node, launch),
            )


def _closed_before(part: ast.expr, join: ast.Call, launch: LaunchFile) -> Fix:
    """Return the fix that closes a call before its last argument."""
    hint = f"close the bracket of join before {ast.unparse(part)[:1]}"
    lists = (node for node in ast.walk(launch.tree) if isinstance(node, ast.List))
    if part is not join.args[-1] or len(join.args) < 2 or join.keywords:
        return Fix(hint)
    if not any(join in each.elts for each in lists):
        return Fix(hint)
    before, file = join.args[-2], launch.shown
    behind, end = (
        Place(file, node.end_lineno or 1, (node.end_col_offset or 0) + 1)
        for node in (before, join)
    )
    last = Place(file, end.line, (end.column or 2) - 1)
    return together(
        hint,
        write_between(behind, behind, ")", hint),
        write_between(last, end, "", hint),
    )


def files_without_folder(around: Surroundings) -> Iterator[Problem]:
    """Report files that ros2 launch looks for in the working folder.

    Only where the launch file takes other files from the package.
    """
    has: Mapping[str, str] = {
        posixpath.basename(path): path for path in around.files.ending(*_ENDINGS)
    }
    for launch in around.launches:
        # A launch file that names all files this way runs in the folder of the package.
        for call in launch.calls if launch.paths else ():
            for given in _paths(call, launch):
                said = launch.values.text(given) or ""
                path = has.get(posixpath.basename(said))
                begins = said[:1] in ("/", "~", "$") or ":" in said
                if path is None or begins or not path.endswith(said):
                    continue
                there = "" if path == said else f" as {path}"
                share = f"get_package_share_directory('{around.files.name}')"
                place = launch.place(given)
                yield Problem.at(
                    place,
                    "warning",
                    "launch-file-missing",
                    f"{said} is looked for in the folder where ros2 launch is run, "
                    f"and the package has it{there}",
                    Fix(f"write os.path.join({share}, '{path}')"),
                )


def _paths(call: Call, launch: LaunchFile) -> Iterator[ast.expr]:
    given = call.given(_FILES[call.name]) if call.name in _FILES else None
    if given is not None:
        yield given
    if call.name == "Node":
        for _, node in call.listing("parameters").items:
            if isinstance(node, ast.Constant):
                yield node
