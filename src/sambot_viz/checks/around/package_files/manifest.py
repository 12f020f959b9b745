"""Check package.xml: what stops colcon from reading it, and the build type."""

from __future__ import annotations

import re
from collections.abc import Iterator

from sambot_viz import limits
from sambot_viz.checks.around.files.manifest_repair import manifest_fault
from sambot_viz.checks.around.place import line_fix, where
from sambot_viz.checks.around.surroundings import Surroundings
from sambot_viz.edits import rename_element, write
from sambot_viz.errors import Fix, Place, Problem, nearest
from sambot_viz.robot.slips.vocabulary import is_one_slip
from sambot_viz.robot.xml.element import Element

_FILE = "package.xml"
_NAME = re.compile(r"[a-zA-Z0-9][\w-]*", re.ASCII)
_REQUIRED = {
    "name": "",
    "version": "<version>0.0.0</version>",
    "description": "<description>A robot</description>",
    "maintainer": '<maintainer email="me@example.org">me</maintainer>',
    "license": "<license>MIT</license>",
}
"""Elements that each package.xml needs, each with a line for it."""

_BUILD_FILES = {"ament_cmake": "CMakeLists.txt", "ament_python": "setup.py"}


def unreadable_manifest(around: Surroundings) -> Iterator[Problem]:
    """Report a package.xml that is empty, is not XML or does not name a package."""
    text, shown = around.files.text(_FILE), around.files.shown(_FILE)
    if text is None or len(text) > limits.BUILD_FILE.value:
        return
    root = around.manifest
    fault = None
    if root is None or root.tag != "package":
        fault = manifest_fault(text, _proposed(around, around.files.folder.name))
    if fault is not None:
        yield Problem.at(
            Place(shown, fault.line),
            "error",
            "package-xml",
            f"{fault.cause}: colcon does not find the package",
            line_fix(fault, Place(shown, fault.line), text),
        )
    elif root is not None and root.tag == "package":
        yield from _misnamed(root, around)


def named_as_its_folder(around: Surroundings) -> bool:
    """Return whether package.xml has no name that colcon accepts."""
    root = around.manifest
    name = root.find("name") if root is not None else None
    return name is None or not _NAME.fullmatch(name.text.strip())


def _misnamed(root: Element, around: Surroundings) -> Iterator[Problem]:
    name = root.find("name")
    said = name.text.strip() if name is not None else ""
    if _NAME.fullmatch(said):
        return
    place = name.place if name is not None else root.place
    what = f'"{said}" is not a name of a package' if said else "there is no <name>"
    here = Place(around.files.shown(_FILE), place.line, place.column)
    yield Problem.at(
        here,
        "error",
        "package-xml",
        f"{what}, which has only letters, digits and _: colcon does not find the "
        "package",
        _named(here, said, _proposed(around, said)),
    )


def _named(place: Place, said: str, right: str) -> Fix:
    hint = f"write <name>{right}</name>"
    return write(place, said, right, hint=hint) if said else Fix(hint)


def _proposed(around: Surroundings, said: str) -> str:
    """Return the name in CMakeLists.txt, or a text as a name."""
    project = around.cmake.project if around.cmake is not None else None
    if project is not None and _NAME.fullmatch(project.text):
        return project.text
    return re.sub(r"\W+", "_", said.lower()).strip("_") or "my_robot"


def incomplete_manifest(around: Surroundings) -> Iterator[Problem]:
    """Report the only missing element of package.xml."""
    root = around.manifest
    if root is None or root.tag != "package":
        return
    missing = [tag for tag in _REQUIRED if root.find(tag) is None]
    tags = [child.tag for child in root.children if child.tag not in _REQUIRED]
    if len(missing) != 1 or missing == ["name"] or nearest(missing[0], tags, 0.7):
        # Another rule reports a misspelt one.
        return
    (tag,) = missing
    yield Problem.at(
        Place(around.files.shown(_FILE), root.place.line, root.place.column),
        "error",
        "package-xml",
        f"package.xml has no <{tag}>: colcon does not take it for a package",
        f"add {_REQUIRED[tag]}",
    )


def _without_build_type(root: Element, around: Surroundings) -> Iterator[Problem]:
    """Report a package for ament that colcon builds with catkin."""
    uses = {e.text.strip() for e in root.children if e.tag.endswith("depend")}
    cmake = around.files.text("CMakeLists.txt")
    needs_cmake = around.setup is None and "ament_cmake" in uses
    kind = "ament_cmake" if cmake is not None or needs_cmake else "ament_python"
    by_ament = "ament_cmake" in (cmake or "") or any("ament_" in use for use in uses)
    whole = all(root.find(tag) is not None for tag in _REQUIRED)
    if "catkin" in uses or not whole or not (by_ament or around.setup is not None):
        return
    export = root.find("export")
    inner = export.children if export else []
    misspelt = next((e for e in inner if is_one_slip(e.tag, "build_type")), None)
    added = f"<build_type>{kind}</build_type>"
    added = added if export else f"<export>{added}</export>"
    at = (misspelt or export or root).place
    here = Place(around.files.shown(_FILE), at.line, at.column)
    hint = f"add {added} inside it"
    yield Problem.at(
        here,
        # catkin may build a CMakeLists.txt, but never a setup.py.
        "error" if cmake is None else "warning",
        "package-build-type",
        "package.xml has no <build_type>, so that colcon builds the package with "
        "catkin, the one of ROS 1" + (": colcon build stops" if cmake is None else ""),
        hint
        if misspelt is None
        else rename_element(here, misspelt.tag, "build_type", "write <build_type>"),
    )


def build_types(around: Surroundings) -> Iterator[Problem]:
    """Report a build type without its file, beside the file of the other type."""
    root = around.manifest
    kinds = [e for e in root.iter() if e.tag == "build_type"] if root else []
    if root is not None and not kinds:
        yield from _without_build_type(root, around)
    if root is None or len(kinds) != 1 or kinds[0].get("condition") is not None:
        return
    said, place = kinds[0].text.strip(), kinds[0].place
    here = Place(around.files.shown(_FILE), place.line, place.column)
    has = {
        kind: file
        for kind, file in _BUILD_FILES.items()
        if around.files.text(file) is not None
    }
    near = [kind for kind in _BUILD_FILES if is_one_slip(said.lower(), kind)]
    depends = {e.text.strip() for e in root.children if e.tag.endswith("depend")}
    if said == "catkin" and "ament_cmake" in depends - {"catkin"} and len(has) == 1:
        yield Problem.at(
            here,
            "error",
            "package-build-type",
            "catkin is the build type of ROS 1, but the package depends on "
            "ament_cmake: colcon build stops",
            write(here, said, next(iter(has))),
        )
    elif near and said not in near:
        yield Problem.at(
            here,
            "error",
            "package-build-type",
            f"colcon knows no {said}, and leaves the package out",
            write(here, said, near[0]),
        )
    elif said in _BUILD_FILES and said not in has and len(has) == 1:
        ((better, file),) = has.items()
        yield Problem.at(
            here,
            "error",
            "package-build-type",
            f"{said} builds with {_BUILD_FILES[said]}, which the package does not "
            f"have; it has {file} ({where(Place(around.files.shown(file), 1), here)}): "
            "colcon build stops",
            write(here, said, better),
        )
