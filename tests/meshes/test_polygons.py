"""Polygons are cut into triangles that cover them, in reasonable time."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from sambot_viz.meshes.assembly.triangles import triangulate
from sambot_viz.meshes.mesh_source import MeshBudget
from sambot_viz.meshes.read_mesh import read_mesh

Write = Callable[..., Path]


def star(corners: int, seed: int) -> np.ndarray:
    """A polygon that does not cross itself, its corners at random distances."""
    chance = np.random.default_rng(seed)
    angles = np.linspace(0, 2 * np.pi, corners, endpoint=False)
    reach = chance.random(corners) + 0.1
    flat = np.column_stack([reach * np.cos(angles), reach * np.sin(angles), 0 * angles])
    return flat @ np.linalg.qr(chance.normal(size=(3, 3)))[0]


@pytest.mark.parametrize("turned", [False, True])
@pytest.mark.parametrize("seed", range(8))
def test_the_triangles_cover_a_polygon_once_and_face_as_it_does(
    seed: int, turned: bool
) -> None:
    points = star(20, seed)[:: -1 if turned else 1]
    triangles = points[triangulate(np.array([20]), points)]
    whole = np.cross(points, np.roll(points, -1, axis=0)).sum(axis=0)
    each = np.cross(
        triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0]
    )
    assert np.all(each @ whole >= 0)
    assert np.linalg.norm(each, axis=1).sum() == pytest.approx(np.linalg.norm(whole))


def test_convex_polygons_become_fans() -> None:
    square = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], dtype=np.float64)
    faces = triangulate(np.array([4, 2, 3]), np.tile(square, (3, 1))[:9])
    assert faces.tolist() == [[0, 1, 2], [0, 2, 3], [6, 7, 8]]


def test_polygons_beyond_the_budget_become_fans_and_are_reported(write: Write) -> None:
    points = star(40_000, 1)
    budget = MeshBudget(Path("a.obj"))
    faces = triangulate(np.array([40_000]), points, budget)
    assert budget.cut_short and len(faces) == 39_998 and np.all(faces[:, 0] == 0)
    lines = "".join(f"v {x} {y} {z}\n" for x, y, z in points)
    corners = " ".join(str(number + 1) for number in range(len(points)))
    mesh = read_mesh(write("a.obj", f"{lines}f {corners}\n"))
    assert [problem.code for problem in mesh.problems] == ["mesh-polygons-tangled"]


def test_an_outline_that_crosses_itself_a_thousand_times_is_cut(write: Write) -> None:
    points = np.random.default_rng(3).random((1000, 2))
    lines = "".join(f"v {x} {y} 0\n" for x, y in points)
    corners = " ".join(str(number + 1) for number in range(len(points)))
    mesh = read_mesh(write("a.obj", f"{lines}f {corners}\n"))
    assert mesh.triangles > 300 and not mesh.problems
