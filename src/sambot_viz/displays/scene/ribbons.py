"""Ribbons: lines with a width in metres that face the camera ("Billboards")."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from sambot_viz.displays.scene.glb_node import drawn_glb, rgba_rows, single
from sambot_viz.displays.scene.lines import LinesNode
from sambot_viz.displays.scene.solids import Rgb
from sambot_viz.geometry import IDENTITY, ORIGIN, Vector3, Wxyz
from sambot_viz.meshes.glb import OPAQUE_FROM

Points = npt.NDArray[np.float32]


class RibbonNode(LinesNode):
    """Ribbons through chains of points, all of one width, in one node."""

    def draw(
        self,
        points: npt.ArrayLike,
        width: float,
        color: npt.ArrayLike,
        *,
        counts: Sequence[int] | None = None,
        alpha: float = 1.0,
        wxyz: Wxyz = IDENTITY,
        position: Vector3 = ORIGIN,
    ) -> None:
        """Draw the chains; none with two points draws nothing.

        Args:
            points: (N, 3), all chains one after the other [m]. A chain ends at a point
                that is not finite.
            width: [m].
            color: one for all (3,), or one for each point with its alpha (N, 4); 0 to
                255. Between points the colours change evenly.
            counts: how many points each chain has; None for one chain.
            alpha: 0 to 1. Whether ribbons are blended is decided by the last point, as
                in RViz.
            wxyz: rotation in the frame of the node above.
            position: there [m].
        """
        at: Points = np.reshape(single(points), (-1, 3))
        rgba = rgba_rows(color, alpha, len(at))
        chain = np.repeat(
            np.arange(1 if counts is None else len(counts)),
            [len(at)] if counts is None else counts,
        )
        finite = np.isfinite(at).all(axis=1)
        chain = (chain + np.cumsum(~finite))[finite]
        at, rgba = at[finite], rgba[finite]
        if len(at) < 2 or not np.any(chain[1:] == chain[:-1]) or not width > 0:
            self.remove()
            return
        self._lines = lambda: (_parts(at, chain), float(width))
        self.show(
            (at, chain, rgba, float(width)),
            lambda: ribbon_glb(at, chain, rgba, float(width)),
            wxyz,
            position,
        )


def _parts(at: Points, chain: npt.NDArray[np.int64]) -> Points:
    """Return the lines from each point to the next one of its chain, (N, 2, 3)."""
    goes_on = chain[1:] == chain[:-1]
    return np.stack([at[:-1][goes_on], at[1:][goes_on]], axis=1)


def segment_ribbons(segments: Points, width: float, color: Rgb, alpha: float) -> bytes:
    """Return a GLB file of lines that do not touch, (N, 2, 3) [m], of one colour."""
    points: Points = np.reshape(segments, (-1, 3))
    chain = np.repeat(np.arange(len(segments)), 2)
    return ribbon_glb(points, chain, rgba_rows(color, alpha, len(points)), width)


def ribbon_glb(
    points: Points,
    chain: npt.NDArray[np.int64],
    rgba: npt.NDArray[np.uint8],
    width: float,
) -> bytes:
    """Return a GLB file of ribbons.

    Each point is there twice; the page moves the two apart, across the line and across
    the direction to the eye.

    Args:
        points: (N, 3) [m], finite.
        chain: (N,), the number of each point's chain; equal numbers are neighbours.
        rgba: (N, 4), 0 to 255.
        width: [m].
    """
    goes_on = chain[1:] == chain[:-1]
    index = np.arange(len(points))
    after = index + np.append(goes_on, False)
    before = index - np.insert(goes_on, 0, False)
    along = points[after] - points[before]
    side = np.tile(np.array([[-1.0], [1.0]], np.float32), (len(points), 1))
    first = 2 * index[:-1][goes_on]
    corners = first[:, None] + np.array([0, 1, 2, 2, 1, 3])
    return drawn_glb(
        "ribbon",
        {
            "POSITION": np.repeat(points, 2, axis=0),
            "_ASIDE": np.hstack([np.repeat(along, 2, axis=0), side]),
            "COLOR_0": np.repeat(rgba, 2, axis=0),
        },
        extras={"width": width},
        indices=corners.astype(np.uint32),
        blended=bool(rgba[-1, 3] < 255 * OPAQUE_FROM),
    )
