"""The unit shapes that RViz draws boxes, cylinders, spheres and arrow heads with.

All of them are flat shaded and have diameter and height 1, so that a URDF shape is
its unit shape scaled: box (x, y, z), cylinder (2r, 2r, length), sphere (2r, 2r, 2r).
The axis of cylinder, cone and sphere is z, as in URDF. Texture coordinates follow
what pictures of the real RViz show; v points up the image (0 is its bottom edge).
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np
import numpy.typing as npt

SIDES = 16
"""Sides of cylinder and cone, meridians of the sphere."""
CONE_BASE, CONE_TIP = -0.509, 0.491
"""Begin and end of the cone on its axis: it is not quite centred."""

_Polygon = tuple[npt.NDArray[np.float64], npt.NDArray[np.float64]]


@dataclass(frozen=True, slots=True, eq=False)
class Primitive:
    """A unit shape; no two of its flat faces share a vertex.

    The arrays are read-only, because every caller is given the same ones.

    Attributes:
        vertices: (N, 3) float32.
        faces: (M, 3) uint32, counter-clockwise seen from outside.
        normals: (N, 3) float32, the unit normal of the face the vertex belongs to.
        uv: (N, 2) float32, v upwards.
    """

    vertices: npt.NDArray[np.float32]
    faces: npt.NDArray[np.uint32]
    normals: npt.NDArray[np.float32]
    uv: npt.NDArray[np.float32]


@cache
def unit_box() -> Primitive:
    """Make a cube, edges from −0.5 to 0.5, the full texture upright on each side."""
    square = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
    x, y, z = np.eye(3)
    # Outward normal = right × up; top and bottom read along x.
    directions = ((y, z), (-x, z), (-y, z), (x, z), (x, y), (x, -y))
    return _shape(
        [
            (
                0.5 * np.cross(right, up)
                + (square[:, :1] - 0.5) * right
                + (square[:, 1:] - 0.5) * up,
                square,
            )
            for right, up in directions
        ]
    )


@cache
def unit_cylinder() -> Primitive:
    """Make a 16-sided cylinder along z: radius 0.5 at the edges, z from −0.5 to 0.5.

    The edges are at 0°, 22.5°, … from x, so the sides face 11.25° + k · 22.5°.
    """
    ring = _ring()
    half = np.array([0.0, 0.0, 0.5])
    bottom, top = ring - half, ring + half
    polygons: list[_Polygon] = []
    for i in range(SIDES):
        j = (i + 1) % SIDES
        # Round the side the image is upside down, as in RViz; its seam
        # is at −y, three quarters of the way round.
        u0, u1 = 0.75 - i / SIDES, 0.75 - (i + 1) / SIDES
        u0, u1 = (u0, u1) if u1 >= 0 else (u0 + 1, u1 + 1)
        uv = np.array([[u0, 1.0], [u1, 1.0], [u1, 0.0], [u0, 0.0]])
        polygons.append((np.array([bottom[i], bottom[j], top[j], top[i]]), uv))
    polygons.append((top, _disc_uv(top)))
    polygons.append((bottom[::-1], _disc_uv(bottom[::-1])))
    return _shape(polygons)


@cache
def unit_cone() -> Primitive:
    """Make a 16-sided cone along z: base radius 0.5 at z = −0.509, tip at 0.491."""
    base = _ring() + np.array([0.0, 0.0, CONE_BASE])
    tip = np.array([0.0, 0.0, CONE_TIP])
    polygons: list[_Polygon] = []
    for i in range(SIDES):
        corners = np.array([base[i], base[(i + 1) % SIDES], tip])
        uv = np.array([[i, 0.0], [i + 1, 0.0], [i + 0.5, SIDES]]) / SIDES
        polygons.append((corners, uv))
    polygons.append((base[::-1], _disc_uv(base[::-1])))
    return _shape(polygons)


@cache
def unit_sphere() -> Primitive:
    """Make a sphere of radius 0.5: 16 meridians, 8 bands, 224 flat triangles."""
    bands = SIDES // 2

    def corner(i: int, k: int) -> list[float]:
        azimuth, polar = 2 * np.pi * i / SIDES, np.pi * k / bands
        sine = np.sin(polar)
        return [sine * np.cos(azimuth), sine * np.sin(azimuth), -np.cos(polar)]

    polygons: list[_Polygon] = []
    for k in range(bands):
        for i in range(SIDES):
            cells = [(i, k), (i + 1, k), (i + 1, k + 1), (i, k + 1)]
            if k == 0:
                cells.pop(1)
            elif k == bands - 1:
                cells.pop(3)
            corners = 0.5 * np.array([corner(*cell) for cell in cells])
            # The middle of the image is at +x, so the seam is at −x.
            shift = 0.5 if i < SIDES // 2 else -0.5
            uv = np.array(cells) / [SIDES, bands] + [shift, 0.0]
            polygons.append((corners, uv))
    return _shape(polygons)


def _ring() -> npt.NDArray[np.float64]:
    angles = 2 * np.pi * np.arange(SIDES) / SIDES
    return 0.5 * np.column_stack([np.cos(angles), np.sin(angles), 0 * angles])


def _disc_uv(ring: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
    """Return the image seen from above, cut out round."""
    return ring[:, :2] + 0.5


def _shape(polygons: list[_Polygon]) -> Primitive:
    """Turn planar convex polygons into arrays, each polygon as a fan of triangles."""
    vertices: list[npt.NDArray[np.float64]] = []
    normals: list[npt.NDArray[np.float64]] = []
    faces: list[list[int]] = []
    first = 0
    for corners, _ in polygons:
        normal = np.cross(corners[1] - corners[0], corners[2] - corners[0])
        vertices.append(corners)
        normals.append(np.tile(normal / np.linalg.norm(normal), (len(corners), 1)))
        faces += [[first, first + i, first + i + 1] for i in range(1, len(corners) - 1)]
        first += len(corners)
    shape = Primitive(
        vertices=np.concatenate(vertices).astype(np.float32),
        faces=np.array(faces, dtype=np.uint32),
        normals=np.concatenate(normals).astype(np.float32),
        uv=np.concatenate([uv for _, uv in polygons]).astype(np.float32),
    )
    for array in (shape.vertices, shape.faces, shape.normals, shape.uv):
        array.flags.writeable = False
    return shape
