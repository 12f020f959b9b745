"""The namespaces of markers, each with a box of its own."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

from sambot_viz.displays.display import EntryList
from sambot_viz.rviz import BoolProperty, DisplayConfig, EntryItem
from sambot_viz.rviz.declarations import Declared
from sambot_viz.rviz.yaml.nodes import Map

NAMESPACES = "Namespaces"
BOX = "Value"
_PROPERTIES = (BoolProperty(BOX, default=True, help="Show the markers of it."),)
MOST_NAMESPACES = 1000


class NamespaceItem(EntryItem):
    """One namespace in the document: its box is written beside its name.

    Args:
        owner: the display.
        name: of the namespace.
    """

    def __init__(self, owner: DisplayConfig, name: str) -> None:
        super().__init__(owner, (NAMESPACES, name), _PROPERTIES)

    def rooted(self, keys: Sequence[str]) -> tuple[Map, Sequence[str]]:
        """Return the display's map in the document, and the place of the box."""
        del keys
        return self._owner.rooted(self._keys)

    def _write(self, declared: Declared, value: Any) -> None:
        above = self._owner.map_at((NAMESPACES,))
        above.put_text(self._keys[-1], declared.property.write(value))


class Namespaces:
    """The namespaces that the file names and those that have come.

    Args:
        config: the display.
    """

    def __init__(self, config: DisplayConfig) -> None:
        self._config = config
        self._items: dict[str, NamespaceItem] = {}
        for name in config.dynamic(NAMESPACES):
            self.item(name)

    @property
    def names(self) -> Sequence[str]:
        """In the order of the alphabet, as RViz lists them."""
        return sorted(self._items)

    def item(self, name: str) -> NamespaceItem:
        """Return a namespace; it is known from then on."""
        found = self._items.get(name)
        if found is None:
            found = NamespaceItem(self._config, name)
            if len(self._items) < MOST_NAMESPACES:
                self._items[name] = found
        return found

    def is_on(self, name: str) -> bool:
        """Return whether markers of a namespace are shown."""
        return bool(self.item(name).get(BOX))

    def entries(
        self,
        changed: Callable[[str], None],
        facts: Callable[[str], Mapping[str, str]],
    ) -> EntryList:
        """Return the rows.

        Args:
            changed: called with the name of one whose box was ticked or unticked.
            facts: name → what else is said of it.
        """

        def set_box(name: str, path: str, value: Any) -> Any:
            now = self.item(name).set(path, value)
            changed(name)
            return now

        return EntryList(NAMESPACES, "namespace", self.names, self.item, set_box, facts)
