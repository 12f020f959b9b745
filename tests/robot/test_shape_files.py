"""Which files a robot is drawn from, and whether they are read."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from sambot_viz import load_robot
from sambot_viz.meshes import cache as store_module
from sambot_viz.meshes.cache import MeshStore
from sambot_viz.meshes.mesh import MeshError
from sambot_viz.meshes.textures import TextureError
from sambot_viz.robot.shape_files import Asset, assets_of, something_missing

STL = (
    "solid s\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\n"
    "vertex 0 1 0\nendloop\nendfacet\nendsolid s\n"
)
ROBOT = """
<robot name="r">
  <link name="a">
    <visual><geometry><mesh filename="part.stl"/></geometry></visual>
    <visual>
      <geometry><box size="1 1 1"/></geometry>
      <material name="wood"><texture filename="wood.png"/></material>
    </visual>
    <collision><geometry><sphere radius="1"/></geometry></collision>
  </link>
</robot>
"""


@pytest.fixture
def model(tmp_path: Path) -> Path:
    (tmp_path / "part.stl").write_text(STL)
    (tmp_path / "wood.png").write_bytes(b"no image")
    path = tmp_path / "robot.urdf"
    path.write_text(ROBOT)
    return path


def test_a_robot_names_its_meshes_and_textures(model: Path) -> None:
    robot = load_robot(model)
    folder = model.parent
    assert list(dict.fromkeys(assets_of(robot))) == [
        Asset("mesh", folder / "part.stl"),
        Asset("texture", folder / "wood.png"),
    ]
    assert not something_missing(robot)


@pytest.mark.parametrize("name", ["part.stl", "wood.png"])
def test_a_robot_knows_when_a_mesh_or_a_texture_is_missing(
    model: Path, name: str
) -> None:
    (model.parent / name).unlink()
    assert something_missing(load_robot(model))


def test_a_file_is_read_until_it_is_saved_again(model: Path) -> None:
    store, asset = MeshStore(), Asset("mesh", model.parent / "part.stl")
    assert not store.is_read(asset)
    store.read(asset)
    assert store.is_read(asset)
    asset.path.write_text(STL.replace("1 0 0", "2 0 0"))
    os.utime(asset.path, (1, 1))
    assert not store.is_read(asset)


def test_a_refusal_counts_as_read_and_is_given_again(model: Path) -> None:
    store, folder = MeshStore(), model.parent
    image, mesh = Asset("texture", folder / "wood.png"), Asset("mesh", folder / "x.stl")
    for asset in (image, mesh):
        store.read(asset)
        assert store.is_read(asset)
    with pytest.raises(TextureError, match="not an image"):
        store.texture(image.path)
    with pytest.raises(MeshError):
        store.get(mesh.path)


def test_a_texture_that_was_missing_is_read_when_it_appears(model: Path) -> None:
    store, asset = MeshStore(), Asset("texture", model.parent / "later.png")
    store.read(asset)
    assert store.is_read(asset)
    asset.path.write_bytes(b"something")
    assert not store.is_read(asset)


def test_a_mesh_names_the_files_it_was_read_from(tmp_path: Path) -> None:
    mesh = tmp_path / "part.obj"
    mesh.write_text("mtllib part.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl red\nf 1 2 3\n")
    (tmp_path / "part.mtl").write_text("newmtl red\nKd 1 0 0\n")
    store, asset = MeshStore(), Asset("mesh", mesh)
    assert store.files(asset) == (mesh,)
    store.read(asset)
    assert set(store.files(asset)) == {mesh, tmp_path / "part.mtl"}


def test_a_fault_of_ours_is_a_refusal_of_that_file_only(
    model: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def fail(path: Path, **options: object) -> None:
        raise ZeroDivisionError("it happens")

    monkeypatch.setattr(store_module, "read_mesh", fail)
    store, asset = MeshStore(), Asset("mesh", model.parent / "part.stl")
    store.read(asset)
    with pytest.raises(MeshError, match="fault of ours: ZeroDivisionError"):
        store.get(asset.path)
