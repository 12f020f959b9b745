"""The unit shapes against the figures of RViz's own meshes."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import numpy.typing as npt
import pytest

from sambot_viz.meshes.primitives import (
    Primitive,
    unit_box,
    unit_cone,
    unit_cylinder,
    unit_sphere,
)

ALL = [unit_box, unit_cylinder, unit_cone, unit_sphere]


def triangle_normals(shape: Primitive) -> npt.NDArray[np.float64]:
    a, b, c = shape.vertices.astype(np.float64)[shape.faces].transpose(1, 0, 2)
    normals = np.cross(b - a, c - a)
    return normals / np.linalg.norm(normals, axis=1, keepdims=True)


@pytest.mark.parametrize(
    ("make", "triangles"),
    [(unit_box, 12), (unit_cylinder, 60), (unit_cone, 30), (unit_sphere, 224)],
)
def test_triangle_counts_are_those_of_rviz(
    make: Callable[[], Primitive], triangles: int
) -> None:
    assert len(make().faces) == triangles


@pytest.mark.parametrize("make", ALL)
def test_every_triangle_faces_outwards_and_has_the_normals_of_its_corners(
    make: Callable[[], Primitive],
) -> None:
    shape = make()
    normals = triangle_normals(shape)
    centres = shape.vertices[shape.faces].mean(axis=1)
    assert np.all(np.einsum("ij,ij->i", normals, centres) > 0)
    assert np.allclose(shape.normals[shape.faces], normals[:, None, :], atol=1e-5)


@pytest.mark.parametrize("make", ALL)
def test_shapes_are_closed(make: Callable[[], Primitive]) -> None:
    shape = make()
    _, index = np.unique(shape.vertices.round(5) + 0.0, axis=0, return_inverse=True)
    corners = index.reshape(-1)[shape.faces]
    edges = np.concatenate([corners[:, [0, 1]], corners[:, [1, 2]], corners[:, [2, 0]]])
    there = {tuple(map(int, edge)) for edge in edges}
    assert len(there) == len(edges)
    assert there == {(b, a) for a, b in there}


@pytest.mark.parametrize("make", ALL)
def test_arrays_are_typed_and_shared_read_only(make: Callable[[], Primitive]) -> None:
    shape = make()
    assert shape is make()
    assert shape.vertices.dtype == np.float32 and shape.faces.dtype == np.uint32
    assert shape.uv.dtype == np.float32 and len(shape.uv) == len(shape.vertices)
    assert 0 <= shape.uv.min() and shape.uv.max() <= 1
    with pytest.raises(ValueError, match="read-only"):
        shape.vertices[0] = 0


@pytest.mark.parametrize("make", [unit_box, unit_cylinder, unit_sphere])
def test_shapes_have_diameter_and_height_one(make: Callable[[], Primitive]) -> None:
    vertices = make().vertices
    assert np.allclose(vertices.min(axis=0), -0.5)
    assert np.allclose(vertices.max(axis=0), 0.5)


def test_the_sphere_has_114_distinct_corners() -> None:
    assert len(np.unique(unit_sphere().vertices.round(5) + 0.0, axis=0)) == 114


@pytest.mark.parametrize("make", [unit_cylinder, unit_cone])
def test_sides_face_11_25_degrees_and_every_22_5_from_there(
    make: Callable[[], Primitive],
) -> None:
    normals = triangle_normals(make())
    sides = normals[np.abs(normals[:, 2]) < 0.9]
    angles = np.degrees(np.arctan2(sides[:, 1], sides[:, 0])) % 360
    expected = 11.25 + 22.5 * np.arange(16)
    assert np.allclose(np.unique(angles.round(3)), expected, atol=0.01)


def test_the_cone_is_a_little_below_its_middle() -> None:
    z = unit_cone().vertices[:, 2]
    assert np.isclose(z.min(), -0.509) and np.isclose(z.max(), 0.491)


@pytest.mark.parametrize(
    ("make", "point", "uv"),
    [
        (unit_box, (0.5, -0.5, 0.5), (0, 1)),  # +x side, upper left seen from outside
        (unit_sphere, (0.5, 0, 0), (0.5, 0.5)),
        (unit_sphere, (0, 0.5, 0), (0.75, 0.5)),
        (unit_cylinder, (0.5, 0, 0.5), (0.75, 0)),  # upside down on the side
        (unit_cylinder, (0, 0.5, 0.5), (0.5, 0)),
    ],
)
def test_textures_lie_as_in_the_picture_of_the_real_rviz(
    make: Callable[[], Primitive],
    point: tuple[float, float, float],
    uv: tuple[float, float],
) -> None:
    shape = make()
    at = np.all(np.isclose(shape.vertices, point, atol=1e-6), axis=1)
    assert any(np.allclose(found, uv, atol=1e-6) for found in shape.uv[at])
