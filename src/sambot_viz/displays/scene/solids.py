"""The solids that RViz builds its markers from: axes, arrows, unit shapes.

Sizes and colours are RViz's (docs/rviz-facts.md). Every solid is
flat shaded; the page script lights it as RViz does.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cache, lru_cache

import numpy as np
import numpy.typing as npt
import viser

from sambot_viz.geometry import (
    Vector3,
    Wxyz,
    rotation_from_xyzw,
    wxyz_from_z,
    wxyz_product,
)
from sambot_viz.meshes.glb import srgb_to_linear
from sambot_viz.meshes.primitives import (
    Primitive,
    unit_box,
    unit_cone,
    unit_cylinder,
    unit_sphere,
)

Rgb = tuple[int, int, int]

_HALF = math.sqrt(0.5)
AXIS_WXYZ: tuple[Wxyz, ...] = (
    (_HALF, 0.0, _HALF, 0.0),
    (_HALF, -_HALF, 0.0, 0.0),
    (1.0, 0.0, 0.0, 0.0),
)
UPSIDE_DOWN: Wxyz = (0.0, 1.0, 0.0, 0.0)
AXIS_COLORS: tuple[Rgb, ...] = ((255, 0, 0), (0, 255, 0), (0, 0, 255))


@cache
def linear(channel: int) -> float:
    """Return an 8-bit sRGB channel in linear colour space, 0 to 1."""
    return srgb_to_linear(channel / 255)


@dataclass(frozen=True, slots=True, eq=False)
class Compact:
    """A unit shape with shared corners, for viser's own flat shading."""

    vertices: npt.NDArray[np.float32]
    faces: npt.NDArray[np.uint32]


def _compact(shape: Primitive) -> Compact:
    rounded: npt.NDArray[np.float32] = np.round(shape.vertices, 6)
    rows = [tuple(row) for row in rounded.tolist()]
    corners = {row: i for i, row in enumerate(dict.fromkeys(rows))}
    index = np.array([corners[row] for row in rows], dtype=np.uint32)
    return Compact(np.array(list(corners), dtype=np.float32), index[shape.faces])


@cache
def cylinder() -> Compact:
    """Return a 16-sided cylinder along z, diameter 1, height 1."""
    return _compact(unit_cylinder())


@cache
def cone() -> Compact:
    """Return a 16-sided cone along z, diameter 1, height 1, tip up."""
    return _compact(unit_cone())


@cache
def box() -> Compact:
    """Return a cube, edge 1."""
    return _compact(unit_box())


@cache
def sphere() -> Compact:
    """RViz's sphere of 224 triangles, diameter 1, poles on z."""
    return _compact(unit_sphere())


def add_batch(
    scene: viser.SceneApi,
    name: str,
    shape: Compact,
    wxyzs: Sequence[Wxyz],
    positions: Sequence[Vector3],
    scales: Sequence[Vector3],
    colors: Sequence[Rgb],
    alphas: Sequence[float] = (),
    scale: float = 1.0,
) -> viser.BatchedMeshHandle:
    """One node for several copies of a unit shape (see the fields of viser).

    Alphas are 0 to 1; none for opaque copies. The scale is that of the node.

    Colours are sRGB as everywhere here; viser takes those of batches as linear.
    """
    linear_colors = [[round(255 * linear(c)) for c in rgb] for rgb in colors]
    return scene.add_batched_meshes_simple(
        name,
        shape.vertices,
        shape.faces,
        np.array(wxyzs, dtype=np.float32),
        np.array(positions, dtype=np.float32),
        batched_scales=np.array(scales, dtype=np.float32),
        batched_colors=np.array(linear_colors, dtype=np.uint8),
        batched_opacities=(
            np.array(alphas, dtype=np.float32) if min(alphas, default=1.0) < 1 else None
        ),
        lod="off",
        flat_shading=True,
        cast_shadow=False,
        receive_shadow=False,
        scale=scale,
    )


def _placed(
    shape: Compact, wxyz: Wxyz, position: Vector3, scale: Vector3
) -> npt.NDArray[np.float32]:
    """Return the corners of a copy of a unit shape, (V, 3) [m]."""
    w, x, y, z = wxyz
    R = np.array(rotation_from_xyzw((x, y, z, w)))
    placed = (shape.vertices * scale) @ np.transpose(R) + position
    return placed.astype(np.float32)


def _merged(copies: Iterable[tuple[Compact, Wxyz, Vector3, Vector3]]) -> Compact:
    """Copies of unit shapes as one, each with its rotation, position and scale."""
    vertices: list[npt.NDArray[np.float32]] = []
    faces: list[npt.NDArray[np.uint32]] = []
    count = 0
    for shape, wxyz, position, scale in copies:
        vertices.append(_placed(shape, wxyz, position, scale))
        faces.append(shape.faces + np.uint32(count))
        count += len(shape.vertices)
    return Compact(np.concatenate(vertices), np.concatenate(faces))


@lru_cache(maxsize=100)
def axes_triangles(length: float, diameter: float) -> Compact:
    """Return the triangles that `add_axes` draws."""
    return _merged(
        (cylinder(), wxyz, position, _thick((length, diameter)))
        for wxyz, position in zip(AXIS_WXYZ, _middles(length), strict=True)
    )


@lru_cache(maxsize=1000)
def arrow_triangles(arrows: tuple[Arrow, ...]) -> Compact:
    """Return the triangles that `add_arrows` draws; there must be an arrow."""
    copies: list[tuple[Compact, Wxyz, Vector3, Vector3]] = []
    for arrow in arrows:
        turn, shaft_at, head_at = arrow.parts()
        copies.append((cylinder(), turn, shaft_at, _thick(arrow.shaft)))
        copies.append((cone(), turn, head_at, _thick(arrow.head)))
    return _merged(copies)


def _thick(part: tuple[float, float]) -> Vector3:
    """Return the scale of a part with a length and a diameter.

    A mirrored copy would show its inside; a turned one looks the same.
    """
    length, diameter = abs(part[0]), abs(part[1])
    return (diameter, diameter, length)


def add_axes(
    scene: viser.SceneApi,
    name: str,
    length: float,
    diameter: float,
    colors: Sequence[Rgb] = AXIS_COLORS,
    alpha: float = 1.0,
    scale: float = 1.0,
) -> viser.BatchedMeshHandle:
    """Three cylinders from the origin along +x (red), +y (green) and +z (blue).

    Args:
        scene: where to draw.
        name: node name; the axes are drawn at the frame of its parent.
        length: [m].
        diameter: what RViz calls "radius" is the diameter of the cylinders [m].
        colors: of the three.
        alpha: 0 to 1.
        scale: of the node, which can be changed later.
    """
    scales = [(diameter, diameter, length)] * 3
    return add_batch(
        scene,
        name,
        cylinder(),
        AXIS_WXYZ,
        _middles(length),
        scales,
        colors,
        [alpha] * 3,
        scale,
    )


def _middles(length: float) -> list[Vector3]:
    """Return the middles of three axes."""
    half = length / 2
    return [(half, 0.0, 0.0), (0.0, half, 0.0), (0.0, 0.0, half)]


def arrow_wxyz(direction: Vector3) -> Wxyz:
    """Return the rotation of z into a direction by which RViz turns arrows.

    It is the shortest one of −z after a half turn, so that the sides of shaft and head
    face where RViz's face.
    """
    x, y, z = direction
    return wxyz_product(UPSIDE_DOWN, wxyz_from_z((x, -y, -z)))


@dataclass(frozen=True, slots=True)
class Arrow:
    """An arrow as RViz draws it: a shaft, and a head at its end.

    Attributes:
        start: where the shaft begins [m].
        direction: towards the tip; any length but 0.
        shaft: length and diameter of the shaft [m].
        head: length and diameter of the head [m].

    A part of a negative length goes backwards from where it begins, as in RViz.
    """

    start: Vector3
    direction: Vector3
    shaft: tuple[float, float]
    head: tuple[float, float]

    def parts(self) -> tuple[Wxyz, Vector3, Vector3]:
        """Rotation of both parts, centre of the shaft, centre of the head."""
        norm = math.hypot(*self.direction)
        unit = tuple(c / norm for c in self.direction)
        shaft_at, head_at = self.shaft[0] / 2, self.shaft[0] + self.head[0] / 2
        x, y, z = self.start
        turn = arrow_wxyz(self.direction)
        return (
            wxyz_product(turn, UPSIDE_DOWN) if self.head[0] < 0 else turn,
            (x + unit[0] * shaft_at, y + unit[1] * shaft_at, z + unit[2] * shaft_at),
            (x + unit[0] * head_at, y + unit[1] * head_at, z + unit[2] * head_at),
        )


def add_arrows(
    scene: viser.SceneApi,
    name: str,
    arrows: Sequence[Arrow],
    shaft_colors: Sequence[Rgb],
    head_colors: Sequence[Rgb],
    alphas: Sequence[float] = (),
) -> tuple[viser.BatchedMeshHandle, viser.BatchedMeshHandle]:
    """Several arrows in one frame: one node for the shafts, one for the heads.

    Colours and alphas are those of each arrow; without alphas all are opaque.
    """
    turns, shafts_at, heads_at = zip(*(arrow.parts() for arrow in arrows), strict=True)
    shafts = [_thick(arrow.shaft) for arrow in arrows]
    heads = [_thick(arrow.head) for arrow in arrows]
    return (
        add_batch(
            scene,
            f"{name}s",
            cylinder(),
            turns,
            shafts_at,
            shafts,
            shaft_colors,
            alphas,
        ),
        add_batch(
            scene, f"{name}h", cone(), turns, heads_at, heads, head_colors, alphas
        ),
    )
