"""The rows of a session or of one client, and the changes that a page lacks.

Every change has a number. A page that has all changes up to one of them gets the
present values of the rows that changed since: a slow page skips intermediate values,
and only its number is kept for it.
"""

from __future__ import annotations

import gzip
import threading
from collections.abc import Callable, Mapping, Sequence
from typing import Literal, Protocol

import msgspec

from sambot_viz.panels.rows.row import Json

LONG = 4096
"""A longer patch is sent compressed, in a binary frame [bytes]."""
COMPRESSED = b"\1"
"""The first byte of a binary frame: a message in JSON, compressed by gzip. Other
numbers mean other content, such as pictures (`displays.pictures`)."""

Scope = Literal["session", "browser", "follower"]


class RowStore:
    """Rows by panel, each part with the number of its last change.

    Rows are changed with the session locked, and read on the event loop at any moment.

    Args:
        scope: whose state they show.

    Attributes:
        version: the number of the last change; 0 before the first.
        listeners: called after changes, with the session locked.
    """

    def __init__(self, scope: Scope) -> None:
        self.version = 0
        self.listeners: list[Callable[[], object]] = []
        self._scope = scope
        # The event loop must not wait for a session's lock, which is held while a robot
        # is drawn; this one is held for the moment of a change or of a patch.
        self._lock = threading.Lock()
        self._rows: dict[str, dict[str, Json]] = {}
        self._panels: dict[str, list[str]] = {}
        self._replaced: dict[str, int] = {}
        # The rows that were changed last are at the end.
        self._changed: dict[str, dict[str, int]] = {}
        self._packed: dict[int, str | bytes] = {}

    def get(self, row_id: str) -> Mapping[str, Json] | None:
        """Return a row as the page has it; None when there is none."""
        return self._rows.get(row_id)

    def replace(self, panel: str, rows: Sequence[dict[str, Json]]) -> None:
        """Give a panel other rows than before."""
        with self._lock:
            for row_id in self._panels.get(panel, ()):
                self._rows.pop(row_id, None)
                self._changed.pop(row_id, None)
            self._panels[panel] = [row["id"] for row in rows]
            self._rows.update((row["id"], row) for row in rows)
            self._replaced[panel] = self._next()

    def update(self, row_id: str, patch: Mapping[str, Json]) -> None:
        """Change some keys of a row; remove those that are None."""
        with self._lock:
            version = self._next()
            changed = self._changed.pop(row_id, {})
            # A new dictionary: the old one may be in the hands of the event loop.
            row = {**self._rows[row_id], **patch}
            kept = {key: value for key, value in row.items() if value is not None}
            self._rows[row_id] = kept
            self._changed[row_id] = changed | dict.fromkeys(patch, version)

    def set_values(self, values: Mapping[str, Json]) -> list[str]:
        """Show other values in rows, together.

        Args:
            values: by row; of those that are not there nothing is kept.

        Returns:
            The rows that have shown something else.
        """
        rows = self._rows
        differing = {
            row_id: value
            for row_id, value in values.items()
            if row_id in rows and rows[row_id].get("value") != value
        }
        if differing:
            with self._lock:
                version = self._next()
                for row_id, value in differing.items():
                    row = {**rows[row_id], "value": value}
                    if value is None:
                        del row["value"]
                    rows[row_id] = row
                    changed = self._changed.pop(row_id, {})
                    self._changed[row_id] = {**changed, "value": version}
        return list(differing)

    def _next(self) -> int:
        self._packed.clear()
        self.version += 1
        return self.version

    def tell(self) -> None:
        """Tell the listeners that there is something new."""
        for listener in tuple(self.listeners):
            listener()

    def since(self, version: int) -> tuple[int, str | bytes | None]:
        """Return the present version, and a message with the changes since one.

        Args:
            version: version of a page's last message; 0 for a page without any.

        Returns:
            None in place of a message when nothing has changed; bytes for a long one.
        """
        with self._lock:
            if version == self.version:
                return version, None
            if version not in self._packed:
                # All pages that are as far as this one get the same.
                self._packed[version] = _packed(self._patch(version))
            return self.version, self._packed[version]

    def _patch(self, since: int) -> Json:
        panels = [name for name, at in self._replaced.items() if at > since]
        whole = {row_id for name in panels for row_id in self._panels[name]}
        rows: dict[str, dict[str, Json]] = {}
        for row_id, changed in reversed(self._changed.items()):
            if max(changed.values()) <= since:
                break
            if row_id not in whole:
                row = self._rows[row_id]
                rows[row_id] = {
                    k: row.get(k) for k, at in changed.items() if at > since
                }
        patch: dict[str, Json] = {"of": self._scope}
        if since == 0:
            patch["all"] = True
        if panels:
            patch["panels"] = {
                name: [self._rows[row_id] for row_id in self._panels[name]]
                for name in panels
            }
        if rows:
            patch["rows"] = rows
        return patch


def _packed(patch: Json) -> str | bytes:
    content = msgspec.json.encode(patch)
    if len(content) <= LONG:
        return content.decode()
    return COMPRESSED + gzip.compress(content, 6, mtime=0)


class Versioned(Protocol):
    """What a page lacks is asked for by the number of what it has; as of a RowStore."""

    listeners: list[Callable[[], object]]

    @property
    def version(self) -> int:
        """The number of the last change."""
        ...

    def since(self, version: int) -> tuple[int, str | bytes | None]:
        """Return the number of what the page has then, and what it lacks, if any."""
        ...


class ClientRows:
    """All rows that one client sees: those of its session, and its own.

    Args:
        stores: both, in this order.
        others: what else is sent to it.
    """

    def __init__(
        self, stores: Sequence[RowStore], others: Sequence[Versioned] = ()
    ) -> None:
        self.stores = tuple(stores)
        self.sent: tuple[Versioned, ...] = (*stores, *others)

    def listen(self, listener: Callable[[], object]) -> Callable[[], None]:
        """Call a listener after changes; returns a function that ends that."""
        for store in self.sent:
            store.listeners.append(listener)

        def end() -> None:
            for store in self.sent:
                store.listeners.remove(listener)

        return end
