"""The part of a glTF file that is drawn, as a document of its own for trimesh.

Every name and count in it is checked, so that trimesh meets nothing unknown: one scene,
nodes that are a tree, triangles and strips with positions, normals and one uv set.
"""

from __future__ import annotations

from typing import cast

from sambot_viz.meshes.formats.gltf_file import GltfFile
from sambot_viz.meshes.formats.gltf_json import (
    Broken,
    Json,
    entry,
    listing,
    numbers,
    section,
    whole,
)
from sambot_viz.meshes.formats.gltf_material import GltfMaterials
from sambot_viz.meshes.formats.gltf_numbers import GltfNumbers
from sambot_viz.meshes.formats.gltf_primitive import GltfPrimitive, read_primitive

_DEEPEST = 200
_TRANSFORM = {"matrix": 16, "translation": 3, "rotation": 4, "scale": 3}


class GltfCopy:
    """Copies the nodes that the default scene shows, and what they use.

    Attributes:
        nodes: of the copy, in the order in which they are drawn.
        meshes: the primitives of each mesh; none is empty.
        numbers: accessors, views and buffers.
    """

    def __init__(self, file: GltfFile) -> None:
        self.nodes: list[Json] = []
        self.meshes: list[list[GltfPrimitive]] = []
        self.numbers = GltfNumbers(file)
        self._file = file
        self._document = file.document
        self._budget = file.source.budget
        self._materials = GltfMaterials(file)
        self._known: dict[int, int | None] = {}
        self._roots = [self._node(root, 0) for root in self._drawn_roots()]

    def document(self) -> Json:
        """The JSON that trimesh reads."""
        return {
            "asset": {"version": "2.0"},
            "scene": 0,
            "scenes": [{"nodes": self._roots}],
            "nodes": self.nodes,
            "meshes": [
                {"name": str(number), "primitives": [each.json for each in mesh]}
                for number, mesh in enumerate(self.meshes)
            ],
            "accessors": self.numbers.accessors,
            "bufferViews": self.numbers.views,
            "buffers": [{"uri": name} for name in self.numbers.data],
        }

    def _drawn_roots(self) -> list[int]:
        """The nodes of the default scene; every root when there is no scene."""
        if listing(self._document, "scenes"):
            scene = entry(self._document, "scenes", self._document.get("scene", 0))
            return numbers(scene, "nodes")
        count = len(listing(self._document, "nodes"))
        nodes = [entry(self._document, "nodes", k) for k in range(count)]
        below = {child for node in nodes for child in numbers(node, "children")}
        return [number for number in range(count) if number not in below]

    def _node(self, number: int, depth: int) -> int:
        if depth > _DEEPEST:
            raise Broken(f"its nodes contain themselves or nest over {_DEEPEST} deep")
        self._budget.spend_nodes()
        node = entry(self._document, "nodes", number)
        new = len(self.nodes)
        copied = _transform(node)
        self.nodes.append(copied)
        if "mesh" in node:
            mesh = self._mesh(entry(self._document, "meshes", node["mesh"]))
            if mesh is not None:
                copied["mesh"] = mesh
        children = numbers(node, "children")
        copied["children"] = [self._node(child, depth + 1) for child in children]
        return new

    def _mesh(self, mesh: Json) -> int | None:
        """The number of a mesh in the copy; None when it has no triangles."""
        primitives = [
            cast(Json, item)
            for item in listing(mesh, "primitives")
            if isinstance(item, dict)
        ]
        for primitive in primitives:
            # Counted for every node, before any memory is taken for it.
            vertices = self._count(section(primitive, "attributes").get("POSITION"))
            corners = self._count(primitive.get("indices"))
            self._budget.spend_triangles((corners or vertices) // 3, vertices)
        if id(mesh) not in self._known:
            every = [
                read_primitive(primitive, self._file, self.numbers, self._materials)
                for primitive in primitives
            ]
            drawn = [primitive for primitive in every if primitive is not None]
            self._known[id(mesh)] = len(self.meshes) if drawn else None
            self.meshes += [drawn] if drawn else []
        return self._known[id(mesh)]

    def _count(self, number: object) -> int:
        """How many entries an accessor announces; 0 when there is no such accessor."""
        try:
            return whole(entry(self._document, "accessors", number), "count")
        except Broken:
            return 0


def _transform(node: Json) -> Json:
    """The part of a node that says where it is."""
    found: Json = {}
    for name, count in _TRANSFORM.items():
        if name in node:
            values = listing(node, name)
            if len(values) != count or not all(
                isinstance(value, (int, float)) for value in values
            ):
                raise Broken("a node's transform is not made of numbers")
            found[name] = values
    return found
