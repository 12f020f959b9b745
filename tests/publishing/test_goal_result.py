"""Why a goal was given up is said, as Nav2's result has it."""

from __future__ import annotations

import struct
from collections.abc import Iterator
from typing import Any

import pytest
from inside import session_of
from live_peers import eventually, knows_takers
from navigator_peer import NavigatorPeer

from sambot_viz import Visualizer
from sambot_viz.cli import main
from sambot_viz.messages import MessageTypes
from sambot_viz.publishing.goal_result import ask_why
from sambot_viz.sources.source import Reply

SERVICE = "/navigate_to_pose/_action/get_result"


def jazzy(code: int) -> bytes:
    """A response with a code alone, as CDR."""
    return b"\0\1\0\0" + struct.pack("<bxH", 6, code)


def kilted(code: int, words: bytes) -> bytes:
    """A response with words too."""
    return jazzy(code) + struct.pack("<I", len(words) + 1) + words + b"\0"


@pytest.fixture
def peer() -> Iterator[NavigatorPeer]:
    made = NavigatorPeer(statuses=(1, 2))
    yield made
    made.stop()


@pytest.mark.parametrize(
    ("reply", "words"),
    [
        (jazzy(206), "not reached: something is where the goal is (error 206)"),
        (jazzy(4711), "not reached: error 4711"),
        (jazzy(0), "not reached: the robot has given it up"),
        (kilted(208, b"no path in 3 tries"), "no path in 3 tries (error 208)"),
        (b"\0\1", "not reached: the robot has given it up"),
        (None, "not reached: the robot has given it up"),
    ],
)
def test_why_a_goal_was_given_up_is_said(
    peer: NavigatorPeer, reply: bytes | None, words: str
) -> None:
    if reply is not None:
        peer.serve(SERVICE, reply=reply)
    with Visualizer(source=peer.uri, port=0, publish="goal") as viz:
        session = session_of(viz)
        eventually(lambda: "map" in session.scene.context.tree.frames)
        assert session.data is not None
        knows_takers(session.data.source, peer)
        viz.publish_goal(1.0, 0.0, 0.0)
        goals = session.publisher.goals
        assert goals is not None
        eventually(lambda: goals.last is not None and goals.last.words == "on the way")
        peer.tell(6)
        eventually(lambda: goals.last is not None and goals.last.is_over)
        assert goals.last is not None and goals.last.words.endswith(words)


def test_rosbridge_says_it_in_json() -> None:
    told: list[str] = []

    class Bridge:
        def call(self, service: str, write: Any, answered: Any) -> None:
            assert service == SERVICE and b'"uuid": [1, 1' in write("json")
            content = b'{"status": 6, "result": {"error_code": 204}}'
            answered(Reply(content, is_json=True))

    source: Any = Bridge()
    ask_why(source, "/goal_pose", b"\1" * 16, MessageTypes(), told.append)
    assert told == ["the goal is outside of the map (error 204)"]


def test_the_command_says_it_too(
    peer: NavigatorPeer, capsys: pytest.CaptureFixture[str]
) -> None:
    peer.statuses = (1, 2, 6)
    peer.serve(SERVICE, reply=jazzy(203))
    assert main(["goal", "1", "0", "0", "--source", peer.uri]) == 1
    said = capsys.readouterr().out.splitlines()
    assert said[-1] == "not reached: the robot is outside of the map (error 203)"
