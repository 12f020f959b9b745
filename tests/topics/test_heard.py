"""A topic's rate and age, on a clock that is given."""

from __future__ import annotations

import pytest

from sambot_viz.messages import Schema
from sambot_viz.sources.message import Recorded, TopicChannel
from sambot_viz.topics.heard import Heard

SECOND = 10**9
SCHEMA = Schema("sensor_msgs/msg/LaserScan")
CHANNEL = TopicChannel("/scan", SCHEMA, "cdr")


@pytest.fixture
def topic() -> Heard:
    return Heard()


def come(topic: Heard, times: list[float]) -> None:
    for time in times:
        topic.take(Recorded("/scan", CHANNEL, round(time * SECOND), None, b""))


def test_before_the_first_message_nothing_is_known(topic: Heard) -> None:
    assert (topic.rate(0), topic.age(0), topic.last, topic.count) == (None,) * 3 + (0,)
    come(topic, [3])
    assert topic.rate(4 * SECOND) is None
    assert topic.age(4 * SECOND) == 1.0


@pytest.mark.parametrize("rate", [0.5, 1, 30, 1000])
def test_the_rate_is_that_of_the_messages(topic: Heard, rate: float) -> None:
    count = max(10, round(2 * rate))
    come(topic, [100 + n / rate for n in range(count)])
    now = round((100 + (count - 1) / rate) * SECOND)
    assert topic.rate(now) == pytest.approx(rate)
    assert topic.count == count


def test_a_topic_that_falls_silent_gets_slower_and_stops(topic: Heard) -> None:
    come(topic, [n / 10 for n in range(100)])
    rates = [topic.rate(round(at * SECOND)) for at in (9.9, 10.1, 12, 14, 20)]
    assert rates[0] == rates[1] == pytest.approx(10)
    assert all(rate is not None for rate in rates)
    assert rates == sorted(rates, key=lambda rate: -(rate or 0))
    assert rates[-1] == 0.0
    assert topic.age(20 * SECOND) == pytest.approx(10.1)


def test_the_rate_is_that_of_the_last_seconds(topic: Heard) -> None:
    come(topic, [n / 100 for n in range(100)])
    come(topic, [10 + n / 2 for n in range(20)])
    assert topic.rate(round(19.5 * SECOND)) == pytest.approx(2)


def test_messages_of_one_time_have_no_rate(topic: Heard) -> None:
    come(topic, [5, 5, 5])
    assert topic.rate(5 * SECOND) is None


def test_a_clock_that_goes_back_begins_again(topic: Heard) -> None:
    come(topic, [n / 10 for n in range(100)])
    come(topic, [1, 1.5, 2])
    assert topic.rate(2 * SECOND) == pytest.approx(2)
    # A clock that is a little late makes no negative age.
    assert topic.age(SECOND) == 0.0
