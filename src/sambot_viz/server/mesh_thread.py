"""The background thread that reads mesh files and textures for all sessions."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from typing import Protocol

from sambot_viz.meshes.asset import Asset
from sambot_viz.meshes.cache import MeshCache

REPORT_PERIOD = 0.1
"""Shortest time between two deliveries [s]; each delivery costs every browser."""

LARGE = 500_000
"""Before the thread reads a file above this size, it delivers the others [B]."""


class MeshListener(Protocol):
    """A session that waits for files."""

    def arrived(self, assets: frozenset[Asset]) -> None:
        """Handle files that the thread has read; called in the reading thread."""


class MeshThread:
    """Reads files one at a time, in the order of the requests.

    All sessions share one thread: reading is mostly work in Python, so a second thread
    would only take time from the first one and from the sliders.

    Args:
        cache: stores the contents.
        on_error: called with an exception of a listener; the thread continues.
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
        """Stop reading, and wait for a running listener."""
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
                    # A failing session must not stop the reading for the others.
                    self._on_error(error)

    def _next(self, wait: bool) -> Asset | None:
        """Return the next file to read; None without one, or after `close`."""
        with self._changed:
            if wait:
                self._changed.wait_for(lambda: self._wanted or self._closed)
            return next(iter(self._wanted), None)


def _is_large(asset: Asset) -> bool:
    """Return whether the files read so far should not wait for this one."""
    try:
        return asset.path.stat().st_size > LARGE
    except (OSError, ValueError):
        return False
