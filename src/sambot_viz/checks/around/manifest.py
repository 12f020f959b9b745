"""package.xml: what stops colcon from reading it, and the build type."""

from __future__ import annotations

import re
from collections.abc import Iterator

from sambot_viz import limits
from sambot_viz.checks.around.files.fault import Fault
from sambot_viz.checks.around.launch_file import LaunchFile
from sambot_viz.checks.around.misspelt import is_misspelt
from sambot_viz.checks.around.place import line_fix, where
from sambot_viz.checks.around.surroundings import Surroundings
from sambot_viz.checks.rule import listed
from sambot_viz.edits import write, write_between
from sambot_viz.errors import Fix, Place, Problem, nearest
from sambot_viz.robot.xml.decode import XmlFault
from sambot_viz.robot.xml.element import Element, parse_xml

_FILE = "package.xml"
_NAME = re.compile(r"[a-zA-Z0-9][\w-]*", re.ASCII)
_OPENED_TWICE = re.compile(r"<([\w.]+)([^<>]*)>([^<>]*)<\1>")
_CLOSED_AS_OTHER = re.compile(r"<([\w.]+)([^<>]*)>([^<>]*)</([\w.]+)>")
_NOT_CLOSED = re.compile(r"<([\w.]+)([^<>]*[^<>/]|)>([^<>]+)$")
_WITHOUT_END = re.compile(r"</([\w.]+)\s*$")
_SMALLEST = (
    '<package format="3"><name>{}</name><version>0.0.0</version>'
    '<description>A robot</description><maintainer email="me@example.org">me'
    "</maintainer><license>MIT</license><buildtool_depend>ament_cmake"
    "</buildtool_depend><export><build_type>ament_cmake</build_type></export></package>"
)
_REQUIRED = {
    "name": "",
    "version": "<version>0.0.0</version>",
    "description": "<description>A robot</description>",
    "maintainer": '<maintainer email="me@example.org">me</maintainer>',
    "license": "<license>MIT</license>",
}
"""What each package.xml needs, and a line for it."""

KNOWN = frozenset(
    """
    controller_manager gazebo_ros joint_state_publisher joint_state_publisher_gui
    nav2_bringup robot_localization robot_state_publisher ros_gz_bridge ros_gz_image
    ros_gz_sim rviz2 slam_toolbox teleop_twist_keyboard tf2_ros twist_mux xacro
    """.split()
)
"""Packages that launch files often use."""
_LIKENESS = 0.8
_BUILD_FILES = {"ament_cmake": "CMakeLists.txt", "ament_python": "setup.py"}


def unreadable_manifest(around: Surroundings) -> Iterator[Problem]:
    """Report a package.xml that is empty, is no XML or names no package."""
    text, shown = around.files.text(_FILE), around.files.shown(_FILE)
    if text is None or len(text) > limits.BUILD_FILE.value:
        return
    root = around.manifest
    fault = _fault(text, around) if root is None else None
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
    """True when package.xml says no name that colcon takes."""
    root = around.manifest
    name = root.find("name") if root is not None else None
    return name is None or not _NAME.fullmatch(name.text.strip())


def _is_xml(text: str) -> bool:
    try:
        parse_xml(text, _FILE)
    except XmlFault:
        return False
    return True


def _fault(text: str, around: Surroundings) -> Fault | None:
    name = _proposed(around, around.files.folder.name)
    if not text.strip():
        return Fault(
            1,
            "package.xml is empty",
            f"write {_SMALLEST.format(name)}",
        )
    lines = text.splitlines()
    if _is_xml(f"{text}\n</package>"):
        last = max(n for n, line in enumerate(lines, 1) if line.strip())
        return Fault(
            last,
            "this file is no XML: <package> is not closed",
            "add </package> at the end of the file",
        )
    for n, line in enumerate(lines):
        for better, cause, hint in _repairs(line):
            if _is_xml("\n".join([*lines[:n], better, *lines[n + 1 :]])):
                return Fault(n + 1, f"this file is no XML: {cause}", hint, better)
    try:
        parse_xml(text, _FILE)
    except XmlFault as fault:
        return Fault(
            fault.line,
            f"this file is no XML ({fault.message})",
            "correct this line or the one above it: each <tag> needs its </tag>",
        )
    return None


def _repairs(line: str) -> Iterator[tuple[str, str, str]]:
    """Give better lines for one, each with the cause and what to write."""
    if match := _OPENED_TWICE.search(line) or _CLOSED_AS_OTHER.search(line):
        better = f"<{match[1]}{match[2]}>{match[3]}</{match[1]}>"
        twice = match.re is _OPENED_TWICE
        wrong = "opened twice and not closed" if twice else f"closed by </{match[4]}>"
        yield (
            line.replace(match[0], better),
            f"<{match[1]}> is {wrong}",
            f"write {better}",
        )
    elif match := _NOT_CLOSED.search(line):
        better = f"{match[0].rstrip()}</{match[1]}>"
        yield (
            line.replace(match[0], better),
            f"<{match[1]}> is not closed",
            f"write {better}",
        )
    if match := _WITHOUT_END.search(line):
        yield (
            f"{line.rstrip()}>",
            f"</{match[1]} has no >",
            f"write </{match[1]}>",
        )
    if "&" in line:
        yield line.replace("&", "&amp;"), "a bare & is not allowed", "write &amp;"


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
    """The name in CMakeLists.txt, or a text as a name."""
    project = around.cmake.project if around.cmake is not None else None
    if project is not None and _NAME.fullmatch(project.text):
        return project.text
    return re.sub(r"\W+", "_", said.lower()).strip("_") or "my_robot"


def incomplete_manifest(around: Surroundings) -> Iterator[Problem]:
    """Report the one element of package.xml that is missing."""
    root = around.manifest
    if root is None or root.tag != "package":
        return
    missing = [tag for tag in _REQUIRED if root.find(tag) is None]
    if len(missing) != 1 or missing == ["name"]:
        return
    (tag,) = missing
    yield Problem.at(
        Place(around.files.shown(_FILE), root.place.line, root.place.column),
        "error",
        "package-xml",
        f"package.xml has no <{tag}>: colcon does not take it for a package",
        f"add {_REQUIRED[tag]}",
    )


def misspelt_dependencies(around: Surroundings) -> Iterator[Problem]:
    """Report a dependency that is almost the name of a package that is used."""
    root = around.manifest
    if root is None:
        return
    depends = [e for e in root.children if e.tag.endswith("depend")]
    named = {element.text.strip() for element in depends}
    used = {word for launch in around.launches for word in _words(launch)}
    for element in depends:
        name = element.text.strip()
        near = nearest(name, sorted(used & KNOWN - named), _LIKENESS)
        if name in used or near is None or not is_misspelt(name, near):
            continue
        if around.files.knows(name):
            continue
        user = next(one for one in around.launches if near in _words(one))
        place = element.place
        here = Place(around.files.shown(_FILE), place.line, place.column)
        yield Problem.at(
            here,
            "warning",
            "package-dependency",
            f"package.xml depends on {name}, but {user.path} uses {near}: rosdep finds "
            f"no {name}, and does not install {near}",
            write(here, name, near),
        )


def missing_dependencies(around: Surroundings) -> Iterator[Problem]:
    """Note well-known packages that launch files start and package.xml does not list.

    One that lists fewer than two of these leaves them to other packages.
    """
    root = around.manifest
    depends = [e for e in root.children if e.tag.endswith("depend")] if root else []
    named = {element.text.strip() for element in depends}
    started: dict[str, Place] = {}
    for launch in around.launches:
        for call in launch.called():
            started.setdefault(launch.text(call, "package") or "", call.place)
        if any(text.startswith("xacro ") for text in launch.strings):
            started.setdefault("xacro", Place(launch.shown, 1))
    for element in (e for root in around.files.frontends for e in root.iter()):
        if element.get("exec") is not None:
            started.setdefault(element.get("pkg") or "", element.place)
    missing = sorted(started.keys() & KNOWN - named)
    if missing and len(named & started.keys() & KNOWN) > 1:
        last = depends[-1].place
        here = Place(around.files.shown(_FILE), last.line, last.column)
        lines = [f"<exec_depend>{name}</exec_depend>" for name in missing]
        them = "it" if len(missing) == 1 else "them"
        yield Problem.at(
            here,
            "info",
            "package-dependency",
            f"launch files start programs of {listed(missing)} "
            f"({where(started[missing[0]], here)}), but package.xml does not depend on "
            f"{them}: rosdep does not install {them}",
            write_between(
                here,
                here,
                "".join(f"{line}\n  " for line in lines),
                f"add {' '.join(lines)}",
            ),
        )


def _words(launch: LaunchFile) -> set[str]:
    return {word for text in launch.strings for word in text.split()}


def _without_build_type(root: Element, around: Surroundings) -> Iterator[Problem]:
    """Report a package that ament is to build, and that colcon gives to catkin."""
    uses = {e.text.strip() for e in root.children if e.tag.endswith("depend")}
    cmake = around.files.text("CMakeLists.txt")
    kind = "ament_python" if cmake is None else "ament_cmake"
    by_ament = "ament_cmake" in (cmake or "") or any("ament_" in use for use in uses)
    whole = all(root.find(tag) is not None for tag in _REQUIRED)
    if "catkin" in uses or not whole or not (by_ament or around.setup is not None):
        return
    export = root.find("export")
    added = f"<build_type>{kind}</build_type>"
    added = added if export else f"<export>{added}</export>"
    here = (export or root).place
    yield Problem.at(
        Place(around.files.shown(_FILE), here.line, here.column),
        # A CMakeLists.txt catkin may get through, a setup.py it never does.
        "error" if cmake is None else "warning",
        "package-build-type",
        "package.xml has no <build_type>, so that colcon builds the package with "
        "catkin, the one of ROS 1" + (": colcon build stops" if cmake is None else ""),
        f"add {added} inside it",
    )


def build_types(around: Surroundings) -> Iterator[Problem]:
    """Report a build type whose file is not there, where that of the other is."""
    root = around.manifest
    kinds = [e for e in root.iter() if e.tag == "build_type"] if root else []
    if root is not None and not kinds:
        yield from _without_build_type(root, around)
    if len(kinds) != 1 or kinds[0].get("condition") is not None:
        return
    said, place = kinds[0].text.strip(), kinds[0].place
    has = {
        kind: file
        for kind, file in _BUILD_FILES.items()
        if around.files.text(file) is not None
    }
    if said not in _BUILD_FILES or said in has or len(has) != 1:
        return
    ((better, file),) = has.items()
    here = Place(around.files.shown(_FILE), place.line, place.column)
    there = Place(around.files.shown(file), 1)
    yield Problem.at(
        here,
        "error",
        "package-build-type",
        f"{said} builds with {_BUILD_FILES[said]}, which the package does not have; it "
        f"has {file} ({where(there, here)}): colcon build stops",
        write(here, said, better),
    )
