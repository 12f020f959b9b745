"""Where rays meet shapes.

viser reports the ray of a click but not what it hits, so the ray is followed here.
All rays of one call are followed at once; distances are (N,) float64, counted in
multiples of the rays' directions, and inf where nothing is hit in front of the eye.
"""

from __future__ import annotations

import numpy as np

from sambot_viz.geometry import Matrix, Vector3
from sambot_viz.robot.model import Box, Capsule, Cylinder, Sphere
from sambot_viz.tools.picking.mesh_raycast import cast_mesh
from sambot_viz.tools.picking.rays import Array, RayGrid, TriangleMesh

Collider = Box | Cylinder | Sphere | Capsule | TriangleMesh
"""A shape that rays can meet."""


def cast(collider: Collider, T: Matrix, rays: RayGrid) -> Array:
    """How far along each ray a shape is met first.

    Args:
        collider: what to meet, in its own frame.
        T: (4, 4) map from the shape's frame to that of the rays; it may scale.
        rays: N rays.

    Returns:
        (N,) distances in multiples of the direction, inf where nothing is met.
    """
    local = rays.seen_from(T)
    if local is None:
        return np.full(rays.count, np.inf)
    d = local.directions
    o = np.broadcast_to(local.origin, d.shape)
    if isinstance(collider, Box):
        return _box(o, d, np.asarray(collider.size) / 2)
    if isinstance(collider, Sphere):
        return _sphere(o, d, collider.radius)
    if isinstance(collider, Cylinder):
        return _cylinder(o, d, collider.radius, collider.length / 2, capped=True)
    if isinstance(collider, Capsule):
        half = collider.length / 2
        side = _cylinder(o, d, collider.radius, half, capped=False)
        ends = [_sphere(o - (0, 0, z), d, collider.radius) for z in (half, -half)]
        return np.minimum(side, np.minimum(*ends))
    middle, half_size = (collider.low + collider.high) / 2, _half_size(collider)
    if not np.isfinite(_box(o - middle, d, half_size + 1e-9)).any():
        return np.full(rays.count, np.inf)
    return cast_mesh(local, collider)


def bounds(collider: Collider, T: Matrix) -> tuple[Array, Array]:
    """The corners (3,) of the box along the axes around a shape's own box [m].

    As in RViz, a turned shape gets the box around its turned box.
    """
    middle = np.zeros(3)
    if isinstance(collider, TriangleMesh):
        middle = (collider.low + collider.high) / 2
    center = T[:3, :3] @ middle + T[:3, 3]
    half = np.abs(T[:3, :3]) @ _half_size(collider)
    return center - half, center + half


def cast_plane(
    origins: Array, directions: Array, point: Vector3 | Array, normal: Vector3 | Array
) -> Array:
    """How far along each ray an endless plane is; all but point and normal (N, 3)."""
    n: Array = np.asarray(normal, np.float64)
    at: Array = np.asarray(point, np.float64)
    up: Array = np.einsum("ni,i->n", at - origins, n)
    along: Array = np.einsum("ni,i->n", directions, n)
    with np.errstate(divide="ignore", invalid="ignore"):
        return _in_front(up / along)


def _half_size(collider: Collider) -> Array:
    if isinstance(collider, TriangleMesh):
        return (collider.high - collider.low) / 2
    if isinstance(collider, Box):
        return np.asarray(collider.size, np.float64) / 2
    r = collider.radius
    if isinstance(collider, Sphere):
        return np.array((r, r, r))
    z = collider.length / 2 + (r if isinstance(collider, Capsule) else 0.0)
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
