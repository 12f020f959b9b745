"""An element of an XML document, with the place where the user wrote it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field

from sambot_viz.errors import Place


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
        return next((child for child in self.children if child.tag == tag), None)

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
            stack.extend(reversed(element.children))

    def line_of(self, attribute: str | None) -> int:
        """Return the line of an attribute, or of the tag where no more is known."""
        if attribute is None:
            return self.place.line
        return self.attribute_lines.get(attribute, self.place.line)
