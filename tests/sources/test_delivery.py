"""Messages on their way to callbacks: bounded, in order, kept for late subscribers."""

from __future__ import annotations

import threading
from collections.abc import Iterator

import pytest
from live_peers import WAIT, Inbox, cdr_string
from lower_limit import lower
from patience import until

from sambot_viz.messages import Schema
from sambot_viz.sources.live.delivery import Delivery
from sambot_viz.sources.message import Recorded, TopicChannel

SCHEMA = Schema("std_msgs/msg/String")


def message(topic: str, words: str, is_latched: bool = False) -> Recorded:
    channel = TopicChannel(topic, SCHEMA, "cdr", is_latched=is_latched)
    return Recorded(topic, channel, 1, None, cdr_string(words))


@pytest.fixture
def line() -> Iterator[Delivery]:
    line = Delivery("line")
    yield line
    line.stop()


def test_topics_keep_their_order_among_each_other(line: Delivery, inbox: Inbox) -> None:
    for topic in ("/a", "/b"):
        line.subscribe(topic, inbox)
    words = [f"{n}" for n in range(300)]
    for n, word in enumerate(words):
        line.put(message("/a" if n % 3 else "/b", word))
    line.start()
    inbox.wait_for(*words)
    assert line.dropped == 0


def test_large_messages_wait_up_to_a_size_of_all(
    line: Delivery, inbox: Inbox, monkeypatch: pytest.MonkeyPatch
) -> None:
    lower(monkeypatch, "WAITING_BYTES", 10_000)
    for topic in ("/cloud", "/tf"):
        line.subscribe(topic, inbox)
    line.put(message("/tf", "before"))
    for n in range(50):
        line.put(message("/cloud", f"{n}" + "." * 3000))
    line.put(message("/tf", "after"))
    line.start()
    until(lambda: inbox.strings()[-1:] == ["after"], WAIT)
    words = [one.rstrip(".") for one in inbox.strings()]
    # The one message of another topic was not taken for the clouds.
    assert words == ["before", "47", "48", "49", "after"]
    assert line.dropped == 47


def test_a_topic_that_nobody_wants_any_longer_is_not_delivered(
    line: Delivery, inbox: Inbox
) -> None:
    other = Inbox()
    line.subscribe("/a", inbox)
    line.subscribe("/b", other)
    line.put(message("/a", "lost"))
    line.put(message("/b", "one"))
    line.unsubscribe("/a", inbox)
    line.put(message("/a", "not taken"))
    line.start()
    other.wait_for("one")
    assert inbox.messages == []
    assert line.wanted() == {"/b"}


def test_the_last_message_is_kept_and_all_of_latched_topics(
    line: Delivery, inbox: Inbox
) -> None:
    line.start()
    for topic in ("/scan", "/tf_static"):
        line.subscribe(topic, inbox)
        for word in ("one", "two"):
            line.put(message(topic, word, is_latched=topic == "/tf_static"))
    inbox.wait_for("one", "two", "one", "two")
    late = Inbox()
    line.subscribe("/scan", late)
    line.subscribe("/tf_static", late)
    late.wait_for("two", "one", "two")


def test_what_is_kept_gives_way_to_what_another_connection_brings(
    line: Delivery, inbox: Inbox
) -> None:
    line.start()
    line.subscribe("/tf_static", inbox)
    line.put(message("/tf_static", "old", True))
    inbox.wait_for("old")
    line.forget()
    late = Inbox()
    line.subscribe("/tf_static", late)
    late.wait_for("old")
    line.put(message("/tf_static", "new", True))
    late.wait_for("old", "new")
    last = Inbox()
    line.subscribe("/tf_static", last)
    last.wait_for("new")


def test_an_action_that_waits_already_runs_once(line: Delivery) -> None:
    ran: list[int] = []
    done = threading.Event()

    def action() -> None:
        ran.append(1)

    for _ in range(5):
        line.post(action)
    line.post(done.set)
    line.start()
    assert done.wait(WAIT)
    assert ran == [1]
