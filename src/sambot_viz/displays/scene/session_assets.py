"""The mesh files and textures of one session: read ones, and those being read."""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import Protocol
from weakref import WeakSet

from sambot_viz.meshes.asset import Asset
from sambot_viz.meshes.cache import Content, MeshCache


class Reader(Protocol):
    """Reads files in the background."""

    def request(self, asset: Asset, listener: SessionAssets) -> None:
        """Read a file soon, then call `SessionAssets.arrived`."""


class AssetUser(Protocol):
    """A shape that is drawn from a file."""

    @property
    def asset(self) -> Asset | None:
        """The file, or None when it needs none."""


class SessionAssets:
    """Gives displays their files as soon as these are read.

    Args:
        cache: the files that are read already.
        reader: reads the others in the background; None reads them on demand.
        on_read: called after some files have been read in the background.

    Attributes:
        cache: as given.
        read_count: number of files that have been read in the background so far.
    """

    def __init__(
        self,
        cache: MeshCache,
        reader: Reader | None = None,
        on_read: Callable[[], None] | None = None,
    ) -> None:
        self.read_count = 0
        self.cache = cache
        self._reader = reader
        self._on_read = on_read
        self._changed = threading.Condition()
        self._users: WeakSet[AssetUser] = WeakSet()
        self._pending: set[Asset] = set()
        self._total = 0
        self._drawing = False

    @property
    def progress(self) -> tuple[int, int] | None:
        """Number of files read and in all, or None when all have been read."""
        with self._changed:
            if not self._pending:
                return None
            return (self._total - len(self._pending), self._total)

    @property
    def used(self) -> set[Asset]:
        """The files of all shapes that there are."""
        with self._changed:
            return {user.asset for user in self._users if user.asset is not None}

    def register(self, user: AssetUser) -> None:
        """Keep the content of a shape's file as long as the shape exists."""
        with self._changed:
            self._users.add(user)

    def look_again(self) -> None:
        """Files may have changed: those that have are read again."""
        self.cache.forget_changed()

    def known(self, asset: Asset) -> Content | None:
        """Return the content of a file that has been read already, or None."""
        return self.cache.known(asset)

    def content(self, asset: Asset) -> Content | None:
        """Return the content of a file; None while it is read in the background."""
        if self._reader is None:
            return self.cache.read(asset)
        content = self.cache.known(asset)
        if content is None:
            with self._changed:
                if asset not in self._pending:
                    self._pending.add(asset)
                    self._total += 1
            self._reader.request(asset, self)
        return content

    def wait(self, timeout: float) -> bool:
        """Wait until everything that was asked for is read and drawn.

        Args:
            timeout: [s].

        Returns:
            Whether it is.
        """
        with self._changed:
            return self._changed.wait_for(
                lambda: not (self._pending or self._drawing), timeout
            )

    def arrived(self, assets: frozenset[Asset]) -> None:
        """These files have been read: draw them."""
        with self._changed:
            self._pending -= assets
            self.read_count += len(assets)
            if not self._pending:
                self._total = 0
            self._drawing = True
        try:
            if self._on_read is not None:
                self._on_read()
        finally:
            with self._changed:
                self._drawing = False
                self._changed.notify_all()
