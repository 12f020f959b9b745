"""The numbers of a glTF file: buffers, views and accessors."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import numpy.typing as npt

from sambot_viz.meshes.assembly.arrays import table_of
from sambot_viz.meshes.formats.gltf_json import Broken, Json, entry, section, whole
from sambot_viz.meshes.source import MeshBudget

_TYPES: dict[int, str] = {
    5120: "<i1",
    5121: "<u1",
    5122: "<i2",
    5123: "<u2",
    5125: "<u4",
    5126: "<f4",
}
_WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}


class Accessors:
    """Typed arrays by accessor number."""

    def __init__(
        self, document: Json, buffer: Callable[[int], bytes], budget: MeshBudget
    ) -> None:
        """`buffer` gives the bytes of a buffer by its number."""
        self.document = document
        self.budget = budget
        self.buffer = buffer

    def view(self, number: object) -> bytes:
        """The bytes of a buffer view."""
        view = entry(self.document, "bufferViews", number)
        data = self.buffer(whole(view, "buffer"))
        start = whole(view, "byteOffset", 0)
        end = start + whole(view, "byteLength")
        if end > len(data):
            raise Broken(f"a buffer view ends at byte {end} of {len(data)}")
        return data[start:end]

    def count(self, number: object) -> int:
        """How many entries an accessor announces; 0 when there is no such accessor."""
        try:
            return whole(entry(self.document, "accessors", number), "count")
        except Broken:
            return 0

    def array(self, number: object, width: int) -> npt.NDArray[Any]:
        """(count, width) of whatever type the file uses, normalized ones as floats."""
        accessor = entry(self.document, "accessors", number)
        dtype = np.dtype(_TYPES.get(whole(accessor, "componentType"), "V0"))
        count = whole(accessor, "count")
        if not dtype.itemsize or _WIDTHS.get(str(accessor.get("type"))) != width:
            raise Broken("an accessor has an unknown or an unexpected type")
        if "bufferView" in accessor:
            start = whole(accessor, "byteOffset", 0)
            table = self._table(accessor["bufferView"], start, count, dtype, width)
        else:
            self.budget.spend_without_data(count)
            table = np.zeros((count, width), dtype=dtype)
        if "sparse" in accessor:
            table = self._sparse(table, section(accessor, "sparse"))
        if accessor.get("normalized") is True and dtype.kind in "iu":
            top = np.iinfo(dtype).max
            table = np.maximum(table.astype(np.float32) / top, -1.0)
        return table

    def _table(
        self, number: object, start: int, count: int, dtype: np.dtype[Any], width: int
    ) -> npt.NDArray[Any]:
        data = self.view(number)
        row = dtype.itemsize * width
        view = entry(self.document, "bufferViews", number)
        stride = whole(view, "byteStride", 0) or row
        if stride < row or (count and start + stride * (count - 1) + row > len(data)):
            raise Broken(f"an accessor of {count} entries does not fit its buffer view")
        if stride == row:
            flat = np.frombuffer(data, dtype=dtype, offset=start, count=count * width)
            return table_of(flat, width)
        return np.ndarray((count, width), dtype, data, start, (stride, dtype.itemsize))

    def _sparse(self, table: npt.NDArray[Any], sparse: Json) -> npt.NDArray[Any]:
        count = whole(sparse, "count")
        where, values = section(sparse, "indices"), section(sparse, "values")
        kind = np.dtype(_TYPES.get(whole(where, "componentType"), "V0"))
        if not kind.itemsize:
            raise Broken("an accessor has an unknown type")
        start = whole(where, "byteOffset", 0)
        places = self._table(where.get("bufferView"), start, count, kind, 1)[:, 0]
        start = whole(values, "byteOffset", 0)
        changed = self._table(
            values.get("bufferView"), start, count, table.dtype, table.shape[1]
        )
        if count and int(places.max()) >= len(table):
            raise Broken("a sparse accessor changes an entry that does not exist")
        patched = np.array(table)
        patched[places] = changed
        return patched
