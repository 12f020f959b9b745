"""Foxglove's packed fields: clouds, grids and voxels, as ROS has them.

What ROS packs alike stays a view of the message; the rest is computed by the column.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from sambot_viz import limits
from sambot_viz.errors import DecodeError
from sambot_viz.meanings.foxglove.common_parts import header_of, part, parts, pose_of
from sambot_viz.meanings.schema_row import SENSOR_POSE, Fields
from sambot_viz.messages.shape import bytes_of, real_number, whole_number

Values = npt.NDArray[Any]
Bytes = npt.NDArray[np.uint8]

_KINDS = ("", "u1", "i1", "<u2", "<i2", "<u4", "<i4", "<f4", "<f8")
"""Foxglove's numeric types, by their numbers."""
_DATATYPES = {
    **{"i1": 1, "u1": 2, "<i2": 3, "<u2": 4, "<i4": 5, "<u4": 6, "<f4": 7, "<f8": 8}
}
"""The datatype of a sensor_msgs/PointField for each of them."""
_FLOAT = "<f4"
_COLORS = ("red", "green", "blue")


@dataclass(frozen=True, slots=True)
class _Packed:
    """Contiguous elements.

    Attributes:
        rows: (N, stride) uint8, a view of the message.
        places: name of a field → its offset in a row, and numpy's type.
    """

    rows: Bytes
    places: Mapping[str, tuple[int, str]]

    @classmethod
    def of(cls, rows: Bytes, fields: Fields) -> _Packed:
        """Return rows with the fields of a message that they have room for."""
        places: dict[str, tuple[int, str]] = {}
        for one in parts(fields, "fields"):
            number = whole_number(one.get("type"))
            kind = _KINDS[number] if 0 < number < len(_KINDS) else ""
            offset = whole_number(one.get("offset"))
            if kind and 0 <= offset <= rows.shape[1] - np.dtype(kind).itemsize:
                places[str(one.get("name", ""))] = offset, kind
        return cls(rows, places)

    def column(self, name: str) -> Values:
        """Return the values of a field, (N,): a view of the message."""
        offset, kind = self.places[name]
        count, stride = self.rows.shape
        shape: Any = {
            "names": ["value"],
            "formats": [kind],
            "offsets": [offset],
            "itemsize": stride,
        }
        return np.ndarray((count,), np.dtype(shape), self.rows)["value"]

    def has(self, *names: str) -> bool:
        """Return whether all of some fields are there."""
        return all(name in self.places for name in names)


def _stride(fields: Fields, name: str) -> int:
    stride = whole_number(fields.get(name))
    if not 0 < stride <= limits.POINT_BYTES.value:
        most = limits.POINT_BYTES.value
        raise DecodeError(f"{name} is {stride:,}: it may be 1 to {most:,} bytes")
    return stride


# clouds


def cloud(fields: Fields) -> Fields:
    """Return a foxglove.PointCloud as a sensor_msgs/PointCloud2."""
    data = bytes_of(fields.get("data"))
    stride = _stride(fields, "point_stride") if len(data) else 1
    count, rest = divmod(len(data), stride)
    if rest:
        raise DecodeError(f"its {len(data)} bytes are not points of {stride} bytes")
    packed = _Packed.of(np.reshape(data, (count, stride)), fields)
    if count and sum(packed.has(axis) for axis in "xyz") < 2:
        raise DecodeError("it has no two of the fields x, y and z")
    added = dict(_added(packed)) if count else {}
    if added:
        columns = {name: packed.column(name) for name in packed.places}
        packed = _packed({**columns, **added})
    return {**_placed(fields), **_cloud_of(packed)}


def _placed(fields: Fields) -> dict[str, Any]:
    return {"header": header_of(fields), SENSOR_POSE: part(fields, "pose")}


def _added(packed: _Packed) -> Iterator[tuple[str, Values]]:
    """Yield the columns that RViz needs in another kind than they have."""
    if any(packed.places.get(axis, (0, ""))[1] != _FLOAT for axis in "xyz"):
        for axis in "xyz":
            values = packed.column(axis) if packed.has(axis) else _zeros(packed)
            with np.errstate(over="ignore"):
                yield axis, values.astype(_FLOAT)
    if packed.has(*_COLORS) and not packed.has("rgb"):
        red, green, blue = _channels(packed)
        yield "rgb", red << 16 | green << 8 | blue


def _zeros(packed: _Packed) -> Values:
    return np.zeros(len(packed.rows), _FLOAT)


def _channels(packed: _Packed) -> Iterator[npt.NDArray[np.uint32]]:
    return (_channel(packed.column(name)) for name in _COLORS)


def _channel(values: Values) -> npt.NDArray[np.uint32]:
    """Return a colour from 0 to 255, (N,); floats are from 0 to 1."""
    if values.dtype.kind == "f":
        values = np.multiply(np.nan_to_num(values), 255)
    return np.minimum(np.maximum(values, 0), 255).astype("<u4")


def _packed(columns: Mapping[str, Values]) -> _Packed:
    """Return columns of the same length as rows."""
    places: dict[str, tuple[int, str]] = {}
    stride, count = 0, 0
    for name, values in columns.items():
        letter = values.dtype.kind
        size = values.dtype.itemsize
        places[name] = stride, f"{letter}1" if size == 1 else f"<{letter}{size}"
        stride, count = stride + size, len(values)
    packed = _Packed(np.empty((count, stride), np.uint8), places)
    for name, values in columns.items():
        packed.column(name)[:] = values
    return packed


def _cloud_of(packed: _Packed) -> dict[str, Any]:
    """Return the parts of a PointCloud2 that hold points."""
    return {
        "height": 1,
        "width": len(packed.rows),
        "fields": [
            {"name": name, "offset": at, "datatype": _DATATYPES[kind], "count": 1}
            for name, (at, kind) in packed.places.items()
        ],
        "point_step": packed.rows.shape[1],
        "row_step": packed.rows.size,
        "data": np.reshape(packed.rows, -1),
    }


# grids


def grid(fields: Fields) -> Fields:
    """Return a foxglove.Grid as a nav_msgs/OccupancyGrid, of its first field."""
    columns = whole_number(fields.get("column_count"))
    size = part(fields, "cell_size") or {}
    width, height = (real_number(size.get(axis)) for axis in "xy")
    if abs(width - height) > 1e-6 * abs(width):
        text = f"its cells are {width:g} × {height:g} m, and only squares are drawn"
        raise DecodeError(text)
    row = whole_number(fields.get("row_stride"))
    packed, (count,) = _cells(fields, [row], [columns])
    header = header_of(fields)
    return {
        "header": header,
        "info": {
            "map_load_time": header["stamp"],
            "resolution": width,
            "width": columns,
            "height": count,
            "origin": pose_of(part(fields, "pose")),
        },
        "data": _shades(packed) if count else None,
    }


def _cells(
    fields: Fields, strides: list[int], counts: list[int]
) -> tuple[_Packed, tuple[int, ...]]:
    """Return the cells of a grid, and how many layers of the outermost kind there are.

    Args:
        fields: of the message.
        strides: bytes of its layers, from the outermost to a row.
        counts: of the parts of each of them.
    """
    data = bytes_of(fields.get("data"))
    if not len(data):
        return _Packed(np.empty((0, 1), np.uint8), {}), (0,)
    cell = _stride(fields, "cell_stride")
    rows: Bytes = data
    for stride, count, size in zip(strides, counts, [*strides[1:], cell], strict=True):
        if not 0 < count * size <= stride:
            raise DecodeError(f"{count} times {size} bytes do not fit in {stride}")
        rows = np.reshape(rows[: rows.size // stride * stride], (-1, stride))
        rows = np.ravel(rows[:, : count * size])
    cells: Bytes = np.reshape(rows, (-1, cell))
    return _Packed.of(cells, fields), (len(data) // strides[0],)


def _shades(packed: _Packed) -> npt.NDArray[np.int8]:
    """Return cells from 0 to 100, -1 where there is nothing to know."""
    if not packed.places:
        raise DecodeError("its cells have no field with a numeric type")
    if packed.has(*_COLORS, "alpha"):
        red, green, blue = _channels(packed)
        light = 0.299 * red + 0.587 * green + 0.114 * blue
        seen = _channel(packed.column("alpha")) > 0
        return np.where(seen, np.rint(100 - light / 2.55), -1).astype(np.int8)
    values = packed.column(next(iter(packed.places)))
    if values.dtype.kind in "iu" and values.dtype.itemsize == 1:
        as_ros = np.frombuffer(values.tobytes(), np.int8)
        if as_ros.min(initial=0) >= -1 and as_ros.max(initial=0) <= 100:
            return as_ros
    real = values.astype(np.float64)
    known = np.isfinite(real)
    least, most = real[known].min(initial=np.inf), real[known].max(initial=-np.inf)
    span = most - least if most > least else 1.0
    scaled = np.rint(100 * np.where(known, (real - least) / span, 0))
    return np.where(known, scaled, -1).astype(np.int8)


def voxels(fields: Fields) -> Fields:
    """Return a foxglove.VoxelGrid as points in the middle of its cells.

    Of one with colours those that can be seen, else those that are not zero.
    """
    columns, rows = (whole_number(fields.get(f"{n}_count")) for n in ("column", "row"))
    row, plane = (whole_number(fields.get(f"{n}_stride")) for n in ("row", "slice"))
    packed, (count,) = _cells(fields, [plane, row], [rows, columns])
    names = [name for name in packed.places if name not in "xyz"]
    if not names:
        return {**_placed(fields), **_cloud_of(packed)}
    seen = packed.column("alpha" if packed.has("alpha") else names[0])
    kept = np.flatnonzero(seen)
    size = part(fields, "cell_size") or {}
    places = np.unravel_index(kept, (count, rows, columns))
    table: dict[str, Values] = {}
    for axis, numbers in zip("zyx", places, strict=True):
        table[axis] = ((numbers + 0.5) * real_number(size.get(axis))).astype(_FLOAT)
    table |= {name: packed.column(name)[kept] for name in names}
    points = _packed(table)
    return {**_placed(fields), **_cloud_of(_packed({**table, **dict(_added(points))}))}
