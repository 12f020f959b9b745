"""xacro's words without their prefix, which xacro passes through in silence."""

from __future__ import annotations

from sambot_viz.errors import Problem
from sambot_viz.robot.model import Place
from sambot_viz.robot.xml import Element

_WORDS = ("include", "property", "macro", "arg")


def missing_prefix(tag: str, is_macro: bool, place: Place) -> Problem:
    """The warning for one such element.

    Args:
        tag: its name.
        is_macro: whether a macro of that name is defined.
        place: where it stands.
    """
    what = "a macro call" if is_macro else "a xacro instruction"
    return Problem(
        "warning",
        "xacro-prefix-missing",
        f"<{tag}> looks like {what} without its prefix: xacro passes it through and "
        "nothing comes of it",
        f"write <xacro:{tag}>",
        place.file,
        place.line,
        place.column,
    )


def missing_prefixes(document: Element) -> list[Problem]:
    """The same for a document that xacro is not run on, for want of a prefix."""
    return [
        missing_prefix(child.tag, False, child.place)
        for child in document.children
        if child.tag in _WORDS
    ]
