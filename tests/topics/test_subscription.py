"""A subscription keeps messages for a display until it draws them."""

from __future__ import annotations

from pathlib import Path

import pytest

from sambot_viz.messages import Schema
from sambot_viz.sources.bag import open_recording
from sambot_viz.sources.message import Recorded, TopicChannel
from sambot_viz.sources.subscriber import jump
from sambot_viz.topics.subscription import Subscription

CHANNEL = TopicChannel("/a", Schema("std_msgs/msg/String", "", ""), "cdr")
S = 1_000_000_000


def message(time_ns: int, payload: bytes = b"") -> Recorded:
    return Recorded("/a", CHANNEL, time_ns, None, payload)


def subscription(topic: str = "/a", size: int = 3, depth_s: float = 1.0):
    return Subscription(
        (topic,), lambda one: one.payload, lambda: None, depth_s=depth_s, size=size
    )


def test_the_newest_messages_wait_in_their_order_and_are_taken_once() -> None:
    one = subscription(size=3)
    for time in range(5):
        one.take(message(time))
    assert one.has_news
    assert [m.log_ns for m in one.drain()] == [2, 3, 4]
    assert not one.has_news
    assert one.drain() == []
    assert one.heard["/a"].count == 5


def test_a_message_that_comes_twice_counts_once() -> None:
    """A latched one comes for that, and as the last one before a time."""
    one = subscription()
    one.take(message(1, b"x"))
    one.take(message(1, b"x"))
    one.take(message(1, b"y"))
    assert [m.payload for m in one.drain()] == [b"x", b"y"]


def test_a_jump_outdates_what_was_drawn_until_that_is_heard() -> None:
    one = subscription()
    one.take(message(1))
    one.clear()
    assert one.is_outdated
    assert one.has_news
    assert one.drain() == []
    assert not one.is_outdated


@pytest.mark.parametrize(("seconds", "rate"), [(1.0, 3.0), (2.0, 1.5)])
def test_the_rate_is_the_mean_since_the_first_message(
    seconds: float, rate: float
) -> None:
    one = subscription()
    assert one.rate("/a", 5 * S) == 0.0
    for time in range(3):
        one.take(message(time))
    assert one.rate("/a", round(seconds * S)) == pytest.approx(rate)


def test_after_a_jump_it_has_what_came_shortly_before(repository: Path) -> None:
    with open_recording(repository / "assets" / "square.mcap") as recording:
        one = subscription("/scan", size=100, depth_s=0.5)
        at_ns = (recording.start_ns or 0) + 5 * S
        jump(recording, at_ns, (one,))
        times = [m.log_ns for m in one.drain()]
        last = recording.last("/scan", at_ns)
        assert last is not None
        assert times[-1] == last.log_ns
        assert all(at_ns - S // 2 <= time <= at_ns for time in times)
