"""The arrays of a glTF file that are drawn, checked before trimesh takes memory."""

from __future__ import annotations

from sambot_viz.meshes.formats.gltf_file import GltfFile
from sambot_viz.meshes.formats.gltf_json import Broken, Json, entry, section, whole

_SIZES = {5120: 1, 5121: 1, 5122: 2, 5123: 2, 5125: 4, 5126: 4}
_SHAPES = {1: "SCALAR", 2: "VEC2", 3: "VEC3"}


class GltfNumbers:
    """Accessors copied from a file, each with a view and a buffer of its own.

    Attributes:
        accessors: of the copy.
        views: its "bufferViews".
        data: the bytes of each buffer by its name, not copied; trimesh's resolver.
    """

    def __init__(self, file: GltfFile) -> None:
        self.accessors: list[Json] = []
        self.views: list[Json] = []
        self.data: dict[str, memoryview] = {}
        self._file = file

    def add(self, accessor: Json, width: int) -> int:
        """Copy an accessor whose entries are `width` numbers; its new number.

        Raises:
            Broken: it does not fit its bytes, or is of another type.
        """
        code, count = whole(accessor, "componentType"), whole(accessor, "count")
        if code not in _SIZES or accessor.get("type") != _SHAPES[width]:
            raise Broken("an accessor has an unknown or an unexpected type")
        new: Json = {"componentType": code, "count": count, "type": _SHAPES[width]}
        if "bufferView" not in accessor:
            self._file.source.budget.spend_without_data(count)
        elif count:
            new["bufferView"] = self._add_view(accessor, count, _SIZES[code] * width)
        self.accessors.append(new)
        return len(self.accessors) - 1

    def add_with_changes(self, name: str, accessor: Json, width: int) -> dict[str, int]:
        """Copy the accessor of an attribute, and its sparse changes as two more."""
        copied = {name: self.add(accessor, width)}
        sparse = section(accessor, "sparse")
        if sparse and whole(sparse, "count"):
            places = {**section(sparse, "indices"), "type": "SCALAR"}
            values = {**accessor, "byteOffset": 0, **section(sparse, "values")}
            for end, changes, size in (("AT", places, 1), ("TO", values, width)):
                changes["count"] = sparse["count"]
                copied[f"_{name}_{end}"] = self.add(changes, size)
        return copied

    def count(self, number: int) -> int:
        """How many entries an accessor of the copy has."""
        return self.accessors[number]["count"]

    def _add_view(self, accessor: Json, count: int, row: int) -> int:
        number = accessor["bufferView"]
        data = self._file.view(number)
        start = whole(accessor, "byteOffset", 0)
        view = entry(self._file.document, "bufferViews", number)
        stride = whole(view, "byteStride", 0) or row
        if stride < row or start + stride * (count - 1) + row > len(data):
            raise Broken(f"an accessor of {count} entries does not fit its buffer view")
        new = len(self.views)
        self.views.append({"buffer": new, "byteLength": len(data) - start})
        if stride != row:
            self.views[new]["byteStride"] = stride
        self.data[str(new)] = data[start:]
        return new
