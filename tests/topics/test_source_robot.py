"""A recording says where the robot is at every time of it."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml

from sambot_viz.errors import UsageError
from sambot_viz.frames import FrameHistory, FrameTree, LookupRefused
from sambot_viz.inputs import Inputs
from sambot_viz.options import Options
from sambot_viz.sources.subscriber import jump
from sambot_viz.topics.source_robot import SourceRobot

TOLERANCE = 1e-6
FRAMES = ("base_footprint", "lidar_link", "drivewhl_l_link", "drivewhl_r_link")


@pytest.fixture
def square(repository: Path) -> Path:
    return repository / "assets" / "square.mcap"


@pytest.fixture
def opened(square: Path) -> Iterator[SourceRobot]:
    with recorded_in(Options(square)) as recorded:
        yield recorded


@contextmanager
def recorded_in(options: Options) -> Iterator[SourceRobot]:
    with Inputs(options) as inputs:
        assert inputs.moved_by is not None
        yield inputs.moved_by


def frames_at(path: Path, *times_ns: int) -> Iterator[tuple[int, FrameTree]]:
    """Yield the frames as `sambot-viz frames --at` has them, of a recording read once.

    To open it takes most of the time. One of the times is that of the command line.
    """
    with recorded_in(Options(path)) as recorded:
        assert recorded.recording.start_ns is not None
        at = (times_ns[0] - recorded.recording.start_ns) * 1e-9
    with Inputs(Options(path, at=at)) as inputs:
        yield times_ns[0], frames_of(inputs)
        assert inputs.moved_by is not None
        for time_ns in times_ns[1:]:
            inputs.moved_by.at_ns = time_ns
            yield time_ns, frames_of(inputs)


def frames_of(inputs: Inputs) -> FrameTree:
    robot, recorded = inputs.robot(), inputs.moved_by
    assert recorded is not None
    return recorded.frames(robot, inputs.options.start_pose.state(robot))


def differences(tree: FrameTree, shown: dict[str, Any]) -> list[str]:
    """What of an entry of the index is otherwise; empty when nothing is."""
    found: list[str] = []
    for frame, expected in shown.items():
        try:
            transform = tree.lookup("odom", frame)
        except LookupRefused:
            if expected is not None:
                found.append(f"{frame} has no place")
            continue
        if expected is None:
            found.append(f"{frame} has a place")
            continue
        history = tree.history
        assert history is not None
        stamp, xyz, xyzw = expected
        if history.latest_common_time("odom", frame, tree) != stamp:
            found.append(f"{frame} is of another time")
        turned = abs(float(np.dot(transform.rotation_xyzw, xyzw)))
        far = float(np.abs(transform.translation - xyz).max())
        if far > TOLERANCE or turned < 1 - TOLERANCE:
            found.append(f"{frame} is elsewhere: {far} m, {turned}")
    return found


def recordings(shared: Path) -> dict[str, dict[str, Any]]:
    index = shared / "data" / "bags" / "made" / "index.yaml"
    listed = yaml.load(index.read_text("utf-8"), yaml.CSafeLoader)
    # Its frames follow from the model and the joint states, which tf2 does not have.
    listed.pop("joints_only.mcap")
    return {name: about for name, about in listed.items() if about.get("shown")}


def test_the_frames_at_all_given_times_are_those_of_tf2(shared: Path) -> None:
    made = shared / "data" / "bags" / "made"
    found = {
        (name, time): wrong
        for name, about in recordings(shared).items()
        for time, tree in frames_at(made / name, *about["shown"])
        if (wrong := differences(tree, about["shown"][time]))
    }
    assert not found


def test_joint_states_place_the_links_where_no_transform_does(shared: Path) -> None:
    path = shared / "data" / "bags" / "made" / "joints_only.mcap"
    with Inputs(Options(path, at=2.0)) as inputs:
        robot, recorded = inputs.robot(), inputs.moved_by
        assert recorded is not None
        states = recorded.joint_states()
        jump(recorded.recording, recorded.at_ns or 0, (states,))
        expected = robot.forward_kinematics(states.changed())
        tree = frames_of(inputs)
    assert abs(expected["drivewhl_l_link"][0, 2]) > 0.1
    for link in robot.links:
        here = tree.lookup(robot.root, link).matrix
        assert here == pytest.approx(expected[link], abs=1e-9)


def played(recorded: SourceRobot, at_ns: int) -> FrameHistory:
    """The frames after all messages up to a time."""
    history = FrameHistory()
    transforms = recorded.transforms(history)
    for message in recorded.recording.messages(None, at_ns, transforms.topics):
        transforms.take(message)
    return history


def jumped(recorded: SourceRobot, *times_ns: int) -> FrameHistory:
    history = FrameHistory()
    transforms = recorded.transforms(history)
    for time in times_ns:
        jump(recorded.recording, time, (transforms,))
    return history


def poses(history: FrameHistory) -> dict[str, Any]:
    return {frame: history.latest(frame) for frame in history.frames}


def without_order(history: FrameHistory) -> dict[str, Any]:
    return {
        frame: sample and (sample.stamp, sample.parent, sample.pose)
        for frame, sample in poses(history).items()
    }


def test_a_jump_gives_what_playing_up_to_it_gives(opened: SourceRobot) -> None:
    start, end = opened.recording.start_ns, opened.recording.end_ns
    assert start is not None and end is not None
    random = np.random.default_rng(1)
    for _ in range(20):
        first, second = (int(t) for t in random.integers(start, end, 2))
        # Whatever was shown before; static transforms of later stay.
        latest = without_order(jumped(opened, end, first, second))
        expected = without_order(played(opened, second))
        assert {f: latest[f] for f in expected} == expected


def test_a_frame_that_was_told_once_long_ago_is_there_after_a_jump(
    write_recording: Callable[..., Path],
) -> None:
    map_to_odom = {"map": "odom"}
    messages = [(0.0, map_to_odom), *((n / 10, {"odom": "base"}) for n in range(300))]
    with recorded_in(Options(write_recording(messages))) as recorded:
        assert recorded.recording.end_ns is not None
        history = jumped(recorded, recorded.recording.end_ns)
    assert history.latest("odom") is not None


def test_a_description_in_sdf_is_the_robot_of_a_recording(
    write_recording: Callable[..., Path],
) -> None:
    description = (
        '<sdf version="1.8"><model name="r"><link name="base"/><link name="arm"/>'
        '<joint name="j" type="fixed"><parent>base</parent><child>arm</child>'
        '<pose relative_to="base">0 0 1 0 0 0</pose></joint></model></sdf>'
    )
    path = write_recording([(0.0, {"odom": "base"})], description)
    with Inputs(Options(path)) as inputs:
        robot, tree = inputs.robot(), frames_of(inputs)
        assert inputs.problems() == ()
    assert (robot.root, robot.language) == ("base", "sdf")
    assert tree.lookup("odom", "arm").translation.tolist() == [0.0, 0.0, 1.0]


@pytest.mark.parametrize("name", ["magic_only.mcap", "no_messages.mcap"])
def test_a_recording_without_messages_is_not_said_to_need_a_model(
    shared: Path, name: str
) -> None:
    with Inputs(Options(shared / "data" / "bags" / "made" / name)) as inputs:
        codes = [p.code for p in inputs.problems()]
        assert codes and "no-description" not in codes


def test_a_recording_without_a_description_shows_its_frames_and_says_so(
    shared: Path,
) -> None:
    path = shared / "data" / "bags" / "made" / "no_description.mcap"
    with Inputs(Options(path)) as inputs:
        assert [p.code for p in inputs.problems()] == ["no-description"]
        assert "--model" in inputs.problems()[0].hint
        assert {"odom", *FRAMES} <= set(frames_of(inputs).frames)


def test_a_model_beside_a_recording_is_the_robot(
    shared: Path, repository: Path
) -> None:
    bag = shared / "data" / "bags" / "made" / "no_description.mcap"
    model = repository / "assets" / "sam_bot.urdf.xacro"
    with Inputs(Options(model, source=f"bag:{bag}")) as inputs:
        assert inputs.robot().name == "sam_bot"
        assert inputs.problems() == inputs.robot().problems


def test_what_a_description_has_of_xacro_reads_no_file(
    write_recording: Callable[..., Path], tmp_path: Path
) -> None:
    secret = tmp_path / "secret.yaml"
    secret.write_text("name: taken\n", encoding="utf-8")
    text = (
        '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">'
        f"<xacro:property name='x' value=\"${{load_yaml('{secret}')}}\"/>"
        "<link name='base_${x[\"name\"]}'/></robot>"
    )
    path = write_recording([(0.0, {"odom": "base"})], text)
    with Inputs(Options(path)) as inputs:
        robot = inputs.robot()
        refused = [p for p in inputs.problems() if p.severity == "error"]
    assert refused
    assert "taken" not in str((robot, refused))
    assert list(robot.links) == ["odom"]


def test_a_description_without_xacro_is_not_given_to_it(
    write_recording: Callable[..., Path],
) -> None:
    """Otherwise a name could stop the robot: for other subscribers it is a text."""
    names = ("${XSS(1)}", "$(find nothing)", "$${a}", "${1/0}")
    links = "".join(f'<link name="{name}"/>' for name in names)
    joints = "".join(
        f'<joint name="j{name}" type="fixed"><parent link="{names[0]}"/>'
        f'<child link="{name}"/></joint>'
        for name in names[1:]
    )
    text = f'<robot name="${{r}}">{links}{joints}</robot>'
    path = write_recording([(0.0, {"odom": names[0]})], text)
    with Inputs(Options(path)) as inputs:
        assert tuple(inputs.robot().links) == names
        assert [p for p in inputs.problems() if p.severity == "error"] == []


@pytest.mark.parametrize("uri", ["file:square.mcap", "bga:square.mcap"])
def test_a_source_that_is_none_is_refused_with_the_right_form(uri: str) -> None:
    with pytest.raises(UsageError, match="known: FILE"):
        Options(source=uri)


def test_a_time_needs_a_recording() -> None:
    with pytest.raises(UsageError, match="needs a recording"):
        Options(at=1.0)


def test_a_recording_without_a_robot_names_what_it_has(shared: Path) -> None:
    bag = shared / "data" / "bags" / "real" / "out.bag"
    with Inputs(Options(source=f"bag:{bag}")) as inputs:
        (problem,) = inputs.problems()
    assert "(topics: rosout)" in problem.message
    assert "no transforms either" in problem.message
