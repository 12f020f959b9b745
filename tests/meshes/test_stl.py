"""STL as RViz reads it."""

from __future__ import annotations

import struct
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from sambot_viz.meshes.mesh import MeshError
from sambot_viz.meshes.read_mesh import read_mesh

TWO = [[[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[1, 0, 0], [1, 1, 0], [0, 1, 0]]]
ASCII = """solid part
  facet normal 0 0 1
    outer loop
      vertex 0 0 0
      VERTEX 1e0 0 0
      vertex 0 1 0
    endloop
  endfacet
endsolid part
"""


def test_a_binary_stl_is_flat_and_leaves_the_colour_to_the_urdf(
    write: Callable[..., Path], binary_stl: Callable[..., bytes]
) -> None:
    mesh = read_mesh(write("a.STL", binary_stl(TWO)))
    (part,) = mesh.parts
    assert mesh.triangles == 2
    assert part.normals is None and part.rgba is None and part.texture is None
    assert part.vertices.dtype == np.float32 and part.faces.dtype == np.uint32
    assert np.array_equal(part.vertices[part.faces], TWO)
    assert np.array_equal(mesh.bounds, [[0, 0, 0], [1, 1, 0]])
    assert mesh.problems == ()


def test_corners_at_the_same_place_are_sent_once(
    write: Callable[..., Path], binary_stl: Callable[..., bytes]
) -> None:
    assert len(read_mesh(write("a.stl", binary_stl(TWO))).parts[0].vertices) == 4


@pytest.mark.parametrize("header", [b"solid part", b"solid", b"SOLID x\nfacet normal"])
def test_a_binary_stl_may_begin_with_solid(
    write: Callable[..., Path], binary_stl: Callable[..., bytes], header: bytes
) -> None:
    assert read_mesh(write("a.stl", binary_stl(TWO, header))).triangles == 2


def test_an_ascii_stl_is_read_whatever_the_letter_case(
    write: Callable[..., Path],
) -> None:
    mesh = read_mesh(write("a.stl", ASCII))
    assert mesh.triangles == 1
    assert np.array_equal(mesh.bounds, [[0, 0, 0], [1, 1, 0]])


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("solid part", "solid vertex group of Müller"),
        ("endsolid part\n", ""),
        ("endsolid part\n", "endsolid vertex"),
        ("\n", "\r"),
        ("\n", "\r\n"),
        ("normal 0 0 1", "normal -nan(ind) x"),
    ],
)
def test_names_ends_of_lines_and_normals_of_an_ascii_stl_do_not_matter(
    write: Callable[..., Path], old: str, new: str, caplog: pytest.LogCaptureFixture
) -> None:
    mesh = read_mesh(write("a.stl", ASCII.replace(old, new)))
    assert np.array_equal(mesh.bounds, [[0, 0, 0], [1, 1, 0]])
    assert mesh.problems == () and caplog.records == []


def test_all_solids_of_an_ascii_stl_are_drawn(write: Callable[..., Path]) -> None:
    second = ASCII.replace("part", "vertex").replace("0 1 0", "0 3 0")
    mesh = read_mesh(write("a.stl", ASCII + second))
    assert mesh.triangles == 2
    assert np.array_equal(mesh.bounds, [[0, 0, 0], [1, 3, 0]])


@pytest.mark.parametrize(
    ("damage", "sentence"),
    [
        (lambda data: data[:60], "has only 60 bytes"),
        (lambda data: data[:-10], "announces 2 triangles, which takes 184 bytes"),
        (lambda data: data + b"\0\0", "but it has 186"),
        (lambda data: data[:80] + struct.pack("<I", 65538) + data[84:], "65538"),
    ],
)
def test_a_binary_stl_of_the_wrong_size_is_refused(
    write: Callable[..., Path],
    binary_stl: Callable[..., bytes],
    damage: Callable[[bytes], bytes],
    sentence: str,
) -> None:
    with pytest.raises(MeshError, match=sentence) as caught:
        read_mesh(write("a.stl", damage(binary_stl(TWO))))
    assert caught.value.problem.code == "mesh-broken"


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("solid empty\nendsolid empty\n", "contains no triangles"),
        (ASCII.replace("VERTEX 1e0 0 0", ""), "2 vertices in 1 complete facets"),
        (ASCII.replace("1e0 0 0", "1 0"), "not three numbers"),
        (ASCII.replace("1e0 0 0", "-1,5 0 0"), r"decimal commas \(-1,5\)"),
        (ASCII[: ASCII.index("endfacet")], "3 vertices in 0 complete facets"),
    ],
)
def test_a_broken_ascii_stl_is_refused(
    write: Callable[..., Path], text: str, sentence: str
) -> None:
    with pytest.raises(MeshError, match=sentence):
        read_mesh(write("a.stl", text))


def test_triangles_with_corners_that_are_no_numbers_are_left_out(
    write: Callable[..., Path], binary_stl: Callable[..., bytes]
) -> None:
    bad = np.array(TWO, dtype="f4")
    bad[1, 0, 0] = np.nan
    mesh = read_mesh(write("a.stl", binary_stl(bad)))
    assert mesh.triangles == 1
    assert [problem.code for problem in mesh.problems] == ["mesh-vertex-not-finite"]
    assert (
        "1 triangles have a corner that is not a finite number"
        in mesh.problems[0].message
    )


def test_a_mesh_without_any_usable_triangle_is_refused_with_the_cause(
    write: Callable[..., Path], binary_stl: Callable[..., bytes]
) -> None:
    with pytest.raises(MeshError, match="nothing of the mesh can be drawn: 2 tri"):
        read_mesh(write("a.stl", binary_stl(np.full((2, 3, 3), np.inf))))
    with pytest.raises(MeshError, match="the mesh has no triangles"):
        read_mesh(write("b.stl", binary_stl([])))
