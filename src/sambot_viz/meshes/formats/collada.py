"""COLLADA (.dae), as RViz shows it.

`<unit meter>` is applied, `<up_axis>` is not, node transforms are baked in, only the
first uv set counts, colours are those of the file. Files that are not well-formed are
recovered with a warning, because RViz shows many of them.

trimesh with pycollada is not used: of 1,707 real files it reads 42 as empty without an
error, leaves `<unit>` out in 206, loses a material or a texture in 126 and cuts 22
concave polygons differently from Assimp.
"""

from __future__ import annotations

import math
import xml.etree.ElementTree as ET
from collections.abc import Iterator

import numpy as np

from sambot_viz import limits
from sambot_viz.geometry import Matrix
from sambot_viz.meshes.assembly.assemble import Submesh, placed
from sambot_viz.meshes.formats.collada_geometry import Geometry, read_geometry
from sambot_viz.meshes.formats.collada_material import Materials
from sambot_viz.meshes.formats.collada_xml import ColladaDocument, parse_document
from sambot_viz.meshes.mesh_source import MeshSource

FEW_CHILDREN = 20
"""Number of transforms and parts with which a node counts as two."""


def read_collada(source: MeshSource) -> list[Submesh]:
    """Return the triangles of a COLLADA file [m].

    Raises:
        MeshError: the file is not COLLADA, even when read leniently.
    """
    document = parse_document(source)
    materials = Materials(document, source)
    scene = _Scene(document, materials, source)
    pieces = list(scene.pieces())
    if not pieces:
        pieces = list(scene.loose_pieces())
    return pieces


class _Scene:
    """The tree of nodes, turned into pieces."""

    def __init__(
        self, document: ColladaDocument, materials: Materials, source: MeshSource
    ) -> None:
        self.document = document
        self.materials = materials
        self.source = source
        self.unit = _unit(document, source)
        self._geometries: dict[int, Geometry] = {}
        self._locals: dict[int, Matrix] = {}

    def pieces(self) -> Iterator[Submesh]:
        """Yield what the scene shows."""
        scene = self.document.root.find("scene/instance_visual_scene")
        visual = self.document.target(scene) if scene is not None else None
        if visual is None:
            visual = self.document.root.find("library_visual_scenes/visual_scene")
        if visual is not None:
            for node in visual.findall("node"):
                yield from self._node(
                    node, _scaling(self.unit, self.unit, self.unit), 0
                )

    def loose_pieces(self) -> Iterator[Submesh]:
        """Yield every geometry, for files whose scene shows none of them."""
        start = _scaling(self.unit, self.unit, self.unit)
        for geometry in self.document.root.iterfind("library_geometries/geometry"):
            pieces = list(self._geometry(geometry, None, start))
            if pieces:
                self.source.warn(
                    "mesh-scene-missing",
                    "the COLLADA file has no scene that shows its geometries; they are "
                    "drawn where the file has them",
                    "export the mesh again",
                )
            yield from pieces

    def _node(self, node: ET.Element, T: Matrix, depth: int) -> Iterator[Submesh]:
        if depth > limits.MESH_DEPTH.value:
            self.source.warn(
                "mesh-nodes-too-deep",
                "the COLLADA nodes contain themselves or are "
                f"nested more than {limits.MESH_DEPTH.value} deep; the rest is left "
                "out",
            )
            return
        # A node has a few transforms, and may be named again and again.
        self.source.budget.spend_nodes(1 + len(node) // FEW_CHILDREN)
        local = self._locals.get(id(node))
        if local is None:
            local = self._locals[id(node)] = _local_transform(node)
        T_root_node = T @ local
        for child in node:
            if child.tag == "node":
                yield from self._node(child, T_root_node, depth + 1)
            elif child.tag == "instance_node":
                target = self.document.target(child)
                if target is not None:
                    yield from self._node(target, T_root_node, depth + 1)
            elif child.tag == "instance_geometry":
                target = self.document.target(child)
                if target is not None:
                    yield from self._geometry(target, child, T_root_node)
            elif child.tag == "instance_controller":
                yield from self._controller(child, T_root_node)

    def _controller(self, instance: ET.Element, T: Matrix) -> Iterator[Submesh]:
        """Yield a skinned mesh is drawn in the pose it was bound in."""
        controller = self.document.target(instance)
        skin = controller.find("skin") if controller is not None else None
        if skin is None:
            return
        target = self.document.by_id(skin.get("source"))
        if target is not None:
            bind = _numbers(skin.findtext("bind_shape_matrix"), 16)
            T_bind = np.eye(4) if bind is None else np.reshape(bind, (4, 4))
            yield from self._geometry(target, instance, T @ T_bind)

    def _geometry(
        self, element: ET.Element, instance: ET.Element | None, T: Matrix
    ) -> Iterator[Submesh]:
        geometry = self._geometries.get(id(element))
        if geometry is None:
            geometry = read_geometry(element, self.document, self.source)
            self._geometries[id(element)] = geometry
        # A few nodes can name the same geometry a million times, an empty one too.
        # So can one geometry have a million parts without a triangle.
        self.source.budget.spend_nodes(1 + len(geometry))
        bound = self.materials.bindings(instance)
        for primitives in geometry:
            self.source.budget.spend_triangles(
                len(primitives.faces), len(primitives.vertices)
            )
            look = self.materials.look(primitives.symbol, bound)
            yield placed(
                Submesh(
                    vertices=primitives.vertices,
                    faces=primitives.faces,
                    normals=primitives.normals,
                    rgba=look.rgba,
                    uv=primitives.uv,
                    texture=look.texture,
                ),
                T,
            )


def _unit(document: ColladaDocument, source: MeshSource) -> float:
    element = document.root.find("asset/unit")
    text = element.get("meter") if element is not None else None
    if text is None:
        return 1.0
    value = _numbers(text, 1)
    if value is None or not value[0] > 0:
        source.warn(
            "mesh-unit-invalid",
            f'<unit meter="{text}"> is not a positive number; 1 m is used',
            'write the length of one unit in metres, for example meter="0.001"',
        )
        return 1.0
    return float(value[0])


def _scaling(x: float, y: float, z: float) -> Matrix:
    """Return the (4, 4) matrix that enlarges."""
    return np.array([[x, 0, 0, 0], [0, y, 0, 0], [0, 0, z, 0], [0, 0, 0, 1]], float)


def _local_transform(node: ET.Element) -> Matrix:
    local = np.eye(4)
    for child in node:
        step = _TRANSFORMS.get(child.tag)
        if step is not None:
            local = local @ step(child.text)
    return local


def _numbers(text: str | None, count: int) -> Matrix | None:
    try:
        values = np.array((text or "").split(), dtype=np.float64)
    except ValueError:
        return None
    return values if len(values) == count and np.isfinite(values).all() else None


def _matrix(text: str | None) -> Matrix:
    values = _numbers(text, 16)
    return np.eye(4) if values is None else np.reshape(values, (4, 4))


def _translate(text: str | None) -> Matrix:
    T = np.eye(4)
    values = _numbers(text, 3)
    if values is not None:
        T[:3, 3] = values
    return T


def _scale(text: str | None) -> Matrix:
    values = _numbers(text, 3)
    return np.eye(4) if values is None else _scaling(*values)


def _rotate(text: str | None) -> Matrix:
    T = np.eye(4)
    values = _numbers(text, 4)
    length = 0.0 if values is None else float(np.linalg.norm(values[:3]))
    if values is None or length == 0:
        return T
    x, y, z = values[:3] / length
    angle = math.radians(values[3])
    K = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    T[:3, :3] += math.sin(angle) * K + (1 - math.cos(angle)) * (K @ K)
    return T


def _lookat(text: str | None) -> Matrix:
    T = np.eye(4)
    values = _numbers(text, 9)
    if values is None:
        return T
    eye, target, up = np.reshape(values, (3, 3))
    back = eye - target
    right = np.cross(up, back)
    if not np.linalg.norm(back) or not np.linalg.norm(right):
        return T
    back, right = back / np.linalg.norm(back), right / np.linalg.norm(right)
    T[:3] = np.column_stack([right, np.cross(back, right), back, eye])
    return T


_TRANSFORMS = {
    "matrix": _matrix,
    "translate": _translate,
    "scale": _scale,
    "rotate": _rotate,
    "lookat": _lookat,
}
