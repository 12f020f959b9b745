"""Joint states: the last finite number of each joint, and few messages decoded."""

from __future__ import annotations

import math
import random
from collections.abc import Sequence
from functools import cache
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from sambot_viz.errors import DecodeError
from sambot_viz.messages import MessageTypes, Schema
from sambot_viz.sources.message import Recorded, TopicChannel
from sambot_viz.topics.decoding import Decoding
from sambot_viz.topics.joint_states import JointStateTopics

TYPE = "sensor_msgs/msg/JointState"
CHANNEL = TopicChannel("/joint_states", Schema(TYPE), "cdr")


def payload(
    names: Sequence[str], positions: Sequence[float], frame: str = "", stamp: int = 0
) -> bytes:
    """A JointState in CDR, without velocities and efforts."""
    store = typestore()
    time = store.types["builtin_interfaces/msg/Time"](stamp, 0)
    header, none = store.types["std_msgs/msg/Header"](time, frame), np.zeros(0)
    state = store.types[TYPE](
        header, list(names), np.array(positions, float), none, none
    )
    return bytes(store.serialize_cdr(state, TYPE))


@cache
def typestore() -> Any:
    from rosbags.typesys import Stores, get_typestore

    return get_typestore(Stores.ROS2_HUMBLE)


class Taker:
    """Takes messages, and counts how many are decoded."""

    def __init__(self) -> None:
        self.decoded = 0
        self._decoding = Decoding(MessageTypes())
        self.topics = JointStateTopics(("/joint_states",), self._decode)

    def take(self, content: bytes, channel: TopicChannel = CHANNEL) -> None:
        self.topics.take(Recorded(channel.topic, channel, 0, None, memoryview(content)))

    def _decode(self, message: Recorded) -> Any:
        self.decoded += 1
        return self._decoding.decode(message)


def test_messages_with_the_same_names_are_decoded_once() -> None:
    taker = Taker()
    for step in range(100):
        taker.take(payload(["left", "right"], [step, -step], stamp=step))
    assert taker.topics.changed() == {"left": 99.0, "right": -99.0}
    assert taker.topics.changed() == {}
    assert taker.decoded == 1


@pytest.mark.parametrize("seed", range(20))
def test_the_last_finite_number_of_each_joint_counts(seed: int) -> None:
    chance = random.Random(seed)
    groups = [["a", "b"], ["b", "c"], ["a", "bb"], ["é", "d"], [], ["a"], ["b", "a"]]
    taker, last, changed = Taker(), dict[str, float](), dict[str, float]()
    for _ in range(200):
        names = chance.choice(groups)
        positions = [
            chance.choice([math.nan, math.inf, chance.random()]) for _ in names
        ]
        if chance.random() < 0.1:
            positions = positions[:-1]
        taker.take(payload(names, positions, chance.choice(["", "base"])))
        for name, position in zip(names, positions, strict=False):
            if math.isfinite(position):
                last[name] = changed[name] = position
        if chance.random() < 0.1:
            assert taker.topics.changed() == changed
            changed = {}
        if chance.random() < 0.1:
            assert taker.topics.last == last
    assert taker.topics.last == last
    assert taker.topics.changed() == changed


def test_a_jump_forgets_what_was_taken_and_knows_which_joints_are_gone() -> None:
    taker = Taker()
    taker.take(payload(["left"], [1.0]))
    taker.take(payload(["left"], [2.0]))
    taker.topics.clear()
    assert taker.topics.changed() == {}
    assert taker.topics.last == {}
    taker.take(payload(["right"], [1.0]))
    assert set(taker.topics.gone()) == {"left"}
    taker.take(payload(["left"], [3.0]))
    assert not taker.topics.gone()


def test_a_message_that_is_cut_is_not_read_by_the_one_before() -> None:
    taker, whole = Taker(), payload(["left", "right"], [1.0, 2.0])
    taker.take(whole)
    for end in range(len(whole)):
        taker.take(whole[:end].replace(b"left", b"lift"))
    assert taker.topics.last == {"left": 1.0, "right": 2.0}
    assert taker.topics.undecoded["/joint_states"] > 0


def test_a_type_with_its_fields_at_other_places_is_decoded_each_time() -> None:
    decoded: list[Recorded] = []

    def decode(message: Recorded) -> Any:
        decoded.append(message)
        if not message.payload:
            raise DecodeError("it is empty")
        return SimpleNamespace(name=["left"], position=[float(len(decoded))])

    topics = JointStateTopics(("/joint_states",), decode)
    for content in (b"", b"\0\1\0\0" + bytes(100), payload(["left"], [7.0])) * 2:
        topics.take(Recorded("/joint_states", CHANNEL, 0, None, content))
    assert len(decoded) == 6
    assert topics.last == {"left": 6.0}
