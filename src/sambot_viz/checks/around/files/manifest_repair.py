"""Correct the line of package.xml that keeps it from being XML.

The module tries each corrected line, and proposes one only if the file then is a
package.xml.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import NamedTuple

from sambot_viz.checks.around.files.fault import Fault
from sambot_viz.checks.vocabulary import vocabulary
from sambot_viz.errors import nearest
from sambot_viz.robot.xml.decode import XmlFault
from sambot_viz.robot.xml.element import Element, parse_xml

_OPENED_TWICE = re.compile(r"<([\w.]+)([^<>]*)>([^<>]*)<\1>")
_CLOSED_AS_OTHER = re.compile(r"<([\w.]+)([^<>]*)>([^<>]*)</([\w.]+)>")
_NOT_CLOSED = re.compile(r"<([\w.]+)([^<>]*[^<>/]|)>([^<>]+)$")
_WITHOUT_END = re.compile(r"</([\w.]+)\s*$")
_WITHOUT_BEGIN = re.compile(r"^(\s*)([\w.]+)(\s[^<>]*)?>([^<>]*</\2>)")
_TAG = re.compile(r"<(/?)([\w.]+)([^<>]*)>\s*$")
_BARE_VALUE = re.compile(r"(\s\w+=)(?:([^\s\"'<>]+)(?=[\s>])|\"([^\"<>]*)(?=>))")
_RUN_TOGETHER = re.compile(r"<([\w.]+)</([\w.]+)>")
_ROOT = "package"
_OPEN = '<package format="3">'
_LIKENESS = 0.7
_SMALLEST = (
    '<package format="3"><name>{}</name><version>0.0.0</version>'
    '<description>A robot</description><maintainer email="me@example.org">me'
    "</maintainer><license>MIT</license><buildtool_depend>ament_cmake"
    "</buildtool_depend><export><build_type>ament_cmake</build_type></export></package>"
)


class _Repair(NamedTuple):
    """A corrected line, the fault of the old one, and what to write."""

    better: str
    cause: str
    hint: str


def manifest_fault(text: str, name: str) -> Fault | None:
    """Return why a text is not a package.xml, or None for one that is XML.

    Args:
        text: of the file.
        name: of the package, for an empty file.
    """
    if not text.strip():
        return Fault(1, "package.xml is empty", f"write {_SMALLEST.format(name)}")
    lines = text.splitlines()
    for n, line in enumerate(lines):
        for better, cause, hint in _repairs(line, n, lines):
            root = _parsed("\n".join([*lines[:n], better, *lines[n + 1 :]]))
            if isinstance(root, Element) and root.tag == _ROOT:
                return Fault(n + 1, f"this file is not XML: {cause}", hint, better)
    fault = _parsed(text)
    if isinstance(fault, Element):
        return None
    return Fault(
        fault.line,
        f"this file is not XML ({fault.message})",
        "correct this line or the one above it: each <tag> needs its </tag>",
    )


def _parsed(text: str) -> Element | XmlFault:
    try:
        return parse_xml(text, "package.xml")
    except XmlFault as fault:
        return fault


def _repairs(line: str, n: int, lines: list[str]) -> Iterator[_Repair]:
    yield from _of_element(line)
    yield from _of_container(line, n, lines)
    if match := _WITHOUT_END.search(line):
        whole = f"</{match[1]}>"
        yield _Repair(f"{line.rstrip()}>", f"</{match[1]} has no >", f"write {whole}")
    if match := _WITHOUT_BEGIN.match(line):
        cause, hint = f"{match[2]} has no <", f"write <{match[2]}>"
        yield _Repair(f"{match[1]}<{line.lstrip()}", cause, hint)
    if match := _BARE_VALUE.search(line):
        quoted = f'{match[1]}"{match[2] or match[3]}"'
        cause = f"the value of {match[1].strip(' =')} is not in quotes"
        better = line.replace(match[0], quoted)
        yield _Repair(better, cause, f"write {quoted.strip()}")
    if "&" in line:
        better = line.replace("&", "&amp;")
        yield _Repair(better, "a bare & is not allowed", "write &amp;")


def _of_element(line: str) -> Iterator[_Repair]:
    """Yield corrections of a line with an element that contains only text."""
    if match := _OPENED_TWICE.search(line) or _CLOSED_AS_OTHER.search(line):
        twice = match.re is _OPENED_TWICE
        wrong = "opened twice and not closed" if twice else f"closed by </{match[4]}>"
        name = match[1] if twice or not _is_known(match[4]) else match[4]
        name = match[1] if _is_known(match[1]) else name
        better = f"<{name}{match[2]}>{match[3]}</{name}>"
        cause = f"<{match[1]}> is {wrong}"
        yield _Repair(line.replace(match[0], better), cause, f"write {better}")
    elif (match := _RUN_TOGETHER.search(line)) and match[1].startswith(match[2]):
        better = f"<{match[2]}>{match[1].removeprefix(match[2])}</{match[2]}>"
        cause = f"<{match[2]} has no >"
        yield _Repair(line.replace(match[0], better), cause, f"write {better}")
    elif match := _NOT_CLOSED.search(line):
        better = f"{match[0].rstrip()}</{match[1]}>"
        cause = f"<{match[1]}> is not closed"
        yield _Repair(line.replace(match[0], better), cause, f"write {better}")


def _is_known(tag: str) -> bool:
    return tag in (*vocabulary("package_xml")["3"], "build_type")


def _of_container(line: str, n: int, lines: list[str]) -> Iterator[_Repair]:
    """Yield corrections of a line beside a tag of <package> or <export>."""
    blanks = line[: len(line) - len(line.lstrip())]
    if (match := _TAG.search(line)) and match[2] != _ROOT:
        near = nearest(match[2].lower(), [_ROOT, "export"], _LIKENESS)
        if near is not None and near != match[2]:
            right = f"<{match[1]}{near}{match[3]}>"
            cause = f"<{match[1]}{match[2]}> is not a tag of package.xml"
            yield _Repair(line.replace(match[0], right), cause, f"write {right}")
    if line.strip().startswith(("<name>", "<build_type>")):
        tag = _OPEN if "<name>" in line else "<export>"
        outer = blanks[: len(blanks) - 2] if len(blanks) > 1 else blanks
        name = tag.strip("<>").partition(" ")[0]
        cause, hint = f"</{name}> closes nothing", f"add {tag} before this line"
        yield _Repair(f"{outer}{tag}\n{line}", cause, hint)
    if line.strip() == "</package>":
        better = f"{blanks}  </export>\n{line}"
        hint = "add </export> before this line"
        yield _Repair(better, "<export> is not closed", hint)
    if line.strip() and not "".join(lines[n + 1 :]).strip():
        better, hint = f"{line}\n</package>", "add </package> at the end of the file"
        yield _Repair(better, "<package> is not closed", hint)
    if line.strip() == _OPEN.replace("<", "</", 1) or line.strip() == "<package>":
        cause = "<package> is opened again"
        yield _Repair(f"{blanks}</package>", cause, "write </package>")
