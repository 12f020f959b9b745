"""A robot whose frames carry a prefix: RobotModel says which, and takes it."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from inside import session_of
from made_recording import described, write_recording

from sambot_viz import Visualizer
from sambot_viz.cli import main
from sambot_viz.displays.robot_display import Repair
from sambot_viz.displays.robot_model.robot_model import RobotModelDisplay
from sambot_viz.frames.frame_prefix import frame_prefix, other_prefix

FRAMES = {"robot1/base_link": "robot1/odom", "robot1/arm": "robot1/base_link"}
TOLD = [("/tf", number / 10, FRAMES) for number in range(30)]


@pytest.fixture
def recording(tmp_path: Path) -> Path:
    texts = {"/robot_description": described("base_link", "arm")}
    return write_recording(tmp_path / "prefix.mcap", texts, TOLD)


@pytest.fixture
def viz(recording: Path) -> Iterator[Visualizer]:
    with Visualizer(recording, port=0) as viz:
        yield viz


def model(viz: Visualizer) -> RobotModelDisplay:
    displays = session_of(viz).scene.displays
    return next(d for d in displays if isinstance(d, RobotModelDisplay))


def set_prefix(viz: Visualizer, prefix: str) -> None:
    session_of(viz).display_edits.set_property(model(viz), "TF Prefix", prefix)


@pytest.mark.parametrize("wrong", ["", "robot2"])
def test_the_status_names_the_prefix_and_its_button_sets_it(
    viz: Visualizer, wrong: str
) -> None:
    set_prefix(viz, wrong)
    frame = f"{wrong}/base_link".removeprefix("/")
    assert model(viz).status.rows["TF Prefix"].text == (
        "All frames of the robot carry the prefix robot1 "
        f"(robot1/base_link instead of {frame}): set TF Prefix to robot1"
    )
    repair = model(viz).repairs()["TF Prefix"]
    assert repair == Repair("Set TF Prefix to robot1", "TF Prefix", "robot1")
    set_prefix(viz, repair.value)
    assert model(viz).status.level == "Ok"
    assert set(model(viz).status.rows) > {"robot1/base_link", "robot1/arm"}
    assert not model(viz).repairs()


def test_no_frames_are_made_up_beside_those_with_the_prefix(viz: Visualizer) -> None:
    assert sorted(viz.frames.frames) == [
        "robot1/arm",
        "robot1/base_link",
        "robot1/odom",
    ]
    assert session_of(viz).scene.context.fixed_frame == "robot1/odom"
    assert (
        session_of(viz).document.config.view.get("Target Frame") == "robot1/base_link"
    )
    viz.player.jump(2.0)
    at = viz.frames.lookup("robot1/odom", "robot1/arm").translation
    assert at.tolist() == pytest.approx([4.0, 0.0, 0.0])


def test_sliders_move_the_frames_with_the_prefix(viz: Visualizer) -> None:
    data = session_of(viz).data
    assert data is not None
    viz.player.jump(2.0)
    data.follow(False)
    viz.set_joint_positions({"base_link_arm": np.pi / 2})
    turned = viz.frames.lookup("robot1/base_link", "robot1/arm").matrix
    assert turned[:2, :2] == pytest.approx(np.array([[0.0, -1.0], [1.0, 0.0]]))
    assert "arm" not in viz.frames.frames
    at = viz.frames.lookup("robot1/odom", "robot1/base_link").translation
    assert at.tolist() == pytest.approx([2.0, 0.0, 0.0])
    data.follow(True)
    at = viz.frames.lookup("robot1/base_link", "robot1/arm").translation
    assert at.tolist() == pytest.approx([2.0, 0.0, 0.0])


def test_commands_have_the_frames_of_the_messages_only(
    recording: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["frames", str(recording)]) == 0
    assert '"base_link"' not in capsys.readouterr().out


def test_a_prefix_is_one_that_puts_joints_between_their_frames() -> None:
    joints = [("base", "arm"), ("arm", "hand")]
    assert frame_prefix(joints, [("r/base", "r/arm")]) == "r/"
    assert frame_prefix(joints, [("a/b/base", "a/b/arm")]) == "a/b/"
    assert frame_prefix(joints, [("r/base", "q/arm"), ("odom", "r/base")]) == ""
    # One that is named as it is belongs to the robot; others are other robots.
    assert frame_prefix(joints, [("r/base", "r/arm"), ("arm", "hand")]) == ""


def test_the_prefix_of_the_topic_comes_before_those_of_other_robots() -> None:
    frames = ["a/base", "a/arm", "b/base", "b/arm", "odom"]
    links = ("base", "arm")
    assert other_prefix(links, links, frames, "b") == "b"
    assert other_prefix(links, links, frames) == "a"
    assert other_prefix(links, ["a/base", "a/arm"], frames, "b") is None
    assert other_prefix(links, ["c/base", "c/arm"], ["base", "arm"]) == ""
    assert other_prefix(links, links, ["odom"]) is None
