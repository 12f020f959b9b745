"""An XML document as elements, each with the place where the user wrote it.

The reader is expat with places. Names keep their prefix as text (``xacro:macro``),
because neither xacro nor urdfdom looks at namespaces.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from xml.parsers import expat

from sambot_viz import limits
from sambot_viz.errors import Place
from sambot_viz.robot.xml.decode import XmlFault

_ATTRIBUTE = re.compile(rb"""\s([^\s=<>"'/]+)\s*=\s*(?:"([^"]*)"|'([^']*)')""")
_EXTERNAL = "external entities and external document types are not read"
_AMPLIFIED = "limit on input amplification by entities"
_NOTHING = frozenset[str]()


def parse_xml(text: str, file: str, *, most_elements: int | None = None) -> Element:
    """Read a document strictly.

    Args:
        text: the document; an encoding that it declares is ignored.
        file: the name for places, as the user wrote it.
        most_elements: a document with more is refused; by default that of a model.

    Raises:
        XmlFault: it is not well-formed, it refers to something outside itself, or it
            is far larger or deeper than any robot.
    """
    most = limits.XML_ELEMENTS.value if most_elements is None else most_elements
    return _TreeBuilder(text, file, most).build()


class _TreeBuilder:
    def __init__(self, text: str, file: str, most_elements: int) -> None:
        self._text = text
        self._data = text.encode("utf-8", "surrogatepass")
        self._file = file
        self._stack: list[Element] = []
        self._pieces: list[list[str]] = []
        self._root: Element | None = None
        self._elements_left = self._most_elements = most_elements
        self._has_entities = False
        self._characters_left = limits.MODEL.value
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
        parent = self._stack[-1] if self._stack else None
        # Each field is given: their defaults would be calls, at every element.
        element = Element(tag, attributes, place, [], "", parent, {}, _NOTHING, None)
        self._look_inside_tag(element, line)
        self._check_limits(attributes)
        if parent is None:
            self._root = element
        else:
            parent.children.append(element)
        self._stack.append(element)
        self._pieces.append([])

    def _look_inside_tag(self, element: Element, line: int) -> None:
        start = self._parser.CurrentByteIndex
        tag = self._data[start : self._data.find(b">", start)]
        if b"\n" not in tag and b"\t" not in tag:
            return
        lines: dict[str, int] = {}
        odd: set[str] = set()
        counted = 0
        for match in _ATTRIBUTE.finditer(tag):
            name = match[1].decode("utf-8", "replace")
            line += tag.count(b"\n", counted, match.start(1))
            counted = match.start(1)
            lines[name] = line
            value = match[2] if match[2] is not None else match[3]
            if any(blank in value for blank in (b"\n", b"\t", b"\r")):
                odd.add(name)
        element.attribute_lines = lines
        element.odd_blanks = frozenset(odd)

    def _check_limits(self, attributes: dict[str, str]) -> None:
        self._elements_left -= 1
        if self._elements_left < 0:
            raise self._fault(f"too many elements: more than {self._most_elements:,}")
        if len(self._stack) >= limits.XML_DEPTH.value:
            raise self._fault(
                f"nested too deeply: more than {limits.XML_DEPTH.value:,}"
            )
        if self._has_entities:
            self._spend(sum(len(value) for value in attributes.values()))

    def _spend(self, characters: int) -> None:
        self._characters_left -= characters
        if self._characters_left < 0:
            raise self._fault(_AMPLIFIED)

    def _end(self, _tag: str) -> None:
        element = self._stack.pop()
        pieces = self._pieces.pop()
        if pieces:
            element.text = "".join(pieces)

    def _characters(self, data: str) -> None:
        self._pieces[-1].append(data)
        if self._has_entities:
            self._spend(len(data))

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
        self._has_entities = True

    def _fault(self, message: str) -> XmlFault:
        return XmlFault(
            message,
            self._parser.CurrentLineNumber,
            self._parser.CurrentColumnNumber + 1,
            self._text,
        )


@dataclass(slots=True, eq=False)
class Element:
    """One element of the tree.

    Attributes:
        tag: name as written, with its prefix.
        attributes: name → value; tabs and line breaks are blanks, as XML requires.
        place: where the start tag is in the file that the user wrote.
        children: child elements in document order.
        text: the character data directly inside, without comments.
        parent: the enclosing element, None for the root.
        attribute_lines: line of an attribute, where it differs from the tag's line.
        odd_blanks: attributes whose value contains a tab or a line break in the file;
            XML turns these into blanks, urdfdom does not.
        call: place of the outermost macro call it came through, or None.
    """

    tag: str
    attributes: dict[str, str]
    place: Place
    children: list[Element] = field(default_factory=lambda: [])
    text: str = ""
    parent: Element | None = None
    attribute_lines: Mapping[str, int] = field(default_factory=dict[str, int])
    odd_blanks: frozenset[str] = frozenset()
    call: Place | None = None

    def find(self, tag: str) -> Element | None:
        """Return the first child with that tag, or None."""
        for child in self.children:
            if child.tag == tag:
                return child
        return None

    def find_all(self, tag: str) -> list[Element]:
        """Return all children with that tag, in document order."""
        return [child for child in self.children if child.tag == tag]

    def get(self, name: str) -> str | None:
        """Return the value of an attribute, or None when it is absent."""
        return self.attributes.get(name)

    def iter(self) -> Iterator[Element]:
        """Yield this element and all below it, in document order."""
        stack: list[Element] = [self]
        while stack:
            element = stack.pop()
            yield element
            if element.children:
                stack.extend(reversed(element.children))

    def line_of(self, attribute: str | None) -> int:
        """Return the line of an attribute, or of the tag where no more is known."""
        if attribute is None:
            return self.place.line
        return self.attribute_lines.get(attribute, self.place.line)
