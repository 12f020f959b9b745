"""The words that the editor offers."""

from __future__ import annotations

from pathlib import Path

from sambot_viz import bundled, load_robot
from sambot_viz.session.editor.keys import offered_keys
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
    assert words["gz_frame_id"].texts == ("hull",)


def test_frames_of_sensors_and_drives_are_links() -> None:
    words = words_of(bundled.model_path())
    assert "base_link" in words["frameName"].texts
    assert "base_link" in words["robotBaseFrame"].texts


def test_parameter_files_get_the_parameters_of_their_nodes() -> None:
    robot = load_robot(bundled.model_path())
    keys = offered_keys(robot, "/**/ekf_filter_node:\n  ros__parameters:\n    x: 1\n")
    assert {*keys} == {"", "ekf_filter_node"} and "amcl" in keys[""]
    ekf = keys["ekf_filter_node"]
    assert "base_link" in ekf["base_link_frame"] and "odom" in ekf["world_frame"]
    assert ekf["two_d_mode"] == ("true", "false") and "odom0_config" in ekf
    costmap = "local_costmap:\n  local_costmap:\n    ros__parameters:\n"
    plugins = offered_keys(robot, costmap)["local_costmap"]["plugin"]
    assert "nav2_costmap_2d::InflationLayer" in plugins
    bridge = offered_keys(robot, "- ros_topic_name: scan\n")["-"]
    assert "sensor_msgs/msg/LaserScan" in bridge["ros_type_name"]
    assert "gz.msgs.LaserScan" in bridge["gz_type_name"]
