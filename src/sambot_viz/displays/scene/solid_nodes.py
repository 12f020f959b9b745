"""Nodes with many solids: arrows, axes, and the unit shapes of markers.

The page pays for each node, so all copies of one shape are a batch.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
import numpy.typing as npt
import viser

from sambot_viz.displays.picking.placed_copies import Items, PlacedCopies
from sambot_viz.displays.scene.batch_node import BatchNode
from sambot_viz.displays.scene.solids import (
    AXIS_COLORS,
    AXIS_WXYZ,
    UPSIDE_DOWN,
    Arrow,
    Rgb,
    arrow_triangles,
    box,
    cone,
    cylinder,
    sphere,
)
from sambot_viz.geometry import (
    IDENTITY,
    ORIGIN,
    Matrix,
    Vector3,
    Wxyz,
    wxyz_from_matrix,
    wxyz_product,
)

Numbers = npt.NDArray[np.float64]
Kind = Literal["box", "cone", "cylinder", "sphere"]
_SHAPES = {"box": box, "cone": cone, "cylinder": cylinder, "sphere": sphere}


class ArrowsNode(BatchNode):
    """Arrows along +x of their poses."""

    def draw(
        self,
        wxyzs: npt.ArrayLike,
        positions: npt.ArrayLike,
        shaft: tuple[float, float],
        head: tuple[float, float],
        color: npt.ArrayLike,
        *,
        alpha: npt.ArrayLike = 1.0,
        sizes: npt.ArrayLike = 1.0,
        wxyz: Wxyz = IDENTITY,
        position: Vector3 = ORIGIN,
    ) -> None:
        """Draw them.

        Args:
            wxyzs: (N, 4), the rotations.
            positions: (N, 3), where the shafts begin [m].
            shaft: length and diameter [m]; RViz's "Shaft Radius" is the diameter,
                except in Path.
            head: length and diameter [m].
            color: of all (3,) or of each (N, 3), 0 to 255.
            alpha: of all or of each (N,), 0 to 1.
            sizes: of all or of each (N,), by the lengths and diameters.
            wxyz: rotation of all in the frame of the node above.
            position: there [m].
        """
        shape = arrow_triangles((Arrow(ORIGIN, (1.0, 0.0, 0.0), shaft, head),))
        scales = np.asarray(sizes, np.float64)[..., None]
        self.show(
            shape, wxyzs, positions, scales, color, alpha, wxyz=wxyz, position=position
        )


class AxesNode(BatchNode):
    """Axes: x red, y green, z blue."""

    def draw(
        self,
        wxyzs: npt.ArrayLike,
        positions: npt.ArrayLike,
        length: float,
        diameter: float,
        *,
        colors: Sequence[Rgb] = AXIS_COLORS,
        alpha: float = 1.0,
        sizes: npt.ArrayLike = 1.0,
        wxyz: Wxyz = IDENTITY,
        position: Vector3 = ORIGIN,
    ) -> None:
        """Draw them.

        Args:
            wxyzs: (N, 4), their rotations.
            positions: (N, 3), their origins [m].
            length: of each axis [m].
            diameter: of each axis, which RViz calls its radius [m].
            colors: of the three.
            alpha: 0 to 1.
            sizes: of all or of each (N,), by the length and the diameter.
            wxyz: rotation of all in the frame of the node above.
            position: there [m].
        """
        turns: Numbers = np.reshape(np.asarray(wxyzs, np.float64), (-1, 4))
        at: Numbers = np.reshape(np.asarray(positions, np.float64), (-1, 3))
        size = np.broadcast_to(np.asarray(sizes, np.float64), len(turns))[:, None]
        axes = np.eye(3) * (length / 2)
        middles = [at + size * rotated(turns, axis) for axis in axes]
        parts = [products(turns, np.array(turn)) for turn in AXIS_WXYZ]
        self.show(
            cylinder(),
            np.concatenate(parts),
            np.concatenate(middles),
            np.tile(size, (3, 1)) * (diameter, diameter, length),
            np.repeat(np.array(colors), len(turns), axis=0),
            alpha,
            wxyz=wxyz,
            position=position,
        )


def products(wxyzs: Numbers, wxyz: Numbers) -> Numbers:
    """Return each of some quaternions (N, 4) times one (4,), normalised."""
    a = _unit(wxyzs)
    w, x, y, z = a[:, 0], a[:, 1], a[:, 2], a[:, 3]
    b, c, d, e = wxyz
    return np.stack(
        [
            w * b - x * c - y * d - z * e,
            w * c + x * b + y * e - z * d,
            w * d - x * e + y * b + z * c,
            w * e + x * d - y * c + z * b,
        ],
        axis=1,
    )


def rotated(wxyzs: Numbers, vector: Numbers) -> Numbers:
    """Return a vector (3,) turned by each of some quaternions (N, 4)."""
    unit = _unit(wxyzs)
    axis = unit[:, 1:]
    twice = 2 * np.cross(axis, vector)
    return vector + unit[:, :1] * twice + np.cross(axis, twice)


def _unit(wxyzs: Numbers) -> Numbers:
    norms = np.linalg.norm(wxyzs, axis=1, keepdims=True)
    return wxyzs / np.where(norms > 0, norms, np.nan)


@dataclass(frozen=True, slots=True)
class Solid:
    """A unit shape with a pose, a size and a colour.

    Attributes:
        kind: box, sphere, or cylinder and cone along z; edges, heights and diameters
            are 1.
        wxyz: its rotation.
        position: of its middle [m].
        scale: along its own axes [m]; negative ones mirror it.
        color: 0 to 255.
        alpha: 0 to 1.
    """

    kind: Kind
    wxyz: Wxyz
    position: Vector3
    scale: Vector3
    color: Rgb
    alpha: float = 1.0

    def placed(self, T: Matrix) -> Solid:
        """Return it in the coordinates of another frame, T_frame_own, (4, 4)."""
        x, y, z = (T[:3, :3] @ np.array(self.position) + T[:3, 3]).tolist()
        turn = wxyz_product(wxyz_from_matrix(T), self.wxyz)
        return replace(self, wxyz=turn, position=(x, y, z))


def arrow_solids(arrow: Arrow, color: Rgb, alpha: float) -> tuple[Solid, ...]:
    """Return the head of an arrow, and its shaft if that has a length.

    Args:
        arrow: in the frame of the solids.
        color: of both, 0 to 255.
        alpha: of both, 0 to 1.
    """
    turn, shaft_at, head_at = arrow.parts()
    (length, wide), (head, head_wide) = arrow.shaft, arrow.head
    sizes = (head_wide, head_wide, abs(head))
    tip = Solid("cone", turn, head_at, sizes, color, alpha)
    if not length:
        return (tip,)
    return (tip, Solid("cylinder", turn, shaft_at, (wide, wide, length), color, alpha))


def _turn(solid: Solid) -> Wxyz:
    """Return the rotation of a solid that is not mirrored and looks the same.

    Of a mirrored copy browsers show the inside. All shapes but the cone are their own
    mirror images.
    """
    is_down = solid.kind == "cone" and solid.scale[2] < 0
    return wxyz_product(solid.wxyz, UPSIDE_DOWN) if is_down else solid.wxyz


class SolidsNode:
    """Any unit shapes, in one batch for each kind.

    Args:
        scene: where to draw.
        name: what the names of the nodes begin with.
    """

    def __init__(self, scene: viser.SceneApi, name: str) -> None:
        self._batches = {kind: BatchNode(scene, name + kind[:2]) for kind in _SHAPES}
        self._kinds: list[Kind] = []

    @property
    def is_gone(self) -> bool:
        """Return whether a node was removed together with one above it."""
        return any(batch.is_gone for batch in self._batches.values())

    def draw(
        self,
        solids: Sequence[Solid],
        *,
        wxyz: Wxyz = IDENTITY,
        position: Vector3 = ORIGIN,
    ) -> None:
        """Draw the shapes, and nothing else.

        Args:
            solids: in one frame.
            wxyz: rotation of that frame in the one of the node above.
            position: there [m].
        """
        self._kinds = [solid.kind for solid in solids]
        for kind, batch in self._batches.items():
            some = [solid for solid in solids if solid.kind == kind]
            if not some:
                batch.remove()
                continue
            batch.show(
                _SHAPES[kind](),
                [_turn(solid) for solid in some],
                [solid.position for solid in some],
                np.abs([solid.scale for solid in some]),
                [solid.color for solid in some],
                [solid.alpha for solid in some],
                wxyz=wxyz,
                position=position,
            )

    def placed(self, T_fixed_above: Matrix, items: Items) -> Iterator[PlacedCopies]:
        """Yield the shapes for rays (see `BatchNode.placed`)."""
        for kind, batch in self._batches.items():
            some = items
            if isinstance(items, Sequence):
                pairs = zip(items, self._kinds, strict=True)
                some = [item for item, one in pairs if one == kind]
            yield from batch.placed(T_fixed_above, some)

    def remove(self) -> None:
        """Take the shapes out of the scene."""
        for batch in self._batches.values():
            batch.remove()
