"""A strict XML reader that records the place of every element.

It is expat with places. Names keep their prefix as text (``xacro:macro``), because
neither xacro nor urdfdom looks at namespaces.
"""

from __future__ import annotations

import re
from xml.parsers import expat

from sambot_viz.errors import Place
from sambot_viz.robot.xml.decode import XmlFault
from sambot_viz.robot.xml.element import Element

_ATTRIBUTE = re.compile(rb"""\s([^\s=<>"'/]+)\s*=\s*(?:"([^"]*)"|'([^']*)')""")
_EXTERNAL = "external entities and external document types are not read"


def parse_xml(text: str, file: str) -> Element:
    """Read a document strictly.

    Args:
        text: the document; a declared encoding in it is ignored.
        file: the name for places, as the user wrote it.

    Raises:
        XmlFault: it is not well-formed, or it refers to something outside itself.
    """
    return _TreeBuilder(text, file).build()


class _TreeBuilder:
    def __init__(self, text: str, file: str) -> None:
        self._text = text
        self._data = text.encode("utf-8", "surrogatepass")
        self._file = file
        self._stack: list[Element] = []
        self._pieces: list[list[str]] = []
        self._root: Element | None = None
        parser = expat.ParserCreate("utf-8")
        parser.buffer_text = True
        parser.StartElementHandler = self._start
        parser.EndElementHandler = self._end
        parser.CharacterDataHandler = self._characters
        parser.StartDoctypeDeclHandler = self._doctype
        parser.EntityDeclHandler = self._entity
        self._parser = parser

    def build(self) -> Element:
        try:
            self._parser.Parse(self._data, True)
        except expat.ExpatError as error:
            raise XmlFault(
                expat.ErrorString(error.code) or str(error),
                error.lineno,
                error.offset + 1,
                self._text,
                error.code,
            ) from None
        if self._root is None:
            raise self._fault("no element found")
        return self._root

    def _start(self, tag: str, attributes: dict[str, str]) -> None:
        line = self._parser.CurrentLineNumber
        place = Place(self._file, line, self._parser.CurrentColumnNumber + 1)
        element = Element(tag, attributes, place)
        self._look_inside_tag(element, line)
        if self._stack:
            element.parent = self._stack[-1]
            self._stack[-1].children.append(element)
        else:
            self._root = element
        self._stack.append(element)
        self._pieces.append([])

    def _look_inside_tag(self, element: Element, line: int) -> None:
        start = self._parser.CurrentByteIndex
        end = self._data.find(b">", start)
        tag = self._data[start:end]
        if b"\n" not in tag and b"\t" not in tag:
            return
        lines: dict[str, int] = {}
        odd: set[str] = set()
        for match in _ATTRIBUTE.finditer(tag):
            name = match[1].decode("utf-8", "replace")
            lines[name] = line + tag.count(b"\n", 0, match.start(1))
            value = match[2] if match[2] is not None else match[3]
            if any(blank in value for blank in (b"\n", b"\t", b"\r")):
                odd.add(name)
        element.attribute_lines = lines
        element.odd_blanks = frozenset(odd)

    def _end(self, _tag: str) -> None:
        element = self._stack.pop()
        element.text = "".join(self._pieces.pop())

    def _characters(self, data: str) -> None:
        self._pieces[-1].append(data)

    def _doctype(
        self, _name: str, system: str | None, public: str | None, _internal: bool
    ) -> None:
        if system is not None or public is not None:
            raise self._fault(_EXTERNAL)

    def _entity(
        self,
        _name: str,
        _is_parameter: bool,
        value: str | None,
        _base: str | None,
        _system: str | None,
        _public: str | None,
        _notation: str | None,
    ) -> None:
        if value is None:
            raise self._fault(_EXTERNAL)

    def _fault(self, message: str) -> XmlFault:
        return XmlFault(
            message,
            self._parser.CurrentLineNumber,
            self._parser.CurrentColumnNumber + 1,
            self._text,
        )
