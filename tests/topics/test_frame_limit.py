"""Of very many frames the first ones are shown, and it is said that there are more."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from inside import session_of
from lower_limit import lower
from made_messages import Make, write_messages

from sambot_viz import Visualizer, limits
from sambot_viz.frames.history import FrameHistory
from sambot_viz.messages import Schema
from sambot_viz.sources.message import Recorded, TopicChannel
from sambot_viz.topics.transforms import TransformTopics, problems_of_transforms

CHANNEL = TopicChannel("/tf", Schema("tf2_msgs/msg/TFMessage"), "cdr")
Edges = tuple[tuple[str, str], ...]


class Listener:
    """Takes transforms as if they had come."""

    def __init__(self) -> None:
        self.history = FrameHistory()
        self._next: list[Any] = []
        decode = lambda message: self._next  # noqa: E731
        self.topics = TransformTopics(self.history, ["/tf"], [], decode)

    def take(self, edges: Edges, x: float = 0.0, at: int = 1) -> None:
        poses = np.zeros((len(edges), 7))
        poses[:, 0], poses[:, 6] = x, 1.0
        self._next = [(at, edges, poses)]
        self.topics.take(Recorded("/tf", CHANNEL, at, None, b""))

    def codes(self) -> Sequence[str]:
        return [one.code for one in problems_of_transforms(self.topics, "it")]


def star(count: int, first: int = 0) -> Edges:
    return tuple(("map", f"f{number}") for number in range(first, first + count))


def test_as_many_as_any_robot_has_are_all_taken() -> None:
    listener = Listener()
    listener.take(star(limits.FRAMES.value - 1))
    assert len(listener.history.frames) == limits.FRAMES.value
    assert listener.codes() == []


def test_more_are_left_out_and_one_sentence_says_so() -> None:
    listener = Listener()
    edges = star(limits.FRAMES.value + 500)
    for at in (1, 2, 3):
        listener.take(edges, float(at), at)
    assert len(listener.history.frames) == limits.FRAMES.value
    (problem,) = problems_of_transforms(listener.topics, "the robot")
    assert problem.severity == "warning"
    assert problem.message == (
        "the robot has more than 2,000 frames: the first ones are shown, f1999 and all "
        "later ones are left out"
    )
    # Those that are taken go on to move.
    assert listener.history.lookup("map", "f0").translation[0] == 3.0
    assert set(listener.topics.changed()) == {
        f"f{n}" for n in range(limits.FRAMES.value - 1)
    }


def test_a_new_name_for_each_message_fills_no_memory() -> None:
    listener = Listener()
    listener.take(star(limits.FRAMES.value - 1))
    for number in range(5000):
        edges = (("map", "f0"), (f"p{number}", "f1"), ("map", f"new{number}"))
        listener.take(edges, 1.0, 2 + number)
    assert len(listener.history.frames) == limits.FRAMES.value
    assert len(listener.topics.parents) == limits.FRAMES.value - 1
    groups = listener.topics._groups  # pyright: ignore[reportPrivateUsage]
    assert len(groups) < 100


def test_one_that_follows_another_takes_the_same_frames() -> None:
    first, second = Listener(), Listener()
    first.take(star(limits.FRAMES.value + 1))
    second.topics.expect_as(first.topics)
    second.take(star(10, limits.FRAMES.value) + star(2))
    assert second.history.frames == ("map", "f0", "f1")


def transforms(first: int, count: int) -> Make:
    def make(types: Any) -> tuple[str, str, object]:
        stamp = types["builtin_interfaces/msg/Time"](1_700_000_000, 0)
        head = types["std_msgs/msg/Header"](stamp, "map")
        pose = types["geometry_msgs/msg/Transform"](
            types["geometry_msgs/msg/Vector3"](1.0, 0.0, 0.0),
            types["geometry_msgs/msg/Quaternion"](0.0, 0.0, 0.0, 1.0),
        )
        one = types["geometry_msgs/msg/TransformStamped"]
        rows = [one(head, f"f{n}", pose) for n in range(first, first + count)]
        return "/tf", "tf2_msgs/msg/TFMessage", types["tf2_msgs/msg/TFMessage"](rows)

    return make


def test_a_page_gets_no_more_and_says_so(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "many.mcap"
    lower(monkeypatch, "FRAMES", 100)
    write_messages(path, *(transforms(50 * n, 50) for n in range(5)))
    with Visualizer(source=f"bag:{path}", port=0) as viz:
        viz.player.jump(viz.player.duration)
        session = session_of(viz)
        assert len(viz.frames.frames) == limits.FRAMES.value
        found = [one for one in session.problems.shown.value.listed]
        assert [one.code for one in found].count("many-frames") == 1
