"""Reading mesh files and textures in a thread, so that nobody waits for them."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Mapping

from sambot_viz.meshes.asset import Asset
from sambot_viz.meshes.cache import MeshStore

TELL_PERIOD = 0.1
"""What was read is handed over at most so often [s]: every time costs each browser."""

LARGE = 500_000
"""Before a file above this size is read, the others are handed over [B]."""

OnRead = Callable[[frozenset[Asset]], None]


class AssetReader:
    """Reads files one after the other, in the order in which they are asked for.

    One thread for all sessions: reading is Python's own work for the most part, a
    second thread would only take time from the first, and from the sliders.

    Args:
        meshes: where the meshes and textures go.
    """

    def __init__(self, meshes: MeshStore) -> None:
        self._meshes = meshes
        self._changed = threading.Condition()
        self._wanted: dict[Asset, list[OnRead]] = {}
        self._thread: threading.Thread | None = None
        self._closed = False
        self._telling = threading.RLock()

    def request(self, asset: Asset, on_read: OnRead) -> None:
        """Read a file soon.

        Args:
            asset: the file.
            on_read: called in the reading thread with this file, and others that were
                asked for with the same function and have been read meanwhile.
        """
        with self._changed:
            if self._closed:
                return
            callbacks = self._wanted.setdefault(asset, [])
            if on_read not in callbacks:
                callbacks.append(on_read)
            if self._thread is None:
                self._thread = threading.Thread(
                    target=self._run, name="sambot-viz-read", daemon=True
                )
                self._thread.start()
            self._changed.notify_all()

    def close(self) -> None:
        """Read nothing any more; the file that is being read is read to its end."""
        with self._changed:
            self._closed = True
            self._wanted.clear()
            self._changed.notify_all()
        with self._telling:
            # Who is being told now must have ended before the server goes.
            return

    def _run(self) -> None:
        done: dict[OnRead, set[Asset]] = {}
        told = float("-inf")
        while not self._closed:
            asset = self._next(wait=not done)
            late = time.monotonic() - told >= TELL_PERIOD
            if done and (asset is None or late or _takes_long(asset)):
                self._tell(done)
                done.clear()
                told = time.monotonic()
            elif asset is not None:
                self._meshes.read(asset)
                with self._changed:
                    for on_read in self._wanted.pop(asset, ()):
                        done.setdefault(on_read, set()).add(asset)

    def _tell(self, done: Mapping[OnRead, set[Asset]]) -> None:
        with self._telling:
            for on_read, assets in done.items():
                if not self._closed:
                    on_read(frozenset(assets))

    def _next(self, wait: bool) -> Asset | None:
        """The file to read next; None when there is none, or all is over."""
        with self._changed:
            if wait:
                self._changed.wait_for(lambda: self._wanted or self._closed)
            return next(iter(self._wanted), None)


def _takes_long(asset: Asset) -> bool:
    """Whether what is read already should not wait for this file."""
    try:
        return asset.path.stat().st_size > LARGE
    except (OSError, ValueError):
        return False
