"""Inside the child: minidom nodes that know their places in the files.

xacro works on a minidom tree without positions. Here every element has the place where
it was parsed. Clones keep it, so an expanded element still has the user's file and
line, and the macro calls that created it.
"""

from __future__ import annotations

import xml.dom.minidom
import xml.parsers.expat
from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, Any
from xml.dom import expatbuilder

from sambot_viz.robot.xml.decode import XmlFault

if TYPE_CHECKING:
    from sambot_viz.robot.xacro.child.exchange import Call, Node, NodePlace

_minidom: Any = xml.dom.minidom
_ELEMENT = _minidom.Node.ELEMENT_NODE
_TEXTS = (_minidom.Node.TEXT_NODE, _minidom.Node.CDATA_SECTION_NODE)


class PlacedBuilder(expatbuilder.ExpatBuilderNS):
    """minidom's own builder, with the place on every element."""

    def __init__(self, file: str) -> None:
        super().__init__()
        self._file = file

    def start_element_handler(self, name: Any, attributes: Any) -> None:
        """Build the element as minidom does, then mark it."""
        super().start_element_handler(name, attributes)
        this: Any = self
        parser = this.getParser()
        this.curNode.sambot_place = (
            self._file,
            parser.CurrentLineNumber,
            parser.CurrentColumnNumber + 1,
        )


def parse_placed(text: str, file: str) -> Any:
    """Parse a text into a minidom document with places.

    Raises:
        XmlFault: the text is not well-formed.
    """
    try:
        return PlacedBuilder(file).parseString(text)
    except xml.parsers.expat.ExpatError as error:
        message = xml.parsers.expat.ErrorString(error.code) or str(error)
        column = error.offset + 1
        raise XmlFault(message, error.lineno, column, text, error.code) from None


class PlaceKeeper:
    """Copies places when minidom clones a node.

    Attributes:
        calls: the macro calls being expanded, outermost first.
    """

    def __init__(self) -> None:
        self.calls: list[Call] = []
        self._of_clone: tuple[Call, ...] | None = None
        self._original: Callable[..., Any] = _minidom._clone_node
        _minidom._clone_node = self._clone

    def _clone(self, node: Any, deep: Any, document: Any) -> Any:
        """Clone as minidom does; the body of a macro gets the current calls."""
        is_body = getattr(node, "tagName", "") == "xacro:macro"
        outermost = self._of_clone is None and is_body
        if outermost:
            self._of_clone = tuple(self.calls)
        calls = self._of_clone
        try:
            copy = self._original(node, deep, document)
        finally:
            if outermost:
                self._of_clone = None
        if node.nodeType == _ELEMENT:
            copy.sambot_place = node.sambot_place
            copy.sambot_calls = calls or getattr(node, "sambot_calls", ())
        return copy


def elements(root: Any) -> Iterator[Any]:
    """Yield all elements in document order."""
    stack = [root]
    while stack:
        node = stack.pop()
        yield node
        children = [child for child in node.childNodes if child.nodeType == _ELEMENT]
        stack.extend(reversed(children))


def packed(root: Any) -> tuple[list[Node], list[NodePlace], list[str]]:
    """Return the tree as plain lists for the parent process, see `child_result.py`.

    Returns:
        The elements in document order, their places, and the file names by number.
    """
    numbers: dict[str, int] = {}
    nodes: list[Node] = []
    places: list[NodePlace] = []
    for node in elements(root):
        file, line, column = node.sambot_place
        texts = [child.data for child in node.childNodes if child.nodeType in _TEXTS]
        count = sum(child.nodeType == _ELEMENT for child in node.childNodes)
        attributes = {name: value for name, value in node.attributes.items()}
        nodes.append((node.tagName, attributes, "".join(texts).strip(), count))
        number = numbers.setdefault(file, len(numbers))
        calls: tuple[Call, ...] = getattr(node, "sambot_calls", ())
        call_file, call_line = -1, -1
        if calls:
            call_file = numbers.setdefault(calls[0][1], len(numbers))
            call_line = calls[0][2]
        places.append((number, line, column, call_file, call_line))
    return nodes, places, list(numbers)
