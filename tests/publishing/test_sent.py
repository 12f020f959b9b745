"""The panel of what was sent: who, where and what, those of one hand together."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import Any

import pytest
from base_peer import BasePeer
from inside import session_of
from live_peers import eventually, knows_takers
from navigator_peer import NavigatorPeer
from protocol_client import ProtocolClient

from sambot_viz import Visualizer
from sambot_viz.publishing.sent_lines import LINES, SentLines
from sambot_viz.publishing.sent_message import SentMessage


def sent(who: str = "a", topic: str = "/t", values: Any = (1.0, 2.0)) -> SentMessage:
    return SentMessage(5.0, who, topic, "std/A", "map", values)


def found(*made: SentMessage) -> list[tuple[str, str, int]]:
    """The lines of messages, the oldest first: who, where and how many."""
    lines = SentLines()
    for one in made:
        lines.add(one)
    return [(one.who, one.topic, one.count) for one in reversed(lines.newest_first)]


def test_steps_of_one_motion_are_one_line() -> None:
    steps = [replace(sent(who), type_name="geometry_msgs/msg/Twist") for who in "aab"]
    assert found(*steps) == [("a", "/t", 2), ("b", "/t", 1)]
    lines = SentLines()
    for one in (steps[0], replace(steps[1], values=(3.0,))):
        lines.add(one)
    assert [one.values for one in lines.newest_first] == ["3 [map]"]


def test_each_goal_and_what_is_chosen_has_a_line() -> None:
    assert found(sent(), sent()) == [("a", "/t", 1)] * 2
    kind = "visualization_msgs/msg/InteractiveMarkerFeedback"
    step = replace(sent(), type_name=kind, values={"event": "POSE_UPDATE"})
    chosen = replace(step, values={"event": "MENU_SELECT"})
    assert [n for *_, n in found(step, step, chosen, chosen)] == [2, 1, 1]


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
    knows_takers(data.source, peer)
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


def test_stop_at_rest_is_said_and_has_a_line(
    protocol: Callable[..., ProtocolClient],
) -> None:
    peer = BasePeer()
    try:
        with opened(peer, publish="drive") as viz:
            client = protocol(viz.viser.get_port())
            client.settle(viz.viser)
            client.act("live/stop")

            def said() -> bool:
                client.settle(viz.viser)
                lines = client.row("sent/lines")["value"]
                state = client.row("live/state")["value"]
                # Another thread sends what STOP sends: which comes first is open.
                assert {(line["topic"], line["who"]) for line in lines} == {
                    ("STOP", "Viewer 1"),
                    ("/cmd_vel", "Viewer 1"),
                }
                return bool(state["why"] == "Viewer 1 pressed STOP" and state["stops"])

            eventually(said)
    finally:
        peer.stop()
