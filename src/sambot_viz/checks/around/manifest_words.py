"""Words of package.xml that colcon does not know, and packages that ROS 2 lacks."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator

from sambot_viz.checks.around.manifest import KNOWN
from sambot_viz.checks.around.surroundings import Surroundings
from sambot_viz.checks.around.words import WordKind, WrittenWord, misspelt
from sambot_viz.checks.vocabulary import vocabulary
from sambot_viz.edits import rename_element, write, write_attribute, write_between
from sambot_viz.errors import Fix, Place, Problem, nearest
from sambot_viz.robot.xml.element import Element

_SINCE_FORMAT_2 = frozenset(
    "build_export_depend buildtool_export_depend depend doc_depend exec_depend".split()
)
_ELEMENT = WordKind(
    "package_xml",
    "package-xml",
    "package.xml of format {owner} has no <{wrong}>: colcon does not take it for a "
    "package",
)
_VERSION = re.compile(r"\d+\.\d+\.\d+")
_STARTED = re.compile(r"v?(\d+)(?:\.(\d+))?")
_NAME_LIKENESS = 0.8


def unknown_elements(around: Surroundings) -> Iterator[Problem]:
    """Report elements of package.xml that its format does not have."""
    root = around.manifest
    if root is None or root.tag != "package":
        return
    yield from misspelt(_elements(root, around), _ELEMENT)
    tags = [element.tag for element in root.children]
    newer = [tag for tag in tags if tag in _SINCE_FORMAT_2]
    if newer and root.get("format") in (None, "1") and "run_depend" not in tags:
        place = _place(root, around)
        behind = Place(place.file, place.line, (place.column or 1) + len("<package"))
        hint = 'write <package format="3">'
        yield _stops(
            place,
            f"package.xml is of format 1, which has no <{newer[0]}>",
            write_between(behind, behind, ' format="3"', hint)
            if root.get("format") is None
            else write_attribute(place, "format", "1", "3", hint=hint),
        )


def _elements(root: Element, around: Surroundings) -> Iterator[WrittenWord]:
    for element in root.children:
        place, tag = _place(element, around), element.tag

        def renamed(right: str, place: Place = place, tag: str = tag) -> Fix:
            return rename_element(place, tag, right, f"write <{right}>")

        yield WrittenWord(root.get("format") or "1", tag, (), place, renamed)


def malformed_values(around: Surroundings) -> Iterator[Problem]:
    """Report a version without three numbers, and a maintainer without an address."""
    root = around.manifest
    if root is None or root.tag != "package":
        return
    version = root.find("version")
    said = version.text.strip() if version is not None else ""
    if version is not None and said and not _VERSION.fullmatch(said):
        place, started = _place(version, around), _STARTED.fullmatch(said)
        right = f"{started[1]}.{started[2] or 0}.0" if started else "0.0.0"
        hint = f"write <version>{right}</version>"
        yield _stops(
            place,
            f"the version {said} is not three numbers with dots between them",
            write(place, said, right, hint=hint) if started else hint,
        )
    people = [child for child in root.children if child.tag == "maintainer"]
    if people and not any(person.get("email") for person in people):
        yield _stops(
            _place(people[0], around),
            "no <maintainer> has an email",
            'write <maintainer email="me@example.org">',
        )


def _stops(place: Place, cause: str, hint: str | Fix) -> Problem:
    follows = "colcon does not take it for a package"
    return Problem.at(place, "error", "package-xml", f"{cause}: {follows}", hint)


def _place(element: Element, around: Surroundings) -> Place:
    shown = around.files.shown("package.xml")
    return Place(shown, element.place.line, element.place.column)


def packages_of_ros1(around: Surroundings) -> Iterator[Problem]:
    """Report dependencies of a package of ROS 2 on packages that only ROS 1 has."""
    root = around.manifest
    built = (
        {e.text.strip() for e in root.iter() if e.tag == "build_type"} if root else ()
    )
    if root is None or not any(kind.startswith("ament") for kind in built):
        return
    for element in root.children:
        name = element.text.strip()
        better = vocabulary("ros1_packages").get(name, ())
        skipped = name in around.names or element.get("condition") is not None
        if not element.tag.endswith("depend") or not better or skipped:
            continue
        place = _place(element, around)
        yield Problem.at(
            place,
            "warning",
            "package-dependency",
            f"{name} is a package of ROS 1, and this package is of ROS 2: rosdep does "
            "not find it",
            write(place, name, better[0]),
        )


def misspelt_packages(around: Surroundings) -> Iterator[Problem]:
    """Report a find_package that is almost a well-known dependency."""
    root, cmake = around.manifest, around.cmake
    if root is None or cmake is None or cmake.fault is not None:
        return
    needed = {e.text.strip() for e in root.children if e.tag.endswith("depend")}
    calls = [c for c in cmake.commands if c.name == "find_package" and c.words]
    found = {call.words[0].text for call in calls}
    # Either of two names may be the misspelt one; these exist.
    known = KNOWN | {name for (name,) in vocabulary("ros1_packages").values()}
    for call in calls:
        name = call.words[0].text
        near = nearest(name, sorted(needed & known - found), _NAME_LIKENESS)
        if near is None or name in needed or not _is_one_slip(name, near):
            continue
        required = "REQUIRED" in (word.text for word in call.words)
        if not required or not call.certain:
            continue
        place = cmake.place(call.words[0].line)
        yield Problem.at(
            place,
            "warning",
            "package-dependency",
            f"CMake is to find {name}, but package.xml depends on {near}: colcon build "
            f"stops where there is no {name}",
            write(place, name, near),
        )


def _is_one_slip(one: str, other: str) -> bool:
    """Tell whether two names differ in one letter, or in the order of their letters.

    There is nav_msgs and nav2_msgs: a digit is no slip.
    """
    letters, wanted = Counter(one), Counter(other)
    more, less = [*(letters - wanted).elements()], [*(wanted - letters).elements()]
    return max(len(more), len(less)) < 2 and all(c.isalpha() for c in more + less)
