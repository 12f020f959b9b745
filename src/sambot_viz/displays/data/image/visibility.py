"""The displays that are drawn in the picture of a camera, each with a box."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from sambot_viz.displays.data.box_item import BOX, BoxItem
from sambot_viz.displays.display import Display, EntryList
from sambot_viz.rviz import DisplayConfig
from sambot_viz.rviz.declarations import GROUP

VISIBILITY = "Visibility"
_HELP = "Draw it in the picture of the camera."
Names = tuple[str, ...]


class Visibility:
    """The boxes of all displays but one, those of a group below the box of the group.

    Args:
        owner: the display that has them.
    """

    def __init__(self, owner: Display) -> None:
        self._owner = owner
        self._items: dict[DisplayConfig, tuple[Names, BoxItem]] = {}

    def hidden(self) -> Sequence[str]:
        """Return the keys of the displays that are shown, and not in the picture."""
        all_on = bool(self._owner.config.get(VISIBILITY))
        return [
            display.key
            for display in self._others()
            if display.shown
            and display.config.kind != GROUP
            and not (all_on and self._is_on(display.config))
        ]

    def entries(self) -> EntryList:
        """Return the rows."""
        found = {names_of(one.config): one.config for one in self._others()}
        items: dict[str, BoxItem] = {}
        above: dict[str, str] = {}
        for names, config in found.items():
            name = "/".join(names)
            if name not in items:
                items[name] = self._item(config)
                if len(names) > 1:
                    above[name] = "/".join(names[:-1])

        def set_box(name: str, path: str, value: Any) -> Any:
            return items[name].set(path, value)

        return EntryList(
            VISIBILITY,
            "display",
            list(items),
            lambda name: items[name],
            set_box,
            _no_facts,
            above=above,
            has_details=False,
        )

    def _others(self) -> Iterator[Display]:
        for display in self._owner.context.displays():
            if display is not self._owner:
                yield display

    def _is_on(self, config: DisplayConfig) -> bool:
        """Return whether the boxes of a display and of its groups are ticked."""
        group = config.parent
        is_on = self._item(config).is_on
        return is_on and (group is None or self._is_on(group))

    def _item(self, config: DisplayConfig) -> BoxItem:
        """Return the box of a display; another name does not change it."""
        names = names_of(config)
        before, item = self._items.get(config, (names, None))
        if item is None or names != before:
            keys, owner = (VISIBILITY, *names), self._owner.config
            made = BoxItem(owner, keys, _HELP, is_group=config.kind == GROUP)
            if item is not None and not item.is_on and not made.is_given(BOX):
                made.set(BOX, False)
            self._items[config] = names, made
            return made
        return item


def names_of(config: DisplayConfig) -> Names:
    """Return the name of a display with the names of its groups before it."""
    above = () if config.parent is None else names_of(config.parent)
    return (*above, config.name)


def _no_facts(name: str) -> Mapping[str, str]:
    del name
    return {}
