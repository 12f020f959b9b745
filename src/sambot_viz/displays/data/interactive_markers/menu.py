"""The menu of an interactive marker."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from sambot_viz import limits
from sambot_viz.displays.picking.handle import MenuEntry
from sambot_viz.text import text

_MARKS = {"[x]": "☑ ", "[ ]": "☐ "}
_FEEDBACK = 0


def menu_of(message: Any) -> Sequence[MenuEntry]:
    """Return the menu of a visualization_msgs/InteractiveMarker.

    An entry whose parent does not come before it has no place, as in RViz, nor has a
    second one of an id: a menu would have no end.
    """
    below: dict[int, list[Any]] = {0: []}
    most = limits.MENU_ENTRIES.value
    for one in message.menu_entries[:most]:
        if int(one.parent_id) in below and int(one.id) not in below:
            below[int(one.parent_id)].append(one)
            below[int(one.id)] = []

    def entry(one: Any) -> MenuEntry:
        title, runs = str(one.title), int(one.command_type) != _FEEDBACK
        mark = _MARKS.get(title[:3], "")
        said = f"{mark}{title[3:].lstrip() if mark else title}"
        inner = [*map(entry, below[int(one.id)])]
        return MenuEntry(int(one.id), text(said, 200), runs, inner)

    more = len(message.menu_entries) - most
    last = [MenuEntry(0, f"{more:,} more, above {most:,}", False, ())]
    return [*map(entry, below[0]), *(last if more > 0 else ())]
