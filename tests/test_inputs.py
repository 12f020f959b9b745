"""The files that options name: opened once, refused early, loaded in the background."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from sambot_viz import (
    ConfigError,
    Robot,
    RobotError,
    UsageError,
    load_config,
    load_robot,
)
from sambot_viz.inputs import Inputs
from sambot_viz.options import Options
from sambot_viz.visualizer import Visualizer

ARM = """<robot name="arm"><link name="a"/><link name="b"/>
<joint name="j" type="continuous"><parent link="a"/><child link="b"/></joint></robot>
"""


@pytest.fixture
def arm(tmp_path: Path) -> Path:
    model = tmp_path / "arm.urdf"
    model.write_text(ARM)
    return model


def test_an_ill_formed_model_is_refused_before_anything_is_loaded(
    tmp_path: Path,
) -> None:
    model = tmp_path / "r.urdf"
    model.write_text('<robot name="r">\n<link name="a">\n</robot>\n')
    with pytest.raises(RobotError) as refused:
        Inputs(Options(model))
    assert refused.value.problems[0].line in (2, 3)


def test_a_model_that_urdf_refuses_is_refused_when_the_robot_is_wanted(
    tmp_path: Path,
) -> None:
    model = tmp_path / "r.urdf"
    model.write_text('<robot name="r"><link name="a"/><link name="b"/></robot>')
    inputs = Inputs(Options(model))
    with pytest.raises(RobotError):
        inputs.robot()


def test_a_config_that_is_not_a_rviz_document_is_refused_at_once(
    tmp_path: Path,
) -> None:
    config = tmp_path / "c.rviz"
    config.write_text("a: [1")
    with pytest.raises(ConfigError):
        Inputs(Options(config=config))


def test_each_file_is_read_once(arm: Path, repository: Path, tmp_path: Path) -> None:
    config = tmp_path / "c.rviz"
    config.write_text((repository / "rviz" / "urdf_config.rviz").read_text())
    inputs = Inputs(Options(arm, config))
    # What was opened is enough: the files may be gone when their content is used.
    config.unlink()
    arm.unlink()
    assert inputs.robot().name == "arm"
    assert inputs.document().file == str(config)


def test_giving_up_ends_the_wait_with_a_keyboard_interrupt(arm: Path) -> None:
    inputs = Inputs(Options(load_robot(arm)))
    assert isinstance(inputs.robot(), Robot)
    waiting = Inputs(Options(arm))
    waiting.give_up()
    # Either the robot was there already, or the wait has ended.
    try:
        assert waiting.robot().name == "arm"
    except KeyboardInterrupt:
        pass


def test_named_poses_are_kept_beside_the_model(arm: Path) -> None:
    # The command line opens the files first and gives them to the visualizer.
    with Visualizer.of_inputs(Inputs(Options(arm))) as viz:
        viz.server.sessions.all()[0].poses.save("half", {"j": 0.5})
    assert "half" in (arm.parent / "arm.poses.yaml").read_text()
    with Visualizer(arm) as again:
        assert again.server.sessions.all()[0].poses.names == ("half",)


def test_poses_of_the_bundled_robot_are_kept_in_the_working_folder(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    assert Inputs(Options()).poses == tmp_path / "sam_bot.poses.yaml"


def test_a_robot_from_python_keeps_its_poses_in_memory(arm: Path) -> None:
    assert Inputs(Options(load_robot(arm))).poses is None
    named = arm.parent / "mine.yaml"
    assert Inputs(Options(load_robot(arm), poses=named)).poses == named


@pytest.mark.parametrize(
    ("wrong", "said"),
    [
        ({"fixed_frame": ""}, "the fixed frame has an empty name"),
        ({"session": "privat"}, "session='privat': it must be 'shared' or 'private'"),
    ],
)
def test_an_option_that_makes_no_sense_is_refused(
    wrong: dict[str, str], said: str
) -> None:
    with pytest.raises(UsageError, match=said):
        Options(**wrong)  # type: ignore[arg-type]


@pytest.mark.parametrize("name", ["sam_bot.urdf.xacro", "mbot.urdf.xacro"])
def test_a_yourdfpy_model_is_shown_like_the_robot_it_came_from(
    name: str, repository: Path
) -> None:
    robot = load_robot(repository / "assets" / name)
    inputs = Inputs(Options(robot.to_yourdfpy()))
    assert inputs.model is None
    assert list(inputs.robot().links) == list(robot.links)
    with Visualizer(model=robot.to_yourdfpy()) as viz:
        assert set(viz.joint_positions) == {
            name for name, joint in robot.joints.items() if joint.type != "fixed"
        }


def test_a_configuration_of_yourdfpy_is_the_start_pose(sam_bot: Robot) -> None:
    model = sam_bot.to_yourdfpy()
    model.update_cfg({"drivewhl_l_joint": 0.5, "drivewhl_r_joint": 0.25})
    with Visualizer(model, port=0, joint_positions={"drivewhl_r_joint": 1.0}) as viz:
        assert dict(viz.joint_positions) == {
            "drivewhl_l_joint": 0.5,
            "drivewhl_r_joint": 1.0,
        }


def test_an_object_that_is_not_a_model_is_refused_with_what_can_be_given() -> None:
    wrong: Any = 5
    with pytest.raises(UsageError) as refused:
        Inputs(Options(wrong))
    assert str(refused.value) == (
        "model is of type int; give a file name, a Robot or a yourdfpy.URDF"
    )


def test_the_look_is_rvizs_with_a_config_and_studio_without(
    arm: Path, repository: Path, tmp_path: Path
) -> None:
    config = repository / "rviz" / "urdf_config.rviz"
    assert Inputs(Options()).options.look == "studio"
    assert Inputs(Options(arm)).options.look == "studio"
    assert Inputs(Options(arm, config)).options.look == "rviz"
    assert Inputs(Options(arm, load_config(config))).options.look == "rviz"
    # That of a package is found without being named.
    package = tmp_path / "package"
    (package / "rviz").mkdir(parents=True)
    (package / "urdf").mkdir()
    (package / "package.xml").write_text("<package><name>package</name></package>")
    (package / "urdf" / "arm.urdf").write_text(ARM)
    (package / "rviz" / "arm.rviz").write_text(config.read_text("utf-8"))
    found = Inputs(Options(package))
    assert found.config is not None and found.options.look == "rviz"
    assert Inputs(Options(arm, look="studio")).options.look == "studio"
    assert Inputs(Options(look="rviz")).options.look == "rviz"


def test_the_config_that_ships_with_the_bundled_robot_is_no_config_of_the_users(
    repository: Path,
) -> None:
    assert Inputs(Options()).config is None
    with pytest.raises(UsageError, match="must be 'rviz' or 'studio'"):
        Options(look="nice")  # type: ignore[arg-type]


def test_a_folder_of_recordings_names_some_of_them(tmp_path: Path) -> None:
    for name in ("c", "a", "b"):
        (tmp_path / name).mkdir()
        (tmp_path / name / "run.mcap").write_bytes(b"")
    (tmp_path / "empty").mkdir()
    with pytest.raises(UsageError, match="its folders 'a' and 'b', and 1 more"):
        Inputs(Options(tmp_path))
