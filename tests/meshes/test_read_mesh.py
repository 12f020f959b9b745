"""What is said about files that are no meshes."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from sambot_viz import errors
from sambot_viz.meshes.mesh import MeshError
from sambot_viz.meshes.read_mesh import read_mesh

POINTER = "version https://git-lfs.github.com/spec/v1\noid sha256:abc\nsize 12\n"


@pytest.mark.parametrize(
    ("name", "content", "code", "sentence"),
    [
        ("a.stl", POINTER, "mesh-lfs-pointer", "run 'git lfs pull'"),
        ("a.dae", "", "mesh-empty", "the file is empty"),
        ("a.mesh", "x", "mesh-format-unknown", r"kind '.mesh' .* one of .stl, .dae"),
        ("noending", "x", "mesh-format-unknown", "kind 'noending'"),
        ("a.dae", "<robot/>", "mesh-broken", "no <COLLADA> element .* <robot>"),
        ("a.dae", "nothing like it", "mesh-broken", "not well-formed XML"),
        ("a.obj", "# nothing\n", "mesh-empty", "no triangles"),
        ("a.glb", b"glTF\2\0", "mesh-broken", "only 6 bytes"),
        ("a.gltf", "{", "mesh-broken", "its JSON cannot be read"),
        ("a.gltf", "[]", "mesh-broken", "its JSON is no object"),
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
    with pytest.raises(MeshError, match=r"'a\.bin' is a git-LFS pointer"):
        read_mesh(write("a.gltf", content))


def test_nothing_heavy_is_imported_before_it_is_needed() -> None:
    code = (
        "import sys, sambot_viz.meshes.read_mesh;"
        "heavy = {'trimesh', 'PIL', 'lxml', 'collada', 'scipy', 'viser'};"
        "print(sorted(heavy & set(sys.modules)))"
    )
    run = [sys.executable, "-c", code]
    assert subprocess.run(run, capture_output=True, text=True).stdout == "[]\n"


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
    with pytest.raises(MeshError, match="the mesh has 2 MB, more than the 1 MB"):
        read_mesh(path, largest=1 << 20)
