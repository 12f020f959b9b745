"""A strict XML reader that knows where every element stands.

It is expat with places. Names keep their prefix as text (``xacro:macro``), because
neither xacro nor urdfdom looks at namespaces (spec/ros-nodes.md §5.2, §6.7).
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from xml.parsers import expat

from sambot_viz.errors import Place
from sambot_viz.robot.xml.decode import XmlFault

_ATTRIBUTE = re.compile(rb"""\s([^\s=<>"'/]+)\s*=\s*(?:"([^"]*)"|'([^']*)')""")
_EXTERNAL = "external entities and external document types are not read"


@dataclass(slots=True, eq=False)
class Element:
    """One element of the tree.

    Attributes:
        tag: name as written, with its prefix.
        attributes: name → value; tabs and line breaks are blanks, as XML says.
        place: where the start tag stands in the file that the user wrote.
        children: child elements in document order.
        text: the character data directly inside, comments left out.
        end_line: line of the end tag.
        parent: the enclosing element, None for the root.
        attribute_lines: line of an attribute, where it is not the tag's line.
        odd_blanks: attributes whose value holds a tab or a line break in the file;
            urdfdom does not take these for blanks (spec/ros-nodes.md §6.2).
        call: line of the outermost macro call it came through, or None.
        call_file: the file of that line.
    """

    tag: str
    attributes: dict[str, str]
    place: Place
    children: list[Element] = field(default_factory=lambda: [])
    text: str = ""
    end_line: int = 0
    parent: Element | None = None
    attribute_lines: Mapping[str, int] = field(default_factory=dict[str, int])
    odd_blanks: frozenset[str] = frozenset()
    call: int | None = None
    call_file: str | None = None

    def find(self, tag: str) -> Element | None:
        """The first child with that tag, or None."""
        return next((child for child in self.children if child.tag == tag), None)

    def find_all(self, tag: str) -> list[Element]:
        """All children with that tag, in document order."""
        return [child for child in self.children if child.tag == tag]

    def get(self, name: str) -> str | None:
        """The attribute's value, or None when it is absent."""
        return self.attributes.get(name)

    def iter(self) -> Iterator[Element]:
        """This element and all below it, in document order."""
        stack: list[Element] = [self]
        while stack:
            element = stack.pop()
            yield element
            stack.extend(reversed(element.children))

    def line_of(self, attribute: str | None) -> int:
        """Line of an attribute, or of the tag when that is all that is known."""
        if attribute is None:
            return self.place.line
        return self.attribute_lines.get(attribute, self.place.line)


@dataclass(frozen=True, slots=True)
class MarkOrigin:
    """Where an element of an expanded document was written.

    Attributes:
        place: the element in the user's file.
        call_file: file of the outermost macro call it came through, or None.
        call_line: line of that call, or None.
    """

    place: Place
    call_file: str | None = None
    call_line: int | None = None


def parse_xml(
    text: str, file: str, origins: Sequence[MarkOrigin | None] | None = None
) -> Element:
    """Read a document strictly.

    Args:
        text: the document; a declared encoding in it is ignored.
        file: the name for places, as the user wrote it.
        origins: for an expanded document the origin of each element in document
            order; None entries take the place in `text`.

    Raises:
        XmlFault: it is not well-formed, or it refers to something outside itself.
    """
    return _Reader(text, file, origins).read()


class _Reader:
    def __init__(
        self, text: str, file: str, origins: Sequence[MarkOrigin | None] | None
    ) -> None:
        self._text = text
        self._data = text.encode("utf-8", "surrogatepass")
        self._file = file
        self._origins = iter(origins or ())
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

    def read(self) -> Element:
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
        origin = next(self._origins, None)
        if origin is not None:
            element.place = origin.place
            element.call, element.call_file = origin.call_line, origin.call_file
        else:
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
        element.end_line = self._parser.CurrentLineNumber

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
