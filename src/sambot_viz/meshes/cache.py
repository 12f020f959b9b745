"""Mesh files and textures, each read once, whoever asks for it and however often."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path

from sambot_viz import limits
from sambot_viz.errors import Problem
from sambot_viz.files import Stamp, is_below, stamp
from sambot_viz.meshes.asset import Asset
from sambot_viz.meshes.mesh import Mesh, MeshError, Texture
from sambot_viz.meshes.read_mesh import read_mesh
from sambot_viz.meshes.textures import TextureError, TextureStore

Content = Mesh | Texture | Problem
"""The content of a file, or the reason why it cannot be drawn."""


@dataclass(frozen=True, slots=True)
class _Entry:
    """The content of an asset, and the stamps of the files it was read from."""

    content: Content
    stamps: Mapping[Path, Stamp | None]

    @property
    def unchanged(self) -> bool:
        return all(stamp(path) == before for path, before in self.stamps.items())


class MeshCache:
    """The content of mesh files and textures; safe to use from several threads.

    What was read stays the same object until `forget_changed` finds that the file, or
    an image or a material file that it names, was saved since.

    Attributes:
        on_read: called after a file was read, in the thread that has read it.
    """

    def __init__(
        self,
        *,
        longest_side: int = limits.TEXTURE_SIDE.value,
        largest: int = limits.MESH.value,
    ) -> None:
        """Set the limits for everything read through this cache.

        Args:
            longest_side: textures are made this small [pixels].
            largest: meshes above this size are refused [bytes].
        """
        self.on_read: Callable[[], object] = lambda: None
        self._images = TextureStore(longest_side)
        self._largest = largest
        self._entries: dict[Asset, _Entry] = {}
        self._locks: dict[Asset, threading.Lock] = {}
        self._guard = threading.Lock()

    def known(self, asset: Asset) -> Content | None:
        """Return what was read from a file, or None when it has not been read."""
        entry = self._entries.get(asset)
        return None if entry is None else entry.content

    def read(self, asset: Asset) -> Content:
        """Return the content of a file, from the cache or by reading it."""
        # Two threads that want the same file wait for one reading; other files
        # are read at the same time.
        with self._guard:
            lock = self._locks.setdefault(asset, threading.Lock())
        with lock:
            entry = self._entries.get(asset)
            if entry is None:
                entry = self._entries[asset] = self._read(asset)
                self.on_read()
        return entry.content

    def files(self, asset: Asset) -> tuple[Path, ...]:
        """List the file and, as far as it was read, the images and materials in it."""
        entry = self._entries.get(asset)
        return (asset.path,) if entry is None else tuple(entry.stamps)

    def forget_changed(self) -> None:
        """Forget what was read from files that were saved since."""
        for asset, entry in list(self._entries.items()):
            if not entry.unchanged:
                self._forget(asset)

    def keep_only(self, assets: Iterable[Asset]) -> None:
        """Forget all but these, so that a long day of saves does not fill memory."""
        kept = set(assets)
        for asset in list(self._entries):
            if asset not in kept:
                self._forget(asset)

    def _forget(self, asset: Asset) -> None:
        with self._guard:
            self._entries.pop(asset, None)
            self._locks.pop(asset, None)

    def _read(self, asset: Asset) -> _Entry:
        stamps = {asset.path: stamp(asset.path)}
        content: Content
        try:
            if asset.kind == "texture":
                content = self._texture(asset)
            else:
                content = read_mesh(
                    asset.path,
                    images=self._images,
                    largest=self._largest,
                    roots=asset.roots,
                )
                stamps.update((path, stamp(path)) for path in content.files[1:])
        except MeshError as error:
            content = error.problem
        except Exception as error:
            # One bad file must not hide the rest of the robot; the page shows this.
            content = Problem.at(
                str(asset.path),
                "error",
                "mesh-unreadable",
                f"internal error while reading the file: {type(error).__name__}: "
                f"{error}",
                "please report it, with the file",
            )
        return _Entry(content, stamps)

    def _texture(self, asset: Asset) -> Texture | Problem:
        """Return the image of a URDF <texture>, or why it cannot be used."""
        try:
            if asset.roots is not None and not is_below(asset.path, asset.roots):
                raise TextureError("it is outside the model's folder")
            return self._images.from_file(asset.path)
        except TextureError as error:
            return Problem.at(
                str(asset.path),
                "warning",
                "texture-unreadable",
                f"the texture {asset.path.name} cannot be used: {error}",
                "save the image again as PNG or JPEG",
            )
