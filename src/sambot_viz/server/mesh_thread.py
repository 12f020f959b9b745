"""The background thread that reads mesh files and textures for all sessions."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from typing import Protocol

from sambot_viz.meshes.asset import Asset
from sambot_viz.meshes.cache import MeshCache

REPORT_PERIOD = 0.1
"""What was read is handed over this often [s] at most; it costs every browser."""

LARGE = 500_000
"""Before a file above this size is read, the others are handed over [B]."""


class MeshListener(Protocol):
    """A session that waits for files."""

    def arrived(self, assets: frozenset[Asset]) -> None:
        """These files have been read; called in the reading thread."""


class MeshThread:
    """Reads files one after the other, in the order in which they are asked for.

    There is one thread for all sessions: reading is mostly Python's own work, so a
    second thread would only take time from the first, and from the sliders.

    Args:
        cache: where the content goes.
        on_error: called with what a listener raised; the thread goes on.
    """

    def __init__(self, cache: MeshCache, on_error: Callable[[Exception], None]) -> None:
        self._cache = cache
        self._on_error = on_error
        self._changed = threading.Condition()
        self._wanted: dict[Asset, list[MeshListener]] = {}
        self._thread: threading.Thread | None = None
        self._closed = False
        self._reporting = threading.RLock()

    def request(self, asset: Asset, listener: MeshListener) -> None:
        """Read a file soon, then call the listener, with several files at a time."""
        with self._changed:
            if self._closed:
                return
            listeners = self._wanted.setdefault(asset, [])
            if listener not in listeners:
                listeners.append(listener)
            if self._thread is None:
                self._thread = threading.Thread(
                    target=self._run, name="sambot-viz-meshes", daemon=True
                )
                self._thread.start()
            self._changed.notify_all()

    def close(self) -> None:
        """Read no further file and wait for a listener that is running."""
        with self._changed:
            self._closed = True
            self._wanted.clear()
            self._changed.notify_all()
        with self._reporting:
            return

    def _run(self) -> None:
        done: dict[MeshListener, set[Asset]] = {}
        reported = float("-inf")
        while not self._closed:
            asset = self._next(wait=not done)
            late = time.monotonic() - reported >= REPORT_PERIOD
            if done and (asset is None or late or _is_large(asset)):
                self._report(done)
                done = {}
                reported = time.monotonic()
            elif asset is not None:
                self._cache.read(asset)
                with self._changed:
                    for listener in self._wanted.pop(asset, ()):
                        done.setdefault(listener, set()).add(asset)

    def _report(self, done: dict[MeshListener, set[Asset]]) -> None:
        with self._reporting:
            for listener, assets in done.items():
                if self._closed:
                    return
                try:
                    listener.arrived(frozenset(assets))
                except Exception as error:
                    # One session that fails must not end reading for all others.
                    self._on_error(error)

    def _next(self, wait: bool) -> Asset | None:
        """The file to read next; None when there is none, or after `close`."""
        with self._changed:
            if wait:
                self._changed.wait_for(lambda: self._wanted or self._closed)
            return next(iter(self._wanted), None)


def _is_large(asset: Asset) -> bool:
    """Whether what is read already should not wait for this file."""
    try:
        return asset.path.stat().st_size > LARGE
    except (OSError, ValueError):
        return False
