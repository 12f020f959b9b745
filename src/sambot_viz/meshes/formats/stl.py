"""STL, binary and ASCII: read by trimesh after RViz's strict checks.

An STL has no colour of its own and is always flat shaded. trimesh reads files that are
empty or cut off as meshes without triangles; here they are refused.
"""

from __future__ import annotations

import io
import re

from sambot_viz.meshes.assembly.assemble import Submesh
from sambot_viz.meshes.formats.trimesh_call import TrimeshError, call_trimesh
from sambot_viz.meshes.mesh import mesh_error
from sambot_viz.meshes.source import MeshSource

_HEADER, _FACET = 84, 50
"""Sizes [bytes] in a binary file."""
_FREE_TEXT = re.compile(rb"^[ \t]*(?:solid|endsolid|facet)[^\n]*", re.MULTILINE)
_AGAIN = "export the mesh again, or copy the file again if it was cut off"


def read_stl(source: MeshSource) -> list[Submesh]:
    """The triangles of an STL file.

    A binary file is recognised by its size, which must fit its number of triangles
    exactly: many exporters begin binary files with "solid".

    Raises:
        MeshError: a file that is cut off, has bytes left over, or no triangles.
    """
    data = source.data
    count = int.from_bytes(data[80:_HEADER], "little")
    expected = _HEADER + count * _FACET
    if len(data) >= _HEADER and len(data) == expected:
        return [_binary(source)] if count else []
    if data.lstrip()[:5].lower() == b"solid" and b"\0" not in data[:1024]:
        return [_ascii(source)]
    if len(data) < _HEADER:
        raise source.broken(
            f"the STL file has only {len(data)} bytes; a binary STL needs at least 84",
        )
    raise source.broken(
        f"the STL file announces {count} triangles, which takes {expected} bytes, but "
        f"it has {len(data)}",
    )


def _binary(source: MeshSource) -> Submesh:
    loaded = call_trimesh("stl", "load_stl_binary", io.BytesIO(source.data))
    return Submesh(loaded["vertices"], loaded["faces"])


def _ascii(source: MeshSource) -> Submesh:
    # trimesh finds its keywords also within names, and needs the last line.
    lines = source.data.lower().replace(b"\r", b"\n")
    text = b"solid\n" + _FREE_TEXT.sub(b"", lines) + b"\nendsolid\n"
    corners, facets = text.count(b"vertex"), text.count(b"endfacet")
    if not corners:
        raise mesh_error(
            source.path,
            "mesh-empty",
            "the ASCII STL file contains no triangles",
            _AGAIN,
        )
    if corners != 3 * facets:
        raise source.broken(
            f"the ASCII STL file has {corners} vertices in {facets} complete facets; "
            "a facet has three",
        )
    not_numbers = "the ASCII STL file has a vertex that is not three numbers"
    try:
        file = io.StringIO(text.decode("latin-1"))
        loaded = call_trimesh("stl", "load_stl_ascii", file)
    except TrimeshError as error:
        raise source.broken(not_numbers) from error
    if len(loaded.get("vertices", ())) != corners:
        raise source.broken(not_numbers)
    return Submesh(loaded["vertices"], loaded["faces"])
