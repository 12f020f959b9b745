"""``sambot-viz echo`` beside tf2_echo."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from sambot_viz.cli import main

Capture = pytest.CaptureFixture[str]

LASER = "0.1 0 0.2 0 0 0 base_link base_laser"
FIRST_PAGE = """\
At time 0.0
- Translation: [0.100, 0.000, 0.200]
- Rotation: in Quaternion [0.000, 0.000, 0.000, 1.000]
- Rotation: in RPY (radian) [0.000, -0.000, 0.000]
- Rotation: in RPY (degree) [0.000, -0.000, 0.000]
- Matrix:
  1.000  0.000  0.000  0.100
  0.000  1.000  0.000  0.000
  0.000  0.000  1.000  0.200
  0.000  0.000  0.000  1.000
"""


@pytest.mark.parametrize(
    "transform",
    [
        LASER,
        "0.1 0 0.2 0 0 0 1 base_link base_laser",
        "--x 0.1 --z 0.2 --frame-id base_link --child-frame-id base_laser",
    ],
)
def test_the_laser_of_the_tutorials_first_page_prints_as_tf2_echo_prints_it(
    capsys: Capture, transform: str
) -> None:
    words = ["echo", "base_link", "base_laser", "--static-transform", transform]
    assert main(words) == 0
    assert capsys.readouterr().out == FIRST_PAGE


def test_source_and_target_are_in_the_order_of_tf2_echo(capsys: Capture) -> None:
    assert main(["echo", "base_laser", "base_link", "--static-transform", LASER]) == 0
    assert "Translation: [-0.100, 0.000, -0.200]" in capsys.readouterr().out


def test_options_may_be_between_the_frames_and_turn_the_wheel(
    repository: Path, capsys: Capture
) -> None:
    model = str(repository / "assets" / "sam_bot.urdf.xacro")
    turn = ["--joint", "drivewhl_l_joint=0.5"]
    words = ["echo", model, "base_link", *turn, "drivewhl_l_link", "--format", "json"]
    assert main(words) == 0
    found = json.loads(capsys.readouterr().out)
    assert found["rpy"] == pytest.approx([0.0, 0.5, 0.0])
    assert set(found) == {"translation", "rotation_xyzw", "rpy", "matrix"}


def test_a_recorded_joint_state_is_used_and_unknown_joints_are_ignored(
    tmp_path: Path, capsys: Capture
) -> None:
    file = tmp_path / "state.yaml"
    file.write_text("name: [drivewhl_l_joint, other]\nposition: [0.25, 1.0]\n---\n")
    words = ["echo", "base_link", "drivewhl_l_link", "--joint-state", str(file)]
    assert main([*words, "--format", "json"]) == 0
    out, err = capsys.readouterr()
    assert json.loads(out)["rpy"][1] == pytest.approx(0.25)
    assert "the robot has no joint 'other'; ignored" in err


@pytest.mark.parametrize(
    ("frames", "wrong", "argument", "near"),
    [
        (["base_lnk", "front_caster"], "base_lnk", "target_frame", "base_link"),
        (["base_link", "front_castr"], "front_castr", "source_frame", "front_caster"),
    ],
)
def test_an_unknown_frame_ends_with_1_tf2s_text_and_the_nearest_name(
    capsys: Capture, frames: list[str], wrong: str, argument: str, near: str
) -> None:
    assert main(["echo", *frames]) == 1
    out, err = capsys.readouterr()
    assert out == ""
    said = f'Invalid frame ID "{wrong}" passed to canTransform argument {argument}'
    assert said in err
    assert f"did you mean '{near}'?" in err


def test_frames_of_separate_trees_end_with_1_and_what_is_missing(
    capsys: Capture,
) -> None:
    added = ["--static-transform", "0 0 0 0 0 0 map odom"]
    assert main(["echo", "map", "base_link", *added]) == 1
    err = capsys.readouterr().err
    assert "not part of the same tree.Tf has two or more unconnected trees." in err
    assert "no transform joins the two" in err


def test_a_floating_joint_is_given_as_the_reason(
    tmp_path: Path, capsys: Capture
) -> None:
    model = tmp_path / "floating.urdf"
    model.write_text(
        '<robot name="r"><link name="a"/><link name="b"/>'
        '<joint name="j" type="floating"><parent link="a"/><child link="b"/></joint>'
        "</robot>"
    )
    assert main(["echo", str(model), "a", "b"]) == 1
    err = capsys.readouterr().err
    assert "held by the floating joint 'j', and ROS publishes no transform" in err


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--static-transform", "0.1"], "all values belong in one quote"),
        (["--static-transform", "1 2 3"], "Extra unparsed arguments on command-line"),
        (["--joint", "drivewhl_l_joint"], "expected NAME=VALUE"),
    ],
)
def test_an_option_that_makes_no_sense_ends_with_2(
    capsys: Capture, words: list[str], said: str
) -> None:
    assert main(["echo", "base_link", "base_link", *words]) == 2
    assert said in capsys.readouterr().err


def test_a_ring_of_frames_is_refused_with_a_reason(capsys: Capture) -> None:
    added = ["--static-transform", "0 0 0 0 0 0 front_caster base_link"]
    assert main(["echo", "base_link", "front_caster", *added]) == 1
    assert "would form a ring" in capsys.readouterr().err


def test_a_mimic_joint_that_disagrees_is_a_warning(
    tmp_path: Path, capsys: Capture
) -> None:
    model = tmp_path / "r.urdf"
    model.write_text(
        '<robot name="r"><link name="a"/><link name="b"/><link name="c"/>'
        '<joint name="lead" type="continuous"><parent link="a"/><child link="b"/>'
        '</joint><joint name="tail" type="continuous"><parent link="b"/>'
        '<child link="c"/><mimic joint="lead"/></joint></robot>'
    )
    words = ["echo", str(model), "a", "c", "--joint", "lead=0.5"]
    assert main([*words, "--joint", "tail=0.5"]) == 0
    assert capsys.readouterr().err == ""
    assert main([*words, "--joint", "tail=0.1"]) == 0
    assert "joint 'tail' was given 0.1, but it mimics 'lead'" in capsys.readouterr().err


def test_the_model_may_come_last(repository: Path, capsys: Capture) -> None:
    model = str(repository / "assets" / "sam_bot.urdf.xacro")
    words = ["base_link", "drivewhl_l_link"]
    for ordered in ([model, *words], [*words, model]):
        assert main(["echo", *ordered]) == 0
    first, second = capsys.readouterr().out.split("At time")[1:]
    assert first == second


def test_a_time_outside_of_a_recording_is_said(
    repository: Path, capsys: Capture
) -> None:
    square = str(repository / "assets" / "square.mcap")
    for at, said in (("99", "its end is shown"), ("-1", "its beginning is shown")):
        main(["echo", square, "odom", "base_link", "--at", at])
        err = capsys.readouterr().err
        assert "at-outside" in err and said in err
    main(["echo", square, "odom", "base_link", "--at", "19"])
    assert capsys.readouterr().err == ""


def test_a_recording_that_does_not_exist_is_no_model(capsys: Capture) -> None:
    for name in ("nowhere.mcap", "nowhere.db3", "nowhere.bag"):
        assert main(["echo", name, "a", "b"]) == 2
        assert f"no recording '{name}'" in capsys.readouterr().err
