"""Triangles of one look in a glTF file: what trimesh is given, what is made of it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from sambot_viz.meshes.assembly.arrays import triples
from sambot_viz.meshes.assembly.assemble import Submesh
from sambot_viz.meshes.assembly.materials import MeshMaterial
from sambot_viz.meshes.formats.gltf_file import GltfFile
from sambot_viz.meshes.formats.gltf_json import Broken, Json, entry, section
from sambot_viz.meshes.formats.gltf_material import GltfMaterials
from sambot_viz.meshes.formats.gltf_numbers import GltfNumbers

_TRIANGLES, _STRIP, _FAN = 4, 5, 6
_UV, _INDEX = "_UV", "_INDEX"
"""trimesh keeps attributes whose names begin with "_" as they are."""
_NO_NUMBERS: Json = {"componentType": 5125, "count": 0, "type": "SCALAR"}
_ATTRIBUTES = {
    "POSITION": ("vertices", 3),
    "NORMAL": ("vertex_normals", 3),
    _UV: (_UV, 2),
}
"""Where trimesh puts them, and how wide they are."""


@dataclass(frozen=True, slots=True)
class GltfPrimitive:
    """Triangles of one look.

    Attributes:
        json: what trimesh reads of them.
        look: colour and texture.
        mode: list, strip or fan of triangles, as in the file.
        normalized: the attributes whose integers are fractions of the largest one.
        shared: as in `Submesh`.
    """

    json: Json
    look: MeshMaterial
    mode: int
    normalized: frozenset[str]
    shared: bool

    def submesh(self, loaded: dict[str, Any]) -> Submesh:
        """The triangles, from what trimesh has read.

        Raises:
            Broken: sparse changes of an entry that does not exist.
        """
        arrays = {**loaded, **loaded.get("vertex_attributes", {})}
        values = {
            name: self._values(arrays, name)
            for name in _ATTRIBUTES
            if name in self.json["attributes"]
        }
        uv = values.get(_UV)
        if uv is not None:
            # v = 0 is the first row of the image in glTF, and the last one here.
            uv = np.column_stack([uv[:, 0], 1 - uv[:, 1]])
        return Submesh(
            vertices=values["POSITION"].astype(np.float64),
            faces=self._faces(arrays),
            normals=values.get("NORMAL"),
            rgba=self.look.rgba,
            uv=uv,
            texture=self.look.texture,
            shared=self.shared,
        )

    def _values(self, arrays: dict[str, Any], name: str) -> npt.NDArray[Any]:
        """One attribute, with the sparse changes and fractions that trimesh ignores."""
        table: npt.NDArray[Any] = arrays[_ATTRIBUTES[name][0]]
        if f"_{name}_AT" in arrays:
            places = np.ravel(arrays[f"_{name}_AT"]).astype(np.int64)
            if not 0 <= places.min() <= places.max() < len(table):
                raise Broken("a sparse accessor changes an entry that does not exist")
            table = np.array(table)
            table[places] = arrays[f"_{name}_TO"]
        if name in self.normalized and table.dtype.kind in "iu":
            top = np.iinfo(table.dtype).max
            return np.maximum(table.astype(np.float32) / top, -1.0)
        return table.astype(np.float32)

    def _faces(self, arrays: dict[str, Any]) -> npt.NDArray[np.int64]:
        """Those of trimesh, or ours for a kind that it does not read."""
        if len(arrays["faces"]):
            return arrays["faces"].astype(np.int64)
        everything = np.arange(len(arrays["vertices"]))
        index = np.ravel(arrays.get(_INDEX, everything)).astype(np.int64)
        if self.mode != _FAN:
            return index[triples(len(index) // 3)]
        k = np.arange(len(index) - 2, dtype=np.int64)
        return index[np.column_stack([0 * k, k + 1, k + 2])]


def read_primitive(
    primitive: Json, file: GltfFile, copy: GltfNumbers, materials: GltfMaterials
) -> GltfPrimitive | None:
    """Check a primitive, an entry of a mesh of the file, and copy its numbers.

    Returns:
        None for one without triangles: RViz ignores points and lines.

    Raises:
        Broken: it names something that does not exist or does not fit.
    """
    mode = primitive.get("mode", _TRIANGLES)
    attributes = section(primitive, "attributes")
    if mode not in (_TRIANGLES, _STRIP, _FAN) or "POSITION" not in attributes:
        return None
    look, uv_set = materials.look(primitive.get("material"))
    names = {"POSITION": "POSITION", "NORMAL": "NORMAL"}
    if look.texture is not None:
        names[_UV] = f"TEXCOORD_{uv_set}"
    wanted = {k: attributes[name] for k, name in names.items() if name in attributes}
    copied, normalized = _copy_attributes(wanted, file, copy)
    index, vertices = None, copy.count(copied["POSITION"])
    corners = vertices
    if "indices" in primitive:
        index = copy.add(entry(file.document, "accessors", primitive["indices"]), 1)
        corners = copy.count(index)
    if corners < 3:
        return None
    json: Json = {"attributes": copied, "mode": mode}
    if mode == _FAN or (mode == _TRIANGLES and corners % 3):
        # No faces for trimesh; they are made here.
        copied.update({} if index is None else {_INDEX: index})
        json.update(mode=_TRIANGLES, indices=copy.add(_NO_NUMBERS, 1))
    elif index is not None:
        json["indices"] = index
    # Vertices split for a texture that is not shown are joined again, and so are those
    # of files that do not share any.
    split = look.texture is None and "TEXCOORD_0" in attributes
    return GltfPrimitive(json, look, mode, normalized, corners > vertices and not split)


def _copy_attributes(
    wanted: dict[str, object], file: GltfFile, copy: GltfNumbers
) -> tuple[dict[str, int], frozenset[str]]:
    """Those that have as many entries as there are positions; which are normalized."""
    copied: dict[str, int] = {}
    normalized: set[str] = set()
    for name, number in wanted.items():
        accessor = entry(file.document, "accessors", number)
        added = copy.add_with_changes(name, accessor, _ATTRIBUTES[name][1])
        if name == "POSITION" or (
            copy.count(added[name]) == copy.count(copied["POSITION"])
        ):
            copied.update(added)
            if accessor.get("normalized") is True:
                normalized.add(name)
    return copied, frozenset(normalized)
