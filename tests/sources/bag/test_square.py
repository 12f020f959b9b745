"""A recording is read by topic and by time."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from pathlib import Path

import pytest

from sambot_viz.sources.bag import Bag, open_bag

START = 1_750_000_000_000_000_000
COUNTS = {
    "/robot_description": 1,
    "/tf": 1000,
    "/joint_states": 400,
    "/odom": 200,
    "/tf_static": 2,
    "/scan": 100,
}


@pytest.fixture
def bag(repository: Path) -> Iterator[Bag]:
    with open_bag(repository / "assets" / "square.mcap") as bag:
        yield bag


def test_topics_have_their_type_encoding_qos_and_count(bag: Bag) -> None:
    assert {name: topic.count for name, topic in bag.topics.items()} == COUNTS
    scan = bag.topics["/scan"]
    assert scan.schema.name == "sensor_msgs/msg/LaserScan"
    assert (scan.schema.encoding, scan.message_encoding) == ("ros2msg", "cdr")
    assert "float32[] ranges" in str(scan.schema.text)
    assert scan.qos is not None
    assert (scan.qos.reliability, scan.qos.durability) == ("best_effort", "volatile")
    latched = {name for name, topic in bag.topics.items() if topic.is_latched}
    assert latched == {"/robot_description", "/tf_static"}
    assert (bag.start_ns, bag.end_ns) == (START + 1_000_000, START + 19_969_666_666)
    assert bag.problems == ()
    assert bag.is_complete


def test_messages_come_by_log_time_and_only_those_asked_for(bag: Bag) -> None:
    messages = list(bag.messages())
    assert Counter(message.topic for message in messages) == COUNTS
    times = [message.log_ns for message in messages]
    assert times == sorted(times)
    begin, end = START + 5_000_000_000, START + 7_000_000_000
    some = list(bag.messages(begin, end, ["/odom", "/scan"]))
    wanted = [
        message
        for message in messages
        if message.topic in ("/odom", "/scan") and begin <= message.log_ns <= end
    ]
    assert len(some) > 20
    assert some == wanted
    first = messages[700].log_ns
    assert next(bag.messages(first)).log_ns == first
    assert list(bag.messages(first, first, ["/tf"])) != []
    assert list(bag.messages(topics=[])) == list(bag.messages(topics=["/no"])) == []


def test_last_next_and_previous_are_those_of_the_whole_list(bag: Bag) -> None:
    for topic in COUNTS:
        times = [message.log_ns for message in bag.messages(topics=[topic])]
        for at in range(START - 10**9, START + 22 * 10**9, 777_777_777):
            before = [time for time in times if time <= at]
            after = [time for time in times if time > at]
            last, following = bag.last(topic, at), bag.next(topic, at)
            assert (last.log_ns if last else None) == (before[-1] if before else None)
            assert (following.log_ns if following else None) == (
                after[0] if after else None
            )
        middle = times[len(times) // 2]
        previous = bag.previous(topic, middle)
        assert (previous.log_ns if previous else None) == max(
            (time for time in times if time < middle), default=None
        )
        assert bag.last(topic, 2**80) is not None
        assert bag.last(topic, -5) is None
        assert bag.next(topic, 2**80) is None


def test_latched_messages_are_there_at_opening(bag: Bag) -> None:
    assert [message.topic for message in bag.latched()] == [
        "/robot_description",
        "/tf_static",
        "/tf_static",
    ]
    assert b"<robot" in bytes(bag.latched()[0].payload)


def test_two_readers_do_not_disturb_each_other(bag: Bag) -> None:
    one, other = bag.messages(), bag.messages(START + 10 * 10**9)
    pairs = [(next(one), next(other)) for _ in range(500)]
    assert [pair[0] for pair in pairs] == list(bag.messages())[:500]
    assert [pair[1] for pair in pairs] == list(bag.messages(START + 10**10))[:500]
