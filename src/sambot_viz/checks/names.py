"""Names that are easily confused or hard to type, and macros that nobody calls."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator

from sambot_viz.checks.rule import Subject
from sambot_viz.errors import Problem, RobotError
from sambot_viz.robot.model_source import read_source
from sambot_viz.robot.parts import Joint, Link
from sambot_viz.robot.xml.decode import XmlFault
from sambot_viz.robot.xml.element import Element
from sambot_viz.robot.xml.parse import parse_xml

_EXPRESSION = re.compile(r"\$\{[^}]*\}")


def names_that_differ_in_case(subject: Subject) -> Iterator[Problem]:
    """Report two links, or two joints, such as "arm" and "Arm"."""
    yield from _case_among("link", subject.robot.links.values())
    yield from _case_among("joint", subject.robot.joints.values())


def _case_among(kind: str, named: Iterable[Link | Joint]) -> Iterator[Problem]:
    seen: dict[str, Link | Joint] = {}
    for item in named:
        other = seen.setdefault(item.name.lower(), item)
        if other is item:
            continue
        where = f" (line {other.place.line})" if other.place else ""
        yield Problem.at(
            item.place,
            "warning",
            "names-differ-in-case",
            f"the {kind} names {other.name}{where} and {item.name} differ only "
            "in capital letters; ROS treats them as two different names",
            "rename one of them, or use one name if the other is a typing error",
        )


def names_with_spaces(subject: Subject) -> Iterator[Problem]:
    """Report a link or joint such as "left wheel"."""
    robot = subject.robot
    for item in (*robot.links.values(), *robot.joints.values()):
        if any(c.isspace() for c in item.name):
            kind = "link" if isinstance(item, Link) else "joint"
            yield Problem.at(
                item.place,
                "info",
                "name-with-blank",
                f'the {kind} name "{item.name}" contains a space: it works, but '
                "commands and launch files split it in two",
                f'write "{"_".join(item.name.split())}"',
            )


def unused_macros(subject: Subject) -> Iterator[Problem]:
    """Report macros that are never called, whose links and joints are missing.

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
