"""Adding, copying, naming, removing and ordering displays."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import viser

from sambot_viz.displays.registry import DISPLAYS
from sambot_viz.panels.widgets import add_buttons, add_text, on_press, options, watch
from sambot_viz.rviz import DisplayConfig
from sambot_viz.rviz.class_name import GROUP
from sambot_viz.session import Session
from sambot_viz.text import text

DUPLICATE, REMOVE, UP, DOWN = "Duplicate", "Remove", "Up", "Down"
TOP = "no group"
_INDENT = "  "


class Arrange:
    """The rows for that, in the current container; made again with the panel.

    Args:
        session: whose displays these are.
        chosen: the display that was chosen before.
    """

    def __init__(self, session: Session, chosen: DisplayConfig | None = None) -> None:
        self._session = session
        gui = session.audience.gui
        self._items = dict(labelled(session.config.displays))
        self._labels = {id(item): label for label, item in self._items.items()}
        self.chosen = chosen if id(chosen) in self._labels else None
        if self.chosen is None:
            self.chosen = next(iter(self._items.values()), None)
        with gui.add_folder("Add a display", expand_by_default=False):
            self._add_row(gui)
        if self.chosen is not None:
            with gui.add_folder("Arrange displays", expand_by_default=False):
                self._arrange_rows(gui, self.chosen)

    def _add_row(self, gui: viser.GuiApi) -> None:
        kinds = {kind.rpartition("/")[2]: kind for kind in sorted(DISPLAYS)}
        names = tuple(sorted(kinds))
        kind = gui.add_dropdown(
            "Type", names, initial_value=names[0], hint="What the display shows."
        )
        watch(
            self._session,
            kind,
            lambda label: _offered(label, kinds),
            lambda label: None,
        )
        button = gui.add_button("Add", hint="Add it at the end, switched on.")
        on_press(self._session, button, lambda client: self._add(kinds[kind.value]))

    def _arrange_rows(self, gui: viser.GuiApi, chosen: DisplayConfig) -> None:
        labels = tuple(self._items)
        which = gui.add_dropdown(
            "Display", labels, initial_value=self._labels[id(chosen)]
        )
        watch(
            self._session,
            which,
            lambda label: _offered(label, self._items),
            self._choose,
        )
        self._name = add_text(
            self._session,
            "Name",
            text(chosen.name),
            self._rename,
            hint="How it is called.",
        )
        add_buttons(
            self._session,
            (UP, DOWN, DUPLICATE, REMOVE),
            lambda button, client: self._act(button),
        )
        groups = {TOP: None} | {
            label: item for label, item in self._items.items() if item.kind == GROUP
        }
        if len(groups) > 1:
            inside = next(
                label for label, item in groups.items() if item is chosen.parent
            )
            self._group = gui.add_dropdown(
                "In group", options(list(groups), inside), initial_value=inside
            )
            watch(
                self._session,
                self._group,
                lambda label: _offered(label, groups),
                lambda label: self._regroup(groups[label]),
            )

    def _choose(self, label: str) -> None:
        with self._session.change():
            self.chosen = self._items[label]
            self._name.value = text(self.chosen.name)

    def _add(self, kind: str) -> None:
        with self._session.change():
            self._session.add_display(kind)

    def _rename(self, name: str) -> None:
        chosen = self.chosen
        if chosen is not None:
            self._session.rename_display(chosen, name)

    def _act(self, button: str) -> None:
        chosen, config = self.chosen, self._session.config
        if chosen is None:
            return
        with self._session.change():
            siblings = chosen.parent.members if chosen.parent else config.displays
            at = list(siblings).index(chosen)
            if button == DUPLICATE:
                self._session.duplicate_display(chosen)
            elif button == REMOVE:
                self._session.remove_display(chosen)
            else:
                to = max(0, at - 1) if button == UP else at + 1
                self._session.move_display(chosen, to, chosen.parent)

    def _regroup(self, group: DisplayConfig | None) -> None:
        chosen = self.chosen
        if chosen is None or chosen.parent is group:
            return
        with self._session.change():
            members = group.members if group else self._session.config.displays
            # A group cannot go into itself: the error refuses the browser's choice.
            self._session.move_display(chosen, len(members), group)


def labelled(
    items: tuple[DisplayConfig, ...],
) -> Iterator[tuple[str, DisplayConfig]]:
    """All displays of a tree, each with a label that no other one has."""
    seen: dict[str, int] = {}
    pending = [(item, 0) for item in reversed(items)]
    while pending:
        item, depth = pending.pop()
        label = _INDENT * depth + (text(item.name, 40) or "(no name)")
        seen[label] = seen.get(label, 0) + 1
        yield (label if seen[label] == 1 else f"{label} ({seen[label]})"), item
        pending += [(member, depth + 1) for member in reversed(item.displays)]


def _offered(label: object, offered: Mapping[str, object]) -> str:
    if not isinstance(label, str) or label not in offered:
        raise ValueError("not offered")
    return label
