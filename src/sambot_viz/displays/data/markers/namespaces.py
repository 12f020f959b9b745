"""The namespaces of markers, each with its own box."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

from sambot_viz import limits
from sambot_viz.displays.data.box_item import BoxItem
from sambot_viz.displays.display import EntryList
from sambot_viz.rviz import DisplayConfig

NAMESPACES = "Namespaces"
_HELP = "Show the markers of it."
"""More namespaces have no box, nor do those with a longer name."""


class Namespaces:
    """The namespaces that the file names and those that have come.

    Args:
        config: the display.
    """

    def __init__(self, config: DisplayConfig) -> None:
        self._config = config
        self._items: dict[str, BoxItem] = {}
        for name in config.dynamic(NAMESPACES):
            self.item(name)

    @property
    def names(self) -> Sequence[str]:
        """In the order of the alphabet, as RViz lists them."""
        return sorted(self._items)

    def item(self, name: str) -> BoxItem:
        """Return a namespace; it is known from then on."""
        found = self._items.get(name)
        if found is None:
            found = BoxItem(self._config, (NAMESPACES, name), _HELP)
            if (
                len(self._items) < limits.NAMESPACES.value
                and len(name) <= limits.KEY.value
            ):
                self._items[name] = found
        return found

    def is_on(self, name: str) -> bool:
        """Return whether markers of a namespace are shown."""
        return self.item(name).is_on

    def entries(
        self,
        changed: Callable[[str], None],
        facts: Callable[[str], Mapping[str, str]],
    ) -> EntryList:
        """Return the rows.

        Args:
            changed: called with the name of a namespace whose box has changed.
            facts: name → further facts about it.
        """

        def set_box(name: str, path: str, value: Any) -> Any:
            now = self.item(name).set(path, value)
            changed(name)
            return now

        return EntryList(NAMESPACES, "namespace", self.names, self.item, set_box, facts)
