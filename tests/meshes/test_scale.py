"""The scale of a URDF mesh, mirrored ones included."""

from __future__ import annotations

import numpy as np
import pytest

from sambot_viz.meshes.mesh import MeshPart, apply_scale

ROOF = MeshPart(
    vertices=np.array([[0, 0, 0], [1, 0, 1], [0, 1, 0]], dtype=np.float32),
    faces=np.array([[0, 1, 2]], dtype=np.uint32),
    normals=np.tile(np.array([-1, 0, 1], dtype=np.float32) / np.sqrt(2), (3, 1)).astype(
        np.float32
    ),
    rgba=(1, 0, 0, 1),
)


def face_normal(part: MeshPart) -> np.ndarray:
    a, b, c = part.vertices[part.faces[0]].astype(float)
    normal = np.cross(b - a, c - a)
    return normal / np.linalg.norm(normal)


@pytest.mark.parametrize(
    "scale",
    [(2, 2, 2), (1, 1, 3), (-1, 1, 1), (1, -2, 1), (-1, -1, 1), (-1, -1, -1)],
)
def test_normals_stay_on_the_side_the_triangles_face(
    scale: tuple[float, float, float],
) -> None:
    part = apply_scale(ROOF, scale)
    assert np.allclose(part.vertices, ROOF.vertices * np.array(scale))
    assert part.normals is not None
    assert np.allclose(part.normals[0], face_normal(part), atol=1e-6)
    assert part.rgba == ROOF.rgba


def test_a_mirrored_shape_shows_its_outside() -> None:
    mirrored = apply_scale(ROOF, (1, -1, 1))
    assert face_normal(mirrored)[2] > 0
    assert mirrored.faces.tolist() == [[2, 1, 0]]


def test_no_scale_is_no_work() -> None:
    assert apply_scale(ROOF, (1.0, 1.0, 1.0)) is ROOF


def test_a_flattened_shape_has_no_bad_numbers() -> None:
    part = apply_scale(ROOF, (1, 1, 0))
    assert part.normals is not None and np.all(np.isfinite(part.normals))
