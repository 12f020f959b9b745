"""Selectable items, selections, and the hits of rays."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Literal, TypeAlias

import numpy as np

from sambot_viz.displays.picking.rays import Array, Indices

ItemKind = Literal["link", "frame", "marker", "points", "pose"]


@dataclass(frozen=True, slots=True)
class Selectable:
    """An item that can be selected.

    Attributes:
        kind: a link of the robot, a TF frame, a marker, the points of one message, or
            the pose of a display.
        name: its name for users.
        of: for data, the display, and for points the message.
    """

    kind: ItemKind
    name: str
    of: str = ""

    @property
    def is_data(self) -> bool:
        """Whether it is drawn of messages."""
        return self.kind not in ("link", "frame")


Selection: TypeAlias = Mapping[Selectable, Indices | None]
"""Selected item → for points their sorted numbers, for others None."""


def merged(before: Selection, items: Selection, modifier: str | None) -> Selection:
    """Return a selection after a click or a rectangle.

    Args:
        before: the selection.
        items: what was clicked on.
        modifier: "shift" adds, "cmd/ctrl" removes, None replaces.
    """
    if modifier is None:
        order = sorted(items, key=lambda item: (item.kind, item.name, item.of))
        return {item: items[item] for item in order}
    kept = dict(before)
    for item, numbers in items.items():
        known = kept.get(item)
        if modifier == "shift":
            if known is not None and numbers is not None:
                numbers = np.union1d(known, numbers)
            kept[item] = numbers
        elif item in kept:
            if known is None or numbers is None or np.isin(known, numbers).all():
                del kept[item]
            else:
                kept[item] = np.setdiff1d(known, numbers)
    return kept


def labels(selection: Selection) -> Iterator[str]:
    """Yield what each selected item is called; each point is one."""
    for item, numbers in selection.items():
        if numbers is None:
            yield item.name
        else:
            yield from (f"Point {number} of {item.name}" for number in numbers[:1000])


@dataclass(frozen=True, slots=True, eq=False)
class Hit:
    """The result of following a ray from the cursor.

    Attributes:
        point: the nearest drawn point, in the fixed frame, (3,) [m]; None for the
            background.
        item: the item that a click selects; None if not selectable, or background.
        number: number of the point, where the item is points.
    """

    point: Array | None
    item: Selectable | None
    number: int | None = None

    @property
    def selection(self) -> Selection:
        """The item of a click, as a selection."""
        if self.item is None:
            return {}
        numbers = None if self.number is None else np.array([self.number])
        return {self.item: numbers}
