"""Two attributes with swapped values: each has the word that the other needs."""

from __future__ import annotations

from collections.abc import Container

from sambot_viz.edits import exchange_attributes
from sambot_viz.errors import Fix
from sambot_viz.robot.xml.element import Element


def exchanged(element: Element, name: str, words: Container[str]) -> Fix | None:
    """Return the fix where another attribute has the word that one needs.

    Args:
        element: the element.
        name: attribute with a value outside the words.
        words: words that it may have.
    """
    mine = element.get(name)
    for other, value in element.attributes.items():
        if mine is not None and other != name and value in words:
            hint = f'write {other}="{mine}" and {name}="{value}"'
            return Fix(hint, exchange_attributes(element.place, name, other))
    return None
