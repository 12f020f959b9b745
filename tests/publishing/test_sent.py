"""The panel of what was sent: who, where and what, those of one hand together."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import pytest
from inside import session_of
from live_peers import eventually
from navigator_peer import NavigatorPeer
from protocol_client import ProtocolClient

from sambot_viz import Visualizer
from sambot_viz.publishing.sent_lines import LINES, SentLines
from sambot_viz.publishing.sent_message import SentMessage


def sent(who: str = "a", topic: str = "/t", values: Any = (1.0, 2.0)) -> SentMessage:
    return SentMessage(5.0, who, topic, "std/A", "map", values)


def test_messages_of_one_hand_on_one_topic_are_one_line() -> None:
    lines = SentLines()
    for made in (sent(), sent(values=(3.0,)), sent("b"), sent("b", "/u")):
        lines.add(made)
    found = [(one.who, one.topic, one.count) for one in lines.newest_first]
    assert found == [("b", "/u", 1), ("b", "/t", 1), ("a", "/t", 2)]
    assert lines.newest_first[-1].values == "3 [map]"


def test_only_the_last_are_kept_and_long_ones_are_cut() -> None:
    lines = SentLines()
    for number in range(LINES + 5):
        lines.add(sent(str(number), values={"robot_description": "<" * 10_000}))
    assert len(lines.newest_first) == LINES
    assert lines.newest_first[0].who == str(LINES + 4)
    assert len(lines.newest_first[0].values) < 200


@pytest.fixture
def peer() -> Iterator[NavigatorPeer]:
    made = NavigatorPeer()
    yield made
    made.stop()


def opened(peer: NavigatorPeer, **options: Any) -> Visualizer:
    viz = Visualizer(source=peer.uri, port=0, **options)
    data = session_of(viz).data
    assert data is not None
    eventually(lambda: data.source.status.is_connected)
    eventually(lambda: "map" in session_of(viz).scene.context.tree.frames)
    return viz


def test_a_page_lists_what_was_sent(
    peer: NavigatorPeer, protocol: Callable[..., ProtocolClient]
) -> None:
    with opened(peer, publish="goal") as viz:
        client = protocol(viz.viser.get_port())
        client.settle(viz.viser)
        assert client.row("sent/lines")["value"] == []
        viz.publish_goal(1.0, 2.0, 0.0)

        def line() -> bool:
            client.settle(viz.viser)
            (found,) = client.row("sent/lines")["value"]
            told = found["who"], found["topic"], found["values"], found["count"]
            return told == ("Python", "/goal_pose", "1, 2, 0 [map]", 1)

        eventually(line)


def test_without_leave_there_is_no_panel(
    peer: NavigatorPeer, protocol: Callable[..., ProtocolClient]
) -> None:
    with opened(peer) as viz:
        client = protocol(viz.viser.get_port())
        client.settle(viz.viser)
        assert not [name for name in client.rows if name.startswith("sent/")]
