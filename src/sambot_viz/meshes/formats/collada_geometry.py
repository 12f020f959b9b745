"""The <mesh> elements of COLLADA: numbers and indices to triangles."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from sambot_viz.meshes.assembly.assemble import Floats, Ints
from sambot_viz.meshes.assembly.triangles import (
    parse_floats,
    parse_ints,
    table_of,
    triangulate,
)
from sambot_viz.meshes.formats.collada_xml import ColladaDocument
from sambot_viz.meshes.mesh_source import MeshSource

_Int64 = npt.NDArray[np.int64]


@dataclass(frozen=True, slots=True)
class Primitives:
    """The triangles of one <triangles>, <polylist>, … in the units of the file.

    Attributes:
        symbol: its material attribute.
        vertices: (N, 3) float64, one per corner kind.
        faces: (M, 3) indices.
        normals: (N, 3), or None when the file has none.
        uv: (N, 2) of the first uv set, or None.
    """

    symbol: str | None
    vertices: npt.NDArray[np.float64]
    faces: Ints
    normals: Floats | None
    uv: Floats | None


Geometry = list[Primitives]


@dataclass(frozen=True, slots=True)
class _Input:
    semantic: str
    source: str
    offset: int
    set: int


def read_geometry(
    element: ET.Element, document: ColladaDocument, source: MeshSource
) -> Geometry:
    """Read the triangles of a <geometry>; lines and points are ignored as in RViz."""
    mesh = element.find("mesh")
    if mesh is None:
        mesh = element.find("convex_mesh")
    if mesh is None:
        return []
    reader = _MeshReader(mesh, document, source)
    geometry = [reader.primitives(child) for child in mesh if child.tag in _CORNERS]
    return [primitives for primitives in geometry if primitives is not None]


class _MeshReader:
    """One <mesh>: its sources are parsed once, whatever refers to them."""

    def __init__(
        self, mesh: ET.Element, document: ColladaDocument, source: MeshSource
    ) -> None:
        self.mesh = mesh
        self.document = document
        self.source = source
        self._sources: dict[str, Floats | None] = {}
        # Some exporters use the same ids again in every mesh.
        self._own = {e.get("id", ""): e for e in reversed(list(mesh.iter()))}

    def _by_id(self, reference: str | None) -> ET.Element | None:
        own = self._own.get((reference or "").strip().removeprefix("#"))
        return self.document.by_id(reference) if own is None else own

    def primitives(self, element: ET.Element) -> Primitives | None:
        """Return the triangles of one element, None when it has none or is broken."""
        inputs = self._inputs(element)
        stride = 1 + max((entry.offset for entry in inputs), default=0)
        corners = _CORNERS[element.tag](element, stride)
        if corners is None:
            self._broken(f"the indices of a <{element.tag}> are not whole numbers")
            return None
        rows, counts = corners
        position = self._values(inputs, "POSITION", 3)
        if position is None or not len(rows):
            return None
        points = self._pick(rows, position)
        if points is None:
            self._broken(f"a <{element.tag}> uses positions that do not exist")
            return None
        faces = triangulate(counts, points, self.source.budget)
        return Primitives(
            symbol=element.get("material"),
            vertices=points.astype(np.float64),
            faces=faces,
            normals=self._pick(rows, self._values(inputs, "NORMAL", 3)),
            uv=self._pick(rows, self._values(inputs, "TEXCOORD", 2)),
        )

    def _broken(self, what: str) -> None:
        self.source.warn(
            "mesh-geometry-broken",
            f"{what}; these triangles are left out",
            "export the mesh again",
        )

    def _pick(self, rows: _Int64, values: tuple[Floats, int] | None) -> Floats | None:
        """Return the value of each corner; None where an index points nowhere."""
        if values is None:
            return None
        array, offset = values
        index = rows[:, offset]
        if not len(array) or index.min() < 0 or index.max() >= len(array):
            return None
        return array[index]

    def _inputs(self, element: ET.Element) -> list[_Input]:
        """Return the inputs, those of the <vertices> element included."""
        inputs: list[_Input] = []
        for entry in element.findall("input"):
            made = _Input(
                entry.get("semantic", ""),
                entry.get("source", ""),
                _whole(entry.get("offset")),
                _whole(entry.get("set")),
            )
            if made.semantic != "VERTEX":
                inputs.append(made)
                continue
            vertices = self._by_id(made.source)
            for inner in vertices.findall("input") if vertices is not None else []:
                semantic, source = inner.get("semantic", ""), inner.get("source", "")
                inputs.append(_Input(semantic, source, made.offset, made.set))
        return inputs

    def _values(
        self, inputs: list[_Input], semantic: str, width: int
    ) -> tuple[Floats, int] | None:
        fitting = [entry for entry in inputs if entry.semantic == semantic]
        if not fitting:
            return None
        # Only the lowest uv set is drawn.
        first = min(fitting, key=lambda entry: entry.set)
        values = self._source(first.source)
        if values is None or values.shape[1] < width:
            return None
        return values[:, :width], first.offset

    def _source(self, reference: str) -> Floats | None:
        if reference not in self._sources:
            element = self._by_id(reference)
            self._sources[reference] = (
                None if element is None else self._read_source(element)
            )
        return self._sources[reference]

    def _read_source(self, element: ET.Element) -> Floats | None:
        accessor = element.find("technique_common/accessor")
        array = element.find("float_array")
        if array is None and accessor is not None:
            array = self._by_id(accessor.get("source"))
        values = None if array is None else parse_floats((array.text or "").encode())
        if values is None:
            self._broken("a <float_array> is missing or holds something else")
            return None
        if accessor is None:
            return table_of(values, 3)
        stride = max(1, _whole(accessor.get("stride"), 1))
        values = values[max(0, _whole(accessor.get("offset"))) :]
        # A param without a name is a column to be skipped.
        params = accessor.findall("param")
        used = [k for k, param in enumerate(params) if param.get("name") is not None]
        table = table_of(values, stride)
        if len(used) in (2, 3) and used != list(range(stride)) and max(used) < stride:
            return table[:, used]
        return table


_Corners = tuple[_Int64, _Int64]


def _triangles(element: ET.Element, stride: int) -> _Corners | None:
    rows = _rows(element.findtext("p"), stride)
    if rows is None:
        return None
    whole = len(rows) // 3
    return rows[: 3 * whole], np.full(whole, 3, dtype=np.int64)


def _polylist(element: ET.Element, stride: int) -> _Corners | None:
    rows = _rows(element.findtext("p"), stride)
    counts = parse_ints((element.findtext("vcount") or "").encode())
    if rows is None or counts is None or np.any(counts < 0):
        return None
    there = np.cumsum(counts) <= len(rows)
    counts = counts[there]
    return rows[: counts.sum()], counts


def _polygons(element: ET.Element, stride: int) -> _Corners | None:
    outlines = [p.text for p in element.iter("p")]
    return _many([_rows(text, stride) for text in outlines], stride)


def _strips(element: ET.Element, stride: int) -> _Corners | None:
    return _unrolled(element, stride, lambda k: (k, k + 1 + k % 2, k + 2 - k % 2))


def _fans(element: ET.Element, stride: int) -> _Corners | None:
    return _unrolled(element, stride, lambda k: (0, k + 1, k + 2))


def _unrolled(
    element: ET.Element, stride: int, corner: Callable[[int], tuple[int, int, int]]
) -> _Corners | None:
    """Turn strips and fans into single triangles."""
    triangles: list[_Int64 | None] = []
    for p in element.findall("p"):
        rows = _rows(p.text, stride)
        if rows is None:
            return None
        triangles += [rows[list(corner(k))] for k in range(len(rows) - 2)]
    return _many(triangles, stride)


def _many(outlines: list[_Int64 | None], stride: int) -> _Corners | None:
    known = [rows for rows in outlines if rows is not None]
    if len(known) != len(outlines):
        return None
    if not known:
        return np.empty((0, stride), dtype=np.int64), np.empty(0, dtype=np.int64)
    return np.concatenate(known), np.array([len(rows) for rows in known])


def _rows(text: str | None, stride: int) -> _Int64 | None:
    """Return the indices of each corner, (corners, stride)."""
    values = parse_ints((text or "").encode())
    if values is None:
        return None
    return table_of(values, stride)


def _whole(text: str | None, default: int = 0) -> int:
    """Return a small whole number, or the default."""
    return int(text) if text is not None and text.strip().isdecimal() else default


_CORNERS: dict[str, Callable[[ET.Element, int], _Corners | None]] = {
    "triangles": _triangles,
    "polylist": _polylist,
    "polygons": _polygons,
    "tristrips": _strips,
    "trifans": _fans,
}
