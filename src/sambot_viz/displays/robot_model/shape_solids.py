"""The triangles and the colours of one <visual> or <collision>, as they are drawn."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import viser

from sambot_viz.displays.scene.frame_nodes import Handle
from sambot_viz.displays.scene.solids import Rgb, sphere
from sambot_viz.displays.triangle_display import Triangles
from sambot_viz.geometry import Matrix, Rgba, Vector3
from sambot_viz.meshes.cache import Content
from sambot_viz.meshes.glb import OPAQUE_FROM
from sambot_viz.meshes.mesh import Mesh, MeshPart, Texture, apply_scale
from sambot_viz.meshes.primitives import unit_box, unit_cylinder, unit_sphere
from sambot_viz.robot.parts import (
    Box,
    Capsule,
    Cylinder,
    Geometry,
    Material,
    MeshFile,
    Sphere,
)

DEFAULT_RED: Rgba = (1.0, 0.0, 0.0, 1.0)
"""The colour of a link without a material."""
ERROR_WHITE: Rgb = (255, 255, 255)
UNLIT = "toon3"
"""The page script draws toon materials unlit; nothing else here uses one."""

Painted = (
    viser.BoxHandle | viser.CylinderHandle | viser.MeshHandle | viser.IcosphereHandle
)
WHITE: Rgba = (1.0, 1.0, 1.0, 1.0)
STAND_IN_SIZE = 0.1
"""Edge of the wire box drawn in place of a mesh that could not be read [m]."""
Solid = tuple[Triangles, Matrix]
"""Triangles, and (4, 4) from them to the frame of the shape."""


@dataclass(frozen=True, slots=True)
class ShapeLook:
    """The look of a shape: visible or not, its alpha, or the white of an error.

    Attributes:
        visible: whether it is drawn at all.
        alpha: display alpha times link alpha; multiplied by the material's own.
        error: whether it is white, opaque and unlit, because its link has no transform.
        color: colour that a program has set for the link, 0 to 255; None for its own.
    """

    visible: bool
    alpha: float
    error: bool = False
    color: Rgb | None = None

    @property
    def textured(self) -> bool:
        """Return whether textures are drawn."""
        return not self.error and self.color is None


@dataclass(frozen=True, slots=True)
class ShapePiece:
    """One node, with the colour and alpha of its material.

    Attributes:
        handle: the node.
        color: 0 to 255.
        alpha: the material's.
        textured: a GLB, whose alpha is fixed when it is sent.
    """

    handle: Handle
    color: Rgb
    alpha: float
    textured: bool = False

    def paint(self, look: ShapeLook, before: ShapeLook | None) -> None:
        """Give the node the colour and opacity of a look.

        Args:
            look: how it is to be drawn.
            before: how it is drawn now; None when it was just made.
        """
        self.handle.visible = look.visible
        if not isinstance(self.handle, Painted):
            return
        # viser sends no value twice, but takes longer to find that out than to send it.
        color, opacity = self._paint_of(look)
        was, was_opacity = (
            (self.color, None) if before is None else self._paint_of(before)
        )
        is_error = before is not None and before.error
        if color != was:
            self.handle.color = color
        if look.error != is_error:
            self.handle.material = UNLIT if look.error else "standard"
        if opacity != was_opacity:
            self.handle.opacity = opacity

    def _paint_of(self, look: ShapeLook) -> tuple[Rgb, float | None]:
        """Return the colour and the opacity of the node in a look."""
        if look.error:
            return ERROR_WHITE, None
        own = self.color if look.color is None else look.color
        return own, _opacity_of(look.alpha * self.alpha)


def _opacity_of(alpha: float) -> float | None:
    """Return an alpha as viser's opacity: None (no blending) from `OPAQUE_FROM` on."""
    return None if alpha >= OPAQUE_FROM else max(0.0, alpha)


def rgb255(rgba: Rgba) -> Rgb:
    """Return a colour of 0 to 1 as 0 to 255."""
    red, green, blue = (min(255, max(0, int(c * 255 + 0.5))) for c in rgba[:3])
    return (red, green, blue)


def material_rgba(material: Material | None) -> Rgba:
    """Return a material's colour; RViz's red without one, white under a texture."""
    if material is None:
        return DEFAULT_RED
    return material.rgba or WHITE


def solids_of(geometry: Geometry, content: Content | None) -> list[Solid]:
    """One for each node that the shape is drawn with, in the same order.

    Args:
        geometry: of the shape.
        content: of its mesh file; anything but a mesh gives none.
    """
    if isinstance(geometry, MeshFile):
        parts = content.parts if isinstance(content, Mesh) else ()
        return [(part, _scaled(geometry.scale)) for part in parts]
    if isinstance(geometry, Box):
        return [(unit_box(), _scaled(geometry.size))]
    width = 2 * geometry.radius
    if isinstance(geometry, Sphere):
        return [(sphere(), _scaled((width, width, width)))]
    tube: Solid = (unit_cylinder(), _scaled((width, width, geometry.length)))
    if isinstance(geometry, Cylinder):
        return [tube]
    ends = (geometry.length / 2, -geometry.length / 2)
    return [tube, *((sphere(), _scaled((width, width, width), z)) for z in ends)]


def stand_in() -> Solid:
    """Return the box in place of a mesh that could not be read."""
    return unit_box(), _scaled((STAND_IN_SIZE, STAND_IN_SIZE, STAND_IN_SIZE))


def textured(
    geometry: Box | Cylinder | Sphere | Capsule, texture: Texture
) -> MeshPart | None:
    """A primitive with a texture as a mesh; None for a capsule, which has no uv."""
    if isinstance(geometry, Box):
        shape, scale = unit_box(), geometry.size
    elif isinstance(geometry, Sphere):
        width = 2 * geometry.radius
        shape, scale = unit_sphere(), (width, width, width)
    elif isinstance(geometry, Cylinder):
        width = 2 * geometry.radius
        shape, scale = unit_cylinder(), (width, width, geometry.length)
    else:
        return None
    part = MeshPart(shape.vertices, shape.faces, uv=shape.uv, texture=texture)
    return apply_scale(part, scale)


def _scaled(scale: Vector3, z: float = 0.0) -> Matrix:
    """Return the map that enlarges along the axes, then moves along z."""
    T = np.eye(4)
    T[0, 0], T[1, 1], T[2, 2] = scale
    T[2, 3] = z
    return T
