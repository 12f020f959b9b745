"""From the answer of the xacro child process to the expanded model, or an error."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from sambot_viz.errors import Place, Problem
from sambot_viz.robot.packages.package_index import Lookup
from sambot_viz.robot.xacro.diagnose.prefix import missing_prefix
from sambot_viz.robot.xacro.result import (
    Definition,
    ExpansionError,
    ExpansionXmlError,
    XacroCall,
    XacroFailure,
)
from sambot_viz.robot.xml.decode import XmlFault
from sambot_viz.robot.xml.element import Element

_NAME = re.compile(r"[^\W\d][\w.\-]*(?::[^\W\d][\w.\-]*)*")
_BLANKS = re.compile(r"[\t\r\n]")
_FORBIDDEN = re.compile("[\x00-\x08\x0b\x0c\x0e-\x1f\ud800-\udfff\ufffe\uffff]")


@dataclass(frozen=True, slots=True)
class ExpandedModel:
    """What xacro made of a model.

    Attributes:
        text: the URDF as the xacro command prints it.
        root: the same as a tree; every element has the place where the user wrote it.
        files: every file that was read, the model first.
        problems: xacro's warnings.
    """

    text: str
    root: Element
    files: tuple[Path, ...]
    problems: tuple[Problem, ...]


def read_answer(answer: Mapping[str, Any], file: str) -> ExpandedModel:
    """Read what the child process sent.

    Args:
        answer: the decoded JSON.
        file: the model as the user wrote it.

    Raises:
        ExpansionError: xacro failed, or its output is not XML.
        ExpansionXmlError: the model or an included file is not XML.
    """
    if "failure" in answer:
        raise ExpansionError(_failure(answer["failure"]))
    if "xml_fault" in answer:
        message, line, column, code = answer["xml_fault"]
        fault = XmlFault(message, line, column, answer["text"], code)
        raise ExpansionXmlError(answer["file"], fault, tuple(answer["files"]))
    problems = [_warning(*entry) for entry in answer["warnings"]]
    problems += [
        missing_prefix(tag, is_macro, Place(*place))
        for tag, is_macro, *place in answer["unprefixed"]
    ]
    names: list[str] = answer["names"]
    root, wrong_name = _tree(answer["nodes"], dict(enumerate(names)))
    if wrong_name or _FORBIDDEN.search(answer["xml"]):
        raise ExpansionError(_not_xml(root, file))
    files = tuple(Path(name) for name in answer["files"])
    return ExpandedModel(answer["xml"], root, files, tuple(dict.fromkeys(problems)))


def _tree(
    nodes: Sequence[Sequence[Any]], files: Mapping[int, str]
) -> tuple[Element, bool]:
    """The elements, and whether one of their names is not allowed in XML.

    Each entry of `nodes` is: tag, attributes, text, number of children, file number,
    line, column, and for an element that came through a macro call the file number
    and line of the outermost call.
    """
    top = Element("", {}, Place("", 0))
    names: set[str] = set()
    waiting = [(top, 1)]
    for tag, attributes, text, count, file, line, column, *call in nodes:
        while len(waiting[-1][0].children) == waiting[-1][1]:
            waiting.pop()
        parent = waiting[-1][0]
        element = Element(tag, attributes, Place(files[file], line, column), text=text)
        element.parent = None if parent is top else parent
        parent.children.append(element)
        if call:
            element.call = Place(files[call[0]], call[1])
        names.add(tag)
        names.update(attributes)
        for name, value in attributes.items():
            if _BLANKS.search(value):
                attributes[name] = _BLANKS.sub(" ", value)
        if count:
            waiting.append((element, count))
    return top.children[0], not all(_NAME.fullmatch(name) for name in names)


def _not_xml(root: Element, file: str) -> XacroFailure:
    """The failure for a name or a character that XML does not allow, with its place."""
    for element in root.iter():
        for name in (element.tag, *element.attributes):
            if not _NAME.fullmatch(name):
                return _failure_at(element, f"the name '{name}'")
        for text in (*element.attributes.values(), element.text):
            found = _FORBIDDEN.search(text)
            if found:
                return _failure_at(element, f"the character U+{ord(found[0]):04X}")
    return XacroFailure("NotXml", "a control character in a comment", file)


def _failure_at(element: Element, text: str) -> XacroFailure:
    place = element.place
    return XacroFailure("NotXml", text, place.file, place.line, place.column)


def _failure(data: Mapping[str, Any]) -> XacroFailure:
    missing = data["missing_package"]
    return XacroFailure(
        kind=data["kind"],
        text=data["text"],
        file=data["file"],
        line=data["line"],
        column=data["column"],
        expressions=tuple(data["expressions"]),
        element=data["element"],
        macros=tuple((name, file) for name, file in data["macros"]),
        calls=tuple(XacroCall(*call) for call in data["calls"]),
        includes=tuple(data["includes"]),
        missing_package=_lookup(*missing) if missing else None,
        definitions=tuple(Definition(*entry) for entry in data["definitions"]),
        files=tuple(data["files"]),
    )


def _lookup(name: str, searched: Sequence[str], known: Sequence[str]) -> Lookup:
    return Lookup(name, None, tuple(searched), tuple(known))


def _warning(
    text: str, file: str, line: int | None = None, column: int | None = None
) -> Problem:
    hint = "xacro goes on, but ros2 launch treats any warning of xacro as a failure"
    return Problem("warning", "xacro-warning", text, hint, file, line, column)
