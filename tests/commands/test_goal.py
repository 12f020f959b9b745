"""`sambot-viz goal`: what is sent, to whom, and what is said of it."""

from __future__ import annotations

import math
import struct
from collections.abc import Callable
from typing import Any

import pytest
from live_peers import WAIT, FoxglovePeer, eventually
from navigator_peer import GOAL, NavigatorPeer
from patience import patience
from rosbridge_peer import RosbridgePeer, Topic

from sambot_viz.cli import main
from sambot_viz.publishing import goal_sender
from sambot_viz.publishing.goal_sender import GoalSender

Capture = pytest.CaptureFixture[str]
POSE_STAMPED = "geometry_msgs/msg/PoseStamped"


@pytest.fixture(autouse=True)
def slow(monkeypatch: pytest.MonkeyPatch) -> None:
    """What a robot may not say at all is waited for longer on a slow machine."""
    monkeypatch.setattr(goal_sender, "FOUND_WITHIN", patience(goal_sender.FOUND_WITHIN))


@pytest.fixture
def patient(monkeypatch: pytest.MonkeyPatch, slow: None) -> None:
    """What a robot says is waited for as long as it takes."""
    monkeypatch.setattr(goal_sender, "FOUND_WITHIN", WAIT)


def numbers_of(payload: bytes) -> tuple[str, tuple[float, ...]]:
    """The frame, and x, y, z of the place and of the quaternion, and w, of CDR."""
    (length,) = struct.unpack_from("<I", payload, 12)
    frame = payload[16 : 16 + length - 1].decode()
    return frame, struct.unpack_from("<7d", payload, len(payload) - 56)


@pytest.mark.usefixtures("patient")
def test_a_goal_is_sent_once_as_rviz_sends_it(
    navigator: Callable[..., NavigatorPeer], capsys: Capture
) -> None:
    peer = navigator()
    assert main(["goal", "-1.5", "2", "1.2", "--source", peer.uri]) == 0
    (came,) = peer.came()
    assert (came.topic, came.type_name) == (GOAL, POSE_STAMPED)
    # The size that RViz's message of this frame has.
    assert len(came.content) == 76
    frame, numbers = numbers_of(came.content)
    assert frame == "map"
    half = math.cos(0.6)
    turn = (0.0, 0.0, math.sin(1.2) / (2 * half), half)
    assert numbers == (-1.5, 2.0, 0.0, *turn)
    out = capsys.readouterr().out.splitlines()
    assert out[0].startswith("Setting goal pose: Frame:map, Position(-1.5, 2, 0)")
    assert out[1] == "sent to /goal_pose, which /bt_navigator takes"
    assert out[2:] == ["accepted", "on the way", "reached"]
    eventually(lambda: peer.advertised() == [])


@pytest.mark.usefixtures("patient")
@pytest.mark.parametrize(
    ("statuses", "code", "said"),
    [
        ((1, 2, 4), 0, "reached"),
        ((1, 2, 5), 1, "cancelled"),
        ((1, 2, 6), 1, "not reached: the robot has given it up"),
    ],
)
def test_what_becomes_of_it_is_the_exit_status(
    navigator: Callable[..., NavigatorPeer],
    capsys: Capture,
    statuses: tuple[int, ...],
    code: int,
    said: str,
) -> None:
    peer = navigator(*statuses)
    assert main(["goal", "1", "2", "0", "--source", peer.uri]) == code
    assert capsys.readouterr().out.splitlines()[-1] == said


@pytest.mark.usefixtures("patient")
def test_one_that_is_on_its_way_when_the_time_is_over_is_fine(
    navigator: Callable[..., NavigatorPeer],
    capsys: Capture,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    follow = GoalSender.follow

    def told_before(sender: GoalSender, *options: Any) -> Any:
        told = sender._outcomes  # pyright: ignore[reportPrivateUsage]
        eventually(lambda: len(told) == 2)
        return follow(sender, *options)

    monkeypatch.setattr(GoalSender, "follow", told_before)
    words = ["goal", "1", "2", "0", "--source"]
    assert main([*words, navigator(1, 2).uri, "--for", "0.5"]) == 0
    assert capsys.readouterr().out.endswith("still on the way after 0.5 s\n")
    # Nobody has waited for it.
    assert main([*words, navigator(1, 6).uri, "--no-wait"]) == 0
    assert "given it up" not in capsys.readouterr().out


@pytest.mark.parametrize(
    ("options", "words", "why"),
    [
        (
            {"refusal": "/goal_pose is not allowed"},
            [],
            "the robot refuses it: /goal_po",
        ),
        ({"node": ""}, [], "nobody has subscribed to /goal_pose: start Nav2"),
        ({}, ["-f", "mpa"], "did you mean 'map'"),
        ({"frames": {"base_link": "odom"}}, [], "'map'"),
        (
            {"frames": {"odom": "map", "b": "a"}},
            ["-f", "b"],
            "a transform between the two",
        ),
    ],
)
def test_why_nothing_becomes_of_it_is_said(
    navigator: Callable[..., NavigatorPeer],
    capsys: Capture,
    options: dict[str, Any],
    words: list[str],
    why: str,
) -> None:
    peer = navigator(**options)
    assert main(["goal", "1", "2", "0", "--source", peer.uri, *words]) == 1
    assert why in capsys.readouterr().err
    assert len(peer.came()) == bool(options.get("refusal"))


@pytest.mark.usefixtures("patient")
def test_a_robot_that_hides_its_actions_says_how_it_would_show_them(
    navigator: Callable[..., NavigatorPeer], capsys: Capture
) -> None:
    peer = navigator(is_hidden=True)
    assert main(["goal", "1", "2", "0", "--source", peer.uri]) == 0
    assert "include_hidden:=true" in capsys.readouterr().out
    # Nothing that the robot says was waited for.
    eventually(lambda: len(peer.came()) == 1)


def test_rosbridge_gets_json_with_the_time_of_its_server(capsys: Capture) -> None:
    peer = RosbridgePeer()
    peer.there[GOAL] = Topic(POSE_STAMPED)
    peer.listen_as(GOAL, "/bt_navigator")
    assert main(["goal", "1", "2", "0", "--source", peer.uri, "-f", "odom"]) == 0
    eventually(peer.came)
    (came,) = peer.came()
    assert came.content["header"] == {"stamp": "now", "frame_id": "odom"}
    assert came.content["pose"]["position"] == {"x": 1.0, "y": 2.0, "z": 0.0}
    assert all("latch" not in one for one in peer.operations)
    peer.stop()


def test_a_topic_of_another_type_is_refused(capsys: Capture) -> None:
    peer = FoxglovePeer()
    peer.advertise(GOAL)
    peer.listen_as(GOAL, "/bt_navigator")
    assert main(["goal", "1", "2", "0", "--source", peer.uri]) == 1
    assert "has messages of std_msgs/msg/String" in capsys.readouterr().err
    assert peer.came() == []
    peer.stop()


@pytest.mark.parametrize(
    ("words", "why"),
    [
        ("1 2 nan", "nan is not a number"),
        ("1e308 2 0", "1e308 is not a number from"),
        ("1 2 0", "name the robot: --source foxglove"),
        ("1 2 0 --source assets/square.mcap", "name the robot: --source foxglove"),
        ("1 2 0 x:=1 --source foxglove://h", "takes no NAME:=VALUE"),
        ("1 2 0 --at 3 --source foxglove://h", "--at is a time of a recording"),
    ],
)
def test_a_command_line_that_makes_no_sense(
    words: str, why: str, capsys: Capture
) -> None:
    try:
        code = main(["goal", *words.split()])
    except SystemExit as ended:
        code = ended.code
    assert code == 2
    assert why in capsys.readouterr().err
