"""Report words of package.xml that colcon does not know."""

from __future__ import annotations

import re
from collections.abc import Iterator

from sambot_viz.checks.around.surroundings import Surroundings
from sambot_viz.checks.around.words import WordKind, WrittenWord, misspelt
from sambot_viz.edits import rename_element, write, write_attribute, write_between
from sambot_viz.errors import Fix, Place, Problem
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


def unknown_elements(around: Surroundings) -> Iterator[Problem]:
    """Report elements of package.xml that are not in its format."""
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
    if version is not None and not _VERSION.fullmatch(said):
        place, started = _place(version, around), _STARTED.fullmatch(said)
        right = f"{started[1]}.{started[2] or 0}.0" if started else "0.0.0"
        hint = f"write <version>{right}</version>"
        yield _stops(
            place,
            f"the version {said} is not three numbers with dots between them"
            if said
            else "<version> is empty",
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
