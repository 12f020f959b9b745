"""Copies of one shape in one node; only what has changed of it is sent."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cache, lru_cache

import numpy as np
import numpy.typing as npt
import viser

from sambot_viz.cached import cached_property
from sambot_viz.displays.picking.placed_copies import Items, PlacedCopies
from sambot_viz.displays.picking.triangle_mesh import TriangleMesh
from sambot_viz.displays.scene.frame_nodes import placed
from sambot_viz.displays.scene.glb_node import single
from sambot_viz.displays.scene.posed_node import Pose, PosedNode
from sambot_viz.displays.scene.solids import Compact, linear
from sambot_viz.geometry import (
    IDENTITY,
    ORIGIN,
    Matrix,
    Vector3,
    Wxyz,
    wxyz_product,
    wxyz_rotated,
)
from sambot_viz.meshes.glb import OPAQUE_FROM

Floats = npt.NDArray[np.float32]


@lru_cache(maxsize=256)
def mesh_of(shape: Compact) -> TriangleMesh:
    """Return the triangles of a unit shape, for rays."""
    return TriangleMesh.of(shape.vertices, shape.faces)


@dataclass(frozen=True, eq=False)
class _Copies:
    """What was drawn last.

    Attributes:
        shape: of all copies.
        wxyzs: (N, 4), unit quaternions.
        positions: (N, 3) [m].
        scales: (N, 3).
        alphas: (N,).
        numbers: (N,), of the copies among those that were given.
    """

    shape: Compact
    wxyzs: Floats
    positions: Floats
    scales: Floats
    alphas: Floats
    numbers: npt.NDArray[np.intp]

    @cached_property
    def seen(self) -> npt.NDArray[np.intp]:
        """Those that can be seen, (M,)."""
        return np.flatnonzero(self.alphas > 0)

    @cached_property
    def poses(self) -> Matrix:
        """The poses of these, (M, 4, 4)."""
        turns: Matrix = self.wxyzs[self.seen].astype(np.float64)
        T: Matrix = np.zeros((len(turns), 4, 4))
        for axis in range(3):
            size = self.scales[self.seen, axis, None]
            T[:, :3, axis] = _turned(turns, np.eye(3)[axis]) * size
        T[:, :3, 3], T[:, 3, 3] = self.positions[self.seen], 1.0
        return T


def _turned(wxyzs: Matrix, vector: Matrix) -> Matrix:
    """Return a vector (3,) turned by unit quaternions (N, 4)."""
    axis = wxyzs[:, 1:]
    twice = 2 * np.cross(axis, vector)
    return vector + wxyzs[:, :1] * twice + np.cross(axis, twice)


class BatchNode(PosedNode[viser.BatchedMeshHandle]):
    """Copies of one shape in one node.

    Args:
        scene: where to draw.
        name: of the node; it is drawn in the frame of the node above.
    """

    _copies: _Copies | None = None

    def show(
        self,
        shape: Compact,
        wxyzs: npt.ArrayLike,
        positions: npt.ArrayLike,
        scales: npt.ArrayLike,
        colors: npt.ArrayLike,
        alphas: npt.ArrayLike = 1.0,
        *,
        wxyz: Wxyz = IDENTITY,
        position: Vector3 = ORIGIN,
    ) -> None:
        """Draw the copies; those that are not finite are left out.

        Args:
            shape: of all of them.
            wxyzs: (N, 4), their rotations, of any length but 0.
            positions: (N, 3) [m].
            scales: (N, 3) or one for all (3,).
            colors: (N, 3) or one for all (3,), 0 to 255.
            alphas: (N,) or one for all, 0 to 1.
            wxyz: rotation of all in the frame of the node above.
            position: there [m].
        """
        turns: Floats = np.reshape(single(wxyzs), (-1, 4))
        count = len(turns)
        at: Floats = np.reshape(single(positions), (-1, 3))
        sizes = np.broadcast_to(single(scales), (count, 3))
        shown = np.broadcast_to(linear_colors(colors), (count, 3))
        alpha = np.broadcast_to(single(alphas), (count,))
        norms = np.linalg.norm(turns, axis=1)
        good = np.isfinite(np.column_stack([turns, at, sizes, alpha])).all(axis=1)
        good &= norms > 0
        if not good.any():
            self.remove()
            return
        alpha = alpha[good].clip(0, 1)
        turns, at = turns[good] / norms[good][:, None], at[good]
        pose = placed(wxyz, position)
        blended = bool(alpha.min() < OPAQUE_FROM)
        if blended and len(at) == 1:
            # Where two can be seen through, the page draws the farther node first.
            pose = _within(pose, turns[0], at[0])
            turns, at = single([IDENTITY]), single([ORIGIN])
        numbers = np.flatnonzero(good)
        self._copies = _Copies(shape, turns, at, sizes[good], alpha, numbers)
        self._send(
            shape, turns, at, sizes[good], shown[good], alpha if blended else None, pose
        )

    def placed(self, T_fixed_above: Matrix, items: Items) -> Iterator[PlacedCopies]:
        """Yield the copies for rays, if there are any.

        Args:
            T_fixed_above: (4, 4), of the node above.
            items: what they are to a selection, one or as many as were drawn.
        """
        copies = self._copies
        if copies is None or not self.is_drawn or not len(copies.seen):
            return
        numbers: list[int] = copies.numbers[copies.seen].tolist()
        if isinstance(items, Sequence):
            items = [items[number] for number in numbers]
        T = self.place(T_fixed_above)
        is_clear = bool(copies.alphas.min() < OPAQUE_FROM)
        mesh = mesh_of(copies.shape)
        yield PlacedCopies(items, mesh, copies.poses, T, is_clear)

    def _send(
        self,
        shape: Compact,
        wxyzs: Floats,
        positions: Floats,
        scales: Floats,
        colors: npt.NDArray[np.uint8],
        alphas: Floats | None,
        pose: Pose,
    ) -> None:
        if self._handle is None or self.is_gone:
            handle = self._scene.add_batched_meshes_simple(
                self._name,
                shape.vertices,
                shape.faces,
                wxyzs,
                positions,
                batched_scales=scales,
                batched_colors=colors,
                batched_opacities=alphas,
                lod="off",
                flat_shading=True,
                cast_shadow=False,
                receive_shadow=False,
                wxyz=pose[0],
                position=pose[1],
            )
            self.has_made(handle, pose)
        else:
            # viser sends what differs from what it has.
            handle = self._handle
            handle.vertices, handle.faces = shape.vertices, shape.faces
            handle.batched_wxyzs = wxyzs
            handle.batched_positions = positions
            handle.batched_scales = scales
            handle.batched_colors = colors
            handle.batched_opacities = alphas
            self.move(pose)


def _within(pose: Pose, wxyz: Floats, position: Floats) -> Pose:
    """Return a pose that is given in the frame of another one."""
    w, x, y, z = wxyz.tolist()
    a, b, c = position.tolist()
    moved = np.add(wxyz_rotated(pose[0], (a, b, c)), pose[1])
    return placed(wxyz_product(pose[0], (w, x, y, z)), moved.tolist())


@cache
def _linear_table() -> npt.NDArray[np.uint8]:
    return np.array([round(255 * linear(c)) for c in range(256)], np.uint8)


def linear_colors(colors: npt.ArrayLike) -> npt.NDArray[np.uint8]:
    """Return colours as viser takes those of batches: in linear light."""
    return _linear_table()[np.round(np.asarray(colors, np.float64)).astype(np.uint8)]
