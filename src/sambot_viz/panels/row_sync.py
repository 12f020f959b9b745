"""Keep the rows of panels up to date after changes of what they show."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from functools import partial
from itertools import chain

from sambot_viz.panels.panel import Item, Panel
from sambot_viz.panels.rows.row import Row, safe
from sambot_viz.panels.rows.row_store import RowStore, Scope
from sambot_viz.session.signals import Listening
from sambot_viz.session.worker import Throttle, Worker

PERIOD = 0.04
"""Shortest time between two changes of rows [s]; 50 ms later would be noticed."""


class RowSync:
    """Makes the rows of one session, or of one client, again when they change.

    Args:
        worker: whose lock is held while rows are made.
        panels: what makes the rows.
        scope: whose state they show.

    Attributes:
        store: the rows, for the pages.
    """

    def __init__(self, worker: Worker, panels: Sequence[Panel], scope: Scope) -> None:
        self.store = RowStore(scope)
        self._worker = worker
        self._panels = tuple(panels)
        # None: its rows were not made yet.
        self._items: dict[str, dict[str, Item] | None] = {p.name: None for p in panels}
        self._remake: set[Panel] = set()
        self._change: set[Panel] = set()
        self._move: set[Panel] = set()
        self._followed = False
        # Of these the page has another value than the rows as they were made last.
        self._moved_rows: set[str] = set()
        self._throttle = Throttle(worker, PERIOD, self._publish)
        self._slow = {
            panel: Throttle(worker, panel.period, partial(self._moved, panel))
            for panel in panels
            if panel.period > PERIOD
        }
        # Of a panel: what makes its rows again, what changes some, and both.
        self._facts = {panel: self._listening_to_facts(panel) for panel in panels}
        self._listening = {panel: [*self._listeners(panel)] for panel in panels}
        for panel in self._panels:
            self._make(panel)

    def close(self) -> None:
        """Follow no changes from now on."""
        all_of = chain(self._facts.values(), self._listening.values())
        for listening in chain.from_iterable(all_of):
            listening.to()
        self._throttle.close()
        for throttle in self._slow.values():
            throttle.close()
        for panel in self._panels:
            panel.close()

    def item(self, item_id: str) -> Item | None:
        """Return the row, data or command of this id, if there is one at present."""
        for items in self._items.values():
            if items is not None and item_id in items:
                return items[item_id]
        return None

    def _listening_to_facts(
        self, panel: Panel
    ) -> tuple[Listening, Listening, Listening]:
        """Return what a panel listens with: to remake rows, to change them, to move."""
        return (
            Listening(partial(self._remake.add, panel)),
            Listening(partial(self._change.add, panel)),
            Listening(self._throttle.request, sends=True),
        )

    def _listeners(self, panel: Panel) -> Iterator[Listening]:
        """Yield what follows a motion; it listens once rows have been made."""
        if panel in self._slow:
            yield Listening(self._slow[panel].request)
        else:
            yield Listening(partial(self._move.add, panel))
            yield Listening(self._throttle.request, sends=True)

    def _moved(self, panel: Panel) -> None:
        with self._worker.lock:
            # Where nothing has changed, the next step need not wait for a period.
            if self._follow(panel):
                self._followed = True
                self._throttle.request()

    def remake(self, panel: Panel) -> None:
        """Make the rows of a panel again, soon."""
        self._remake.add(panel)
        self._throttle.request()

    def _publish(self) -> None:
        with self._worker.lock:
            remake, change, move = {*self._remake}, {*self._change}, {*self._move}
            for waiting in (self._remake, self._change, self._move):
                waiting.clear()
            changed: list[bool] = []
            for panel in self._panels:
                if panel in remake:
                    changed.append(self._make(panel))
                    continue
                if panel in change:
                    changed.append(self._make_changed(panel))
                if panel in move:
                    changed.append(self._follow(panel))
            followed, self._followed = self._followed, False
            if followed or any(changed):
                self.store.tell()

    def _make(self, panel: Panel) -> bool:
        """Make the rows of a panel; returns whether the page has to show others."""
        panel.refresh()
        remade, changed, both = self._facts[panel]
        remade.to(*panel.remade_by)
        changed.to(*panel.changed_by)
        both.to(*panel.remade_by, *panel.changed_by)
        made = {item.id: item for item in panel.items()}
        for listening in self._listening[panel]:
            listening.to(*panel.moved_by)
        before, self._items[panel.name] = self._items[panel.name], made
        moved = self._moved_rows & made.keys()
        self._moved_rows -= moved
        if before is None or _places(before) != _places(made):
            self.store.replace(panel.name, [item.json() for item in made.values()])
            return True
        differing = [
            item
            for item_id, item in made.items()
            if item_id in moved or not _is_same(item, before[item_id])
        ]
        return any([self._update(item) for item in differing])

    def _make_changed(self, panel: Panel) -> bool:
        """Make only the rows of a panel that differ; the others are there already."""
        rows, items = panel.changed_rows(), self._items[panel.name]
        if rows is None or items is None:
            return self._make(panel)
        places = ((items.get(row.id), row.parent) for row in rows)
        if any(not isinstance(x, Row) or x.parent != above for x, above in places):
            return self._make(panel)
        items.update((row.id, row) for row in rows)
        return any([self._update(row) for row in rows])

    def _update(self, item: Item) -> bool:
        old, new = self.store.get(item.id) or {}, item.json()
        patch = {key: value for key, value in new.items() if old.get(key) != value}
        patch |= {key: None for key in old if key not in new}
        if patch:
            self.store.update(item.id, patch)
        return bool(patch)

    def _follow(self, panel: Panel) -> bool:
        values = panel.values().items()
        changed = self.store.set_values(
            {row_id: safe(value) for row_id, value in values}
        )
        self._moved_rows.update(changed)
        return bool(changed)


def _places(items: Mapping[str, Item]) -> list[tuple[str, str]]:
    """Return all items in order, each with what it is below: so a tree is laid out."""
    return [(i, x.parent if isinstance(x, Row) else "") for i, x in items.items()]


def _is_same(item: Item, before: Item) -> bool:
    """Return whether a row is the same for the page; data are always compared there."""
    if not isinstance(item, Row) or item != before:
        return False
    # What sets it is not compared, but whether it can be set is shown.
    return isinstance(before, Row) and (item.set is None) == (before.set is None)
