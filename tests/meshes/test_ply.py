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


HEADER, SOUND = header("ascii", 1), b"0 0 0 1\n" * 4 + b"3 0 1 2\n"


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
    [[(0, 1, 2, 3)], [(0, 1, 2), (0, 2, 3)]],
)
def test_binary_files_are_read_in_both_orders_of_bytes(
    write: Write, order: str, faces: list[tuple[int, ...]]
) -> None:
    mesh = read_mesh(write("a.ply", binary(order, faces)))
    assert mesh.triangles == sum(len(face) - 2 for face in faces)
    assert np.array_equal(mesh.bounds, [[0, 0, 0], [2, 1, 0]])
    assert mesh.parts[0].rgba == (1, 1, 1, 1) and mesh.parts[0].normals is None


MIXED = [(0, 1, 2), (0, 1, 2, 3), (0, 2, 3)]


@pytest.mark.parametrize(
    ("faces", "sentence"),
    [
        (MIXED, "PLY is unexpected length!"),
        # As long as three faces of four corners.
        ([(0, 1, 2, 3), (0, 1, 2), (0, 1, 2, 3, 0)], "different numbers of corners"),
    ],
)
def test_a_binary_file_whose_faces_differ_is_refused(
    write: Write, faces: list[tuple[int, ...]], sentence: str
) -> None:
    with pytest.raises(MeshError, match=sentence) as caught:
        read_mesh(write("a.ply", binary("<", faces)))
    assert "binary files as triangles only" in caught.value.problem.hint


def test_an_ascii_file_may_mix_triangles_with_larger_polygons(write: Write) -> None:
    rows = "".join(f"{x} {y} {z} 200\n" for x, y, z in POINTS)
    rows += "".join(f"{len(face)} {' '.join(map(str, face))}\n" for face in MIXED)
    mesh = read_mesh(write("a.ply", header("ascii", 3) + rows))
    assert mesh.triangles == 4
    assert np.array_equal(mesh.bounds, [[0, 0, 0], [2, 1, 0]])


@pytest.mark.parametrize("order", ["ascii", "<"])
def test_a_polygon_with_an_inward_corner_is_covered_once(
    write: Write, order: str
) -> None:
    corners = [(0, 0), (4, 0), (4, 4), (3, 1)]
    text = header(order, 1).replace("uchar red", "float s")
    rows = "".join(f"{x} {y} 0 1\n" for x, y in corners) + "4 0 1 2 3\n"
    data = text.encode() + rows.encode()
    if order == "<":
        data = text.replace("<", "binary_little_endian").encode()
        data += b"".join(struct.pack("<4f", x, y, 0, 1) for x, y in corners)
        data += struct.pack("<B4i", 4, 0, 1, 2, 3)
    part = read_mesh(write("a.ply", data)).parts[0]
    a, b, c = part.vertices[part.faces].transpose(1, 0, 2)
    areas = np.cross(b - a, c - a)[:, 2] / 2
    assert np.all(areas > 0) and areas.sum() == pytest.approx(4)


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
        (binary("<", [(0, 1, 2)])[:-3], "unexpected length"),
        (binary("<", [(0, 1, 2)])[:-20], "unexpected length"),
        (binary("<", [(0, 1, 2)]) + b"\0", "unexpected length"),
        (binary("<", []).replace(b"vertex 4", b"vertex 4" + b"0" * 30), "no triangles"),
        (HEADER.encode() + b"0 0 0 1\n" * 4, "announces 5 entries but has 4 lines"),
        (HEADER.encode() + b"0 0 0 1\n" * 4 + b"\n3 0 1 2", "but has 6 lines"),
        (HEADER.encode() + b"0 0 x 1\n" * 4 + b"3 0 1 2", "not made of numbers"),
        (HEADER.encode() + b"0 0 0\n" * 4 + b"3 0 1 2", "vertex has 3 numbers and not"),
        (HEADER.encode() + b"0 0 0 1\n" * 4 + b"3 0 1", "face has 3 numbers and not 4"),
        (HEADER.encode() + b"0 0 0 1\n" * 4 + b"3.5 0 1 2", "invalid literal for int"),
        (HEADER.replace("ascii", "gzip").encode(), "names no known format"),
        (HEADER.replace("ply", "ply\ncomment big").encode(), "names no known format"),
        (HEADER.replace("uchar red", "red").encode(), "a line that is not known"),
        (HEADER.replace("int vert", "vert").encode(), "a line that is not known"),
        (HEADER.replace("uchar red", "odd red").encode() + SOUND, "KeyError: 'odd'"),
        (HEADER.replace(" x", " u").encode() + SOUND, "KeyError: 'x'"),
        (HEADER.replace("face 1", "edge 1").encode() + SOUND, "it has edges"),
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
    with pytest.raises(MeshError, match="a property of it is there twice: x"):
        read_mesh(write("a.ply", data))


def test_a_list_that_announces_more_than_memory_takes_none(write: Write) -> None:
    data = binary("<", [(0, 1, 2)]).replace(b"list uchar", b"list uint")
    data = data[:-13] + struct.pack("<I3i", 2**31 - 1, 0, 1, 2)
    with pytest.raises(MeshError, match="the PLY file is broken: trimesh cannot read"):
        read_mesh(write("a.ply", data))


def test_a_texture_that_a_file_names_is_not_opened(write: Write) -> None:
    text = HEADER.replace("comment test", "comment TextureFile ../../secret.png")
    mesh = read_mesh(write("a.ply", text.encode() + SOUND.replace(b"2\n", b"3\n")))
    assert mesh.problems == () and len(mesh.files) == 1
