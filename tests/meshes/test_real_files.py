"""Every mesh of the collection, compared with trimesh, and the golden ones."""

from __future__ import annotations

import re
import time
import warnings
from pathlib import Path

import numpy as np
import pytest
from patience import patience

from sambot_viz.meshes.mesh import Mesh, MeshError
from sambot_viz.meshes.read_mesh import read_mesh

ENDINGS = {".stl", ".dae", ".obj", ".glb", ".gltf", ".ply"}


def mesh_files(shared: Path) -> list[Path]:
    folders = [shared / "data" / "robots", shared / "data" / "golden"]
    found = [path for folder in folders for path in folder.rglob("*")]
    return sorted(path for path in found if path.suffix.lower() in ENDINGS)


def unit_of(path: Path) -> float:
    if path.suffix.lower() != ".dae":
        return 1.0
    found = re.search(rb'<unit[^>]*\bmeter="([^"]*)"', path.read_bytes())
    return float(found[1]) if found else 1.0


def test_every_real_mesh_is_read_quickly(shared: Path) -> None:
    refused: list[str] = []
    start = time.process_time()
    for path in mesh_files(shared):
        try:
            assert read_mesh(path).triangles > 0
        except MeshError as error:
            refused.append(str(error))
    assert refused == []
    assert time.process_time() - start < patience(20.0)


def test_real_meshes_agree_with_trimesh(shared: Path) -> None:
    import trimesh

    different: list[str] = []
    for path in mesh_files(shared):
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            try:
                scene = trimesh.load_scene(path)
            except Exception:  # Broken COLLADA, which only ours recovers.
                continue
        mesh = read_mesh(path)
        nodes = scene.graph.nodes_geometry
        triangles = sum(len(scene.geometry[scene.graph[n][1]].faces) for n in nodes)
        bounds = scene.bounds * unit_of(path)
        if triangles != mesh.triangles or not np.allclose(
            bounds, mesh.bounds, rtol=1e-4, atol=1e-5
        ):
            different.append(path.name)
    assert different == []


def test_meshes_that_the_stock_tools_lose_are_recovered(shared: Path) -> None:
    robots = shared / "data" / "robots"
    (velodyne,) = robots.rglob("HDL32E_base.dae")
    mesh = read_mesh(velodyne)
    assert [problem.code for problem in mesh.problems] == ["mesh-recovered"]
    assert mesh.triangles > 1000


def colours(mesh: Mesh) -> list[tuple[float, ...]]:
    return sorted(
        tuple(round(255 * value) for value in part.rgba or ()) for part in mesh.parts
    )


def test_the_pr2_base_has_the_size_rviz_tests_for(shared: Path) -> None:
    """RViz draws the file with its own unit."""
    found = list((shared / "data" / "robots").rglob("pr2-base.dae"))
    if not found:
        pytest.skip("the collection has no pr2-base.dae")
    mesh = read_mesh(found[0])
    low, high = (-0.342375, -0.340043, -0.00656401), (0.340425, 0.340043, 0.662748)
    # OGRE widens the bounds by one percent of the size on every side.
    margin = 0.01 * np.ptp(mesh.bounds, axis=0)
    assert np.allclose(
        mesh.bounds + np.array([-margin, margin]), [low, high], atol=1e-6
    )
    assert 3 * mesh.triangles == 3600
    assert mesh.parts[0].texture is not None


def test_the_golden_bracket_has_the_same_shape_and_colours_in_every_format(
    shared: Path,
) -> None:
    folder = shared / "data" / "golden" / "golden_meshes" / "meshes"
    meshes = {
        name: read_mesh(folder / name)
        for name in (
            "bracket.stl",
            "bracket_ascii.stl",
            "bracket_colour.dae",
            "bracket_colour.obj",
        )
    }
    for mesh in meshes.values():
        assert mesh.triangles == 120
        assert np.allclose(mesh.bounds, meshes["bracket.stl"].bounds, atol=1e-6)
    expected = [(26, 153, 51, 255), (38, 64, 204, 255), (204, 26, 26, 255)]
    assert colours(meshes["bracket_colour.dae"]) == expected
    assert colours(meshes["bracket_colour.obj"]) == expected


def test_y_up_and_z_up_give_the_same_picture(shared: Path) -> None:
    folder = shared / "data" / "golden" / "golden_meshes" / "meshes"
    one, other = read_mesh(folder / "yup_cm.dae"), read_mesh(folder / "zup_cm.dae")
    assert np.allclose(one.bounds, other.bounds)
    assert np.allclose(one.bounds[1], [0.20196, 0.34121, 0.11196], atol=1e-4)
    assert colours(one) == [
        (51, 204, 230, 255),
        (128, 51, 204, 255),
        (255, 128, 0, 255),
    ]
