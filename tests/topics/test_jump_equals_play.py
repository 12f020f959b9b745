"""A jump shows what playing to that time shows, whatever was recorded."""

from __future__ import annotations

import math
import random
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import made_recording
import numpy as np
import pytest
from inside import session_of
from lower_limit import lower
from protocol_client import wait_for_workers

from sambot_viz import Visualizer
from sambot_viz.frames import FrameHistory, FrameTree
from sambot_viz.inputs import Inputs
from sambot_viz.options import Options
from sambot_viz.sources.message import Recorded
from sambot_viz.sources.subscriber import jump
from sambot_viz.topics import seconds
from sambot_viz.topics.source_robot import SourceRobot

SECONDS = 60
FRAMES = ("map", "odom", "base", "arm", "hand", "wheel", "laser")
TFMESSAGE = "tf2_msgs/msg/TFMessage"
Sent = tuple[str, float, float, dict[str, str]]
"""Topic, log time and stamp [s], and the parent of each child."""


class AnyRecording:
    """Publishers that begin, stop, lose their clock and disagree, by chance."""

    def __init__(self, seed: int) -> None:
        self._chance = random.Random(seed)

    def messages(self) -> list[Sent]:
        """Return what they send, in the order of the log."""
        chance = self._chance
        sent = [one for _ in range(chance.randint(1, 5)) for one in self._moving()]
        sent += [one for _ in range(chance.randint(0, 3)) for one in self._fixed()]
        sent.sort(key=lambda one: one[1])
        # As when a simulation is reset.
        back = chance.choice((0.0, 0.0, 0.5, 20.0, 1000.0))
        turn = chance.uniform(0, SECONDS)
        return [
            (topic, log, stamp - (back if log > turn else 0.0), frames)
            for topic, log, stamp, frames in sent
        ]

    def _moving(self) -> Iterator[Sent]:
        chance = self._chance
        frames = self._edges()
        period = chance.choice((0.1, 0.3, 1.0, 7.0, 30.0))
        late, log = chance.choice((0.0, 0.0, 0.2, 3.0)), chance.uniform(0, 20)
        while log < SECONDS:
            yield "/tf", log, log - late, frames
            pause = chance.choice((11.0, 25.0)) if chance.random() < 0.02 else 0.0
            log += period + pause
            if chance.random() < 0.01:
                frames = self._edges()

    def _fixed(self) -> Iterator[Sent]:
        log = self._chance.choice((0.0, self._chance.uniform(0, SECONDS)))
        yield "/tf_static", log, log, self._edges()

    def _edges(self) -> dict[str, str]:
        """Return the parents of some frames, which may form a ring."""
        count = self._chance.randint(1, 3)
        children = self._chance.sample(FRAMES, count)
        return {child: self._chance.choice(FRAMES) for child in children}


def written(path: Path, sent: list[Sent]) -> Path:
    store = made_recording.store_of_all()
    start = made_recording.START
    return made_recording.write_messages(
        path,
        [
            (
                topic,
                TFMESSAGE,
                round((start + log) * 1e9),
                made_recording.transforms_message(store, stamp, frames),
            )
            for topic, log, stamp, frames in sent
        ],
    )


def state(history: FrameHistory, frames: tuple[str, ...]) -> dict[str, Any]:
    """All that a look-up could find."""
    return {
        name: (
            history.is_static(name),
            tuple(history.stamps(name)),
            sample and (sample.stamp, sample.parent, sample.pose),
        )
        for name in frames
        if (sample := history.latest(name)) is not None
    }


def played(recorded: SourceRobot, at_ns: int) -> dict[str, Any]:
    history = FrameHistory()
    transforms = recorded.transforms(history)
    for message in recorded.recording.messages(None, at_ns, transforms.topics):
        transforms.take(message)
    return state(history, FRAMES)


def jumped(recorded: SourceRobot, at_ns: int) -> dict[str, Any]:
    history = FrameHistory()
    jump(recorded.recording, at_ns, (recorded.transforms(history),))
    return state(history, FRAMES)


@pytest.mark.parametrize("seed", range(25))
def test_a_jump_leaves_the_frames_as_playing_to_it_does(
    tmp_path: Path, seed: int
) -> None:
    path = written(tmp_path / "any.mcap", AnyRecording(seed).messages())
    chance = random.Random(seed)
    with Inputs(Options(path)) as inputs:
        recorded = inputs.moved_by
        assert recorded is not None
        start, end = recorded.recording.start_ns, recorded.recording.end_ns
        assert start is not None and end is not None
        for at_ns in (end, *(chance.randint(start, end) for _ in range(5))):
            assert jumped(recorded, at_ns) == played(recorded, at_ns)


JOINTS = ("wheel", "arm", "hand", "lid")
JOINT_STATE = "sensor_msgs/msg/JointState"
Positions = dict[str, float]


def any_joints(seed: int) -> list[tuple[str, float, Positions]]:
    """Publishers of some joints each, which begin late, fall silent, and send NaN."""
    chance = random.Random(seed)
    sent: list[tuple[str, float, Positions]] = []
    for _ in range(chance.randint(1, 4)):
        topic = chance.choice(("/joint_states", "/arm/joint_states"))
        names = chance.sample(JOINTS, chance.randint(1, 3))
        period = chance.choice((0.1, 0.5, 5.0, 40.0))
        log, end = chance.uniform(0, 40), chance.choice((SECONDS, SECONDS / 3))
        while log < end:
            values = (chance.choice((chance.random(), math.nan)) for _ in names)
            sent.append((topic, round(log, 1), dict(zip(names, values, strict=True))))
            log += period
    return sorted(sent, key=lambda one: one[1])


def with_joints(path: Path, sent: list[tuple[str, float, Positions]]) -> Path:
    store, start = made_recording.store_of_all(), made_recording.START
    kind, none = store.types[JOINT_STATE], np.zeros(0)
    time = store.types["builtin_interfaces/msg/Time"](0, 0)
    header = store.types["std_msgs/msg/Header"](time, "")
    beat = (("/joint_states", 0.0, {"lid": 0.5}), ("/joint_states", SECONDS, {}))
    return made_recording.write_messages(
        path,
        [
            (
                topic,
                JOINT_STATE,
                round((start + log) * 1e9),
                kind(header, list(names), np.array([*names.values()]), none, none),
            )
            for topic, log, names in (beat[0], *sent, beat[1])
        ],
    )


@pytest.mark.parametrize("seed", range(25))
def test_a_jump_leaves_the_joints_as_playing_to_it_does(
    tmp_path: Path, seed: int
) -> None:
    path = with_joints(tmp_path / "any.mcap", any_joints(seed))
    chance = random.Random(seed)
    with Inputs(Options(path)) as inputs:
        recorded = inputs.moved_by
        assert recorded is not None
        recording, jumped = recorded.recording, recorded.joint_states()
        assert recording is not None
        start, end = recording.start_ns, recording.end_ns
        assert start is not None and end is not None and jumped.topics
        for at_ns in (end, *(chance.randint(start, end) for _ in range(5))):
            played = recorded.joint_states()
            for message in recording.messages(None, at_ns, played.topics):
                played.take(message)
            jump(recording, at_ns, (jumped,))
            assert jumped.last == played.last


def test_a_joint_that_has_not_been_told_of_goes_back_to_its_start(
    tmp_path: Path,
) -> None:
    model = tmp_path / "r.urdf"
    joint = '<joint name="{0}" type="continuous"><parent link="b"/><child link="{0}"/>'
    joints = "".join(f'<link name="{n}"/>{joint.format(n)}</joint>' for n in JOINTS)
    model.write_text(f'<robot name="r"><link name="b"/>{joints}</robot>')
    sent = [
        ("/joint_states", 10.0, {"arm": 1.0}),
        ("/joint_states", 40.0, {"lid": 2.0}),
    ]
    path = with_joints(tmp_path / "late.mcap", sent)
    with Visualizer(model, source=str(path), port=0) as viz:
        player = session_of(viz).data.player
        for at, expected in ((50.0, (1.0, 2.0)), (5.0, (0.0, 0.5)), (20.0, (1.0, 0.5))):
            player.jump(player.start_ns + round(at * 1e9))
            wait_for_workers()
            positions = viz.joint_positions
            assert (positions["arm"], positions["lid"]) == pytest.approx(expected)


def test_what_a_jump_has_not_looked_further_for_is_said(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    sent: list[Sent] = [("/tf", 0.0, 0.0, {"old": "map", "odom": "map"})]
    sent += [("/tf", n / 10, n / 10, {"odom": "map"}) for n in range(1, 600)]
    path = written(tmp_path / "long.mcap", sent)
    joints: list[tuple[str, float, Positions]] = [
        ("/joint_states", 1.0 + n / 10, {"arm": 1.0}) for n in range(500)
    ]
    of_joints = with_joints(tmp_path / "joints.mcap", joints)
    for most, told in ((10_000, False), (20, True)):
        lower(monkeypatch, "SEARCHED", most)
        monkeypatch.setattr(seconds, "FEW", 10)
        assert (after_a_jump(path) == ["the frame old"]) == told
        assert (after_a_jump(of_joints) == ["the joint lid"]) == told


def after_a_jump(path: Path) -> list[str]:
    """Return of what it is said that it was not looked for in all messages."""
    with Visualizer(source=str(path), port=0) as viz:
        viz.player.jump(viz.player.duration)
        wait_for_workers()
        told = session_of(viz).problems.shown.value.listed
        found = [one for one in told if one.code == "not-looked-further"]
        assert all("searched 20 messages back" in one.message for one in found)
        return [one.message.partition(":")[0] for one in found]


def test_a_second_jump_reads_only_what_holds(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    sent: list[Sent] = [("/tf", 0.0, 0.0, {"odom": "map"})]
    sent += [("/tf", n / 10, n / 10, {"base": "odom"}) for n in range(1, 600)]
    read: list[Recorded] = []
    with Inputs(Options(written(tmp_path / "long.mcap", sent))) as inputs:
        recorded = inputs.moved_by
        assert recorded is not None
        end = recorded.recording.end_ns
        assert end is not None
        whole = jumped(recorded, end)
        monkeypatch.setattr(
            recorded.recording, "messages", counted(recorded.recording.messages, read)
        )
        assert jumped(recorded, end) == whole
    assert len(read) < 130


def counted(
    messages: Callable[..., Iterator[Recorded]], read: list[Recorded]
) -> Callable[..., Iterator[Recorded]]:
    def through(*wanted: Any) -> Iterator[Recorded]:
        for message in messages(*wanted):
            read.append(message)
            yield message

    return through


@pytest.fixture
def reported(shared: Path) -> Path:
    return shared / "data" / "reported"


def frames_of(path: Path, at: float | None = None) -> FrameTree:
    with Inputs(Options(source=f"bag:{path}", at=at)) as inputs:
        robot, recorded = inputs.robot(), inputs.moved_by
        assert recorded is not None
        return recorded.frames(robot, inputs.options.start_pose.state(robot))


@pytest.mark.parametrize(("at", "along_x"), [(14.5, 5.9), (20.0, 5.9)])
def test_two_publishers_have_a_common_time_after_a_gap(
    reported: Path, at: float, along_x: float
) -> None:
    """tf2 keeps ten seconds of each frame, however long ago they were."""
    tree = frames_of(reported / "recordings" / "tf_gap.mcap", at)
    assert tree.lookup("odom", "arm").translation[0] == pytest.approx(along_x)


def test_the_direct_parent_is_found_below_a_loop(reported: Path) -> None:
    tree = frames_of(reported / "recordings" / "tf_ring_direct.mcap")
    assert tree.lookup("odom", "map").translation[0] == 2.0
    assert tree.lookup("map", "odom").translation[0] == 1.0
    assert tree.latest_common_time("odom", "map") > 0.0


def test_a_loop_is_a_problem_of_the_recording_and_no_frame_is_invented(
    reported: Path,
) -> None:
    path = reported / "bags" / "c13_loop"
    with Inputs(Options(source=f"bag:{path}")) as inputs:
        (loop,) = (p for p in inputs.problems() if p.code == "tf-loop")
    assert "odom -> body -> odom" in loop.message
    assert "body -> odom on /tf" in loop.hint
    assert "base_link" not in frames_of(path).frames


def test_what_is_newer_than_a_clock_that_went_back_is_forgotten(
    reported: Path,
) -> None:
    path = reported / "recordings" / "tf_clock_back.mcap"
    for at, newest in ((1.0, 1_700_000_101), (2.5, 1_700_000_002.5)):
        history = frames_of(path, at).history
        assert history is not None
        stamps = history.stamps("base")
        assert stamps[-1] == pytest.approx(newest * 1e9)
        assert stamps[-1] - stamps[0] < 4e9
