"""Report xacro elements without their prefix, which xacro copies to its output."""

from __future__ import annotations

from pathlib import Path

from sambot_viz.errors import Place, Problem
from sambot_viz.robot.xml.element import Element

_PARTS = ("include", "macro")
"""Without these a part of the robot is missing; other elements are harmless."""


def missing_prefix(tag: str, is_macro: bool, place: Place) -> Problem:
    """The warning for one element.

    Args:
        tag: its name.
        is_macro: whether a macro of that name is defined.
        place: where it is.
    """
    what = "a macro call" if is_macro else "a xacro instruction"
    return Problem(
        "warning",
        "xacro-prefix-missing",
        f"<{tag}> looks like {what} without its prefix: xacro copies it to the "
        "URDF, where ROS ignores it",
        f"write <xacro:{tag}>",
        place.file,
        place.line,
        place.column,
    )


def missing_prefixes(document: Element) -> list[Problem]:
    """The warnings for a document without any prefix, on which xacro is not run."""
    return [
        missing_prefix(child.tag, False, child.place)
        for child in document.children
        if child.tag in _PARTS
    ]


def undeclared_prefix(document: Element, path: Path | None) -> Problem | None:
    """The warning for a .urdf file that uses ``xacro:`` without declaring it.

    xacro refuses such a file, but the nodes of ROS read a .urdf file without xacro, and
    they ignore elements they do not know.

    Returns:
        None when the prefix is declared or not used, or when the file is meant for
        xacro by its name: then it is an error.
    """
    if path is None or path.suffix.lower() != ".urdf":
        return None
    first: Element | None = None
    for element in document.iter():
        if "xmlns:xacro" in element.attributes:
            return None
        names = (element.tag, *element.attributes)
        if first is None and any(name.startswith("xacro:") for name in names):
            first = element
    if first is None:
        return None
    place = first.place
    return Problem(
        "warning",
        "xacro-prefix-undeclared",
        f"the prefix xacro: of <{first.tag}> is not declared, so this .urdf file is "
        "not a xacro file: ROS ignores these elements, and what they would create "
        "is missing",
        f'add xmlns:xacro="http://www.ros.org/wiki/xacro" to <{document.tag}> on line '
        f"{document.place.line}, and call the file .urdf.xacro",
        place.file,
        place.line,
        place.column,
    )
