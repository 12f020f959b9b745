"""The triangles of a marker: with colours of their own, or in one that is lit."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt
import viser

from sambot_viz.displays.data.markers.fields import (
    alpha_of,
    rgb_of,
    rgba_of,
)
from sambot_viz.displays.data.message_numbers import coordinates_of
from sambot_viz.displays.scene.glb_node import GlbNode, digest_of, drawn_glb
from sambot_viz.displays.scene.nodes import NodeCache, placed
from sambot_viz.geometry import Vector3, Wxyz
from sambot_viz.meshes.glb import OPAQUE_FROM

Floats = npt.NDArray[np.float32]


class TrianglesNode:
    """Triangles that are seen from both sides.

    Args:
        scene: where to draw.
        name: of the node.
    """

    def __init__(self, scene: viser.SceneApi, name: str) -> None:
        self._scene = scene
        self._name = name
        self._unlit = GlbNode(scene, name)
        self._lit = NodeCache()

    def draw(self, marker: Any, wxyz: Wxyz, position: Vector3) -> None:
        """Draw the triangles of a marker; those too far away for browsers are left out.

        Args:
            marker: three of its points are one.
            wxyz: rotation in the frame of the node above.
            position: there [m].
        """
        size = marker.scale
        scale = np.array((size.x, size.y, size.z))
        with np.errstate(over="ignore", invalid="ignore"):
            corners = (coordinates_of(marker.points) * scale).astype(np.float32)
        finite = np.isfinite(np.reshape(corners, (-1, 9)))
        good: npt.NDArray[np.bool_] = np.all(finite, axis=1)
        at = corners[np.repeat(good, 3)]
        if not len(at):
            self.remove()
        elif marker.colors:
            self._lit.remove()
            self._draw_colored(marker, at, good, wxyz, position)
        else:
            self._unlit.remove()
            self._draw_lit(marker, at, wxyz, position)

    def _draw_colored(
        self,
        marker: Any,
        at: Floats,
        good: npt.NDArray[np.bool_],
        wxyz: Wxyz,
        position: Vector3,
    ) -> None:
        """Draw a colour for each corner, or for each triangle; nothing is lit.

        Args:
            marker: has the colours.
            at: (N, 3), the corners of those triangles that are drawn [m].
            good: which of the marker's triangles are drawn.
            wxyz: rotation in the frame of the node above.
            position: there [m].
        """
        rgba = rgba_of(marker.colors)
        if len(rgba) == len(marker.points):
            blended = bool((rgba[:, 3] < 255 * OPAQUE_FROM).any())
        else:
            blended = marker.color.a < OPAQUE_FROM
            rgba = np.repeat(rgba, 3, axis=0)
        rgba = rgba[np.repeat(good, 3)]
        # What is not blended is opaque, whatever its alpha.
        alpha = rgba[:, 3] * alpha_of(marker.color) if blended else 255
        rgba = np.column_stack([rgba[:, :3], np.full(len(rgba), alpha)])
        colors = np.round(rgba).astype(np.uint8)
        self._unlit.show(
            (at, colors, blended),
            lambda: drawn_glb(
                "triangles", {"POSITION": at, "COLOR_0": colors}, blended=blended
            ),
            wxyz,
            position,
        )

    def _draw_lit(self, marker: Any, at: Floats, wxyz: Wxyz, position: Vector3) -> None:
        color, alpha = rgb_of(marker.color), alpha_of(marker.color)
        pose = placed(wxyz, position)
        self._lit.show(
            (digest_of((at,)), color, alpha, pose),
            lambda: [
                self._scene.add_mesh_simple(
                    self._name,
                    at,
                    np.reshape(np.arange(len(at), dtype=np.uint32), (-1, 3)),
                    color=color,
                    flat_shading=True,
                    side="double",
                    opacity=alpha if alpha < OPAQUE_FROM else None,
                    wxyz=pose[0],
                    position=pose[1],
                    cast_shadow=False,
                    receive_shadow=False,
                )
            ],
        )

    def remove(self) -> None:
        """Take them out of the scene."""
        self._unlit.remove()
        self._lit.remove()
