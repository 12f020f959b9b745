"""The mesh files and textures of one session: what is read, and what is on its way."""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import Protocol

from sambot_viz.errors import Problem
from sambot_viz.meshes.asset import Asset
from sambot_viz.meshes.cache import MeshStore
from sambot_viz.meshes.mesh import Mesh, MeshError, Texture
from sambot_viz.meshes.textures import TextureError

AssetContent = Mesh | Texture | Problem | None
"""What was read from a file, or why it cannot be used; None before that."""
_MEND = "save the image anew as PNG or JPEG"


class Reader(Protocol):
    """What reads files in the background."""

    def request(
        self, asset: Asset, on_read: Callable[[frozenset[Asset]], None]
    ) -> None:
        """Read a file soon, then call back."""


class SessionAssets:
    """Gives displays what they draw from as soon as it is read.

    Args:
        meshes: what is read already.
        reader: reads the rest in the background; None reads it when it is asked for.
        on_read: called after some files have been read in the background.

    Attributes:
        generation: grows when files may have changed; what was drawn in an earlier one
            is compared with its file again.
        read_count: how many files have been read in the background so far.
    """

    def __init__(
        self,
        meshes: MeshStore,
        reader: Reader | None = None,
        on_read: Callable[[], None] | None = None,
    ) -> None:
        self.generation = 0
        self.read_count = 0
        self._meshes = meshes
        self._reader = reader
        self._on_read = on_read
        self._changed = threading.Condition()
        self._pending: set[Asset] = set()
        self._total = 0
        self._drawing = False

    @property
    def progress(self) -> tuple[int, int] | None:
        """How many files of how many have been read, or None when all have been."""
        with self._changed:
            if not self._pending:
                return None
            return (self._total - len(self._pending), self._total)

    def look_again(self) -> None:
        """Files may have changed: what is drawn from them is to be compared."""
        self.generation += 1

    def is_there(self, asset: Asset) -> bool:
        """Whether a file can be taken now; if not, it is read in the background."""
        if self._reader is None or self._meshes.is_read(asset):
            return True
        with self._changed:
            if asset not in self._pending:
                self._pending.add(asset)
                self._total += 1
        self._reader.request(asset, self._arrived)
        return False

    def take(self, asset: Asset) -> AssetContent:
        """What is in a file, or why it cannot be drawn."""
        try:
            if asset.kind == "mesh":
                return self._meshes.get(asset.path, asset.roots)
            return self._meshes.texture(asset.path)
        except MeshError as error:
            return error.problem
        except TextureError as error:
            place = str(asset.path)
            text = f"the texture {asset.path.name} cannot be used: {error}"
            return Problem("warning", "texture-unreadable", text, _MEND, place)

    def known(self, asset: Asset) -> AssetContent:
        """What is in a file, if it has been read already; nothing is read for it."""
        return self.take(asset) if self._meshes.is_read(asset) else None

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

    def _arrived(self, assets: frozenset[Asset]) -> None:
        with self._changed:
            self._pending -= assets
            self.read_count += len(assets)
            if not self._pending:
                self._total = 0
            self._drawing = True
        if self._on_read is not None:
            self._on_read()
        with self._changed:
            self._drawing = False
            self._changed.notify_all()
