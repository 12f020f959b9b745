"""Every mesh file is read once, whoever asks for it and however often."""

from __future__ import annotations

import contextlib
import threading
from dataclasses import dataclass
from pathlib import Path

from sambot_viz.meshes.asset import Asset
from sambot_viz.meshes.mesh import Mesh, MeshError, Texture, mesh_error
from sambot_viz.meshes.read_mesh import LARGEST, read_mesh
from sambot_viz.meshes.textures import LONGEST_SIDE, TextureError, TextureStore

_Stamp = tuple[tuple[Path, int, int], ...]


@dataclass(frozen=True, slots=True)
class _Entry:
    """What came of a file, and the state of all files that were read for it."""

    stamp: _Stamp
    outcome: Mesh | MeshError

    @property
    def files(self) -> tuple[Path, ...]:
        return tuple(path for path, *_ in self.stamp)


class MeshStore:
    """Meshes and textures by file; safe to use from several threads.

    A file is read again when it, or an image or material file it names, was saved
    since (time of change or size differ).
    """

    def __init__(
        self, *, longest_side: int = LONGEST_SIDE, largest: int = LARGEST
    ) -> None:
        """Limits for everything read through this store.

        Args:
            longest_side: textures are made this small [pixels].
            largest: meshes above this size are refused [bytes].
        """
        self.images = TextureStore(longest_side)
        self._largest = largest
        self._entries: dict[Asset, _Entry] = {}
        self._locks: dict[Asset, threading.Lock] = {}
        self._guard = threading.Lock()

    def get(self, path: Path, roots: tuple[Path, ...] | None = None) -> Mesh:
        """The mesh in a file, the same object as long as the file does not change.

        Args:
            path: the file.
            roots: folders it may use, as for `read_mesh`.

        Raises:
            MeshError: it cannot be drawn; see `read_mesh`.
        """
        # Two threads that want the same file wait for one reading; other files
        # are read at the same time.
        asset = Asset("mesh", path, roots)
        with self._guard:
            lock = self._locks.setdefault(asset, threading.Lock())
        with lock:
            entry = self._entries.get(asset)
            if entry is None or entry.stamp != _stamp(entry.files):
                entry = self._entries[asset] = self._read(asset)
        if isinstance(entry.outcome, MeshError):
            raise MeshError(entry.outcome.problem)
        return entry.outcome

    def texture(self, path: Path) -> Texture:
        """The image of a URDF <texture>.

        Raises:
            TextureError: it cannot be used; the text says why.
        """
        return self.images.from_file(path)

    def is_read(self, asset: Asset) -> bool:
        """Whether `get` or `texture` has its answer at hand, also a refusal."""
        if asset.kind == "texture":
            return self.images.is_read(asset.path)
        entry = self._entries.get(asset)
        return entry is not None and entry.stamp == _stamp(entry.files)

    def read(self, asset: Asset) -> None:
        """Read a file, so that `is_read` holds; a refusal is kept for `get`."""
        with contextlib.suppress(MeshError, TextureError):
            if asset.kind == "texture":
                self.texture(asset.path)
            else:
                self.get(asset.path, asset.roots)

    def files(self, asset: Asset) -> tuple[Path, ...]:
        """The file and, as far as it was read, the images and materials it names."""
        entry = self._entries.get(asset)
        return (asset.path,) if entry is None else entry.files

    def _read(self, asset: Asset) -> _Entry:
        path = asset.path
        before = _stamp((path,))
        try:
            mesh = read_mesh(
                path, images=self.images, largest=self._largest, roots=asset.roots
            )
        except MeshError as error:
            return _Entry(before, error)
        except Exception as error:
            # One file that finds a fault of ours must not hide the rest of the robot.
            return _Entry(before, _our_fault(path, error))
        return _Entry(before + _stamp(mesh.files[1:]), mesh)


def _our_fault(path: Path, error: Exception) -> MeshError:
    return mesh_error(
        path,
        "mesh-unreadable",
        f"reading the file failed by a fault of ours: {type(error).__name__}: {error}",
        "please report it, with the file",
    )


def _stamp(files: tuple[Path, ...]) -> _Stamp:
    stamps: list[tuple[Path, int, int]] = []
    for path in files:
        try:
            stat = path.stat()
            stamps.append((path, stat.st_mtime_ns, stat.st_size))
        except (OSError, ValueError):
            stamps.append((path, 0, -1))
    return tuple(stamps)
