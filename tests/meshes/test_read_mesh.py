"""What is said about files that are not meshes."""

from __future__ import annotations

import base64
import json
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest
from lower_limit import lower

from sambot_viz import errors
from sambot_viz.errors import SambotVizError
from sambot_viz.meshes.mesh import MeshError
from sambot_viz.meshes.named_files import NamedFileError
from sambot_viz.meshes.read_mesh import read_mesh
from sambot_viz.meshes.textures import TextureError

POINTER = "version https://git-lfs.github.com/spec/v1\noid sha256:abc\nsize 12\n"


@pytest.mark.parametrize(
    ("name", "content", "code", "sentence"),
    [
        ("a.stl", POINTER, "mesh-lfs-pointer", "run 'git lfs pull'"),
        ("a.dae", "", "mesh-empty", "the file is empty"),
        ("a.mesh", "x", "mesh-format-unknown", r"kind '.mesh' .* one of .stl, .dae"),
        ("noending", "x", "mesh-format-unknown", "kind 'noending'"),
        ("a.dae", "<part/>", "mesh-broken", "no <COLLADA> element .* <part>"),
        ("a.dae", "nothing like it", "mesh-broken", "not well-formed XML"),
        ("a.obj", "# nothing\n", "mesh-empty", "no triangles"),
        ("a.glb", b"glTF\2\0", "mesh-broken", "only 6 bytes"),
        ("a.gltf", "{", "mesh-broken", "its JSON cannot be read"),
        ("a.gltf", "[]", "mesh-broken", "its JSON is not an object"),
        ("a.ply", "plx", "mesh-broken", "no PLY header"),
    ],
)
def test_what_is_no_mesh_is_refused_in_one_sentence(
    write: Callable[..., Path], name: str, content: str, code: str, sentence: str
) -> None:
    path = write(name, content)
    with pytest.raises(MeshError, match=sentence) as caught:
        read_mesh(path)
    problem = caught.value.problem
    assert problem.code == code
    assert problem.severity == "error" and problem.file == str(path)
    assert "\n" not in str(caught.value)
    assert isinstance(caught.value, errors.RobotError)


def test_a_pointer_beside_the_mesh_is_said(write: Callable[..., Path]) -> None:
    write("a.mtl", POINTER)
    mesh = read_mesh(
        write("a.obj", "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    )
    assert [problem.code for problem in mesh.problems] == ["mesh-lfs-pointer"]
    write("a.bin", POINTER)
    content = """{"nodes": [{"mesh": 0}], "meshes": [{"primitives": [
      {"attributes": {"POSITION": 0}}]}], "buffers": [{"uri": "a.bin"}],
      "bufferViews": [{"buffer": 0, "byteLength": 36}], "accessors": [
      {"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}]}"""
    with pytest.raises(MeshError, match=r"'a\.bin': it is a git-LFS pointer"):
        read_mesh(write("a.gltf", content))


def test_nothing_heavy_is_imported_before_it_is_needed() -> None:
    code = (
        "import sys, sambot_viz.meshes.read_mesh;"
        "heavy = {'trimesh', 'PIL', 'lxml', 'collada', 'scipy', 'viser'};"
        "print(sorted(heavy & set(sys.modules)))"
    )
    run = [sys.executable, "-c", code]
    assert subprocess.run(run, capture_output=True, text=True).stdout == "[]\n"


@pytest.mark.parametrize("kind", ["binary", "ascii"])
def test_reading_an_stl_imports_no_mesh_library(
    write: Callable[..., Path], binary_stl: Callable[..., bytes], kind: str
) -> None:
    corners = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]
    vertices = "".join(f"vertex {x} {y} {z}\n" for x, y, z in corners)
    text = f"solid a\nfacet normal 0 0 1\n{vertices}endfacet\nendsolid a\n"
    path = write("a.stl", binary_stl([corners]) if kind == "binary" else text)
    code = (
        "import sys, pathlib; from sambot_viz.meshes.read_mesh import read_mesh;"
        f"print(read_mesh(pathlib.Path({str(path)!r})).triangles,"
        "sorted({'trimesh', 'scipy', 'networkx', 'PIL'} & set(sys.modules)))"
    )
    run = [sys.executable, "-c", code]
    assert subprocess.run(run, capture_output=True, text=True).stdout == "1 []\n"


def test_a_missing_file_and_a_folder_are_said(tmp_path: Path) -> None:
    with pytest.raises(MeshError, match="there is no such file"):
        read_mesh(tmp_path / "gone.stl")
    folder = tmp_path / "folder.stl"
    folder.mkdir()
    with pytest.raises(MeshError, match="this is not a file"):
        read_mesh(folder)


def test_a_name_that_no_file_can_have_is_said() -> None:
    with pytest.raises(MeshError, match="cannot be read"):
        read_mesh(Path("a\0.stl"))


def test_a_file_above_the_limit_is_refused_before_it_is_read(
    write: Callable[..., Path],
) -> None:
    path = write("a.stl", b"x" * 2_100_000)
    with pytest.raises(MeshError, match="the mesh has more than the 1,048,576 bytes"):
        read_mesh(path, largest=1 << 20)


@pytest.mark.parametrize("copies", [1, 40])
def test_entries_that_the_file_does_not_contain_take_no_memory(
    write: Callable[..., Path], copies: int
) -> None:
    primitive = {"attributes": {"POSITION": 0}}
    document = {
        "asset": {"version": "2.0"},
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [primitive] * copies}],
        "accessors": [{"componentType": 5126, "count": 2**24, "type": "VEC3"}],
    }
    with pytest.raises(MeshError, match=r"more than (1,048,576 entries|30,000,000)"):
        read_mesh(write("a.gltf", json.dumps(document)))


def test_vertices_that_many_primitives_share_are_counted_for_each(
    write: Callable[..., Path], monkeypatch: pytest.MonkeyPatch
) -> None:
    lower(monkeypatch, "MESH_VERTICES", 1000)
    data = base64.b64encode(bytes(1200)).decode()
    document = {
        "asset": {"version": "2.0"},
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}] * 40}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 99, "type": "VEC3"}
        ],
        "bufferViews": [{"buffer": 0, "byteLength": 1200}],
        "buffers": [{"byteLength": 1200, "uri": f"data:;base64,{data}"}],
    }
    with pytest.raises(MeshError, match="more than 1,000 vertices"):
        read_mesh(write("a.gltf", json.dumps(document)))


@pytest.mark.parametrize("end", ["", "</x>" * 200_000])
def test_a_collada_file_that_is_nested_too_deep_is_refused_clearly(
    write: Callable[..., Path], end: str
) -> None:
    text = "<COLLADA>" + "<x>" * 200_000 + end
    with pytest.raises(MeshError) as caught:
        read_mesh(write("a.dae", text))
    assert "internal" not in str(caught.value) and "expected" not in str(caught.value)


def test_the_errors_of_meshes_belong_to_the_tree_of_this_package() -> None:
    for kind in (TextureError, NamedFileError, MeshError):
        assert issubclass(kind, SambotVizError)
