"""PLY, ASCII and binary, as RViz shows it.

White, whatever colours its vertices have; flat unless the file has normals.

trimesh is not used: it refuses binary files that mix triangles with larger polygons
("PLY is unexpected length!"), fails on a point cloud, takes faces with missing corners,
and cuts every polygon as if it were convex.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np
import numpy.typing as npt

from sambot_viz.meshes.assembly.arrays import parse_floats, table_of
from sambot_viz.meshes.assembly.assemble import Submesh
from sambot_viz.meshes.assembly.polygons import triangulate
from sambot_viz.meshes.mesh import WHITE
from sambot_viz.meshes.source import MeshSource

_TYPES = {
    "char": "i1", "int8": "i1", "uchar": "u1", "uint8": "u1",
    "short": "i2", "int16": "i2", "ushort": "u2", "uint16": "u2",
    "int": "i4", "int32": "i4", "uint": "u4", "uint32": "u4",
    "float": "f4", "float32": "f4", "double": "f8", "float64": "f8",
}  # fmt: skip
_LISTS = ("vertex_indices", "vertex_index")


class _Broken(ValueError):
    """A file that contradicts itself; the text says how."""


@dataclass(slots=True)
class _Property:
    name: str
    kind: str
    count_kind: str | None = None


@dataclass(slots=True)
class _Element:
    name: str
    count: int
    properties: list[_Property] = field(default_factory=list[_Property])


@dataclass(slots=True)
class _Body:
    """What is left to read."""

    data: bytes
    order: str
    at: int = 0


def read_ply(source: MeshSource) -> list[Submesh]:
    """The triangles of a PLY file.

    Raises:
        MeshError: broken or cut off.
    """
    try:
        elements, body = _header(source.data)
        if body.order == "ascii":
            return _pieces(_read_ascii(elements, body.data), source)
        return _pieces(_read_binary(elements, body), source)
    except (_Broken, UnicodeDecodeError) as error:
        raise source.broken(f"the PLY file is broken: {error}") from error


_Columns = dict[str, npt.NDArray[Any]]


@dataclass(slots=True)
class _Contents:
    vertex: _Columns = field(default_factory=_Columns)
    counts: npt.NDArray[np.int64] | None = None
    corners: npt.NDArray[np.int64] | None = None


def _pieces(contents: _Contents, source: MeshSource) -> list[Submesh]:
    if contents.counts is None or contents.corners is None:
        return []
    vertices = _stack(contents.vertex, ("x", "y", "z"))
    if vertices is None:
        raise _Broken("its vertices have no x, y and z")
    corners = contents.corners
    inside = (corners >= 0) & (corners < len(vertices))
    points = np.zeros((len(corners), 3))
    points[inside] = vertices[corners[inside]]
    faces = triangulate(contents.counts, points, source.budget)
    normals = _stack(contents.vertex, ("nx", "ny", "nz"))
    return [Submesh(vertices, corners[faces], normals=normals, rgba=WHITE)]


def _stack(columns: _Columns, names: tuple[str, ...]) -> npt.NDArray[np.float64] | None:
    if any(name not in columns for name in names):
        return None
    return np.column_stack([columns[name].astype(np.float64) for name in names])


def _header(data: bytes) -> tuple[list[_Element], _Body]:
    end = data.find(b"end_header")
    if not data.startswith(b"ply") or end < 0:
        raise _Broken("it has no PLY header")
    following = data.find(b"\n", end)
    start = len(data) if following < 0 else following + 1
    order = ""
    elements: list[_Element] = []
    for line in data[:end].decode("latin-1").splitlines():
        words = line.split()
        if words[:1] == ["format"] and len(words) > 1:
            order = {
                "ascii": "ascii",
                "binary_little_endian": "<",
                "binary_big_endian": ">",
            }.get(words[1], "")
        elif words[:1] == ["element"] and len(words) == 3 and words[2].isdecimal():
            elements.append(_Element(words[1], int(words[2])))
        elif words[:1] == ["property"] and elements:
            elements[-1].properties.append(_property(words))
    if not order:
        raise _Broken("its header names no known format")
    for element in elements:
        if len({entry.name for entry in element.properties}) < len(element.properties):
            raise _Broken(f"its header lists a property of {element.name} twice")
    elements = [element for element in elements if element.properties]
    return elements, _Body(data[start:], order)


def _property(words: list[str]) -> _Property:
    if len(words) == 5 and words[1] == "list":
        count_kind, kind, name = words[2], words[3], words[4]
        if count_kind in _TYPES and kind in _TYPES:
            return _Property(name, _TYPES[kind], _TYPES[count_kind])
    elif len(words) == 3 and words[1] in _TYPES:
        return _Property(words[2], _TYPES[words[1]])
    raise _Broken(f"its header has a property that cannot be read: {' '.join(words)}")


def _read_binary(elements: list[_Element], body: _Body) -> _Contents:
    contents = _Contents()
    for element in elements:
        if all(entry.count_kind is None for entry in element.properties):
            table = _fixed(element, body, {})
            if element.name == "vertex":
                contents.vertex = {
                    entry.name: table[entry.name] for entry in element.properties
                }
        elif element.name == "face":
            contents.counts, contents.corners = _binary_faces(element, body)
        else:
            _loose_rows(element, body)
    return contents


def _fixed(element: _Element, body: _Body, lengths: dict[str, int]) -> npt.NDArray[Any]:
    """All rows of an element at once, its lists having these lengths."""
    fields: list[tuple[str, str] | tuple[str, str, int]] = []
    for entry in element.properties:
        kind = body.order + entry.kind
        if entry.count_kind is None:
            fields.append((entry.name, kind))
        else:
            fields.append((entry.name + " count", body.order + entry.count_kind))
            fields.append((entry.name, kind, lengths[entry.name]))
    dtype = np.dtype(fields)
    end = body.at + dtype.itemsize * element.count
    if end > len(body.data):
        raise _Broken(f"it is cut off in its {element.count} {element.name} entries")
    table = np.frombuffer(body.data, dtype, element.count, body.at)
    body.at = end
    return table


def _binary_faces(
    element: _Element, body: _Body
) -> tuple[npt.NDArray[np.int64], npt.NDArray[np.int64]]:
    """Quickly when every list is as long as in the first row, else row by row."""
    lists = [entry for entry in element.properties if entry.count_kind is not None]
    outline = next((entry for entry in lists if entry.name in _LISTS), lists[0])
    start = body.at
    if not element.count:
        return np.empty(0, dtype=np.int64), np.empty(0, dtype=np.int64)
    first = _Element(element.name, 1, element.properties)
    lengths = {k: len(v) for k, v in _loose_rows(first, body)[0].items()}
    body.at = start
    try:
        table = _fixed(element, body, lengths)
    except _Broken:
        table = None
    if table is not None and all(
        np.all(table[entry.name + " count"] == lengths[entry.name]) for entry in lists
    ):
        counts = np.full(element.count, lengths[outline.name], dtype=np.int64)
        return counts, np.ravel(table[outline.name]).astype(np.int64)
    body.at = start
    rows = [row[outline.name] for row in _loose_rows(element, body)]
    corners = np.concatenate(rows) if rows else np.empty(0)
    return np.array([len(row) for row in rows]), corners.astype(np.int64)


def _loose_rows(element: _Element, body: _Body) -> list[_Columns]:
    """The lists of every row of an element whose rows differ in length."""
    rows: list[_Columns] = []
    for _ in range(element.count):
        row: _Columns = {}
        for entry in element.properties:
            count = 1
            if entry.count_kind is not None:
                count = int(_take(body, entry.count_kind, 1)[0])
            values = _take(body, entry.kind, count)
            if entry.count_kind is not None:
                row[entry.name] = values
        rows.append(row)
    return rows


def _take(body: _Body, kind: str, count: int) -> npt.NDArray[Any]:
    dtype = np.dtype(body.order + kind)
    end = body.at + dtype.itemsize * count
    if count < 0 or end > len(body.data):
        raise _Broken("it is cut off, or a list in it has an impossible length")
    values = np.frombuffer(body.data, dtype, count, body.at)
    body.at = end
    return values


def _read_ascii(elements: list[_Element], data: bytes) -> _Contents:
    contents = _Contents()
    lines = [line for line in data.splitlines() if line.strip()]
    at = 0
    for element in elements:
        rows = lines[at : at + element.count]
        at += element.count
        if len(rows) < element.count:
            raise _Broken(
                f"it is cut off in its {element.count} {element.name} entries"
            )
        if element.name == "vertex" and rows:
            width = len(element.properties)
            values = parse_floats(b" ".join(rows))
            if values is None or len(values) != width * len(rows):
                raise _Broken(f"a vertex is not made of {width} numbers")
            table = table_of(values, width)
            contents.vertex = {
                entry.name: table[:, k] for k, entry in enumerate(element.properties)
            }
        elif element.name == "face":
            contents.counts, contents.corners = _ascii_faces(element, rows)
    return contents


def _ascii_faces(
    element: _Element, rows: list[bytes]
) -> tuple[npt.NDArray[np.int64], npt.NDArray[np.int64]]:
    counts: list[int] = []
    corners: list[int] = []
    for row in rows:
        words = row.split()
        at = 0
        try:
            for entry in element.properties:
                length = 1 if entry.count_kind is None else int(words[at]) + 1
                if entry.count_kind is not None and entry.name in _LISTS:
                    outline = [int(word) for word in words[at + 1 : at + length]]
                    if len(outline) != length - 1:
                        raise _Broken("a face has fewer corners than it says")
                    counts.append(len(outline))
                    corners += outline
                at += length
        except (ValueError, IndexError) as error:
            if isinstance(error, _Broken):
                raise
            raise _Broken("a face is not made of whole numbers") from error
    return np.array(counts, dtype=np.int64), np.array(corners, dtype=np.int64)
