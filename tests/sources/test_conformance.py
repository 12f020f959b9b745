"""What every live source does, whatever its transport."""

from __future__ import annotations

import threading
from collections.abc import Callable

import pytest
from live_peers import STRING, WAIT, Inbox, LivePeer
from lower_limit import lower
from patience import until

from sambot_viz.sources.message import Recorded
from sambot_viz.sources.source import Source

Open = Callable[[str], Source]


def wait(condition: Callable[[], object], why: str = "") -> None:
    until(condition, WAIT, why)


def test_topics_appear_and_vanish(peer: LivePeer, opened: Open) -> None:
    peer.advertise("/first")
    source = opened(peer.uri)
    told: list[set[str]] = []
    source.on_topics = lambda: told.append(set(source.topics()))
    wait(lambda: set(source.topics()) == {"/first"})
    peer.advertise("/second")
    wait(lambda: set(source.topics()) == {"/first", "/second"})
    topic = source.topics()["/second"]
    assert (topic.name, topic.schema.name) == ("/second", STRING)
    assert topic.message_encoding == "cdr"
    assert topic.schema.encoding == "ros2msg"
    assert topic.reason is None
    peer.remove("/first")
    wait(lambda: set(source.topics()) == {"/second"})
    wait(lambda: told and told[-1] == {"/second"})


def test_messages_come_in_their_order(
    peer: LivePeer, opened: Open, inbox: Inbox
) -> None:
    peer.advertise("/chatter")
    source = opened(peer.uri)
    source.subscribe("/chatter", inbox)
    wait(lambda: peer.subscribed() == ["/chatter"])
    words = [f"hello {n}" for n in range(200)]
    for word in words:
        peer.publish("/chatter", word)
    inbox.wait_for(*words)
    first = inbox.messages[0]
    assert first.topic == "/chatter"
    assert first.channel.schema.name == STRING
    assert first.log_ns > 0
    assert memoryview(first.payload).readonly


def test_a_topic_may_be_subscribed_to_before_it_exists(
    peer: LivePeer, opened: Open, inbox: Inbox
) -> None:
    source = opened(peer.uri)
    source.subscribe("/later", inbox)
    wait(lambda: source.status.is_connected)
    peer.advertise("/later", latched=True)
    peer.publish("/later", "kept")
    inbox.wait_for("kept")


def test_nothing_is_asked_for_that_nobody_has_subscribed_to(
    peer: LivePeer, opened: Open, inbox: Inbox
) -> None:
    for name in ("/a", "/b", "/c"):
        peer.advertise(name)
    source = opened(peer.uri)
    wait(lambda: set(source.topics()) == {"/a", "/b", "/c"})
    source.subscribe("/b", inbox)
    wait(lambda: peer.subscribed() == ["/b"])
    source.unsubscribe("/b", inbox)
    wait(lambda: peer.subscribed() == [])


def test_subscribing_twice_is_subscribing_once(
    peer: LivePeer, opened: Open, inbox: Inbox
) -> None:
    peer.advertise("/chatter")
    source = opened(peer.uri)
    other = Inbox()
    source.unsubscribe("/chatter", inbox)
    source.subscribe("/chatter", inbox)
    source.subscribe("/chatter", inbox)
    source.subscribe("/chatter", other)
    wait(lambda: peer.subscribed() == ["/chatter"])
    peer.publish("/chatter", "one")
    inbox.wait_for("one")
    other.wait_for("one")
    source.unsubscribe("/chatter", other)
    source.unsubscribe("/chatter", other)
    peer.publish("/chatter", "two")
    inbox.wait_for("one", "two")
    assert other.strings() == ["one"]
    assert peer.subscribed() == ["/chatter"]


def test_latched_messages_reach_a_late_subscriber(
    peer: LivePeer, opened: Open, inbox: Inbox
) -> None:
    peer.advertise("/tf_static", latched=True)
    for word in ("wheels", "laser"):
        peer.publish("/tf_static", word)
    source = opened(peer.uri)
    source.subscribe("/tf_static", inbox)
    inbox.wait_for("wheels", "laser")
    late = Inbox()
    source.subscribe("/tf_static", late)
    late.wait_for("wheels", "laser")
    peer.publish("/tf_static", "camera")
    inbox.wait_for("wheels", "laser", "camera")
    late.wait_for("wheels", "laser", "camera")
    source.unsubscribe("/tf_static", inbox)
    source.unsubscribe("/tf_static", late)
    wait(lambda: peer.subscribed() == [])
    source.subscribe("/tf_static", inbox)
    inbox.wait_for(*["wheels", "laser", "camera"] * 2)


def test_a_connection_that_was_pulled_is_made_again(
    peer: LivePeer, opened: Open, inbox: Inbox
) -> None:
    peer.advertise("/chatter")
    peer.advertise("/map", latched=True)
    peer.publish("/map", "hall")
    source = opened(peer.uri)
    told: list[bool] = []
    source.on_status = lambda: told.append(source.status.is_connected)
    source.subscribe("/chatter", inbox)
    source.subscribe("/map", inbox)
    inbox.wait_for("hall")
    peer.stop()
    wait(lambda: not source.status.is_connected)
    assert set(source.topics()) == {"/chatter", "/map"}, "the last known ones"
    wait(lambda: peer.absent in source.status.sentence)
    assert peer.remedy in source.status.sentence
    assert 0 < (source.status.retry_s or 0) <= 15
    peer.start()
    inbox.wait_for("hall", "hall")
    assert source.status.is_connected
    wait(lambda: peer.subscribed() == ["/chatter", "/map"])
    peer.publish("/chatter", "again")
    inbox.wait_for("hall", "hall", "again")
    assert told[-1]
    assert False in told


def test_a_robot_may_be_switched_on_later(
    peer: LivePeer, opened: Open, inbox: Inbox
) -> None:
    peer.advertise("/chatter")
    peer.stop()
    source = opened(peer.uri)
    source.subscribe("/chatter", inbox)
    wait(lambda: peer.absent in source.status.sentence)
    peer.start()
    wait(lambda: peer.subscribed() == ["/chatter"])
    peer.publish("/chatter", "awake")
    inbox.wait_for("awake")


def test_callbacks_that_raise_harm_nobody(
    peer: LivePeer, opened: Open, inbox: Inbox
) -> None:
    def careless(message: Recorded) -> None:
        raise RuntimeError("careless")

    def careless_owner() -> None:
        raise RuntimeError("careless owner")

    peer.advertise("/chatter")
    source = opened(peer.uri)
    source.on_topics = source.on_status = careless_owner
    source.subscribe("/chatter", careless)
    source.subscribe("/chatter", inbox)
    wait(lambda: peer.subscribed() == ["/chatter"])
    peer.publish("/chatter", "one")
    peer.publish("/chatter", "two")
    inbox.wait_for("one", "two")
    assert source.status.is_connected


def test_all_callbacks_run_in_one_thread(
    peer: LivePeer, opened: Open, inbox: Inbox
) -> None:
    threads: set[int] = set()

    def note(*_: object) -> None:
        threads.add(threading.get_ident())

    peer.advertise("/chatter")
    source = opened(peer.uri)
    source.on_topics = source.on_status = note
    source.subscribe("/chatter", note)
    source.subscribe("/chatter", inbox)
    wait(lambda: peer.subscribed() == ["/chatter"])
    peer.publish("/chatter", "one")
    inbox.wait_for("one")
    assert len(threads) == 1
    assert threading.get_ident() not in threads


def test_a_slow_callback_loses_the_oldest_messages_and_they_are_counted(
    peer: LivePeer, opened: Open, inbox: Inbox, monkeypatch: pytest.MonkeyPatch
) -> None:
    lower(monkeypatch, "WAITING", 10)
    free, begun = threading.Event(), threading.Event()

    def slow(message: Recorded) -> None:
        begun.set()
        free.wait(WAIT)

    peer.advertise("/fast")
    peer.advertise("/other")
    source = opened(peer.uri)
    source.subscribe("/fast", slow)
    source.subscribe("/fast", inbox)
    source.subscribe("/other", inbox)
    wait(lambda: peer.subscribed() == ["/fast", "/other"])
    peer.publish("/fast", "0")
    assert begun.wait(WAIT)
    peer.publish("/other", "kept")
    for n in range(1, 101):
        peer.publish("/fast", str(n))
    wait(lambda: source.status.dropped == 90)
    wait(lambda: "displays were too slow" in source.status.sentence)
    free.set()
    wait(lambda: {"100", "kept"} <= {*inbox.strings()})
    numbers = [int(word) for word in inbox.strings() if word != "kept"]
    assert numbers == [0, *range(91, 101)]


def test_close_joins_the_threads_and_may_be_called_twice(
    peer: LivePeer, opened: Open, inbox: Inbox
) -> None:
    before = set(threading.enumerate())
    peer.advertise("/chatter")
    source = opened(peer.uri)
    # The peer has threads of its own in this process.
    new = set(threading.enumerate()) - before
    own = {thread for thread in new if thread.name.startswith("sambot-viz")}
    assert own
    source.subscribe("/chatter", inbox)
    wait(lambda: peer.subscribed() == ["/chatter"])
    source.close()
    assert not any(thread.is_alive() for thread in own)
    wait(lambda: peer.subscribed() == [])
    source.close()
    source.open()
    assert not source.status.is_connected
    assert source.status.sentence.endswith("is closed")
    source.subscribe("/other", inbox)
    source.unsubscribe("/chatter", inbox)


def test_a_callback_may_close_the_source(
    peer: LivePeer, opened: Open, inbox: Inbox
) -> None:
    closed = threading.Event()
    peer.advertise("/chatter")
    source = opened(peer.uri)

    def last(message: Recorded) -> None:
        source.close()
        closed.set()

    source.subscribe("/chatter", last)
    wait(lambda: peer.subscribed() == ["/chatter"])
    peer.publish("/chatter", "end")
    assert closed.wait(WAIT)
    wait(lambda: peer.subscribed() == [])


def test_a_callback_may_subscribe_and_unsubscribe(
    peer: LivePeer, opened: Open, inbox: Inbox
) -> None:
    peer.advertise("/first")
    peer.advertise("/second", latched=True)
    peer.publish("/second", "kept")
    source = opened(peer.uri)

    def once(message: Recorded) -> None:
        source.unsubscribe("/first", once)
        source.subscribe("/second", inbox)

    source.subscribe("/first", once)
    wait(lambda: peer.subscribed() == ["/first"])
    peer.publish("/first", "go")
    inbox.wait_for("kept")
    wait(lambda: peer.subscribed() == ["/second"])
