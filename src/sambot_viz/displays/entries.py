"""Per-link, per-joint and per-frame settings of a display.

A robot has hundreds of them, so the panel offers a list to choose from and shows the
rows of the chosen one only.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from sambot_viz.rviz import Property

Rows = Mapping[str, Any]


@dataclass(frozen=True, slots=True)
class EntryList:
    """One kind of things, such as the links of a RobotModel.

    Attributes:
        title: RViz's name for all of them: "Links", "Joints", "Frames".
        singular: what one of them is called.
        names: those there are.
        properties: the rows that each of them has.
        get: name → row → value.
        set: takes a name, a row and a checked value, and writes them into the document.
        facts: name → what is only shown, such as "Position" → "1; 2; 3".
        rows: name → the rows it has, when not all of them.
    """

    title: str
    singular: str
    names: Sequence[str]
    properties: tuple[Property, ...]
    get: Callable[[str], Rows]
    set: Callable[[str, str, Any], None]
    facts: Callable[[str], Mapping[str, str]]
    rows: Callable[[str], Sequence[str]] | None = None


def is_on(value: object, default: bool = True) -> bool:
    """A box that nobody declared, by RViz's rule and YAML's words."""
    if not isinstance(value, str):
        return default
    return value.lower() not in ("", "0", "false", "no", "off")


def numbers(values: Sequence[float]) -> str:
    """Several numbers as RViz shows a vector: five digits each."""
    return "; ".join(f"{float(value) + 0.0:.5g}" for value in values)
