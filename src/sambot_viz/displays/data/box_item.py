"""A box for each of some names that a file lists, such as namespaces of markers."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from sambot_viz.rviz import BoolProperty, DisplayConfig, EntryItem
from sambot_viz.rviz.declarations import Declared
from sambot_viz.rviz.yaml.yaml_nodes import Map

BOX = "Value"


class BoxItem(EntryItem):
    """One box in the document, on unless the file says otherwise.

    It is written beside its name, or into the map of that where others are below it.

    Args:
        owner: the display.
        keys: its place there; the last one is its name.
        help: a sentence on the box.
        is_group: whether others are below it.
    """

    def __init__(
        self,
        owner: DisplayConfig,
        keys: Sequence[str],
        help: str,
        *,
        is_group: bool = False,
    ) -> None:
        self._box_at = (*keys, BOX) if is_group else tuple(keys)
        super().__init__(owner, keys, (BoolProperty(BOX, default=True, help=help),))

    @property
    def is_on(self) -> bool:
        """Whether it is ticked."""
        return bool(self.get(BOX))

    def rooted(self, keys: Sequence[str]) -> tuple[Map, Sequence[str]]:
        """Return the display's map in the document, and the place of the box."""
        del keys
        return self._owner.rooted(self._box_at)

    def _write(self, declared: Declared, value: Any) -> None:
        above = self._owner.map_at(self._box_at[:-1])
        above.put_text(self._box_at[-1], declared.property.write(value))
