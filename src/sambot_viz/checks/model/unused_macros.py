"""Report macros without a call."""

from __future__ import annotations

import re
from collections.abc import Iterator

from sambot_viz.checks.rule import Subject
from sambot_viz.errors import Problem, RobotError
from sambot_viz.robot.model_source import read_source
from sambot_viz.robot.parts import Link
from sambot_viz.robot.xml.decode import XmlFault
from sambot_viz.robot.xml.element import Element, parse_xml

_EXPRESSION = re.compile(r"\$\{[^}]*\}")


def unused_macros(subject: Subject) -> Iterator[Problem]:
    """Report macros without a call, and the elements missing because of that.

    Only the main file counts: a library may have more macros than a model needs.
    """
    massless = bool(links_without_mass(subject))
    for macro in _never_called(subject):
        name = macro.get("name")
        if massless and _makes_inertia(macro):
            # The finding of this macro includes the links without mass.
            continue
        yield Problem.at(
            macro.place,
            "warning",
            "unused-macro",
            f"the macro {name} is defined but never called{_missing(macro)}",
            f"call it with <xacro:{name} …/>, or delete it",
        )


def links_without_mass(subject: Subject) -> list[Link]:
    """Return the links below the root with a collision shape and no mass.

    Gazebo merges links that fixed joints connect into one body.
    """
    robot = subject.robot
    body = {name: name for name in robot.links}
    fixed = {j.child: j.parent for j in robot.joints.values() if j.type == "fixed"}
    for name in body:
        seen = {name}
        while (body[name] in fixed) and fixed[body[name]] not in seen:
            body[name] = fixed[body[name]]
            seen.add(body[name])
    heavy = {body[link.name] for link in robot.links.values() if link.inertial}
    return [
        link
        for link in robot.links.values()
        if link.collisions and body[link.name] not in heavy and link.name != robot.root
    ]


def unused_inertia(subject: Subject) -> Element | None:
    """Return a macro without a call that makes only an <inertial>."""
    return next(filter(_makes_inertia, _never_called(subject)), None)


def _makes_inertia(macro: Element) -> bool:
    return [child.tag for child in macro.children] == ["inertial"]


def _missing(macro: Element) -> str:
    """Name what a robot lacks: ", so its links and joints are missing"."""
    parts = {element.tag for element in macro.iter()}
    if not parts.isdisjoint({"link", "joint"}):
        return ", so its links and joints are missing"
    first = next((c.tag for c in macro.children if ":" not in c.tag), None)
    return f", so its <{first}> is missing" if first else ""


def _never_called(subject: Subject) -> Iterator[Element]:
    documents = [d for d in map(_document, subject.files) if d is not None]
    if not documents:
        return
    macros = [e.get("name") or "" for d in documents for e in _macros(d)]
    called = {name for d in documents for name in _called(d, macros)}
    for macro in _macros(documents[0]):
        name = macro.get("name") or ""
        if name and name.removeprefix("xacro:") not in called:
            yield macro


def _document(file: str) -> Element | None:
    """Return the tree of a xacro file before its expansion."""
    try:
        text = read_source(file).text
        return parse_xml(text, file) if "xacro" in text else None
    except (RobotError, XmlFault):
        return None


def _macros(document: Element) -> list[Element]:
    return [e for e in document.iter() if e.tag == "xacro:macro"]


def _called(document: Element, macros: list[str]) -> Iterator[str]:
    """Yield names of called macros, whatever the namespace of the call."""
    for element in document.iter():
        prefix, _, name = element.tag.rpartition(":")
        if element.tag == "xacro:call":
            # The name may contain expressions, which can become any text.
            parts = map(re.escape, _EXPRESSION.split(element.get("macro") or ""))
            pattern = re.compile(".*".join(parts))
            yield from (macro for macro in macros if pattern.fullmatch(macro))
        elif prefix in ("", "xacro"):
            # The xacro reader reports a call without its prefix.
            yield name.rpartition(".")[2]
