"""Macros that the model defines and never calls."""

from __future__ import annotations

import re
from collections.abc import Iterator

from sambot_viz.checks.rule import Subject
from sambot_viz.errors import Problem, RobotError
from sambot_viz.robot.model_source import read_source
from sambot_viz.robot.xml.decode import XmlFault
from sambot_viz.robot.xml.element import Element
from sambot_viz.robot.xml.parse import parse_xml

_EXPRESSION = re.compile(r"\$\{[^}]*\}")


def unused_macros(subject: Subject) -> Iterator[Problem]:
    """Xacro drops a macro that is never called, with its links and joints.

    Only the main file is checked: a library may have more macros than a model needs.
    """
    documents = [d for d in map(_document, subject.files) if d is not None]
    if not documents:
        return
    macros = [e.get("name") or "" for d in documents for e in _macros(d)]
    called = {name for d in documents for name in _called(d, macros)}
    for macro in _macros(documents[0]):
        name = macro.get("name") or ""
        if name and name.removeprefix("xacro:") not in called:
            yield Problem.at(
                macro.place,
                "warning",
                "unused-macro",
                f"the macro {name} is defined but never called, so its links and "
                "joints are missing",
                f"call it with <xacro:{name} …/>, or delete it",
            )


def _document(file: str) -> Element | None:
    """The tree of a xacro file, before it is expanded."""
    try:
        text = read_source(file).text
        return parse_xml(text, file) if "xacro" in text else None
    except (RobotError, XmlFault):
        return None


def _macros(document: Element) -> list[Element]:
    return [e for e in document.iter() if e.tag == "xacro:macro"]


def _called(document: Element, macros: list[str]) -> Iterator[str]:
    """Names that are called, whatever namespace they are called through."""
    for element in document.iter():
        prefix, _, name = element.tag.rpartition(":")
        if element.tag == "xacro:call":
            # The name may contain expressions, which can become any text.
            parts = map(re.escape, _EXPRESSION.split(element.get("macro") or ""))
            pattern = re.compile(".*".join(parts))
            yield from (macro for macro in macros if pattern.fullmatch(macro))
        elif prefix in ("", "xacro"):
            # A call without its prefix is reported by the xacro reader.
            yield name.rpartition(".")[2]
