"""Mesh files that markers name: found, read and allowed as those of a robot are."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from typing import Any
from xml.sax.saxutils import quoteattr

from sambot_viz import limits, viser_private
from sambot_viz.displays.data.markers.marker_fields import alpha_of, rgb_of
from sambot_viz.displays.display import DisplayContext
from sambot_viz.displays.picking.placed import PlacedMesh
from sambot_viz.displays.picking.selectable import Selectable
from sambot_viz.displays.picking.triangle_mesh import TriangleMesh
from sambot_viz.displays.robot_display import Description, ModelRequest, ModelResult
from sambot_viz.displays.robot_model.shape_solids import rgb255
from sambot_viz.displays.scene.frame_nodes import Handle, NodeCache, any_gone, placed
from sambot_viz.displays.scene.solids import Rgb
from sambot_viz.errors import Problem, RobotError
from sambot_viz.geometry import IDENTITY, ORIGIN, Matrix, Rgba, Vector3, Wxyz
from sambot_viz.matrices import matrix_from_wxyz
from sambot_viz.meshes.asset import Asset
from sambot_viz.meshes.cache import Content
from sambot_viz.meshes.glb import OPAQUE_FROM, has_own_normals, to_glb
from sambot_viz.meshes.mesh import WHITE, Mesh, MeshPart, apply_scale
from sambot_viz.robot.model import asset_of
from sambot_viz.robot.packages.file_finder import why_not_found

_STRONGEST_TINT = 0.5


class MeshFinder:
    """Finds one mesh file.

    The name is looked up as that of a robot with a single shape would be, so markers
    can open the same files as a robot from a topic, and no others; a live robot serves
    them.

    Args:
        context: reads models.
        resource: the name in the marker.
        found: called when the file is known, or known to be missing.

    Attributes:
        resource: the name in the marker.
        asset: the file; None while it is not found.
        is_done: whether the search has ended.
        reason: why it was not found, the searched places, and what to do.
    """

    def __init__(
        self, context: DisplayContext, resource: str, found: Callable[[], None]
    ) -> None:
        self.asset: Asset | None = None
        self.is_done = False
        self.reason = ""
        self._apply = context.apply
        self._found = found
        self.resource = resource
        if len(resource) > limits.ASSET_NAME.value:
            self.reason = f"the address has {limits.ASSET_NAME.said(len(resource))}"
        if context.models is None or self.reason:
            self.is_done = True
            return
        text = (
            '<robot name="marker"><link name="marker"><visual><geometry>'
            f"<mesh filename={quoteattr(resource)}/>"
            "</geometry></visual></link></robot>"
        )
        described = Description("", text, label="marker")
        context.models.read(ModelRequest(self, described, False, self._take))

    def _take(self, result: ModelResult) -> None:
        """Take what was read; called in the thread that reads."""
        if not isinstance(result, RobotError):
            visuals = [v for link in result.links.values() for v in link.visuals]
            if visuals:
                self.asset = asset_of(visuals[0], result.file_roots)
            self.reason = why_not_found(result.problems)
        self.is_done = True
        self._apply(self._found)


@dataclass(frozen=True, slots=True)
class _Look:
    """The colouring of a mesh.

    Attributes:
        color: the colour of the whole mesh, or blended over its own colours.
        tint: weight of the blending; None for the colour alone.
        alpha: 0 to 1.
    """

    color: Rgb
    tint: float | None
    alpha: float

    def of(self, part: MeshPart) -> tuple[Rgba, bool, Rgba | None]:
        """Return the colour of a part, whether its texture stays, and the overlay."""
        red, green, blue = (c / 255 for c in self.color)
        if self.tint is None:
            return (red, green, blue, self.alpha), False, None
        if part.rgba is None and part.texture is None:
            # RViz takes the colour for the overlay, and draws it alone.
            alpha = self.alpha if self.alpha >= OPAQUE_FROM else self.tint
            return (red, green, blue, alpha), False, None
        own, textured = (part.rgba or WHITE)[:3], part.texture is not None
        if not self.tint:
            return (*own, self.alpha), textured, None
        # RViz draws the mesh, and the colour over it once more.
        over = (red, green, blue, self.tint)
        if textured:
            return (*own, self.alpha), True, over
        own_part = self.alpha * (1 - self.tint)
        alpha = own_part + self.tint
        mixed = [
            (c * own_part + new * self.tint) / alpha
            for c, new in zip(own, over[:3], strict=True)
        ]
        return (mixed[0], mixed[1], mixed[2], alpha), False, None


def look_of(marker: Any) -> _Look:
    """Return how the mesh of a marker is coloured."""
    color, alpha = rgb_of(marker.color), alpha_of(marker.color)
    if not marker.mesh_use_embedded_materials:
        return _Look(color, None, alpha)
    if color == (0, 0, 0) and alpha == 0.0:
        return _Look(color, 0.0, 1.0)
    return _Look(color, min(alpha, _STRONGEST_TINT), alpha)


class MeshNodes:
    """The parts of one mesh file, each a node.

    Args:
        context: the scene and the files.
        name: of the first node.

    Attributes:
        finder: knows the file; set by whoever draws.
    """

    def __init__(self, context: DisplayContext, name: str) -> None:
        self.finder: MeshFinder | None = None
        self.asset: Asset | None = None
        self._context = context
        self._name = name
        self._nodes = NodeCache()
        self._content: Content | None = None
        self._parts: list[MeshPart] = []
        self._triangles: list[TriangleMesh] | None = None
        self._pose: tuple[Wxyz, Vector3] = (IDENTITY, ORIGIN)
        context.assets.register(self)

    @property
    def fault(self) -> str | None:
        """RViz's sentence, and the reason, for a file that is missing or unreadable."""
        finder, reason = self.finder, ""
        if finder is None or not finder.is_done:
            return None
        if finder.asset is None:
            reason = finder.reason
        elif isinstance(self._content, Problem):
            reason = self._content.message
        else:
            return None
        return f"could not load [{finder.resource}]{reason and f': {reason}'}"

    def draw(self, marker: Any, wxyz: Wxyz, position: Vector3) -> None:
        """Draw the mesh of a marker, if it is read.

        Args:
            marker: names it.
            wxyz: rotation in the frame of the node above.
            position: there [m].
        """
        self.asset = None if self.finder is None else self.finder.asset
        content = None
        if self.asset is not None:
            content = self._context.assets.content(self.asset)
        self._content = content
        if not isinstance(content, Mesh):
            self._nodes.remove()
            return
        mesh, look, pose = content, look_of(marker), placed(wxyz, position)
        scale = (
            float(marker.scale.x),
            float(marker.scale.y),
            float(marker.scale.z),
        )
        self._nodes.show(
            (id(mesh), look, pose, scale), lambda: self._add(mesh, look, pose, scale)
        )

    def placed(
        self, T_fixed_above: Matrix, item: Selectable | None
    ) -> Iterator[PlacedMesh]:
        """Yield the parts for rays, if they are drawn.

        Args:
            T_fixed_above: (4, 4), of the node above.
            item: what they are to a selection.
        """
        if not self._nodes.handles or any_gone(self._nodes.handles):
            return
        if self._triangles is None:
            parts = self._parts
            self._triangles = [TriangleMesh.of(p.vertices, p.faces) for p in parts]
        T = T_fixed_above @ matrix_from_wxyz(*self._pose)
        for mesh in self._triangles:
            yield PlacedMesh(item, mesh, T)

    def remove(self) -> None:
        """Take it out of the scene."""
        self._nodes.remove()

    def _add(
        self, mesh: Mesh, look: _Look, pose: tuple[Wxyz, Vector3], scale: Vector3
    ) -> list[Handle]:
        handles: list[Handle] = []
        self._parts, self._triangles, self._pose = [], None, pose
        for number, own in enumerate(mesh.parts):
            part = apply_scale(own, scale)
            self._parts.append(part)
            name = self._name if number == 0 else f"{self._name}.{number}"
            handles.append(self._add_part(name, part, look, pose))
        return handles

    def _add_part(
        self,
        name: str,
        part: MeshPart,
        look: _Look,
        pose: tuple[Wxyz, Vector3],
    ) -> Handle:
        scene = self._context.scene
        rgba, textured, over = look.of(part)
        if textured or has_own_normals(part):
            shown = part if textured else replace(part, texture=None)
            return scene.add_glb(
                name,
                to_glb(shown, rgba=rgba, over=over),
                wxyz=pose[0],
                position=pose[1],
                cast_shadow=False,
                receive_shadow=False,
            )
        handle = scene.add_mesh_simple(
            name,
            part.vertices,
            part.faces,
            color=rgb255(rgba),
            opacity=rgba[3] if rgba[3] < OPAQUE_FROM else None,
            flat_shading=part.normals is None,
            wxyz=pose[0],
            position=pose[1],
            cast_shadow=False,
            receive_shadow=False,
        )
        viser_private.share_arrays(handle, vertices=part.vertices, faces=part.faces)
        return handle
