"""Check the name of a package in its setup.py and in its launch files."""

from __future__ import annotations

import ast
import difflib
import re
from collections.abc import Iterator

from sambot_viz.checks.around.files.launch_values import SHARE
from sambot_viz.checks.around.misspelt import is_misspelt
from sambot_viz.checks.around.running.known import known_nodes
from sambot_viz.checks.around.surroundings import Surroundings
from sambot_viz.checks.around.workspace import Package
from sambot_viz.checks.launch_files import call_name
from sambot_viz.checks.vocabulary import vocabulary
from sambot_viz.edits import write
from sambot_viz.errors import Place, Problem, nearest
from sambot_viz.robot.slips.vocabulary import is_one_slip
from sambot_viz.robot.xml.element import Element

_SHARE_CALLS = frozenset({"FindPackageShare", "get_package_share_directory", "find"})
_IN_TEXT = re.compile(r"\$\(\s*find-pkg-share\s+([\w.-]+)\s*\)")
_PARTS = frozenset(
    """
    base bringup common config control controller demo description driver examples
    fake firmware gazebo generator gz hardware interfaces launch localization
    mapping moveit msgs nav nav2 navigation node perception robot sim simulation
    simulator slam support teleop tests tools utils viz
    """.split()
)
"""Endings of package names of one robot."""


def setup_name(around: Surroundings) -> Iterator[Problem]:
    """Compare the name in setup.py with the one in the package.xml beside it."""
    name, setup = around.files.name, around.setup
    for node in ast.walk(setup.tree) if setup is not None else ():
        named = _assigned_name(node)
        if named is None or named[0] == name:
            continue
        place = Place(around.files.shown("setup.py"), named[1])
        if _is_right(named[0], around) and not _is_right(name or "", around):
            yield _of_manifest(named[0], place, around)
            return
        yield Problem.at(
            place,
            "error",
            "setup-py-name",
            f"setup.py calls the package {named[0]}, package.xml calls it "
            f"{name}: colcon and ros2 launch will not find it",
            write(place, named[0], name, " here"),
        )
        return


def _is_right(name: str, around: Surroundings) -> bool:
    """Return whether the files of a Python package have its name."""
    folder = around.files.folder
    return (folder / f"resource/{name}").is_file() and bool(name)


def _of_manifest(right: str, other: Place, around: Surroundings) -> Problem:
    """Report a package.xml with another name than all other files of the package."""
    root, name = around.manifest, around.files.name or ""
    element = root.find("name") if root is not None else None
    at = element.place if element is not None else Place("", 1)
    here = Place(around.files.shown("package.xml"), at.line, at.column)
    return Problem.at(
        here,
        "error",
        "setup-py-name",
        f"package.xml calls the package {name}, but setup.py (line {other.line}) and "
        f"resource/{right} call it {right}: colcon and ros2 launch will not find it",
        write(here, name, right, hint=f"write <name>{right}</name>"),
    )


def _assigned_name(node: ast.AST) -> tuple[str, int] | None:
    """Return the text and line of ``package_name = "…"`` or ``setup(name="…")``."""
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


def _text(node: ast.expr | None) -> str | None:
    if isinstance(node, ast.Constant) and isinstance(node.value, str):
        return node.value
    return None


def unknown_packages(around: Surroundings) -> Iterator[Problem]:
    """Report a name similar to the package's, in a file without the right name."""
    for package in around.packages:
        others = around.names | _dependencies(package.manifest)
        if package.cmake is not None and package.cmake.project is not None:
            # Where launch files use the project name of CMakeLists.txt, package.xml is
            # wrong.
            others |= {package.cmake.project.text}
        for asked in _asked(package):
            # Beside the right name, a similar one may belong to another package.
            has_right = any(text == package.name for text, _ in asked)
            is_meant = is_one_slip if has_right else _alike
            for text, place in asked:
                if (
                    text not in others
                    and is_meant(text, package.name)
                    and not package.knows(text)
                    and not _has_others(text, package, around)
                ):
                    yield Problem.at(
                        place,
                        "error",
                        "launch-package-unknown",
                        f"the launch file asks for the package {text}, but the package "
                        f"here is called {package.name} (package.xml)",
                        write(place, text, package.name),
                    )
                    break


def misspelt_shares(around: Surroundings) -> Iterator[Problem]:
    """Report a folder of a package that misspells a well-known one."""
    known = {*vocabulary("launch_programs"), *known_nodes().packages}
    for package in around.packages:
        others = around.names | _dependencies(package.manifest) | known
        for asked in _asked(package):
            for text, place in asked:
                near = None if text in others else nearest(text, sorted(known), 0.85)
                if near is None or package.knows(text):
                    continue
                if is_misspelt(text, near):
                    yield Problem.at(
                        place,
                        "error",
                        "launch-package-unknown",
                        f"there is no package {text}, but {near}: ros2 launch stops "
                        "with it",
                        write(place, text, near),
                    )


def _asked(package: Package) -> Iterator[list[tuple[str, Place]]]:
    """Yield the packages whose share folders each launch file asks for."""
    for launch in package.launches:
        first = (c.given("package", 0) for c in launch.called(*_SHARE_CALLS))
        yield [
            (text, launch.place(node))
            for node in first
            if node is not None and (text := _text(node)) is not None
        ]
    for root in package.frontends:
        yield [
            (text, element.place)
            for element in root.iter()
            for value in element.attributes.values()
            for text in _IN_TEXT.findall(value)
        ]


def _dependencies(manifest: Element | None) -> set[str]:
    """Return the packages that package.xml lists as dependencies."""
    tags = (e for e in manifest.children if "depend" in e.tag) if manifest else ()
    return {element.text.strip() for element in tags}


def _alike(name: str, package: str) -> bool:
    """Return whether one package name looks like a misspelling of the other."""
    words, others = (re.split(r"[_\-]", text) for text in (name, package))
    if words[-1].rstrip("0123456789") in _PARTS and words[-1] != others[-1]:
        # Two packages of one robot; the other one may be elsewhere.
        return False
    ratio = difflib.SequenceMatcher(None, name, package).ratio()
    return ratio > 0.8 or (words[0] == others[0] and ratio > 0.5)


def _has_others(name: str, package: Package, around: Surroundings) -> bool:
    """Return whether launch files open a file of a package that this one lacks."""
    start = f"{SHARE}{name}/"
    python = (fact for launch in package.launches for fact in launch.paths)
    said = (f.value.partition(start)[2] for f in (*python, *around.running.paths))
    return any(
        below and not any(f"{path}/".startswith(f"{below}/") for path in package.paths)
        for below in said
    )
