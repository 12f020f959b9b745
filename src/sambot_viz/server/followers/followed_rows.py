"""Messages for a follower's pages, apart from the scene, as the origin sends them."""

from __future__ import annotations

import gzip
from collections.abc import Callable, Iterable
from typing import Any, cast

import msgspec

from sambot_viz.panels.rows.row import Data, Json
from sambot_viz.panels.rows.row_store import COMPRESSED, ClientRows, RowStore

STATE = "follower/state"
"""Data of the page that names the origin."""


class LatestMessage:
    """A message of which only the newest counts, such as the camera to show."""

    def __init__(self) -> None:
        self.version = 0
        self.listeners: list[Callable[[], object]] = []
        self._message: str | bytes | None = None

    def take(self, message: str | bytes) -> None:
        """Replace the message."""
        self.version += 1
        self._message = message
        for listener in tuple(self.listeners):
            listener()

    def since(self, version: int) -> tuple[int, str | bytes | None]:
        """Return the current version, and the message unless the caller has it."""
        return self.version, None if version == self.version else self._message


class FollowedRows:
    """Rows and data from another server.

    Call all methods on the event loop.

    Attributes:
        all: messages for each page.
    """

    def __init__(self) -> None:
        self._stores = {scope: RowStore(scope) for scope in ("session", "browser")}
        self._panels = {scope: set[str]() for scope in self._stores}
        self._own, self._camera = RowStore("follower"), LatestMessage()
        stores = (self._own, *self._stores.values())
        self.all = ClientRows(stores, (self._camera,))

    def say(self, origin: str, trouble: str) -> None:
        """Show in the pages which server they follow.

        Args:
            origin: address of the page that offers control; "" if unknown.
            trouble: reason why the pages show an old state; "" if they do not.
        """
        state: Json = {"origin": origin, "trouble": trouble}
        self._own.replace("follower", [Data(STATE, state).json()])
        self._own.tell()

    def replace(self, messages: Iterable[bytes]) -> None:
        """Show the rows of a snapshot."""
        for message in messages:
            self.take(message)

    def take(self, message: bytes) -> None:
        """Handle a message of the origin to a page.

        Raises:
            ValueError: it is not a message of a server of the same version.
        """
        packed = message[:1] == COMPRESSED
        if not packed and message[:1] != b"{":
            # A picture, which no page of this server has requested.
            return
        try:
            content = gzip.decompress(message[1:]) if packed else message
            patch: dict[str, Any] = msgspec.json.decode(content)
            scope = patch.get("of")
            if scope == "camera":
                self._camera.take(content.decode())
            elif scope in self._stores:
                self._change(scope, patch)
        except (OSError, EOFError, msgspec.DecodeError, LookupError) as error:
            raise ValueError(f"not a message of rows: {error}") from error

    def _change(self, scope: str, patch: dict[str, Any]) -> None:
        store = self._stores[scope]
        panels = cast("dict[str, list[dict[str, Json]]]", patch.get("panels", {}))
        if patch.get("all"):
            for name in self._panels[scope] - panels.keys():
                store.replace(name, [])
            self._panels[scope] = set(panels)
        for name, rows in panels.items():
            store.replace(name, rows)
        for row_id, changed in patch.get("rows", {}).items():
            store.update(row_id, changed)
        store.tell()
