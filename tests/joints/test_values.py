"""Joint values as text: arguments, files, commands, named poses."""

from __future__ import annotations

import math
import shlex
from pathlib import Path

import pytest
import yaml

from sambot_viz.errors import JointError, UsageError
from sambot_viz.joints.presets import Presets
from sambot_viz.joints.value_texts import (
    as_arguments,
    as_launch_parameters,
    as_topic_pub,
    as_yaml,
    load_joint_state,
    parse_assignments,
)

POSITIONS = {"wheel": 1 / 3, "a: b": -1e-7, "it's": 0.0, "yes": 1e22, "바퀴": 2.0}


def test_assignments_are_read_as_given() -> None:
    texts = ["wheel=1.5", " lift = -2e-3", "odd=name=1", "wheel=2"]
    assert parse_assignments(texts, "--joint") == {
        "wheel": 2.0,
        "lift": -0.002,
        "odd=name": 1.0,
    }


def test_an_assignment_has_the_units_that_the_page_takes() -> None:
    texts = ["a=90deg", "b= -45 °", "c=15mm", "d=1.5 rad", "e=.2m"]
    values = parse_assignments(texts, "--joint")
    assert list(values.values()) == [math.pi / 2, -math.pi / 4, 0.015, 1.5, 0.2]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (
            "wheel",
            "--zeros wheel: expected NAME=VALUE, such as --zeros drivewhl_l_joint=1.57",
        ),
        (
            "=1",
            "--zeros =1: expected NAME=VALUE, such as --zeros drivewhl_l_joint=1.57",
        ),
        (
            "wheel=90grad",
            "--zeros wheel=90grad: '90grad' is not a finite number of radians or "
            "metres, nor one with its unit, such as 90deg or 15mm",
        ),
        (
            "wheel=nan",
            "--zeros wheel=nan: 'nan' is not a finite number of radians or metres, "
            "nor one with its unit, such as 90deg or 15mm",
        ),
    ],
)
def test_an_assignment_that_makes_no_sense_says_what_is_expected(
    text: str, message: str
) -> None:
    with pytest.raises(UsageError) as caught:
        parse_assignments([text], "--zeros")
    assert str(caught.value) == message


def test_yaml_comes_back_exactly_whatever_the_names(tmp_path: Path) -> None:
    file = tmp_path / "state.yaml"
    file.write_text(as_yaml(POSITIONS), encoding="utf-8")
    assert load_joint_state(file) == POSITIONS
    assert yaml.safe_load(as_yaml({})) == {"name": [], "position": []}


def test_the_topic_command_is_one_shell_line_with_yaml_in_it() -> None:
    words = shlex.split(as_topic_pub(POSITIONS))
    assert words[:6] == [
        "ros2",
        "topic",
        "pub",
        "--once",
        "/joint_states",
        "sensor_msgs/msg/JointState",
    ]
    message = yaml.safe_load(words[6])
    assert message == {
        "header": "auto",
        "name": list(POSITIONS),
        "position": list(POSITIONS.values()),
    }
    assert as_topic_pub({"j": 1.0}) == (
        "ros2 topic pub --once /joint_states sensor_msgs/msg/JointState "
        "'{header: auto, name: [j], position: [1.0]}'"
    )


def test_a_message_as_ros2_topic_echo_prints_it_can_be_read(tmp_path: Path) -> None:
    file = tmp_path / "echo.yaml"
    file.write_text(
        "header:\n  stamp:\n    sec: 1\n    nanosec: 2\n  frame_id: ''\n"
        "name:\n- j\n- k\nposition:\n- 0.5\n- 1\nvelocity: []\neffort: []\n---\n"
        "name: [j]\nposition: [9]\n"
    )
    assert load_joint_state(file) == {"j": 0.5, "k": 1.0}


def test_a_plain_mapping_can_be_read_also_with_a_joint_called_name(
    tmp_path: Path,
) -> None:
    file = tmp_path / "plain.yaml"
    file.write_text("j: 0.5\nname: 1\n")
    assert load_joint_state(file) == {"j": 0.5, "name": 1.0}


def test_of_a_name_that_stands_twice_the_first_counts(tmp_path: Path) -> None:
    file = tmp_path / "twice.yaml"
    file.write_text("name: [j, j]\nposition: [1, 2]\n")
    assert load_joint_state(file) == {"j": 1.0}


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (
            "name: [a, b]\nposition: [1]\n",
            "{} names 2 joints and gives 1 positions; there must be one position for "
            "each name",
        ),
        (
            "name: [a]\n",
            "{} names 1 joints and gives 0 positions; there must be one position for "
            "each name",
        ),
        ("j: fast\n", "{}: joint 'j' has 'fast', which is not a finite number"),
        ("j: .nan\n", "{}: joint 'j' has nan, which is not a finite number"),
        ("j: true\n", "{}: joint 'j' has True, which is not a finite number"),
        (
            "- 1\n",
            "{} is not a joint state: expected the lists 'name' and 'position', or one "
            "'joint: value' per line",
        ),
    ],
)
def test_a_file_that_is_no_joint_state_says_why(
    tmp_path: Path, text: str, message: str
) -> None:
    file = tmp_path / "bad.yaml"
    file.write_text(text)
    with pytest.raises(JointError) as caught:
        load_joint_state(file)
    assert str(caught.value) == message.format(file)


def test_a_file_that_cannot_be_read_says_why(tmp_path: Path) -> None:
    with pytest.raises(JointError, match=r"^cannot read .*: no such file or directory"):
        load_joint_state(tmp_path / "none.yaml")
    (tmp_path / "latin.yaml").write_bytes(b"j: \xff\n")
    with pytest.raises(JointError, match=r"it is not UTF-8 text$"):
        load_joint_state(tmp_path / "latin.yaml")
    (tmp_path / "broken.yaml").write_text("j: [1\n")
    with pytest.raises(JointError, match=r"is not yaml: while parsing .* line 2"):
        load_joint_state(tmp_path / "broken.yaml")


def test_a_device_and_a_huge_file_are_not_read(tmp_path: Path) -> None:
    with (tmp_path / "huge.yaml").open("wb") as file:
        file.truncate(2**34)
    for path in (Path("/dev/zero"), tmp_path / "huge.yaml"):
        with pytest.raises(JointError, match="cannot read"):
            load_joint_state(path)
        with pytest.raises(JointError, match="cannot read"):
            Presets(path)


def test_poses_are_saved_and_found_again(tmp_path: Path) -> None:
    file = tmp_path / "poses.yaml"
    presets = Presets(file)
    presets.save("tucked in", {"j": 1 / 3, "바퀴": 2.0})
    presets.save("up", {"j": 0.0})
    presets.save("up", {"j": 1.0})
    again = Presets(file)
    assert again.names == ("tucked in", "up")
    assert again.get("tucked in") == {"j": 1 / 3, "바퀴": 2.0}
    assert again.get("up") == {"j": 1.0}
    again.remove("up")
    assert Presets(file).names == ("tucked in",)
    assert [path.name for path in tmp_path.iterdir()] == ["poses.yaml"]


def test_a_pose_is_a_copy() -> None:
    presets = Presets()
    positions = {"j": 1.0}
    presets.save("up", positions)
    positions["j"] = 2.0
    presets.get("up")["j"] = 3.0
    assert presets.get("up") == {"j": 1.0}


def test_a_pose_that_does_not_exist_offers_those_that_do() -> None:
    presets = Presets()
    presets.save("tucked", {"j": 1.0})
    for ask in (presets.get, presets.remove):
        with pytest.raises(JointError) as caught:
            ask("tuckd")
        assert str(caught.value) == "no pose 'tuckd'; did you mean 'tucked'?"


def test_a_pose_that_makes_no_sense_changes_nothing(tmp_path: Path) -> None:
    file = tmp_path / "poses.yaml"
    presets = Presets(file)
    with pytest.raises(JointError, match=r"^joint 'j' has nan: not a finite number$"):
        presets.save("up", {"j": math.nan})
    with pytest.raises(JointError, match=r"^a pose needs a name$"):
        presets.save("  ", {"j": 1.0})
    assert presets.names == ()
    assert not file.exists()


def test_a_file_that_cannot_be_written_leaves_the_poses_as_they_were(
    tmp_path: Path,
) -> None:
    presets = Presets(tmp_path / "no such folder" / "poses.yaml")
    with pytest.raises(JointError, match=r"^cannot save the poses in "):
        presets.save("up", {"j": 1.0})
    assert presets.names == ()
    folder = tmp_path / "poses.yaml"
    presets = Presets(folder)
    folder.mkdir()
    with pytest.raises(JointError, match=r"^cannot save the poses in "):
        presets.save("up", {"j": 1.0})
    assert [path.name for path in tmp_path.iterdir()] == ["poses.yaml"]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("- up\n", "{} has no poses: expected 'pose: {{joint: value}}'"),
        ("up: 1\n", "{}: pose 'up' is not a list of 'joint: value'"),
        (
            "up: {j: x}\n",
            "{}: pose 'up' has 'x' for joint 'j', which is not a finite number",
        ),
    ],
)
def test_a_file_of_something_else_is_refused(
    tmp_path: Path, text: str, message: str
) -> None:
    file = tmp_path / "poses.yaml"
    file.write_text(text)
    with pytest.raises(JointError) as caught:
        Presets(file)
    assert str(caught.value) == message.format(file)


def test_an_empty_file_holds_no_poses(tmp_path: Path) -> None:
    file = tmp_path / "poses.yaml"
    file.write_text("")
    assert Presets(file).names == ()


def test_arguments_give_back_what_they_were_made_of() -> None:
    words = shlex.split(as_arguments(POSITIONS))
    assert words[::2] == ["--joint"] * len(POSITIONS)
    assert parse_assignments(words[1::2], "--joint") == POSITIONS


def test_launch_parameters_are_the_start_values_of_joint_state_publisher() -> None:
    text = as_launch_parameters(POSITIONS)
    written = eval(text.strip().removeprefix("parameters=").removesuffix(","))
    assert written == [{f"zeros.{name}": value for name, value in POSITIONS.items()}]
