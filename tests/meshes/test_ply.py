"""PLY as RViz shows it."""

from __future__ import annotations

import struct
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from sambot_viz.meshes.mesh import MeshError
from sambot_viz.meshes.read_mesh import read_mesh

Write = Callable[..., Path]

POINTS = [(0, 0, 0), (2, 0, 0), (2, 1, 0), (0, 1, 0)]


def header(kind: str, faces: int, more: str = "") -> str:
    return (
        f"ply\nformat {kind} 1.0\ncomment test\nelement vertex 4\n"
        "property float x\nproperty float y\nproperty float z\n"
        f"property uchar red\n{more}element face {faces}\n"
        "property list uchar int vertex_indices\nend_header\n"
    )


def binary(order: str, faces: list[tuple[int, ...]]) -> bytes:
    kind = {"<": "binary_little_endian", ">": "binary_big_endian"}[order]
    data = header(kind, len(faces)).encode()
    for point in POINTS:
        data += struct.pack(order + "fffB", *point, 255)
    for face in faces:
        data += struct.pack(f"{order}B{len(face)}i", len(face), *face)
    return data


@pytest.mark.parametrize("order", ["<", ">"])
@pytest.mark.parametrize(
    "faces",
    [[(0, 1, 2, 3)], [(0, 1, 2), (0, 2, 3)], [(0, 1, 2), (0, 1, 2, 3), (0, 2, 3)]],
)
def test_binary_files_are_read_whatever_their_faces(
    write: Write, order: str, faces: list[tuple[int, ...]]
) -> None:
    mesh = read_mesh(write("a.ply", binary(order, faces)))
    assert mesh.triangles == sum(len(face) - 2 for face in faces)
    assert np.array_equal(mesh.bounds, [[0, 0, 0], [2, 1, 0]])
    assert mesh.parts[0].rgba == (1, 1, 1, 1) and mesh.parts[0].normals is None


def test_an_ascii_file_is_white_whatever_colours_its_vertices_have(
    write: Write,
) -> None:
    rows = "".join(f"{x} {y} {z} 200\n" for x, y, z in POINTS)
    mesh = read_mesh(write("a.ply", header("ascii", 1) + rows + "4 0 1 2 3\n"))
    assert mesh.triangles == 2 and mesh.parts[0].rgba == (1, 1, 1, 1)


def test_normals_of_the_file_make_it_smooth(write: Write) -> None:
    more = "property float nx\nproperty float ny\nproperty float nz\n"
    rows = "".join(f"{x} {y} {z} 200 0 0 2\n" for x, y, z in POINTS)
    part = read_mesh(
        write("a.ply", header("ascii", 1, more) + rows + "3 0 1 2\n")
    ).parts[0]
    assert part.normals is not None and np.allclose(part.normals, [0, 0, 1])


@pytest.mark.parametrize(
    ("content", "sentence"),
    [
        (binary("<", [(0, 1, 2)])[:-3], "cut off"),
        (binary("<", [(0, 1, 2)])[:-20], "cut off in its 4 vertex entries"),
        (
            header("ascii", 1).encode() + b"0 0 0 1\n" * 4,
            "cut off in its 1 face entries",
        ),
        (header("ascii", 1).encode() + b"0 0 x 1\n" * 4 + b"3 0 1 2", "4 numbers"),
        (header("ascii", 1).encode() + b"0 0 0 1\n" * 4 + b"3 0 1", "fewer corners"),
        (header("ascii", 1).encode() + b"0 0 0 1\n" * 4 + b"3 0 1 z", "whole numbers"),
        (header("gzip", 1).encode(), "names no known format"),
        (header("ascii", 1).replace("uchar red", "color red").encode(), "cannot be"),
        (header("ascii", 0).replace(" x", " u").encode() + b"0 0 0 1\n" * 4, "no x, y"),
    ],
)
def test_a_broken_file_is_refused(write: Write, content: bytes, sentence: str) -> None:
    with pytest.raises(MeshError, match=sentence):
        read_mesh(write("a.ply", content))


def test_a_point_cloud_is_no_mesh(write: Write) -> None:
    text = "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\n"
    text += "property float y\nproperty float z\nend_header\n0 0 0\n"
    with pytest.raises(MeshError, match="no triangles"):
        read_mesh(write("a.ply", text))


def test_a_property_listed_twice_is_refused(write: Write) -> None:
    data = binary("<", [(0, 1, 2)]).replace(b"float y", b"float x")
    with pytest.raises(MeshError, match="a property of vertex twice"):
        read_mesh(write("a.ply", data))
