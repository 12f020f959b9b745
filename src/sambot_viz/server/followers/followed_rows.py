"""What a page of a follower is sent beside the scene: as the origin sends it."""

from __future__ import annotations

import gzip
from collections.abc import Callable, Iterable
from typing import Any, cast

import msgspec

from sambot_viz.panels.rows.row import Data, Json
from sambot_viz.panels.rows.row_store import COMPRESSED, ClientRows, RowStore

STATE = "follower/state"
"""The data of the page that says whom it follows."""


class LatestMessage:
    """A message of which only the newest counts, such as the camera to show."""

    def __init__(self) -> None:
        self.version = 0
        self.listeners: list[Callable[[], object]] = []
        self._message: str | bytes | None = None

    def take(self, message: str | bytes) -> None:
        """Show another one."""
        self.version += 1
        self._message = message
        for listener in tuple(self.listeners):
            listener()

    def since(self, version: int) -> tuple[int, str | bytes | None]:
        """Return the present version, and the message for who has another one."""
        return self.version, None if version == self.version else self._message


class FollowedRows:
    """Rows and data that come from another server.

    All is called on the event loop.

    Attributes:
        all: what each page is sent.
    """

    def __init__(self) -> None:
        self._stores = {scope: RowStore(scope) for scope in ("session", "browser")}
        self._panels = {scope: set[str]() for scope in self._stores}
        self._own, self._camera = RowStore("follower"), LatestMessage()
        stores = (self._own, *self._stores.values())
        self.all = ClientRows(stores, (self._camera,))

    def say(self, origin: str, trouble: str) -> None:
        """Say whom the pages follow.

        Args:
            origin: the address of the page where control can be requested; "" for
                none that is known.
            trouble: why what they show is not what is there now; "" when it is.
        """
        state: Json = {"origin": origin, "trouble": trouble}
        self._own.replace("follower", [Data(STATE, state).json()])
        self._own.tell()

    def replace(self, messages: Iterable[bytes]) -> None:
        """Show the rows of a snapshot."""
        for message in messages:
            self.take(message)

    def take(self, message: bytes) -> None:
        """Take what the origin sends to a page.

        Raises:
            ValueError: it is not a message of a server of the same version.
        """
        packed = message[:1] == COMPRESSED
        if not packed and message[:1] != b"{":
            # A picture, which no page has asked this server for.
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
