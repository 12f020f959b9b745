"""The words that the editor offers."""

from __future__ import annotations

from pathlib import Path

from sambot_viz import bundled, load_robot
from sambot_viz.session.editor.words import OfferedElement, offered


def words_of(path: Path) -> dict[str, OfferedElement]:
    robot = load_robot(path)
    return {each.name: each for each in offered(robot, map(str, robot.files))}


def test_elements_attributes_and_names_of_a_model_are_offered() -> None:
    words = words_of(bundled.model_path())
    assert words["robot"].is_root
    assert {"origin", "parent", "child", "axis", "limit"} <= {*words["joint"].children}
    assert "continuous" in words["joint"].attributes["type"]
    assert "base_link" in words["parent"].attributes["link"]
    assert {"filename", "scale"} == {*words["mesh"].attributes}


def test_macros_are_offered_with_their_parameters(tmp_path: Path) -> None:
    model = tmp_path / "r.urdf.xacro"
    model.write_text(
        '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">'
        '<xacro:macro name="wheel" params="side:=left x *origin"/>'
        '<link name="hull"/></robot>'
    )
    words = words_of(model)
    assert [*words["xacro:wheel"].attributes] == ["side", "x"]
    assert "xacro:wheel" in words["robot"].children


def test_an_sdf_model_gets_the_elements_of_sdf(tmp_path: Path) -> None:
    model = tmp_path / "r.sdf"
    model.write_text(
        '<sdf version="1.9"><model name="r"><link name="hull"/></model></sdf>'
    )
    words = words_of(model)
    assert {"link", "joint"} <= {*words["model"].children}
    assert words["child"].texts == ("hull",)
