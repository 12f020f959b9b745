"""Files that a server hands out, each fetched once for all browsers.

A robot of thirty meshes shown in thirty browsers asks the robot for thirty files. What
was fetched holds until the server starts again.
"""

from __future__ import annotations

import threading
import time
from collections import OrderedDict
from concurrent.futures import Future
from dataclasses import dataclass, field

from sambot_viz import limits
from sambot_viz.errors import Problem, SourceError
from sambot_viz.text import text

LONGEST_FETCH = 120.0
"""A file that has not come after this time is given up [s]: a mesh may be large."""


@dataclass(slots=True)
class _Asset:
    """A file that was asked for: its bytes, or the refusal, or who waits for it."""

    uri: str
    due: float
    request_id: int | None = None
    content: bytes | SourceError | None = None
    waiting: list[Future[bytes]] = field(default_factory=list[Future[bytes]])


class AssetStore:
    """Keeps fetched files, and the queue of requests."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._assets: OrderedDict[str, _Asset] = OrderedDict()
        self._size = 0
        self._last_id = 0

    def fetch(self, uri: str) -> Future[bytes]:
        """Return a future of a file; each caller gets its own."""
        future: Future[bytes] = Future()
        # It cannot be cancelled: the answer is on its way.
        future.set_running_or_notify_cancel()
        if len(uri) > limits.ASSET_NAME.value:
            size = limits.ASSET_NAME.said(len(uri))
            future.set_exception(
                not_served(uri, f"the address has {size}", "give the file a short name")
            )
            return future
        with self._lock:
            asset = self._assets.get(uri)
            if asset is None:
                asset = _Asset(uri, time.monotonic() + LONGEST_FETCH)
                self._assets[uri] = asset
            self._assets.move_to_end(uri)
            if asset.content is None:
                asset.waiting.append(future)
        if asset.content is not None:
            _settle([future], asset.content)
        return future

    def to_ask(self) -> list[tuple[int, str]]:
        """Return id and URI of each new request, once."""
        with self._lock:
            open_ones = [one for one in self._assets.values() if one.content is None]
            sent = sum(one.request_id is not None for one in open_ones)
            chosen = [one for one in open_ones if one.request_id is None]
            chosen = chosen[: max(0, limits.ASSETS_AT_ONCE.value - sent)]
            for asset in chosen:
                self._last_id = self._last_id % (2**32 - 1) + 1
                asset.request_id = self._last_id
            return [(one.request_id or 0, one.uri) for one in chosen]

    def answer(
        self, request_id: int, content: bytes, refused: str | None, hint: str
    ) -> None:
        """Accept the answer to a request; ignore it if nothing waits for it.

        Args:
            request_id: the id from `to_ask`.
            content: the file.
            refused: the server's reason for a refusal; None if it has sent the file.
            hint: what to do about the refusal.
        """
        with self._lock:
            open_ones = (one for one in self._assets.values() if one.content is None)
            asset = next((a for a in open_ones if a.request_id == request_id), None)
            if asset is None:
                return
            if refused is None:
                asset.content = content
            else:
                reason = f"the server says: {text(refused, 300)}"
                asset.content = not_served(asset.uri, reason, hint)
            self._size += _size(asset.content)
            self._shrink()
        _settle(asset.waiting, asset.content)

    def ask_again(self) -> None:
        """Begin a new connection: what was on its way is asked for again."""
        with self._lock:
            for asset in self._assets.values():
                if asset.content is None:
                    asset.request_id = None

    def forget(self) -> None:
        """Begin a new session of the server: its files may be others."""
        with self._lock:
            for asset in [
                one for one in self._assets.values() if one.content is not None
            ]:
                del self._assets[asset.uri]
            self._size = 0

    def expire(self, reason: str) -> None:
        """Give up what has not come in time; it may be asked for again."""
        self._give_up(reason, "", time.monotonic())

    def refuse_all(self, reason: str, hint: str = "") -> None:
        """Give up everything that has not come."""
        self._give_up(reason, hint, float("inf"))

    def _give_up(self, reason: str, hint: str, until: float) -> None:
        with self._lock:
            late = [
                one
                for one in self._assets.values()
                if one.content is None and one.due <= until
            ]
            for asset in late:
                del self._assets[asset.uri]
        for asset in late:
            _settle(asset.waiting, not_served(asset.uri, reason, hint))

    def _shrink(self) -> None:
        done = [one for one in self._assets.values() if one.content is not None]
        for asset in done:
            if self._size <= limits.ASSET.value:
                break
            self._size -= _size(asset.content)
            del self._assets[asset.uri]


def not_served(uri: str, reason: str, hint: str = "") -> SourceError:
    """Return the error for a file that cannot be had."""
    message = f"{text(uri, 200)}: {reason}"
    return SourceError([Problem("error", "mesh-not-served", message, hint)])


def _size(content: bytes | SourceError | None) -> int:
    return len(content) if isinstance(content, bytes) else 100


def _settle(waiting: list[Future[bytes]], content: bytes | SourceError) -> None:
    for future in waiting:
        if isinstance(content, bytes):
            future.set_result(content)
        else:
            future.set_exception(content)
