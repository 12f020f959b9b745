"""Check the launch files and setup.py of a package.

The files are read as Python text and never run.
"""

from __future__ import annotations

import ast
import difflib
import re
import warnings
from collections.abc import Iterator
from pathlib import Path

from sambot_viz.checks.rule import listed
from sambot_viz.edits import write
from sambot_viz.errors import Place, Problem
from sambot_viz.robot.model import Robot
from sambot_viz.robot.packages.package_index import package_name

_SHARE_CALLS = frozenset({"FindPackageShare", "get_package_share_directory", "find"})
_TRUE = frozenset({"true", "1"})
_PROJECT = re.compile(r"^[ \t]*project\s*\(\s*([\w.-]+)", re.MULTILINE | re.IGNORECASE)


def check_package(folder: Path | str, robot: Robot | None = None) -> list[Problem]:
    """Find what will not work in a package's launch files and setup.py.

    Args:
        folder: the package, with its package.xml.
        robot: its robot; its movable joints are named in the messages.
    """
    root = Path(folder)
    problems = check_setup_py(root / "setup.py")
    name, built_as = package_name(root), _name_in_build_file(root)
    for path in launch_files(root):
        problems += check_launch_file(path, name, robot, built_as)
    return problems


def check_launch_file(
    path: Path | str,
    package: str | None = None,
    robot: Robot | None = None,
    built_as: str | None = None,
) -> list[Problem]:
    """Find what will not work in a Python launch file.

    Args:
        path: the launch file.
        package: the name of the package it belongs to, if known.
        robot: the robot it shows, if known.
        built_as: what CMakeLists.txt or setup.py calls the package, if known.

    Returns:
        Nothing when the file cannot be read as Python.
    """
    _, calls = calls_in(Path(path))
    return [
        *_no_joint_states(calls, str(path), robot),
        *_unknown_package(calls, str(path), package, built_as),
    ]


def check_setup_py(path: Path | str) -> list[Problem]:
    """Compare the name in setup.py with the one in the package.xml beside it."""
    file = Path(path)
    package = package_name(file.parent)
    if package is None:
        return []
    for named in _names_in_setup_py(file):
        if named[0] == package:
            continue
        return [
            Problem.at(
                (place := Place(str(path), named[1])),
                "error",
                "setup-py-name",
                f"setup.py calls the package {named[0]}, package.xml calls it "
                f"{package}: colcon and ros2 launch will not find it",
                write(place, named[0], package, " here"),
            )
        ]
    return []


def _names_in_setup_py(file: Path) -> Iterator[tuple[str, int]]:
    tree = _python(file)
    for node in ast.walk(tree) if tree is not None else ():
        if named := _assigned_name(node):
            yield named


def _name_in_build_file(root: Path) -> str | None:
    """Return what CMakeLists.txt or setup.py calls a package, if one does."""
    try:
        project = _PROJECT.search((root / "CMakeLists.txt").read_text("utf-8"))
    except (OSError, ValueError):
        project = None
    if project is not None:
        return project[1]
    return next((name for name, _ in _names_in_setup_py(root / "setup.py")), None)


def _assigned_name(node: ast.AST) -> tuple[str, int] | None:
    """The text and line of ``package_name = "…"`` or ``setup(name="…")``."""
    if isinstance(node, ast.Assign) and len(node.targets) == 1:
        target = node.targets[0]
        if isinstance(target, ast.Name) and target.id == "package_name":
            text = _text(node.value)
            return (text, node.lineno) if text is not None else None
    if isinstance(node, ast.Call) and call_name(node.func) == "setup":
        for keyword in node.keywords:
            text = _text(keyword.value)
            if keyword.arg == "name" and text is not None:
                return text, keyword.value.lineno
    return None


def _python(path: Path) -> ast.Module | None:
    try:
        return parse_python(path.read_bytes())
    except OSError:
        return None


def parse_python(text: str | bytes) -> ast.Module | None:
    """Read Python without running it; None when it is none."""
    try:
        with warnings.catch_warnings():
            # Python warns of odd escapes in the file, on the terminal of the user.
            warnings.simplefilter("ignore")
            return ast.parse(text)
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        return None


def launch_files(folder: Path) -> list[Path]:
    """Find the Python launch files of a package, at most fifty."""
    return sorted(folder.glob("launch/**/*launch.py"))[:50]


def calls_in(path: Path) -> tuple[ast.Module | None, list[ast.Call]]:
    """Read a Python file and the calls in it, from top to bottom."""
    tree = _python(path)
    found = [n for n in ast.walk(tree) if isinstance(n, ast.Call)] if tree else []
    return tree, sorted(found, key=lambda call: (call.lineno, call.col_offset))


def call_name(function: ast.expr) -> str:
    """Return the name of what is called: "Node" in ``actions.Node(…)``."""
    if isinstance(function, ast.Attribute):
        return function.attr
    return function.id if isinstance(function, ast.Name) else ""


def _text(node: ast.expr | None) -> str | None:
    if isinstance(node, ast.Constant) and isinstance(node.value, str):
        return node.value
    return None


def _keyword(call: ast.Call, name: str) -> ast.expr | None:
    return next((k.value for k in call.keywords if k.arg == name), None)


def _no_joint_states(
    calls: list[ast.Call], file: str, robot: Robot | None
) -> Iterator[Problem]:
    """A joint state publisher that does not start because gui is true by default."""
    nodes = [c for c in calls if call_name(c.func) == "Node"]
    started = {_text(_keyword(n, "executable")) for n in nodes}
    if "joint_state_publisher_gui" in started:
        return
    for node in nodes:
        if _text(_keyword(node, "executable")) != "joint_state_publisher":
            continue
        argument = _unless(_keyword(node, "condition"))
        if argument is None or not _is_true_by_default(calls, argument):
            continue
        joints = [j.name for j in robot.joints.values() if j.movable] if robot else []
        stays = listed(joints) or "every movable joint"
        verb = "stay" if len(joints) > 1 else "stays"
        yield Problem(
            "warning",
            "launch-no-joint-states",
            f"no node publishes joint states here: {argument} is true, so "
            "joint_state_publisher does not start, and no joint_state_publisher_gui "
            f"node is listed; {stays} {verb} without a transform",
            f"add the joint_state_publisher_gui node, or run with {argument}:=False",
            file,
            node.lineno,
            node.col_offset + 1,
        )


def _unless(condition: ast.expr | None) -> str | None:
    """The argument in ``UnlessCondition(LaunchConfiguration("gui"))``."""
    if (
        not isinstance(condition, ast.Call)
        or call_name(condition.func) != "UnlessCondition"
    ):
        return None
    inner = condition.args[0] if condition.args else None
    if isinstance(inner, ast.Call) and call_name(inner.func) == "LaunchConfiguration":
        return _text(inner.args[0]) if inner.args else None
    return None


def _is_true_by_default(calls: list[ast.Call], argument: str) -> bool:
    for call in calls:
        if call_name(call.func) != "DeclareLaunchArgument" or not call.args:
            continue
        if _text(call.args[0]) == argument:
            default = _text(_keyword(call, "default_value")) or ""
            return default.strip().lower() in _TRUE
    return False


def _unknown_package(
    calls: list[ast.Call], file: str, package: str | None, built_as: str | None
) -> Iterator[Problem]:
    """A name like that of the package, in a file that never uses the right name.

    Where the build file has the same name, that of package.xml is wrong.
    """
    if package is None:
        return
    asked = [
        (text, call)
        for call in calls
        if call_name(call.func) in _SHARE_CALLS
        and call.args
        and (text := _text(call.args[0])) is not None
    ]
    if any(text in (package, built_as) for text, _ in asked):
        return
    for text, call in asked:
        if _alike(text, package):
            place = Place(file, call.lineno, call.col_offset + 1)
            yield Problem.at(
                place,
                "error",
                "launch-package-unknown",
                f"the launch file asks for the package {text}, but the package here "
                f"is called {package} (package.xml)",
                write(place, text, package),
            )
            return


def _alike(name: str, package: str) -> bool:
    """Tell whether one package name looks like a misspelling of the other."""
    first = re.split(r"[_\-]", name)[0] == re.split(r"[_\-]", package)[0]
    ratio = difflib.SequenceMatcher(None, name, package).ratio()
    return ratio > 0.8 or (first and ratio > 0.5)
