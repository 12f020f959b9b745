"""Mesh files and textures, as displays ask the mesh cache for them."""

from __future__ import annotations

from pathlib import Path
from typing import Literal, NamedTuple


class Asset(NamedTuple):
    """A file that has to be read before a shape can be drawn.

    Attributes:
        kind: a mesh, or the image of a URDF <texture>.
        path: the file.
        roots: resolved folders that it, and the files it names, must be in; None for
            a trusted model, whose files may be anywhere.
    """

    kind: Literal["mesh", "texture"]
    path: Path
    roots: tuple[Path, ...] | None = None
