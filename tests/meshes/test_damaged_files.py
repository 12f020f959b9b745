"""Whatever happens to a file: a mesh that can be drawn, or one clear error."""

from __future__ import annotations

import random
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from sambot_viz.meshes.glb import to_glb
from sambot_viz.meshes.mesh import MeshError, MeshPart
from sambot_viz.meshes.read_mesh import read_mesh

DAE = """<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit meter="0.01"/></asset><library_geometries><geometry id="g"><mesh>
<source id="p"><float_array id="pa" count="12">0 0 0 2 0 0 2 1 0 0 1 0</float_array>
<technique_common><accessor source="#pa" count="4" stride="3"><param name="X"/>
<param name="Y"/><param name="Z"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<polylist count="2"><input semantic="VERTEX" source="#v" offset="0"/>
<vcount>3 4</vcount><p>0 1 2 0 1 2 3</p></polylist></mesh></geometry>
</library_geometries>
<library_visual_scenes><visual_scene id="s"><node>
<matrix>1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1
</matrix><instance_geometry url="#g"/></node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene></COLLADA>"""
OBJ = """mtllib a.mtl
v 0 0 0
v 1 0 0
v 0 1 0
v 1 1 0.5
vt 0 0
vn 0 0 1
usemtl a
f 1/1/1 2/1/1 3/1/1
f -1//1 -2//1 -3//1
f 1 2 4 3
"""
PLY = """ply
format ascii 1.0
element vertex 3
property float x
property float y
property float z
element face 1
property list uchar int vertex_indices
end_header
0 0 0
1 0 0
0 1 0
3 0 1 2
"""
STL = """solid a
facet normal 0 0 1
outer loop
vertex 0 0 0
vertex 1 0 0
vertex 0 1 0
endloop
endfacet
endsolid a
"""


def glb() -> bytes:
    vertices = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]], dtype=np.float32)
    return to_glb(MeshPart(vertices, np.array([[0, 1, 2]], dtype=np.uint32)))


def damaged(data: bytes, chance: random.Random) -> bytes:
    kind = chance.randrange(5)
    at = chance.randrange(len(data))
    if kind == 0:
        return data[:at]
    if kind == 1:
        return data[:at] + bytes([chance.randrange(256)]) + data[at + 1 :]
    if kind == 2:
        return data[:at] + data[at + chance.randrange(1, 12) :]
    if kind == 3:
        other = chance.randrange(len(data))
        return data[:at] + data[other : other + 9] + data[at:]
    return data.replace(
        chance.choice([b"0", b"1", b"2", b"3"]),
        chance.choice([b"-1", b"99999999999", b"nan", b"1e99", b"x", b"", b"[]"]),
        chance.randrange(1, 4),
    )


@pytest.mark.parametrize("name", ["a.dae", "a.obj", "a.ply", "a.stl", "b.stl", "a.glb"])
def test_damaged_files_are_drawn_or_refused(
    name: str, write: Callable[..., Path], binary_stl: Callable[..., bytes]
) -> None:
    triangle = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]
    whole = {
        "a.dae": DAE.encode(),
        "a.obj": OBJ.encode(),
        "a.ply": PLY.encode(),
        "a.stl": STL.encode(),
        "b.stl": binary_stl([triangle, triangle]),
        "a.glb": glb(),
    }[name]
    chance = random.Random(name)
    write("a.mtl", "newmtl a\nKd 1 0 0\n")
    assert read_mesh(write(name, whole)).triangles
    for _ in range(400):
        try:
            mesh = read_mesh(write(name, damaged(whole, chance)))
        except MeshError as error:
            assert error.problem.message and error.problem.file
            continue
        for part in mesh.parts:
            assert len(part.faces) and np.all(np.isfinite(part.vertices))
            assert part.faces.max() < len(part.vertices)
            assert part.normals is None or np.all(np.isfinite(part.normals))
