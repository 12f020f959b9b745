"""PLY, ASCII and binary: read by trimesh, shown as in RViz.

White, whatever colours its vertices have; flat unless the file has normals.

trimesh skips what it does not understand of a header, counts no lines, fills rows that
are too short, takes the length of the first list for all, and cuts every polygon as if
it were convex. So the text and the lengths are checked, and polygons are cut, here.
"""

from __future__ import annotations

import io
from typing import Any

import numpy as np
import numpy.typing as npt

from sambot_viz import limits
from sambot_viz.meshes.assembly.assemble import Submesh
from sambot_viz.meshes.assembly.triangles import triangulate
from sambot_viz.meshes.formats.trimesh_call import call_trimesh
from sambot_viz.meshes.mesh import WHITE
from sambot_viz.meshes.mesh_source import MeshSource

_Element = dict[str, bool]
"""The properties of a kind of entry, and which of them are lists."""
_FORMATS = ("ascii", "binary_little_endian", "binary_big_endian")
_NUMBERS = b"0123456789+-.eE \t\r\nnaifNAIF"


def read_ply(source: MeshSource) -> list[Submesh]:
    """Read the triangles of a PLY file.

    Raises:
        MeshError: broken, cut off, or written in a way that is not read.
    """
    try:
        faces = _check(source.data)
        if faces == 0:
            return []
        source.budget.spend_triangles(faces, 0)
        data = io.BytesIO(source.data)
        loaded = call_trimesh(
            "ply", "load_ply", data, skip_materials=True, fix_texture=False
        )
        return [_submesh(loaded["metadata"]["_ply_raw"], source)]
    except (ValueError, LookupError, TypeError, AttributeError) as error:
        raise source.broken(
            f"the PLY file is broken: {error}",
            "export it again, binary files as triangles only, or copy it again if it "
            "was cut off",
        ) from error


def _check(data: bytes) -> int:
    """Return how many faces a file announces, once its header and text are sound."""
    head, end, _ = data[: limits.PLY_HEADER.value].partition(b"end_header")
    lines = [line.split() for line in head.decode("latin-1").splitlines()]
    if lines[:1] == [["ply"]] and not end and len(data) > limits.PLY_HEADER.value:
        most = limits.PLY_HEADER.value
        raise ValueError(f"its header does not end in its first {most:,} bytes")
    if lines[:1] != [["ply"]] or not end:
        raise ValueError("it has no PLY header")
    kind = lines[1][1] if len(lines[1]) > 1 and lines[1][0] == "format" else ""
    if kind not in _FORMATS:
        raise ValueError("its second line names no known format")
    elements: dict[str, _Element] = {}
    counts: dict[str, int] = {}
    for words in lines[2:]:
        if words[:1] == ["element"] and len(words) == 3 and words[1] not in counts:
            counts[words[1]], elements[words[1]] = int(words[2]), {}
        elif words[:1] == ["property"] and len(words) == 3 + 2 * ("list" in words):
            properties = elements[list(elements)[-1]]
            if words[-1] in properties:
                raise ValueError(f"a property of it is there twice: {words[-1]}")
            properties[words[-1]] = "list" in words
        elif words[:1] not in (["comment"], ["obj_info"]):
            raise ValueError(f"its header has a line that is not known: {words}")
    if counts.get("edge"):
        raise ValueError("it has edges, which this program does not read")
    if kind == "ascii":
        start = data.find(b"\n", len(head)) + 1
        _check_text(data[start:], elements, counts)
    return counts.get("face", 0)


def _check_text(
    text: bytes, elements: dict[str, _Element], counts: dict[str, int]
) -> None:
    """Refuse lines that trimesh would fill up or cut off."""
    if text.translate(None, _NUMBERS):
        raise ValueError("it has an entry that is not made of numbers")
    lines = text.rstrip().splitlines()
    if len(lines) != sum(counts.values()):
        raise ValueError(
            f"it announces {sum(counts.values())} entries but has {len(lines)} lines"
        )
    following = iter(lines)
    for name, properties in elements.items():
        lists = list(properties.values())
        for _ in range(counts[name]):
            words, width = next(following).split(), 0
            for is_list in lists:
                width += 1 + (int(words[width]) if is_list else 0)
            if width != len(words):
                raise ValueError(f"a {name} has {len(words)} numbers and not {width}")


def _submesh(raw: dict[str, Any], source: MeshSource) -> Submesh:
    """Return the triangles of what trimesh found under each property."""
    vertex: Any = raw["vertex"]["data"]
    vertices = _columns(vertex, "x", "y", "z")
    smooth = all(name in raw["vertex"]["properties"] for name in ("nx", "ny", "nz"))
    counts, corners = _faces(raw["face"]["data"])
    inside = (corners >= 0) & (corners < len(vertices))
    points = np.zeros((len(corners), 3))
    points[inside] = vertices[corners[inside]]
    return Submesh(
        vertices,
        corners[triangulate(counts, points, source.budget)],
        normals=_columns(vertex, "nx", "ny", "nz") if smooth else None,
        rgba=WHITE,
    )


def _columns(data: Any, *names: str) -> npt.NDArray[np.float64]:
    return np.column_stack([np.ravel(data[name]).astype(np.float64) for name in names])


def _faces(data: Any) -> tuple[npt.NDArray[np.int64], npt.NDArray[np.int64]]:
    """Return how many corners each face has, and all corners one after the other."""
    names = list(getattr(data, "dtype", np.dtype([])).names or data)
    name = next((k for k in names if k in ("vertex_indices", "vertex_index")), names[0])
    rows = data[name]
    if rows.dtype.names:
        lengths = [
            (data[k]["f0"], data[k]["f1"].shape[1])
            for k in names
            if data.dtype[k].names
        ]
        if any(np.any(found != length) for found, length in lengths):
            raise ValueError("its faces have different numbers of corners")
        rows = rows["f1"]
    if rows.ndim == 2:
        return np.full(len(rows), rows.shape[1]), np.ravel(rows).astype(np.int64)
    counts = np.array([len(row) for row in rows], dtype=np.int64)
    return counts, np.concatenate(list(rows)).astype(np.int64)
