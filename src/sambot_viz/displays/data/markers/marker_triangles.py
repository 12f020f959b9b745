"""The triangles of a marker: with their own colours, or lit, in one or a picture."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt
import viser

from sambot_viz.displays.data.markers.marker_fields import (
    alpha_of,
    rgb_of,
    rgba_of,
)
from sambot_viz.displays.data.markers.marker_textures import (
    has_texture,
    is_clear,
    texture_of,
    uv_of,
)
from sambot_viz.displays.data.message_numbers import coordinates_of
from sambot_viz.displays.picking.placed import PlacedMesh
from sambot_viz.displays.picking.selectable import Selectable
from sambot_viz.displays.picking.triangle_mesh import TriangleMesh
from sambot_viz.displays.scene.frame_nodes import NodeCache, placed
from sambot_viz.displays.scene.glb_node import GlbNode, digest_of, drawn_glb
from sambot_viz.displays.scene.solids import Rgb
from sambot_viz.geometry import IDENTITY, ORIGIN, Matrix, Vector3, Wxyz
from sambot_viz.matrices import matrix_from_wxyz
from sambot_viz.meshes.glb import OPAQUE_FROM, to_glb
from sambot_viz.meshes.mesh import MeshPart, Texture
from sambot_viz.meshes.textures import TextureError

Floats = npt.NDArray[np.float32]


@dataclass(frozen=True, slots=True, eq=False)
class TriangleLook:
    """How triangles that are lit look.

    Attributes:
        color: 0 to 255.
        alpha: 0 to 1.
        is_mirrored: by their scale.
        texture: multiplies the colour, or None.
        uv: (N, 2), the place of each corner in the texture, v upwards.
    """

    color: Rgb
    alpha: float
    is_mirrored: bool
    texture: Texture | None = None
    uv: Floats | None = None


def look_of(marker: Any, good: npt.NDArray[np.bool_]) -> TriangleLook | None:
    """Return how the triangles of a marker are lit; None when their colours are not.

    Args:
        marker: three of its points are one triangle.
        good: which triangles are drawn.
    """
    scale, count = marker.scale, len(marker.points)
    mirrored = scale.x * scale.y * scale.z < 0
    color, alpha = rgb_of(marker.color), alpha_of(marker.color)
    colors = marker.colors if len(marker.colors) in (count, count // 3) else ()
    if has_texture(marker):
        try:
            texture = texture_of(marker)
        except TextureError:
            pass  # The status says so.
        else:
            uv = uv_of(marker)[np.repeat(good, 3)]
            white = (255, 255, 255), 1.0
            color, alpha = white if colors else (color, alpha)
            return TriangleLook(color, alpha, mirrored, texture, uv)
    return None if colors else TriangleLook(color, alpha, mirrored)


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
        self._plain = NodeCache()
        self._textured = GlbNode(scene, name)
        self._corners: Floats = np.zeros((0, 3), np.float32)
        self._mesh: TriangleMesh | None = None
        self._pose: tuple[Wxyz, Vector3] = (IDENTITY, ORIGIN)

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
        self._corners, self._mesh, self._pose = at, None, placed(wxyz, position)
        if not len(at):
            self.remove()
            return
        look = look_of(marker, good)
        if look is None:
            self._plain.remove()
            self._textured.remove()
            self._draw_colored(marker, at, good, wxyz, position)
        else:
            self._unlit.remove()
            self._draw_lit(at, look, wxyz, position)

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
        # Triangles that are not blended are opaque, whatever their alpha.
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

    def _draw_lit(
        self, at: Floats, look: TriangleLook, wxyz: Wxyz, position: Vector3
    ) -> None:
        faces = np.reshape(np.arange(len(at), dtype=np.uint32), (-1, 3))
        if look.is_mirrored:
            # The dark side is the one that it is without a scale.
            faces = faces[:, ::-1]
        if look.texture is None:
            self._textured.remove()
            self._draw_plain(at, faces, look, wxyz, position)
            return
        self._plain.remove()
        texture = look.texture
        part = MeshPart(at, faces, uv=look.uv, texture=texture)
        red, green, blue = (c / 255 for c in look.color)
        rgba = (red, green, blue, look.alpha)
        self._textured.show(
            (at, look.uv, texture.data, rgba, look.is_mirrored),
            lambda: to_glb(part, rgba=rgba, two_sided=True, blended=is_clear(texture)),
            wxyz,
            position,
        )

    def _draw_plain(
        self,
        at: Floats,
        faces: npt.NDArray[np.uint32],
        look: TriangleLook,
        wxyz: Wxyz,
        position: Vector3,
    ) -> None:
        pose = placed(wxyz, position)
        color, alpha = look.color, look.alpha
        self._plain.show(
            (digest_of((at,)), look.is_mirrored, color, alpha, pose),
            lambda: [
                self._scene.add_mesh_simple(
                    self._name,
                    at,
                    faces,
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

    def placed(
        self, T_fixed_above: Matrix, item: Selectable | None
    ) -> Iterator[PlacedMesh]:
        """Yield the triangles for rays.

        Args:
            T_fixed_above: (4, 4), of the node above.
            item: what they are to a selection.
        """
        if not len(self._corners):
            return
        if self._mesh is None:
            faces = np.reshape(np.arange(len(self._corners)), (-1, 3))
            self._mesh = TriangleMesh.of(self._corners, faces).both_sides()
        T = T_fixed_above @ matrix_from_wxyz(*self._pose)
        yield PlacedMesh(item, self._mesh, T)

    def remove(self) -> None:
        """Take them out of the scene."""
        for node in (self._unlit, self._plain, self._textured):
            node.remove()
