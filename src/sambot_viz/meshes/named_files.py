"""Files that a mesh file names: its materials, images and buffers.

Mesh files come from anywhere, so a name in one may lead anywhere. A model that is not
trusted may use only files below the folders it was opened from, and every file has a
largest size.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from pathlib import Path, PureWindowsPath
from urllib.parse import unquote

from sambot_viz.errors import SambotVizError
from sambot_viz.files import is_below, is_lfs_pointer, read_limited, reason_of

_FOLDERS = ("", "textures", "../materials/textures", "../textures")
_OF_PACKAGES = re.compile("(?:model|package)://([^/].*)")
_MAX_UP = 6
"""Number of folders above the mesh to search for packages."""


class NamedFileError(SambotVizError):
    """A file that a mesh names and that cannot be used; the text says why."""


class LfsPointerError(NamedFileError):
    """A git-LFS pointer in place of the file itself."""


class NamedFiles:
    """Finds and reads the files that one mesh file names.

    Args:
        mesh: the mesh file.
        roots: resolved folders that the files must be in, links followed; None for no
            limit.

    Attributes:
        used: the files that were read, each once.
    """

    def __init__(self, mesh: Path, roots: Sequence[Path] | None = None) -> None:
        self.used: list[Path] = []
        self._mesh = mesh
        self._roots = roots

    def find(self, name: str) -> Path:
        """Return the file that a name in the mesh file means.

        It is searched relative to the mesh, in any letter case, and by its last part
        beside the mesh, in `textures` and in `../materials/textures`: exporters write
        paths of the machine they ran on. `model://` and `package://` name a folder
        above the mesh, or one beside such a folder.

        Args:
            name: as written in the mesh; may be a URI, percent-encoded, or a Windows
                path.

        Raises:
            NamedFileError: there is no such file, or it is outside the folders. Nothing
                outside is read, so the text is the same for every name.
        """
        outside = False
        for path, meant in self._candidates(name):
            if self._roots is not None and not is_below(path, self._roots):
                outside = outside or meant
                continue
            found = _any_letter_case(path, self._roots)
            if found is not None:
                return found
        if outside:
            raise NamedFileError("it is outside the model's folder")
        raise NamedFileError("there is no such file")

    def read(self, name: str, largest: int) -> bytes:
        """Return the bytes of a file that the mesh names.

        Args:
            name: as for `find`.
            largest: refuse more than this [bytes].

        Raises:
            NamedFileError: not found, not allowed, not readable, too large, or a
                git-LFS pointer.
        """
        path = self.find(name)
        try:
            data = read_limited(path, largest)
        except (OSError, ValueError) as error:
            raise NamedFileError(reason_of(error)) from error
        self.note(path)
        if is_lfs_pointer(data):
            raise LfsPointerError("it is a git-LFS pointer; run 'git lfs pull'")
        return data

    def note(self, path: Path) -> None:
        """Remember that a file was read, so that it is watched for changes."""
        if path not in self.used:
            self.used.append(path)

    def _candidates(self, name: str) -> Iterator[tuple[Path, bool]]:
        """Yield paths to try; True for those that the name itself says."""
        plain = name.strip().removeprefix("file://")
        folder = self._mesh.parent
        for text in dict.fromkeys((plain, unquote(plain))):
            if not text or "\0" in text:
                continue
            if package := _OF_PACKAGES.fullmatch(text):
                for above in list(self._mesh.absolute().parents)[:_MAX_UP]:
                    yield above / package[1], True
            yield folder / text.replace("\\", "/"), True
            base = PureWindowsPath(text).name
            if base:
                for beside in _FOLDERS:
                    yield folder / beside / base, False


def _any_letter_case(path: Path, roots: Sequence[Path] | None) -> Path | None:
    """Return the file, or the one whose name differs only in letter case."""
    try:
        if path.is_file():
            return path
        lower = path.name.lower()
        for other in sorted(path.parent.iterdir()):
            if other.name.lower() == lower and other.is_file():
                return other if roots is None or is_below(other, roots) else None
    except OSError:
        return None
    return None
