"""OBJ and MTL as RViz shows them."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from sambot_viz.meshes.mesh import Mesh, MeshError
from sambot_viz.meshes.read_mesh import read_mesh

Write = Callable[..., Path]

SQUARE = (
    "v 0 0 0\nv 2 0 0\nv 2 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvn 0 0 1\n"
)


def codes(mesh: Mesh) -> list[str]:
    return [problem.code for problem in mesh.problems]


@pytest.mark.parametrize(
    "faces",
    [
        "f 1 2 3 4",
        "f 1/1 2/2 3/3 4/4",
        "f 1//1 2//1 3//1 4//1",
        "f 1/1/1 2/2/1 3/3/1 4/4/1",
        "f -4 -3 -2 -1",
        "f 1 2 3\nf 1 3 4",
        "f 1 2 3\nf 1/1/1 3/3/1 4/4/1",
        "f 1/1 2 3/3/1 4",
        "f 1\t2 3 \\\n 4",
        "  f 1 2 3 4",
        "f 1 2 3 4\r",
    ],
)
def test_faces_are_read_however_they_are_written(write: Write, faces: str) -> None:
    mesh = read_mesh(write("a.obj", SQUARE + faces + "\n"))
    triangles = np.concatenate([part.vertices[part.faces] for part in mesh.parts])
    a, b, c = triangles.transpose(1, 0, 2)
    assert mesh.triangles == 2
    assert np.allclose(np.cross(b - a, c - a).sum(axis=0), [0, 0, 4])
    assert {part.rgba for part in mesh.parts} == {(0.6, 0.6, 0.6, 1.0)}
    assert mesh.problems == ()


def test_backward_indices_count_from_where_they_stand(write: Write) -> None:
    text = (
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -2 -1\nv 0 0 5\nv 1 0 5\nv 0 1 5\nf -3 -2 -1\n"
    )
    assert read_mesh(write("a.obj", text)).bounds[1][2] == 5


def test_normals_are_used_only_when_every_corner_has_one(write: Write) -> None:
    smooth = read_mesh(write("a.obj", SQUARE + "f 1//1 2//1 3//1\n")).parts[0]
    assert smooth.normals is not None and np.allclose(smooth.normals, [0, 0, 1])
    assert read_mesh(write("b.obj", SQUARE + "f 1 2 3\n")).parts[0].normals is None


def test_vertex_colours_and_weights_are_ignored(write: Write) -> None:
    text = "v 0 0 0 1 0 0\nv 1 0 0 1 0 0\nv 0 1 0 1 0 0\nf 1 2 3\n"
    assert read_mesh(write("a.obj", text)).triangles == 1
    mixed = "v 0 0 0 1\nv 1 0 0\nv 0 1 0 1 0 0\nf 1 2 3\n"
    assert np.allclose(read_mesh(write("b.obj", mixed)).bounds[1], [1, 1, 0])


def test_materials_come_from_the_library(
    write: Write, png: Callable[..., bytes]
) -> None:
    write("skin image.png", png())
    write(
        "my parts.mtl",
        "newmtl red\nKd 0.8 0.1 0.2\nd 0.5\nnewmtl plain\n"
        "newmtl skin\nKd 1 1 1\nmap_Kd -s 1 1 1 -clamp on skin image.png\n"
        "newmtl gone\nd 0\nKd 0.3\n",
    )
    lines = [
        f"usemtl {name}\nf 1/1 2/2 3/3"
        for name in ("red", "plain", "skin", "gone", "x")
    ]
    mesh = read_mesh(
        write("a.obj", "mtllib my parts.mtl\n" + SQUARE + "\n".join(lines))
    )
    assert [part.rgba for part in mesh.parts] == [
        (0.8, 0.1, 0.2, 0.5),
        (0.6, 0.6, 0.6, 1.0),  # also what usemtl names but the library does not have
        (1, 1, 1, 1),
        (0.3, 0.3, 0.3, 1.0),
    ]
    assert mesh.parts[2].texture is not None and mesh.parts[2].uv is not None
    assert codes(mesh) == ["mesh-material-broken"]
    assert [path.name for path in mesh.files] == [
        "a.obj",
        "my parts.mtl",
        "skin image.png",
    ]


def test_parts_of_one_look_are_one_part(write: Write) -> None:
    write("a.mtl", "newmtl a\nKd 1 0 0\nnewmtl b\nKd 1 0 0\n")
    faces = "usemtl a\nf 1 2 3\nusemtl b\nf 1 3 4\n" * 3
    mesh = read_mesh(write("a.obj", "mtllib a.mtl\n" + SQUARE + faces))
    assert len(mesh.parts) == 1 and mesh.triangles == 6


def test_a_missing_library_is_grey_with_a_warning(write: Write) -> None:
    mesh = read_mesh(
        write("a.obj", "mtllib gone.mtl\nusemtl red\n" + SQUARE + "f 1 2 3\n")
    )
    assert mesh.parts[0].rgba == (0.6, 0.6, 0.6, 1.0)
    assert codes(mesh) == ["mesh-material-missing"]
    assert "'gone.mtl' cannot be used: there is no" in mesh.problems[0].message


def test_indices_that_point_nowhere_are_left_out(write: Write) -> None:
    mesh = read_mesh(write("a.obj", SQUARE + "f 1 2 3\nf 1 2 9\nf 0 1 2\n"))
    assert mesh.triangles == 1
    assert codes(mesh) == ["mesh-index-out-of-range"]


def test_lines_that_are_no_numbers_are_said(write: Write) -> None:
    with pytest.raises(MeshError, match="an index that is not a whole number"):
        read_mesh(write("a.obj", SQUARE + "f a b c\n"))
    mesh = read_mesh(write("b.obj", SQUARE + "v x y z\nf 1 2 3\nf 1 2 5\n"))
    assert mesh.triangles == 1 and "mesh-geometry-broken" in codes(mesh)


MIXED = (
    "mtllib a.mtl\nusemtl a\n" + SQUARE + "v 0 0 -1\nv 1 0 -1\n"
    "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvn 0 0 1\n"
    "f 1/1/1 2/2/1 3/3/1 4/4/1\nf 1 5 6 2\n"
)


def test_a_face_without_uv_and_normals_leaves_those_of_the_other_faces(
    write: Write, png: Callable[..., bytes]
) -> None:
    write("a.png", png())
    write("a.mtl", "newmtl a\nKd 1 1 1\nmap_Kd a.png\n")
    mesh = read_mesh(write("a.obj", MIXED))
    smooth = next(part for part in mesh.parts if part.normals is not None)
    flat = next(part for part in mesh.parts if part.normals is None)
    assert smooth.texture is not None and len(smooth.faces) == len(flat.faces) == 2
    assert smooth.uv is not None and {tuple(row) for row in smooth.uv.tolist()} == {
        (0, 0),
        (1, 0),
        (1, 1),
        (0, 1),
    }
    # As in Assimp, the corners without uv take the image at (0, 0).
    assert flat.uv is not None and not np.any(flat.uv)


def test_emission_adds_to_the_diffuse_colour(write: Write) -> None:
    write("a.mtl", "newmtl a\nKe 0 0.8 0.5\nKd 0.2 0 0.75\nd 0.5\n")
    mesh = read_mesh(write("a.obj", "mtllib a.mtl\nusemtl a\n" + SQUARE + "f 1 2 3\n"))
    assert mesh.parts[0].rgba == (0.2, 0.8, 1.0, 0.5)
