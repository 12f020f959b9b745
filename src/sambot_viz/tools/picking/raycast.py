"""Where rays meet shapes.

viser tells the ray of a click but not what it hits (spec/viser.md §1.4), so the ray
is followed here. All rays of one call are followed at once: origins and directions
are (N, 3) float64 [m], directions of length 1; distances are (N,) float64 [m], inf
where nothing is hit in front of the origin.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from sambot_viz.geometry import Matrix, Vector3
from sambot_viz.robot.model import Box, Capsule, Cylinder, Sphere

Array = npt.NDArray[np.float64]
Indices = npt.NDArray[np.integer[Any]]
PAIRS = 2_000_000
"""So many rays × triangles are tried at once, which bounds the memory."""


@dataclass(frozen=True, slots=True)
class Triangles:
    """A mesh: vertices (V, 3) [m] and faces (F, 3)."""

    vertices: Array
    faces: Indices


Solid = Box | Cylinder | Sphere | Capsule | Triangles


def cast(solid: Solid, T: Matrix, origins: Array, directions: Array) -> Array:
    """How far along each ray a solid is met first.

    Args:
        solid: what to meet, in its own frame.
        T: pose of the solid in the frame of the rays, (4, 4).
        origins: where the rays begin, (N, 3).
        directions: where they go, (N, 3).
    """
    R, p = T[:3, :3], T[:3, 3]
    o, d = (origins - p) @ R, directions @ R
    if isinstance(solid, Box):
        return _box(o, d, np.asarray(solid.size) / 2)
    if isinstance(solid, Sphere):
        return _sphere(o, d, solid.radius)
    if isinstance(solid, Cylinder):
        return _cylinder(o, d, solid.radius, solid.length / 2, capped=True)
    if isinstance(solid, Capsule):
        half = solid.length / 2
        side = _cylinder(o, d, solid.radius, half, capped=False)
        ends = [_sphere(o - (0, 0, z), d, solid.radius) for z in (half, -half)]
        return np.minimum(side, np.minimum(*ends))
    return _triangles(o, d, solid)


def bounds(solid: Solid, T: Matrix) -> tuple[Array, Array]:
    """The corners (3,) of the box along the axes that a solid fills [m]."""
    R, p = np.abs(T[:3, :3]), T[:3, 3]
    if isinstance(solid, Triangles):
        points: Array = np.einsum("ij,vj->vi", T[:3, :3], solid.vertices) + p
        return points.min(axis=0), points.max(axis=0)
    half = R @ _half_size(solid)
    return p - half, p + half


def cast_plane(
    origins: Array, directions: Array, point: Vector3 | Array, normal: Vector3 | Array
) -> Array:
    """How far along each ray an endless plane is."""
    n: Array = np.asarray(normal, np.float64)
    at: Array = np.asarray(point, np.float64)
    up: Array = np.einsum("ni,i->n", at - origins, n)
    along: Array = np.einsum("ni,i->n", directions, n)
    with np.errstate(divide="ignore", invalid="ignore"):
        return _in_front(up / along)


def _half_size(solid: Box | Cylinder | Sphere | Capsule) -> Array:
    if isinstance(solid, Box):
        return np.asarray(solid.size) / 2
    r = solid.radius
    if isinstance(solid, Sphere):
        return np.array((r, r, r))
    z = solid.length / 2 + (r if isinstance(solid, Capsule) else 0.0)
    return np.array((r, r, z))


def _in_front(t: Array) -> Array:
    return np.where(np.isfinite(t) & (t >= 0.0), t, np.inf)


def _box(o: Array, d: Array, half: Array) -> Array:
    with np.errstate(divide="ignore", invalid="ignore"):
        one, two = (-half - o) / d, (half - o) / d
    # A ray along a face divides 0 by 0; it is inside that pair of planes.
    inside = np.abs(o) <= half
    one = np.where(d == 0.0, np.where(inside, -np.inf, np.inf), one)
    two = np.where(d == 0.0, np.where(inside, np.inf, np.inf), two)
    enter: Array = np.minimum(one, two).max(axis=1)
    leave: Array = np.maximum(one, two).min(axis=1)
    t = np.where(enter >= 0.0, enter, leave)
    return np.where((enter <= leave) & (leave >= 0.0), t, np.inf)


def _nearest_root(a: Array, b: Array, c: Array) -> tuple[Array, Array]:
    """Both solutions of a t² + 2 b t + c = 0, the smaller first; NaN for none."""
    with np.errstate(divide="ignore", invalid="ignore"):
        root = np.sqrt(b * b - a * c)
        return (-b - root) / a, (-b + root) / a


def _sphere(o: Array, d: Array, radius: float) -> Array:
    a = np.einsum("ij,ij->i", d, d)
    b = np.einsum("ij,ij->i", o, d)
    c = np.einsum("ij,ij->i", o, o) - radius**2
    near, far = _nearest_root(a, b, c)
    return np.minimum(_in_front(near), _in_front(far))


def _cylinder(o: Array, d: Array, radius: float, half: float, capped: bool) -> Array:
    a = (d[:, :2] ** 2).sum(axis=1)
    b = (o[:, :2] * d[:, :2]).sum(axis=1)
    c = (o[:, :2] ** 2).sum(axis=1) - radius**2
    best = np.full(len(o), np.inf)
    for root in _nearest_root(a, b, c):
        t = _in_front(root)
        with np.errstate(invalid="ignore"):
            z = o[:, 2] + t * d[:, 2]
        best = np.minimum(best, np.where(np.abs(z) <= half, t, np.inf))
    if capped:
        for z in (half, -half):
            t = cast_plane(o, d, (0.0, 0.0, z), (0.0, 0.0, 1.0))
            at = o[:, :2] + np.where(np.isfinite(t), t, 0.0)[:, None] * d[:, :2]
            on_cap = (at**2).sum(axis=1) <= radius**2
            best = np.minimum(best, np.where(on_cap, t, np.inf))
    return best


def _triangles(o: Array, d: Array, mesh: Triangles) -> Array:
    """Möller and Trumbore's test, for the rays that meet the mesh's box."""
    best = np.full(len(o), np.inf)
    if not len(mesh.faces):
        return best
    low, high = mesh.vertices.min(axis=0), mesh.vertices.max(axis=0)
    middle, half = (low + high) / 2, (high - low) / 2 + 1e-9
    rays = np.flatnonzero(np.isfinite(_box(o - middle, d, half)))
    corner = mesh.vertices[mesh.faces[:, 0]]
    one = mesh.vertices[mesh.faces[:, 1]] - corner
    two = mesh.vertices[mesh.faces[:, 2]] - corner
    step = max(1, PAIRS // len(mesh.faces))
    for start in range(0, len(rays), step):
        some = rays[start : start + step]
        best[some] = _meet(o[some], d[some], corner, one, two)
    return best


def _meet(o: Array, d: Array, corner: Array, one: Array, two: Array) -> Array:
    """Distances (N,) of N rays to the nearest of F triangles, from either side."""
    p = np.cross(d[:, None, :], two[None])
    with np.errstate(divide="ignore", invalid="ignore"):
        inverse = 1.0 / np.einsum("fk,nfk->nf", one, p)
        s = o[:, None, :] - corner[None]
        u = np.einsum("nfk,nfk->nf", s, p) * inverse
        q = np.cross(s, one[None])
        v = np.einsum("nk,nfk->nf", d, q) * inverse
        t = np.einsum("fk,nfk->nf", two, q) * inverse
        hit = (u >= 0.0) & (v >= 0.0) & (u + v <= 1.0) & (t >= 0.0)
    return np.where(hit & np.isfinite(t), t, np.inf).min(axis=1)
