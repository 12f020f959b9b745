"""Sends rows to the page: all of them once, then what changes.

viser keeps only the last content of an HTML element for browsers that come later. So
there are two elements: one with all rows, written rarely, and one with all changes
since, written again with every change. A browser that joins applies both.
"""

from __future__ import annotations

import json
import secrets
import time
from collections.abc import Callable, Iterator, Sequence
from functools import partial
from typing import Literal, Protocol

import viser

from sambot_viz.panels.panel import Item, Panel
from sambot_viz.panels.row import Json, safe
from sambot_viz.session.signals import connect
from sambot_viz.session.throttle import Throttle
from sambot_viz.session.worker import Worker

PERIOD = 0.04
"""Shortest time between two messages with rows [s]; 50 ms later would be noticed."""
MOST_CHANGES = 16_000
"""When the changes are longer than this, all rows are sent again [characters]."""
FEW_CHANGES = 2000
TIDY_PERIOD = 5.0
"""For changes longer than `FEW_CHANGES`, all rows are sent again this often [s];
a step of one joint is a few bytes again then."""

Scope = Literal["session", "browser"]


class Owner(Protocol):
    """Who sees the rows: a session's audience, or one browser of it."""

    gui: viser.GuiApi

    def flush(self) -> None:
        """Send waiting messages now."""


class Publisher:
    """The rows of one session, or of one browser.

    Args:
        owner: whom they are sent to.
        worker: whose lock is held while rows are made.
        panels: what makes the rows.
        scope: whose state they show.
    """

    def __init__(
        self, owner: Owner, worker: Worker, panels: Sequence[Panel], scope: Scope
    ) -> None:
        self._owner = owner
        self._worker = worker
        self._panels = tuple(panels)
        self._scope = scope
        # A page whose connection was interrupted finds another one here.
        self._from = secrets.token_hex(4)
        self._base = 0
        self._tidied_at = time.monotonic()
        self._items: dict[str, dict[str, Item]] = {panel.name: {} for panel in panels}
        self._sent: dict[str, dict[str, Json]] = {}
        self._replaced: dict[str, list[dict[str, Json]]] = {}
        self._patches: dict[str, dict[str, Json]] = {}
        self._remake: set[Panel] = set()
        self._move: set[Panel] = set()
        self._followed = False
        self._throttle = Throttle(worker, PERIOD, self._publish)
        self._slow = {
            panel: Throttle(worker, panel.period, partial(self._moved, panel))
            for panel in panels
            if panel.period > PERIOD
        }
        for panel in self._panels:
            self._make(panel)
        self._all = owner.gui.add_html(self._whole())
        self._changes = owner.gui.add_html(self._element("changes", self._difference()))
        self._disconnect = [
            ending for panel in self._panels for ending in self._connect(panel)
        ]

    def close(self) -> None:
        """Send nothing any more."""
        for disconnect in self._disconnect:
            disconnect()
        self._throttle.close()
        for throttle in self._slow.values():
            throttle.close()
        for panel in self._panels:
            panel.close()

    def item(self, item_id: str) -> Item | None:
        """Return the row, data or command of this id, if there is one at present."""
        for items in self._items.values():
            if item_id in items:
                return items[item_id]
        return None

    def _connect(self, panel: Panel) -> Iterator[Callable[[], None]]:
        """Send what a panel shows after a change, all panels together."""
        request = self._throttle.request
        yield connect(panel.remade_by, partial(self._remake.add, panel))
        yield connect(panel.remade_by, request, sends=True)
        if panel in self._slow:
            yield connect(panel.moved_by, self._slow[panel].request)
        else:
            yield connect(panel.moved_by, partial(self._move.add, panel))
            yield connect(panel.moved_by, request, sends=True)

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
            remake, move = {*self._remake}, self._move - self._remake
            self._remake.clear()
            self._move.clear()
            changed = [self._make(panel) for panel in self._panels if panel in remake]
            changed += [self._follow(panel) for panel in self._panels if panel in move]
            followed, self._followed = self._followed, False
            if followed or any(changed):
                self._send()

    def _send(self) -> None:
        changes = self._element("changes", self._difference())
        tidy = time.monotonic() - self._tidied_at >= TIDY_PERIOD
        if len(changes) > (FEW_CHANGES if tidy else MOST_CHANGES):
            self._base += 1
            self._tidied_at = time.monotonic()
            self._replaced.clear()
            self._patches.clear()
            self._all.content = self._whole()
            changes = self._element("changes", self._difference())
        self._changes.content = changes
        self._owner.flush()

    def _make(self, panel: Panel) -> bool:
        """Make the rows of a panel; whether the page has to show something else."""
        made = {item.id: item for item in panel.items()}
        before, self._items[panel.name] = self._items[panel.name], made
        new = {item_id: item.json() for item_id, item in made.items()}
        if list(before) != list(new):
            for row_id in before:
                self._sent.pop(row_id, None)
                self._patches.pop(row_id, None)
            self._sent |= new
            self._replaced[panel.name] = list(new.values())
            return True
        return any([self._patch(row_id, value) for row_id, value in new.items()])

    def _patch(self, row_id: str, new: dict[str, Json]) -> bool:
        old = self._sent[row_id]
        patch = {key: value for key, value in new.items() if old.get(key) != value}
        patch |= {key: None for key in old if key not in new}
        if not patch:
            return False
        self._sent[row_id] = new
        self._patches.setdefault(row_id, {}).update(patch)
        return True

    def _follow(self, panel: Panel) -> bool:
        changed = False
        for row_id, value in panel.values().items():
            sent = self._sent.get(row_id)
            if sent is not None and sent.get("value") != (shown := safe(value)):
                sent["value"] = shown
                self._patches.setdefault(row_id, {})["value"] = shown
                changed = True
        return changed

    def _whole(self) -> str:
        panels = {
            name: [self._sent[row_id] for row_id in rows]
            for name, rows in self._items.items()
        }
        self._replaced.clear()
        whole = {"from": self._from, "base": self._base, "panels": panels}
        return self._element("rows", whole)

    def _difference(self) -> Json:
        return {
            "base": self._base,
            "panels": self._replaced,
            "rows": self._patches,
        }

    def _element(self, what: str, content: Json) -> str:
        data = json.dumps(content, separators=(",", ":"), ensure_ascii=False)
        data = data.replace("<", "\\u003c")
        return (
            f'<script type="application/json" data-sambot="{what}" '
            f'data-of="{self._scope}">{data}</script>'
        )
