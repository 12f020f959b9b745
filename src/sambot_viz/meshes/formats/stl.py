"""STL, binary and ASCII, with RViz's strict checks.

An STL has no colour of its own and is always flat shaded. numpy reads it: trimesh takes
half a second to import, and would read a file that is cut off as one without triangles.
"""

from __future__ import annotations

import re

import numpy as np

from sambot_viz.meshes.assembly.assemble import Submesh
from sambot_viz.meshes.assembly.triangles import (
    DECIMAL_COMMA,
    WITH_POINTS,
    parse_floats,
    table_of,
    triples,
)
from sambot_viz.meshes.mesh import mesh_error
from sambot_viz.meshes.mesh_source import MeshSource

_HEADER = 84
_FACET = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("extra", "<u2")])
_FREE_TEXT = re.compile(rb"^[ \t]*(?:solid|endsolid|facet)[^\n]*", re.MULTILINE)
_VERTEX = re.compile(rb"vertex([^\n]*)")
_AGAIN = "export the mesh again, or copy the file again if it was cut off"


def read_stl(source: MeshSource) -> list[Submesh]:
    """Read the triangles of an STL file.

    A binary file is recognised by its size, which must fit its number of triangles
    exactly: many exporters begin binary files with "solid".

    Raises:
        MeshError: a file that is cut off, has bytes left over, or no triangles.
    """
    data = source.data
    count = int.from_bytes(data[80:_HEADER], "little")
    expected = _HEADER + count * _FACET.itemsize
    if len(data) >= _HEADER and len(data) == expected:
        source.budget.spend_triangles(count, 3 * count)
        corners = np.frombuffer(data, _FACET, count, _HEADER)["corners"]
        return [Submesh(np.reshape(corners, (-1, 3)), triples(count))]
    if data.lstrip()[:5].lower() == b"solid" and b"\0" not in data[:1024]:
        return [_ascii(source)]
    if len(data) < _HEADER:
        raise source.broken(
            f"the STL file has only {len(data)} bytes; a binary STL needs at least 84"
        )
    raise source.broken(
        f"the STL file announces {count} triangles, which takes {expected} bytes, but "
        f"it has {len(data)}"
    )


def _ascii(source: MeshSource) -> Submesh:
    # Names may contain the keywords too.
    text = _FREE_TEXT.sub(b"", source.data.lower().replace(b"\r", b"\n"))
    corners, facets = text.count(b"vertex"), text.count(b"endfacet")
    source.budget.spend_triangles(facets, corners)
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
            "a facet has three"
        )
    vertices = b" ".join(_VERTEX.findall(text))
    numbers = parse_floats(vertices)
    if numbers is None or len(numbers) != 3 * corners:
        if comma := DECIMAL_COMMA.search(vertices):
            raise source.broken(
                f"the ASCII STL file has decimal commas ({comma[0].decode()})",
                WITH_POINTS,
            )
        raise source.broken("the ASCII STL file has a vertex that is not three numbers")
    return Submesh(table_of(numbers, 3), triples(facets))
