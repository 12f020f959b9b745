"""Which files a robot is drawn from."""

from __future__ import annotations

from pathlib import Path

import pytest

from sambot_viz import load_robot
from sambot_viz.meshes.asset import Asset
from sambot_viz.robot.model import assets_of, something_missing

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


def test_the_files_of_an_untrusted_model_have_their_allowed_folders(
    model: Path,
) -> None:
    robot = load_robot(model, trusted=False)
    roots = {asset.roots for asset in assets_of(robot)}
    assert roots == {(model.parent.resolve(),)}
