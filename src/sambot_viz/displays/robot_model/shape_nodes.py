"""One <visual> or <collision> as scene nodes."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TypedDict

import numpy as np
import viser

from sambot_viz import viser_private
from sambot_viz.displays.picking.box_lines import box_lines
from sambot_viz.displays.picking.selectable import Selectable
from sambot_viz.displays.robot_model.shape_solids import (
    STAND_IN_SIZE,
    WHITE,
    ShapeLook,
    ShapePiece,
    material_rgba,
    rgb255,
    solids_of,
    stand_in,
    textured,
)
from sambot_viz.displays.scene.frame_nodes import any_gone, position_of, remove_all
from sambot_viz.displays.scene.session_assets import SessionAssets
from sambot_viz.displays.scene.solids import Rgb, sphere
from sambot_viz.displays.triangle_display import DrawnTriangles
from sambot_viz.errors import Problem
from sambot_viz.geometry import Matrix, Rgba, Vector3, Wxyz, wxyz_from_matrix
from sambot_viz.meshes.asset import Asset
from sambot_viz.meshes.cache import Content
from sambot_viz.meshes.glb import OPAQUE_FROM, has_own_normals, shared_glb
from sambot_viz.meshes.mesh import Mesh, MeshPart, Texture, apply_scale
from sambot_viz.robot.parts import Box, Capsule, Cylinder, MeshFile, Shape, Sphere

STAND_IN_COLOR: Rgb = (255, 140, 0)


class _Placing(TypedDict):
    """Arguments of viser for every solid: its pose, and no shadows, as in RViz."""

    wxyz: Wxyz
    position: Vector3
    cast_shadow: bool
    receive_shadow: bool


def _placing(T: Matrix) -> _Placing:
    return {
        "wxyz": wxyz_from_matrix(T),
        "position": position_of(T),
        "cast_shadow": False,
        "receive_shadow": False,
    }


def is_file(part: MeshPart) -> bool:
    """Return whether a part travels as a file, with its texture or its normals."""
    return part.texture is not None or has_own_normals(part)


class ShapeNode:
    """The nodes of one shape under its link's frame node.

    Primitives and plain meshes change colour and opacity in place; a part with a
    texture or with its own normals is sent again for another opacity.

    Attributes:
        asset: the file it is drawn from, or None.
        waiting: whether the file is being read.
    """

    def __init__(
        self,
        scene: viser.SceneApi,
        name: str,
        shape: Shape,
        asset: Asset | None,
        assets: SessionAssets,
    ) -> None:
        self.waiting = False
        self._scene = scene
        self._name = name
        self._shape = shape
        self._assets = assets
        self.asset = asset
        self._content: Content | None = None
        self._wanted: ShapeLook | None = None
        self._look: ShapeLook | None = None
        self._pieces: list[ShapePiece] = []
        assets.register(self)

    def shows(self, shape: Shape, asset: Asset | None) -> bool:
        """Return whether this is the node of that shape, drawn from that file."""
        # Paths take no part in the comparison of shapes.
        return shape == self._shape and asset == self.asset

    def draw(self, look: ShapeLook) -> None:
        """Create the nodes, or change what differs from the last look.

        What comes from a file that is not read yet is drawn by a later call, while
        `waiting` is true; an older version of it stays until then.
        """
        self._wanted = look
        if look.visible and self.asset is not None:
            self._take_content(self.asset)
        if look == self._look or (self.waiting and not self._pieces):
            return
        if self._pieces and self._must_resend(look):
            self.remove()
        if not self._pieces:
            if not look.visible:
                return
            self._create(look)
        for piece in self._pieces:
            piece.paint(look, self._look)
        self._look = look

    def draw_again(self) -> None:
        """Draw what could not be drawn before its file was read."""
        if self.waiting and self._wanted is not None:
            self.draw(self._wanted)

    @property
    def problem(self) -> str | None:
        """RViz's sentence when the geometry could not be loaded, else None."""
        fault = self._content.message if isinstance(self._content, Problem) else None
        geometry = self._shape.geometry
        if not isinstance(geometry, MeshFile):
            return fault
        text = f"Could not load mesh resource '{geometry.filename}'"
        if geometry.path is None:
            return text
        return None if fault is None else f"{text}: {fault}"

    @property
    def problems(self) -> tuple[Problem, ...]:
        """Problems of the file of the shape."""
        if isinstance(self._content, Problem):
            return (self._content,)
        return self._content.problems if isinstance(self._content, Mesh) else ()

    def _take_content(self, asset: Asset) -> None:
        """Take what the file holds now, if it is read, and drop what it held before."""
        content = self._assets.content(asset)
        self.waiting = content is None
        if content is not None and content is not self._content:
            self.remove()
            self._content = content

    @property
    def gone(self) -> bool:
        """Return whether its nodes went with the frame they hung below."""
        return any_gone(piece.handle for piece in self._pieces)

    def drawn(self, frame: str | None, item: Selectable) -> Iterator[DrawnTriangles]:
        """Yield the parts that are on the screen.

        Args:
            frame: the frame of its link, or None for the fixed frame.
            item: what it belongs to.
        """
        look = self._look
        if look is None or not look.visible or not self._pieces:
            return
        solids = solids_of(self._shape.geometry, self._content)
        solid = bool(solids)
        for piece, (triangles, T_shape_solid) in zip(
            self._pieces, solids or [stand_in()], strict=True
        ):
            if look.error or look.alpha * piece.alpha > 0.0:
                T = self._shape.origin.matrix @ T_shape_solid
                color = look.color or piece.color
                clear = not look.error and look.alpha * piece.alpha < OPAQUE_FROM
                yield DrawnTriangles(triangles, T, frame, item, solid, color, clear)

    def remove(self) -> None:
        """Take the nodes out of the scene."""
        remove_all(piece.handle for piece in self._pieces)
        self._pieces.clear()
        self._look = None

    def _must_resend(self, look: ShapeLook) -> bool:
        before = self._look
        if before is None or before.textured != look.textured:
            return self._has_files
        same = before.alpha == look.alpha
        return not same and any(piece.textured for piece in self._pieces)

    @property
    def _has_files(self) -> bool:
        content = self._content
        if isinstance(content, Mesh):
            return any(is_file(part) for part in content.parts)
        return isinstance(content, Texture)

    def _create(self, look: ShapeLook) -> None:
        pose = _placing(self._shape.origin.matrix)
        geometry, material = self._shape.geometry, self._shape.material
        if isinstance(geometry, MeshFile):
            self._create_mesh(geometry, look, pose)
            return
        part = None
        if isinstance(self._content, Texture) and look.textured:
            part = textured(geometry, self._content)
        if part is not None:
            self._add_part(self._name, part, WHITE, look, pose)
        else:
            self._create_primitive(geometry, material_rgba(material), pose)

    def _create_primitive(
        self, geometry: Box | Cylinder | Sphere | Capsule, rgba: Rgba, pose: _Placing
    ) -> None:
        scene, name, color = self._scene, self._name, rgb255(rgba)
        if isinstance(geometry, Box):
            box = scene.add_box(name, color, geometry.size, **pose)
            self._pieces.append(ShapePiece(box, color, rgba[3]))
            return
        if isinstance(geometry, Sphere):
            self._add_sphere(name, geometry.radius, rgba, pose)
            return
        cylinder = scene.add_cylinder(
            name,
            geometry.radius,
            geometry.length,
            color,
            radial_segments=16,
            flat_shading=True,
            **pose,
        )
        self._pieces.append(ShapePiece(cylinder, color, rgba[3]))
        if isinstance(geometry, Capsule):
            for end, z in (("t", geometry.length / 2), ("b", -geometry.length / 2)):
                T = np.eye(4)
                T[2, 3] = z
                self._add_sphere(f"{name}/{end}", geometry.radius, rgba, _placing(T))

    def _add_sphere(self, name: str, radius: float, rgba: Rgba, pose: _Placing) -> None:
        shape, color = sphere(), rgb255(rgba)
        handle = self._scene.add_mesh_simple(
            name,
            shape.vertices,
            shape.faces,
            color=color,
            flat_shading=True,
            scale=2 * radius,
            **pose,
        )
        self._pieces.append(ShapePiece(handle, color, rgba[3]))

    def _create_mesh(self, geometry: MeshFile, look: ShapeLook, pose: _Placing) -> None:
        if not isinstance(self._content, Mesh):
            self._add_stand_in(pose)
            return
        rgba = material_rgba(self._shape.material)
        for i, part in enumerate(self._content.parts):
            own = (
                rgba if part.rgba is None else (*part.rgba[:3], part.rgba[3] * rgba[3])
            )
            name = self._name if i == 0 else f"{self._name}.{i}"
            self._add_part(name, apply_scale(part, geometry.scale), own, look, pose)

    def _add_part(
        self, name: str, part: MeshPart, rgba: Rgba, look: ShapeLook, pose: _Placing
    ) -> None:
        """A mesh of one colour, or a GLB when it has more than that."""
        color = rgb255(rgba)
        textured = is_file(part) and look.textured
        if textured:
            handle = self._scene.add_glb(
                name, shared_glb(part, rgba, look.alpha), **pose
            )
        else:
            handle = self._scene.add_mesh_simple(
                name,
                part.vertices,
                part.faces,
                color=color,
                flat_shading=part.normals is None,
                **pose,
            )
            viser_private.share_arrays(handle, vertices=part.vertices, faces=part.faces)
        self._pieces.append(ShapePiece(handle, color, rgba[3], textured))

    def _add_stand_in(self, pose: _Placing) -> None:
        """A box of orange lines where the mesh should be."""
        lines = self._scene.add_line_segments(
            self._name,
            box_lines([-STAND_IN_SIZE / 2] * 3, [STAND_IN_SIZE / 2] * 3),
            colors=STAND_IN_COLOR,
            thickness=1.5,
            thickness_units="screen",
            wxyz=pose["wxyz"],
            position=pose["position"],
        )
        self._pieces.append(ShapePiece(lines, STAND_IN_COLOR, 1.0))
