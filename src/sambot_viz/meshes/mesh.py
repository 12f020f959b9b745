"""A mesh file as data: triangles, colours, textures, ready to be drawn.

Positions are in metres in the frame of the file, with the file's own unit and node
transforms applied and the scale of the URDF not yet applied.
"""

from __future__ import annotations

import weakref
from dataclasses import dataclass, field
from pathlib import Path
from typing import Literal

import numpy as np
import numpy.typing as npt

from sambot_viz.errors import Problem, RobotError
from sambot_viz.geometry import Rgba, Vector3

FloatArray = npt.NDArray[np.float32]
IndexArray = npt.NDArray[np.uint32]

GREY: Rgba = (0.6, 0.6, 0.6, 1.0)
"""RViz's colour where a file says nothing about it."""
WHITE: Rgba = (1.0, 1.0, 1.0, 1.0)


@dataclass(frozen=True, eq=False)
class Texture:
    """An image that a browser can show, encoded.

    The same image is the same object wherever it is used. There are no slots, because
    caches refer to it weakly.

    Attributes:
        data: the PNG or JPEG file, the original bytes where they were small enough.
        mime: which of the two it is.
        width: pixels.
        height: pixels.
    """

    data: bytes = field(repr=False)
    mime: Literal["image/png", "image/jpeg"]
    width: int
    height: int


@dataclass(frozen=True, eq=False)
class MeshPart:
    """All triangles of a file that look the same; nobody changes the arrays.

    There are no slots, because caches refer to it weakly.

    Attributes:
        vertices: (N, 3) float32 [m].
        faces: (M, 3) uint32, counter-clockwise seen from outside.
        normals: (N, 3) float32 unit normals; None means flat shaded. Vertices are
            shared exactly where position and normal (and uv) agree, so computing
            smooth normals from the faces gives much the same.
        rgba: the file's own colour, 0 to 1 as RViz shows it face on; None (STL) means
            that the URDF's material decides.
        uv: (N, 2) float32, v upwards (0 is the bottom of the image); None without a
            texture.
        texture: multiplies the colour, or None.
    """

    vertices: FloatArray
    faces: IndexArray
    normals: FloatArray | None = None
    rgba: Rgba | None = None
    uv: FloatArray | None = None
    texture: Texture | None = None


@dataclass(frozen=True, eq=False)
class Mesh:
    """A mesh file that can be drawn; it has at least one triangle.

    There are no slots, because caches refer to it weakly.

    Attributes:
        path: the file.
        parts: one per distinct look (colour, texture, flat or smooth).
        problems: what was doubtful: a recovered file, a missing texture.
        files: every file that was read for it, the mesh first.
    """

    path: Path
    parts: tuple[MeshPart, ...]
    problems: tuple[Problem, ...] = ()
    files: tuple[Path, ...] = ()

    @property
    def bounds(self) -> npt.NDArray[np.float64]:
        """The lowest and the highest corner, (2, 3) [m]."""
        lows = [part.vertices.min(axis=0) for part in self.parts]
        highs = [part.vertices.max(axis=0) for part in self.parts]
        return np.array([np.min(lows, axis=0), np.max(highs, axis=0)], dtype=np.float64)

    @property
    def triangles(self) -> int:
        """The number of triangles of all parts."""
        return sum(len(part.faces) for part in self.parts)


class MeshError(RobotError):
    """A mesh file that cannot be drawn; `problem` says why in one sentence."""

    def __init__(self, problem: Problem) -> None:
        self.problem = problem
        super().__init__([problem])


def mesh_error(path: Path, code: str, message: str, hint: str = "") -> MeshError:
    """Return a `MeshError` about a file."""
    problem = Problem.at(str(path), "error", code, message, hint, cause=message)
    return MeshError(problem)


_FARTHEST = 1e30
"""The largest coordinate [m]: corners are stored in 32 bits, where more is infinite."""


_scaled: weakref.WeakKeyDictionary[MeshPart, dict[Vector3, MeshPart]] = (
    weakref.WeakKeyDictionary()
)


def apply_scale(part: MeshPart, scale: Vector3) -> MeshPart:
    """Return the part enlarged by a URDF scale: the same object for all who ask.

    A mirrored part (an odd number of negative factors) is turned inside out by the
    scale, so its triangles are turned back: RViz shows it from outside too.

    Args:
        part: what to scale.
        scale: factors along x, y, z of the mesh; may be negative or differ.
    """
    if scale == (1.0, 1.0, 1.0):
        return part
    known = _scaled.setdefault(part, {})
    if scale not in known:
        known[scale] = _scale(part, scale)
    return known[scale]


def _scale(part: MeshPart, scale: Vector3) -> MeshPart:
    factors = np.array(scale, dtype=np.float64)
    normals = part.normals
    if normals is not None:
        # A normal is stretched the other way; the cofactors stay finite at zero.
        x, y, z = scale
        cofactors = np.array([y * z, x * z, x * y])
        bent = normals * (cofactors * (np.sign(np.prod(factors)) or 1.0))
        lengths = np.linalg.norm(bent, axis=1, keepdims=True)
        normals = np.where(lengths > 0, bent / np.where(lengths > 0, lengths, 1), 0)
        normals = normals.astype(np.float32)
    faces = part.faces
    if np.prod(np.sign(factors)) < 0:
        faces = np.ascontiguousarray(faces[:, ::-1])
    return MeshPart(
        vertices=np.minimum(
            np.maximum(part.vertices * factors, -_FARTHEST), _FARTHEST
        ).astype(np.float32),
        faces=faces,
        normals=normals,
        rgba=part.rgba,
        uv=part.uv,
        texture=part.texture,
    )
