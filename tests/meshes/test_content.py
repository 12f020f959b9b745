"""A file that is not the mesh its name announces is called what it is."""

from __future__ import annotations

import io
import struct
import zipfile
from collections.abc import Callable
from pathlib import Path

import pytest

from sambot_viz.meshes.mesh import MeshError
from sambot_viz.meshes.read_mesh import read_mesh

Write = Callable[..., Path]

HTML = "\n<!DOCTYPE html>\n<html><body>part.stl at main</body></html>"
COLLADA = """<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
  <library_geometries><geometry id="g"><mesh>
    <source id="p"><float_array id="a" count="9">0 0 0 1 0 0 0 1 0</float_array>
      <technique_common><accessor source="#a" count="3" stride="3"/></technique_common>
    </source>
    <vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
    <triangles count="1"><input semantic="VERTEX" source="#v" offset="0"/>
      <p>0 1 2</p></triangles>
  </mesh></geometry></library_geometries>
</COLLADA>
"""
STL = bytes(80) + struct.pack("<I", 1) + struct.pack("<12fH", *[0.0] * 3, *range(9), 0)
ASCII = """solid part
  facet normal 0 0 1
    outer loop
      vertex 0 0 0
      vertex 1 0 0
      vertex 0 1 0
    endloop
  endfacet
endsolid part
"""
OBJ = "# made by hand\n\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"
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


def zipped(name: str) -> bytes:
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w") as archive:
        archive.writestr(name, "content")
    return stream.getvalue()


@pytest.mark.parametrize(
    ("name", "content", "said"),
    [
        ("a.stl", HTML, "this is a web page (HTML), not an STL file"),
        ("a.dae", HTML, "this is a web page (HTML), not a COLLADA file"),
        ("a.obj", HTML, "this is a web page (HTML), not an OBJ file"),
        ("a.glb", HTML, "this is a web page (HTML), not a glTF file"),
        ("a.ply", HTML, "this is a web page (HTML), not a PLY file"),
        ("a.stl", zipped("part.stl"), "this is a zip archive, not an STL file"),
        ("a.stl", zipped("3D/3dmodel.model"), "this is a 3MF file, not an STL file"),
        ("a.stl", b"\x1f\x8b\x08" + bytes(99), "this is a gzip archive"),
        ("a.stl", "ISO-10303-21;\nHEADER;\n", "this is a STEP file of a CAD program"),
        ("a.obj", "Kaydara FBX Binary  \0", "this is an FBX file, not an OBJ file"),
        ("a.dae", b"\x89PNG\r\n" + bytes(99), "this is an image, not a COLLADA file"),
        ("a.dae", '{"a": 1}', "this is a JSON file, not a COLLADA file"),
        ("a.dae", '<robot name="r"/>', "this is a robot model, not a COLLADA file"),
        ("a.stl", "404: Not Found", "this is a text (“404: Not Found”), not an STL"),
    ],
)
def test_what_the_file_really_is_comes_first(
    write: Write, name: str, content: str | bytes, said: str
) -> None:
    with pytest.raises(MeshError) as caught:
        read_mesh(write(name, content))
    problem = caught.value.problem
    assert problem.code == "mesh-other-content"
    assert problem.message.startswith(said)
    assert problem.hint


@pytest.mark.parametrize(
    ("name", "content", "right"),
    [
        ("a.stl", COLLADA, "a.dae"),
        ("a.stl", OBJ, "a.obj"),
        ("a.stl", PLY, "a.ply"),
        ("a.dae", STL, "a.stl"),
        ("a.obj", STL, "a.stl"),
        ("a.dae", ASCII, "a.stl"),
        ("a.ply", OBJ, "a.obj"),
    ],
)
def test_a_mesh_with_a_wrong_ending_is_read_under_the_right_one(
    write: Write, name: str, content: str | bytes, right: str
) -> None:
    path = write(name, content)
    with pytest.raises(MeshError) as caught:
        read_mesh(path)
    hint = caught.value.problem.hint
    assert hint == f"call the file {right}, and write that name in the model"
    assert read_mesh(path.rename(path.with_name(right))).triangles == 1


@pytest.mark.parametrize(
    ("name", "content"),
    [
        ("a.stl", STL[:-10]),
        ("a.stl", ASCII[:60]),
        ("a.dae", COLLADA[:200]),
        ("a.obj", "v 0 0 0\n"),
        ("a.ply", PLY[:80]),
    ],
)
def test_a_file_that_is_cut_off_is_still_called_broken(
    write: Write, name: str, content: str | bytes
) -> None:
    with pytest.raises(MeshError) as caught:
        read_mesh(write(name, content))
    assert caught.value.problem.code in ("mesh-broken", "mesh-empty")
