"""The report of the xacro child process: the expanded model, or the failure."""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from sambot_viz.errors import Place, Problem
from sambot_viz.robot.packages.package_index import Lookup
from sambot_viz.robot.slips.needs_xacro import missing_prefix
from sambot_viz.robot.urdf.urdf_words import URDF
from sambot_viz.robot.xml.decode import XmlFault
from sambot_viz.robot.xml.element import Element

if TYPE_CHECKING:
    from sambot_viz.robot.xacro.child.exchange import (
        ChildAnswer,
        ExpandedAnswer,
        FailureAnswer,
    )

_NAME = re.compile(r"[^\W\d][\w.\-]*(?::[^\W\d][\w.\-]*)*")
_BLANKS = re.compile(r"[\t\r\n]")
_FORBIDDEN = re.compile("[\x00-\x08\x0b\x0c\x0e-\x1f\ud800-\udfff\ufffe\uffff]")


class Definition(NamedTuple):
    """A macro, property or argument that was defined before xacro failed.

    Attributes:
        kind: "macro", "property" or "arg".
        name: its name without the prefix ``xacro:``.
        file: the file that defines it, as the user would write it.
        line: line of the defining element, from 1.
        params: the parameter text of a macro, else empty.
    """

    kind: str
    name: str
    file: str
    line: int
    params: str = ""


class XacroCall(NamedTuple):
    """One macro call on the way to an element: the macro, and the place of the call."""

    macro: str
    file: str
    line: int


class XacroFailure(NamedTuple):
    """The cause of a failed expansion, as xacro and the child process report it.

    Attributes:
        kind: class name of the underlying exception ("NameError", "SyntaxError",
            "ZeroDivisionError", "XacroException", "ArgException" for an argument
            without a value, "PackageNotFoundError", "FileNotFoundError",
            "RecursionError", "MemoryError", …), or a kind of this package: "Timeout",
            "OutputLimit", "Refused" (the untrusted mode forbids it), "NotXml" (the
            output cannot be written as XML), "Crash".
        text: the underlying exception's own text, without location lines.
        file: the file being processed when it failed.
        line: line of the element being processed in `file`, from 1, or None. Inside
            a macro that is the line in the macro's body.
        column: its column, from 1, or None.
        expressions: the nested ``${…}`` texts, innermost first.
        element: tag of the element being processed ("xacro:wheell"), or None.
        macros: macros being expanded, innermost first, as (name, file of the macro).
        calls: the same chain as places of the calls, innermost first.
        includes: files being read, innermost first; the last is the main file.
        missing_package: the failed look-up of ``$(find name)``, or None.
        definitions: what was defined so far, for near names.
        files: the files that were read or looked for, beside the model.
    """

    kind: str
    text: str
    file: str
    line: int | None = None
    column: int | None = None
    expressions: tuple[str, ...] = ()
    element: str | None = None
    macros: tuple[tuple[str, str], ...] = ()
    calls: tuple[XacroCall, ...] = ()
    includes: tuple[str, ...] = ()
    missing_package: Lookup | None = None
    definitions: tuple[Definition, ...] = ()
    files: tuple[str, ...] = ()


class ExpansionError(Exception):
    """The expansion failed; `failure` has the cause."""

    def __init__(self, failure: XacroFailure) -> None:
        super().__init__(failure.text)
        self.failure = failure


class ExpansionXmlError(Exception):
    """A file that xacro reads is not XML: `file`, and the `fault` in it.

    `files` lists the files beside the model that xacro has read or looked for.
    """

    def __init__(self, file: str, fault: XmlFault, files: tuple[str, ...] = ()) -> None:
        super().__init__(str(fault))
        self.file = file
        self.fault = fault
        self.files = files


class ExpandedModel(NamedTuple):
    """A model after xacro.

    Attributes:
        text: the URDF as the xacro command prints it.
        root: the same as a tree; every element has the place where the user wrote it.
        files: every file that was read, the model first.
        problems: xacro's warnings.
        macros: the macros that it defines.
    """

    text: str
    root: Element
    files: tuple[Path, ...]
    problems: tuple[Problem, ...]
    macros: frozenset[str] = frozenset()


def read_result(answer: ChildAnswer, file: str) -> ExpandedModel:
    """Decode the answer of the child process.

    Args:
        answer: the decoded JSON.
        file: the model as the user wrote it.

    Raises:
        ExpansionError: xacro failed, or its output is not XML.
        ExpansionXmlError: the model or an included file is not XML.
    """
    if answer["failure"] is not None:
        raise ExpansionError(_failure(answer["failure"]))
    if answer["not_xml"] is not None:
        found = answer["not_xml"]
        fault = XmlFault(
            found["message"],
            found["line"],
            found["column"],
            found["text"],
            found["code"],
        )
        raise ExpansionXmlError(found["file"], fault, tuple(found["files"]))
    if answer["expanded"] is None:
        raise ExpansionError(XacroFailure("Crash", "an empty answer", file))
    expanded = answer["expanded"]
    problems = [_warning(*entry) for entry in expanded["warnings"]]
    problems += [
        missing_prefix(tag, is_macro, Place(place, line, column))
        for tag, is_macro, place, line, column in expanded["unprefixed"]
        if tag not in URDF.children(URDF.root)
    ]
    root, wrong_name = _tree(expanded)
    if wrong_name or _FORBIDDEN.search(expanded["xml"]):
        raise ExpansionError(_not_xml(root, file))
    files = tuple(map(Path, expanded["files"]))
    return ExpandedModel(
        expanded["xml"],
        root,
        files,
        tuple(dict.fromkeys(problems)),
        frozenset(expanded["macros"]),
    )


def _tree(expanded: ExpandedAnswer) -> tuple[Element, bool]:
    """Return the elements, and whether XML forbids one of their names."""
    top = Element("", {}, Place("", 0))
    names: set[str] = set()
    waiting = [(top, 1)]
    files = expanded["names"]
    for node, place in zip(expanded["nodes"], expanded["places"], strict=True):
        tag, attributes, text, count = node
        file, line, column, call_file, call_line = place
        while len(waiting[-1][0].children) == waiting[-1][1]:
            waiting.pop()
        parent = waiting[-1][0]
        element = Element(tag, attributes, Place(files[file], line, column), text=text)
        element.parent = None if parent is top else parent
        parent.children.append(element)
        if call_file >= 0:
            element.call = Place(files[call_file], call_line)
        names.add(tag)
        names.update(attributes)
        for name, value in attributes.items():
            if _BLANKS.search(value):
                attributes[name] = _BLANKS.sub(" ", value)
        if count:
            waiting.append((element, count))
    return top.children[0], not all(_NAME.fullmatch(name) for name in names)


def _not_xml(root: Element, file: str) -> XacroFailure:
    """Return the failure for a name or a character that XML forbids, with its place."""
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


def _failure(data: FailureAnswer) -> XacroFailure:
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
