"""The links, joints or frames of a display, each with properties of its own.

A robot has hundreds of them, so the panel offers a list to choose from and shows the
rows of the chosen one only.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from sambot_viz.rviz import EntryItem


@dataclass(frozen=True, slots=True)
class EntryList:
    """One kind of things, such as the links of a RobotModel.

    Attributes:
        title: RViz's name for all of them: "Links", "Joints", "Frames".
        singular: what one of them is called.
        names: those there are.
        item: name → its item of the document, with its properties.
        set: (name, property, value) → the value it has now; others may follow.
        facts: name → what is only shown, such as "Position" → "1; 2; 3".
        rows: name → the properties that have a row, when not all of them do.
    """

    title: str
    singular: str
    names: Sequence[str]
    item: Callable[[str], EntryItem]
    set: Callable[[str, str, Any], Any]
    facts: Callable[[str], Mapping[str, str]]
    rows: Callable[[str], Sequence[str]] | None = None


def numbers(values: Sequence[float]) -> str:
    """Return several numbers as RViz shows a vector: five digits each."""
    return "; ".join(f"{float(value) + 0.0:.5g}" for value in values)
