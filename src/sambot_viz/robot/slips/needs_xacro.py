"""Whether xacro has to expand a document, and what is odd about its use of xacro.

The content decides, not the ending of the file name.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from pathlib import Path

from sambot_viz.edits import exchange_attributes, rename_element
from sambot_viz.errors import Fix, Place, Problem
from sambot_viz.robot.slips.vocabulary import meant
from sambot_viz.robot.xml.element import Element

OWN_TAGS = (
    "arg attribute call element if include insert_block macro property unless".split()
)
"""The elements of xacro."""
_PREFIX = "xacro:"
_PARTS = ("include", "macro")
"""Without these a part of the robot is missing; other elements are harmless."""
_SUBSTITUTION = re.compile(r"\$[{(]")


def first_own(document: Element) -> Element | None:
    """Find the first of xacro's own elements, or with one of its attributes."""
    return next(filter(_is_own, document.iter()), None)


def first_substitution(document: Element) -> Element | None:
    """Find the first element with an expression where the format needs a value.

    ``$(find …)`` in a Gazebo plugin or in a comment does not count: xacro could fail
    there although ROS does not use the value. In SDF, which launch files always give to
    xacro, every substitution counts.
    """
    if document.tag == "sdf":
        every = document.iter()
        return next(
            (e for e in every if _has_substitution((e.text, *e.attributes.values()))),
            None,
        )
    robot = document if document.tag == "robot" else document.find("robot")
    parts = robot.children if robot is not None else []
    return next(
        (
            element
            for part in parts
            if part.tag in ("link", "joint", "material")
            for element in part.iter()
            if _has_substitution(element.attributes.values())
        ),
        None,
    )


def left_over(document: Element, path: Path | None) -> list[Problem]:
    """Make the warnings for macro calls that were left in a finished URDF.

    xacro refuses such a file, but the nodes of ROS read it without xacro, and ignore
    what they do not know.

    Args:
        document: the root element.
        path: the file; None for a text.

    Returns:
        One for each call; none when something else in the document needs xacro, when a
        call may be a misspelt word of xacro, or when the file's name is xacro's.
    """
    if path is not None and path.suffix.lower() != ".urdf":
        return []
    own = [element for element in document.iter() if _is_own(element)]
    calls = [e for e in own if e.tag.startswith(_PREFIX) and not _may_be_own_tag(e.tag)]
    if len(calls) < len(own) or first_substitution(document) is not None:
        return []
    return [
        Problem.at(
            call.place,
            "warning",
            "xacro-left-over",
            f"<{call.tag}> is left over from xacro: this file neither defines nor "
            "includes the macro, so ROS ignores the element; xacro refuses the file",
            "delete it, or include the file of the macro and call this one .urdf.xacro",
        )
        for call in calls
    ]


def _may_be_own_tag(tag: str) -> bool:
    """Return whether a tag is a word of xacro, or was meant to be one."""
    return meant(tag.removeprefix(_PREFIX), OWN_TAGS) is not None


def _has_substitution(values: Iterable[str]) -> bool:
    for value in values:
        if "$" in value and _SUBSTITUTION.search(value):
            return True
    return False


def _is_own(element: Element) -> bool:
    if element.tag.startswith(_PREFIX):
        return True
    for name in element.attributes:
        if name.startswith(_PREFIX):
            return True
    return False


def only_names_files(document: Element) -> bool:
    """Return whether all substitutions of a document are in file names.

    Then it is a plain URDF for urdfdom, which does not open these files.
    """
    return document.tag != "sdf" and not any(
        _is_own(element)
        or any(
            name != "filename" and _SUBSTITUTION.search(value)
            for name, value in element.attributes.items()
        )
        for element in document.iter()
    )


def missing_prefix(tag: str, is_macro: bool, place: Place) -> Problem:
    """Make the warning for one element without its prefix.

    Args:
        tag: its name.
        is_macro: whether a macro of that name is defined.
        place: where it is.
    """
    what = "a macro call" if is_macro else "a xacro instruction"
    return Problem.at(
        place,
        "warning",
        "xacro-prefix-missing",
        f"<{tag}> looks like {what} without its prefix: xacro copies it to the "
        "URDF, where ROS ignores it",
        rename_element(place, tag, f"xacro:{tag}", f"write <xacro:{tag}>"),
    )


def exchanged_name(document: Element) -> list[Problem]:
    """Make the warning for a <robot> whose name is the address of xacro."""
    name, address = document.get("name") or "", document.get("xmlns:xacro") or ""
    if "://" not in name or "xacro" not in name or "://" in address:
        return []
    if "xmlns:xacro" not in document.attributes:
        return []
    hint = f'write name="{address}" and xmlns:xacro="{name}"'
    return [
        Problem.at(
            document.place,
            "warning",
            "robot-name-exchanged",
            f"the values of name and xmlns:xacro are exchanged: the <{document.tag}> "
            f"is called {name}",
            Fix(hint, exchange_attributes(document.place, "name", "xmlns:xacro")),
        )
    ]


def missing_prefixes(document: Element) -> list[Problem]:
    """Make the warnings for a document without any prefix, which xacro does not see."""
    return [
        missing_prefix(child.tag, False, child.place)
        for child in document.children
        if child.tag in _PARTS and document.tag != "sdf"
    ]


def refused_without_prefix(document: Element, undeclared: Problem) -> Problem:
    """Make the error for a file that has expressions, and that nothing replaces.

    Args:
        document: the root element.
        undeclared: the warning of `undeclared_prefix`.
    """
    return Problem.at(
        document.place,
        "error",
        "xml-prefix-undeclared",
        f"the prefix xacro: is used (first on line {undeclared.line}) but not declared "
        f"on <{document.tag}>: xacro refuses the file, and without xacro ROS does not "
        "know what ${…} is",
        f'add xmlns:xacro="http://www.ros.org/wiki/xacro" to <{document.tag}> on line '
        f"{document.place.line}",
    )


def undeclared_prefix(
    document: Element, first: Element | None, path: Path | None
) -> Problem | None:
    """Make the warning for a .urdf file that uses ``xacro:`` without declaring it.

    xacro refuses such a file, but the nodes of ROS read a .urdf file without xacro, and
    they ignore elements they do not know.

    Args:
        document: the root element.
        first: the first element that is xacro's own, or None.
        path: the file; None for a text.

    Returns:
        None when the prefix is declared or not used, or when the file is meant for
        xacro by its name: then it is an error.
    """
    if first is None or path is None or path.suffix.lower() != ".urdf":
        return None
    if any("xmlns:xacro" in element.attributes for element in document.iter()):
        return None
    return Problem.at(
        first.place,
        "warning",
        "xacro-prefix-undeclared",
        f"the prefix xacro: of <{first.tag}> is not declared, so this .urdf file is "
        "not a xacro file: ROS ignores these elements, and what they would create "
        "is missing",
        f'add xmlns:xacro="http://www.ros.org/wiki/xacro" to <{document.tag}> on line '
        f"{document.place.line}",
    )
