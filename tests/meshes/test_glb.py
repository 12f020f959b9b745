"""The GLB writer, read back by another reader and by ours."""

from __future__ import annotations

import io
import json
import struct
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from sambot_viz.meshes.glb import has_own_normals, to_glb
from sambot_viz.meshes.mesh import MeshPart
from sambot_viz.meshes.read_mesh import read_mesh
from sambot_viz.meshes.textures import encode_texture

SQUARE = np.array([[0, 0, 0], [2, 0, 0], [2, 1, 0], [0, 1, 0]], dtype=np.float32)
FACES = np.array([[0, 1, 2], [0, 2, 3]], dtype=np.uint32)
UV = np.array([[0, 0], [1, 0], [1, 1], [0, 1]], dtype=np.float32)
UP = np.tile(np.array([0, 0, 1], dtype=np.float32), (4, 1))


def json_of(data: bytes) -> dict[str, Any]:
    (length,) = struct.unpack_from("<I", data, 12)
    return json.loads(data[20 : 20 + length])


@pytest.fixture
def part(png: Callable[..., bytes]) -> MeshPart:
    return MeshPart(SQUARE, FACES, UP, (1, 1, 1, 1), UV, encode_texture(png()))


def test_the_image_travels_as_it_is_and_once(
    part: MeshPart, png: Callable[..., bytes]
) -> None:
    data = to_glb(part)
    assert data.count(png()) == 1
    content = json_of(data)
    assert len(content["images"]) == len(content["textures"]) == 1


def test_materials_are_neither_metallic_nor_two_sided(part: MeshPart) -> None:
    (material,) = json_of(to_glb(part))["materials"]
    assert material["pbrMetallicRoughness"]["metallicFactor"] == 0
    assert material["pbrMetallicRoughness"]["roughnessFactor"] == 1
    assert material["doubleSided"] is False
    assert "alphaMode" not in material


@pytest.mark.parametrize(
    ("rgba", "alpha", "factor", "blended"),
    [
        (None, 1.0, [1, 1, 1, 1], False),
        (None, 0.9998, [1, 1, 1, 0.9998], False),
        (None, 0.9997, [1, 1, 1, 0.9997], True),
        ((1, 0, 0.5, 0.5), 0.5, [1, 0, 0.21404, 0.25], True),
    ],
)
def test_colour_and_alpha_multiply(
    part: MeshPart,
    rgba: tuple[float, float, float, float] | None,
    alpha: float,
    factor: list[float],
    blended: bool,
) -> None:
    (material,) = json_of(to_glb(part, rgba=rgba, alpha=alpha))["materials"]
    written = material["pbrMetallicRoughness"]["baseColorFactor"]
    assert np.allclose(written, factor, atol=1e-5)
    assert material.get("alphaMode", "OPAQUE") == ("BLEND" if blended else "OPAQUE")


def test_flat_parts_have_no_normals() -> None:
    (primitive,) = json_of(to_glb(MeshPart(SQUARE, FACES)))["meshes"][0]["primitives"]
    assert set(primitive["attributes"]) == {"POSITION"}


def test_normals_that_faces_do_not_give_are_there_twice() -> None:
    """viser overwrites those named NORMAL with normals of the faces."""
    tilted = np.tile(np.array([0, 0.6, 0.8], dtype=np.float32), (4, 1))
    for normals, own in ((UP, False), (tilted, True), (None, False)):
        part = MeshPart(SQUARE, FACES, normals)
        assert has_own_normals(part) is own
        (primitive,) = json_of(to_glb(part))["meshes"][0]["primitives"]
        assert ("_NORMAL" in primitive["attributes"]) is own


def test_a_colour_over_a_part_is_a_second_look_of_its_corners(part: MeshPart) -> None:
    """RViz draws a tinted mesh twice: the tint has no texture."""
    written = json_of(to_glb(part, over=(1, 0, 0, 0.5)))
    first, second = written["meshes"][0]["primitives"]
    assert first["attributes"] == second["attributes"]
    own, over = (written["materials"][one["material"]] for one in (first, second))
    assert "baseColorTexture" in own["pbrMetallicRoughness"]
    assert over["pbrMetallicRoughness"]["baseColorFactor"] == [1, 0, 0, 0.5]
    assert "baseColorTexture" not in over["pbrMetallicRoughness"]
    assert "alphaMode" not in own and over["alphaMode"] == "BLEND"


def test_our_own_reader_gets_back_what_was_written(
    part: MeshPart, write: Callable[..., Path]
) -> None:
    mesh = read_mesh(write("a.glb", to_glb(part)))
    (again,) = mesh.parts
    assert np.array_equal(again.vertices, part.vertices)
    assert np.array_equal(again.faces, part.faces)
    assert again.uv is not None and np.array_equal(again.uv, UV)
    assert again.texture is not None and part.texture is not None
    assert again.texture.data == part.texture.data


def test_trimesh_reads_it_too(part: MeshPart) -> None:
    import trimesh

    for shape, low in ((part, [0, 0, 0]), (MeshPart(SQUARE + 5, FACES), [5, 5, 5])):
        scene = trimesh.load_scene(io.BytesIO(to_glb(shape)), file_type="glb")
        assert np.allclose(scene.bounds, [low, np.add(low, [2, 1, 0])])
        assert sum(len(geometry.faces) for geometry in scene.geometry.values()) == 2


def test_large_parts_have_wide_indices() -> None:
    count = 70_000
    vertices = np.zeros((count, 3), dtype=np.float32)
    faces = np.array([[0, 1, count - 1]], dtype=np.uint32)
    content = json_of(to_glb(MeshPart(vertices, faces)))
    assert content["accessors"][1]["componentType"] == 5125
