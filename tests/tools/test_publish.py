"""The tools that send something to a robot: when, what, to whom, and what is said."""

from __future__ import annotations

import json
import math
import struct
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from action_peers import ACTION, KIND, FoxgloveAction
from hand import Hand
from inside import session_of, viser_server
from live_peers import eventually, knows_takers
from navigator_peer import GOAL, NavigatorPeer, transforms
from protocol_client import ProtocolClient, wait_for_workers

from sambot_viz import Visualizer
from sambot_viz.errors import PublishError, UsageError
from sambot_viz.publishing import publisher

CONFIG = """
Visualization Manager:
  Global Options: {{Fixed Frame: {frame}}}
  Displays:
    - Class: rviz_default_plugins/RobotModel
      Enabled: true
      Description Topic: {{Value: /robot_description}}
  Tools:
    - {{Class: rviz_default_plugins/MoveCamera}}
    - Class: rviz_default_plugins/SetInitialPose
      Covariance x: 0.5
      Topic: {{Value: initialpose}}
    - Class: rviz_default_plugins/SetGoal
      Topic: {{Depth: 5, Value: /goal_pose}}
    - {{Class: nav2_rviz_plugins/GoalTool}}
    - Class: rviz_default_plugins/PublishPoint
      Single click: true
      Topic: {{Value: /clicked_point}}
"""
ALL = "goal,pose,point"


@pytest.fixture
def hand(
    tmp_path: Path, protocol: Callable[..., ProtocolClient]
) -> Iterator[Callable[..., Hand]]:
    made: list[Visualizer] = []

    def make(peer: NavigatorPeer, frame: str = "map", **options: Any) -> Hand:
        config = tmp_path / "a.rviz"
        config.write_text(CONFIG.format(frame=frame))
        prefix = options.pop("prefix", "")
        if prefix:
            uri, options["source_prefix"] = f"robot={peer.uri}", {"robot": prefix}
        else:
            uri = peer.uri
        viz = Visualizer(source=uri, config=config, port=0, **options)
        made.append(viz)
        data = session_of(viz).data
        assert data is not None
        found = Hand(viz, protocol(viz.viser.get_port()))
        eventually(lambda: data.source.status.is_connected)
        known = session_of(viz).scene.context.tree
        eventually(lambda: f"{prefix}/map".lstrip("/") in known.frames)
        knows_takers(data.source, peer, prefix)
        wait_for_workers()
        return found

    yield make
    for viz in made:
        viz.stop()


def pose_of(payload: bytes, behind: int = 0) -> tuple[float, ...]:
    """The place and the quaternion at the end of CDR, before so many bytes."""
    return struct.unpack_from("<7d", payload, len(payload) - behind - 56)


def test_a_drag_sends_the_place_and_the_heading_and_leaves_the_tool(
    navigator: Callable[..., NavigatorPeer], hand: Callable[..., Hand]
) -> None:
    peer = navigator()
    page = hand(peer, publish="")
    page.choose("2D Goal Pose")
    eventually(lambda: peer.advertised() == [(GOAL, "geometry_msgs/msg/PoseStamped")])
    # From the middle to the right, which is x, and upwards, which is y.
    page.drag((0.5, 0.5), (0.6, 0.5), (0.6, 0.6), ends=False)
    assert page.draws() and peer.came() == []
    page.drag((0.5, 0.5), (0.6, 0.5 - 0.1 * 640 / 480))
    eventually(lambda: len(peer.came()) == 1)
    (came,) = peer.came()
    x, y, z, *_, qz, qw = pose_of(came.content)
    assert (x, y, z) == pytest.approx((0.0, 0.0, 0.0), abs=1e-6)
    assert 2.0 * math.atan2(qz, qw) == pytest.approx(math.pi / 4)
    assert page.current == "Move Camera" and not page.draws()
    eventually(lambda: page.said == "Reached.")


def test_a_drag_of_which_only_the_end_is_left_sends_the_same(
    navigator: Callable[..., NavigatorPeer], hand: Callable[..., Hand]
) -> None:
    peer = navigator()
    page = hand(peer, publish="")
    page.choose("2D Goal Pose")
    # A server that has much to do takes the last move of a drag only.
    page.act("tools/drop", 0.5, 0.5, 0.6, 0.5, None)
    eventually(lambda: len(peer.came()) == 1)
    assert pose_of(peer.came()[0].content)[:2] == pytest.approx((0.0, 0.0), abs=1e-6)


def test_a_refused_frame_is_put_right_with_a_button(
    navigator: Callable[..., NavigatorPeer], hand: Callable[..., Hand]
) -> None:
    peer = navigator()
    peer.listen_as("/initialpose", "/amcl")
    page = hand(peer, "odom", publish="")
    page.choose("2D Pose Estimate")
    page.drag((0.5, 0.5), (0.6, 0.5))
    assert "AMCL takes poses in map only" in page.said
    assert page.client.row("tools/wants_map")["value"] is True
    page.act("tools/use_map")
    assert page.client.row("tools/wants_map")["value"] is False
    assert page.current == "2D Pose Estimate" and "AMCL" not in page.said
    page.drag((0.5, 0.5), (0.6, 0.5))
    eventually(lambda: len(peer.came()) == 1)


def test_a_pose_by_numbers_is_shown_before_it_is_sent(
    navigator: Callable[..., NavigatorPeer], hand: Callable[..., Hand]
) -> None:
    peer = navigator()
    page = hand(peer, publish="")
    # Without a tool that takes a pose nothing is meant.
    page.act("tools/send", 1.0, 2.0, 0.5)
    page.choose("2D Goal Pose")
    page.act("tools/preview", 1.0, 2.0, 0.5)
    assert page.draws() and peer.came() == []
    page.act("tools/right_click")
    assert not page.draws()
    page.act("tools/send", 1.5, -2.0, 0.5)
    eventually(lambda: len(peer.came()) == 1)
    x, y, z, *_, qz, qw = pose_of(peer.came()[0].content)
    assert (x, y, z) == (1.5, -2.0, 0.0)
    assert 2.0 * math.atan2(qz, qw) == pytest.approx(0.5)
    assert page.current == "Move Camera" and not page.draws()


@pytest.mark.parametrize("prefix", ["", "a"])
def test_the_tool_of_nav2_sends_to_its_action(
    hand: Callable[..., Hand], prefix: str
) -> None:
    robot = FoxgloveAction()
    frame = f"{prefix}/map".lstrip("/")
    page = hand(robot.peer, frame, publish="", prefix=prefix)
    page.choose("Nav2 Goal")
    data = session_of(page.viz).data
    assert data is not None
    eventually(lambda: data.source.action(ACTION, KIND))
    page.act("tools/send", 1.5, -2.0, 0.5)
    eventually(lambda: robot.places() == [(1.5, -2.0)])
    assert robot.frames() == ["map"]
    assert page.said == f"Sent to {ACTION}." and page.current == "Move Camera"
    robot.end(4)
    eventually(lambda: page.said == "Reached.")
    assert robot.peer.came() == []
    robot.peer.stop()


def test_a_robot_with_a_prefix_gets_the_names_of_its_own_frames(
    navigator: Callable[..., NavigatorPeer], hand: Callable[..., Hand]
) -> None:
    peer = navigator()
    page = hand(peer, "a/map", publish="", prefix="a")
    page.choose("2D Goal Pose")
    page.act("tools/drop", 0.5, 0.5, 0.6, 0.5, None)
    eventually(lambda: len(peer.came()) == 1)
    (came,) = peer.came()
    assert came.topic == GOAL
    # The stamp, then the name of the frame with its end.
    assert bytes(came.content)[12:20] == b"\x04\0\0\0map\0"


def test_an_estimate_has_the_covariance_of_the_properties(
    navigator: Callable[..., NavigatorPeer], hand: Callable[..., Hand]
) -> None:
    peer = navigator()
    peer.listen_as("/initialpose", "/amcl")
    page = hand(peer, publish=ALL)
    page.choose("2D Pose Estimate")
    # Before that it is not known who takes it.
    eventually(peer.advertised)
    page.drag((0.5, 0.5), (0.6, 0.5))
    eventually(lambda: len(peer.came()) == 1)
    (came,) = peer.came()
    assert came.topic == "/initialpose"
    assert len(came.content) == 364
    matrix = struct.unpack_from("<36d", came.content, len(came.content) - 288)
    told = {n: value for n, value in enumerate(matrix) if value}
    assert told == {0: 0.5, 7: 0.25, 35: pytest.approx((math.pi / 12) ** 2)}
    assert page.said == "Sent to /initialpose, which /amcl takes."


def test_what_is_clicked_on_is_sent_as_a_point(
    navigator: Callable[..., NavigatorPeer], hand: Callable[..., Hand]
) -> None:
    peer = navigator()
    peer.listen_as("/clicked_point", "/waypoints")
    page = hand(peer, publish="point", model="assets/sam_bot.urdf.xacro")
    page.choose("Publish Point")
    ray = {"ray_direction": (0.0, 0.0, -1.0), "screen_pos": ((0.5, 0.5),)}
    for origin in ((50.0, 0.0, 5.0), (0.0, 0.0, 5.0)):
        page.client.send(
            "ScenePointerMessage",
            event_type="click",
            ray_origin=origin,
            modifier=None,
            **ray,
        )
        page.client.settle(viser_server(page.viz))
        if origin[0]:
            assert page.said.startswith("Nothing is there to click on")
    eventually(lambda: len(peer.came()) == 1)
    (came,) = peer.came()
    assert (came.topic, len(came.content)) == ("/clicked_point", 44)
    x, y, z = struct.unpack_from("<3d", came.content, 20)
    assert (x, y) == pytest.approx((0.0, 0.0)) and z > 0.05


@pytest.mark.parametrize(
    ("options", "frame", "why"),
    [
        ({}, "map", "start with --publish goal to allow it"),
        ({"publish": "pose,point"}, "map", "start with --publish goal to allow it"),
        ({"publish": ALL}, "island", "no frame 'island'"),
        ({"publish": ALL, "presenter": "a-long-word"}, "map", "View only"),
    ],
)
def test_what_may_not_be_sent_is_not_sent_and_says_why(
    navigator: Callable[..., NavigatorPeer],
    hand: Callable[..., Hand],
    options: dict[str, Any],
    frame: str,
    why: str,
) -> None:
    peer = navigator()
    page = hand(peer, frame, **options)
    page.choose("2D Goal Pose")
    page.drag((0.5, 0.5), (0.6, 0.5))
    assert why in page.said
    assert page.current == "2D Goal Pose"
    wait_for_workers()
    assert peer.came() == []
    if frame == "island":
        eventually(peer.advertised)
    assert bool(peer.advertised()) == (frame == "island")


def test_a_private_copy_sends_nothing(
    navigator: Callable[..., NavigatorPeer],
    tmp_path: Path,
    protocol: Callable[..., ProtocolClient],
) -> None:
    peer = navigator()
    with Visualizer(source=peer.uri, port=0, session="private", publish="") as viz:
        client = protocol(viz.viser.get_port())
        client.settle(viser_server(viz))
        client.act("tools/choose", "2D Goal Pose")
        client.settle(viser_server(viz))
        said = str(client.row("tools/hint")["value"]["text"])
        assert said == "a private copy sends nothing to the robot"
    assert peer.advertised() == []


def test_without_a_heading_with_esc_and_beside_the_ground_nothing_is_sent(
    navigator: Callable[..., NavigatorPeer], hand: Callable[..., Hand]
) -> None:
    peer = navigator()
    page = hand(peer, publish="")
    page.choose("2D Goal Pose")
    page.drag((0.5, 0.5))
    assert page.said.startswith("Nothing was sent without a heading")
    page.drag((0.5, 0.5), (0.7, 0.5), ends=False)
    page.act("tools/escape")
    assert not page.draws()
    page.act("tools/drop", 0.5, 0.5, 0.7, 0.5, None)
    page.choose("2D Goal Pose")
    # Along the ground nobody means a place, however far it is.
    page.look((0.5, -0.5, 0.5, -0.5), (0.0, 0.0, 1.0))
    for y in (0.4, 0.51):
        page.drag((0.5, y), (0.6, y))
        assert page.said.startswith("There is no ground")
    page.drag((0.5, 0.6), (0.6, 0.6), ends=False)
    assert page.draws()
    page.act("tools/escape")
    page.look((0.0, 1.0, 0.0, 0.0), (0.0, 0.0, 5.0))
    page.choose("2D Goal Pose")
    # What is left of the last gesture is not taken for this one.
    page.drag((0.2, 0.2))
    page.client.edit("tools/drag", [7.0, float("1e300"), 0.5, 0.5, None])
    page.client.settle(viser_server(page.viz))
    assert peer.came() == []


def test_what_was_sent_is_in_the_log(
    navigator: Callable[..., NavigatorPeer],
    hand: Callable[..., Hand],
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
) -> None:
    peer, log = navigator(), tmp_path / "sent.jsonl"
    page = hand(peer, publish="goal", publish_log=log)
    for _ in range(2):
        page.choose("2D Goal Pose")
        page.drag((0.5, 0.5), (0.6, 0.5))
        eventually(lambda: page.said == "Reached.")
    lines = [json.loads(line) for line in log.read_text().splitlines()]
    assert [one["topic"] for one in lines] == [GOAL, GOAL]
    assert {one["who"] for one in lines} == {"Viewer 1"}
    assert lines[0]["frame"] == "map"
    assert "Viewer 1: Setting goal pose: Frame:map" in capsys.readouterr().err


def test_a_program_sends_a_goal_where_it_may(
    navigator: Callable[..., NavigatorPeer], hand: Callable[..., Hand]
) -> None:
    peer = navigator()
    viz = hand(peer, publish="goal").viz
    assert viz.publish_goal(1.0, 2.0, 0.0) == "/goal_pose, which /bt_navigator takes"
    eventually(lambda: len(peer.came()) == 1)
    assert pose_of(peer.came()[0].content)[:3] == (1.0, 2.0, 0.0)
    for place, frame, why in (
        ((math.nan, 0.0, 0.0), "map", "a goal needs finite numbers"),
        ((0.0, 0.0, 0.0), "mpa", "did you mean 'map'"),
    ):
        with pytest.raises(PublishError, match=why):
            viz.publish_goal(*place, frame)
    with pytest.raises(PublishError, match="start with --publish goal"):
        hand(navigator()).viz.publish_goal(0.0, 0.0, 0.0)


def test_the_buttons_are_there_with_a_live_robot_alone(
    navigator: Callable[..., NavigatorPeer],
    hand: Callable[..., Hand],
    protocol: Callable[..., ProtocolClient],
) -> None:
    sending = {"2D Pose Estimate", "2D Goal Pose", "Nav2 Goal", "Publish Point"}
    assert sending <= set(hand(navigator()).labels)
    with Visualizer(source="bag:assets/square.mcap", port=0) as viz:
        client = protocol(viz.viser.get_port())
        client.settle(viser_server(viz))
        listed = client.row("tools/list")["value"]
        assert not sending & {tool["name"] for tool in listed}


@pytest.mark.parametrize(
    ("options", "why"),
    [
        ({"publish": ""}, "--publish needs a live robot"),
        ({"publish": "fly", "source": "foxglove://h"}, "'fly' cannot be sent; there a"),
        ({"publish_log": "a", "source": "foxglove://h"}, "--publish-log needs --publi"),
    ],
)
def test_options_that_make_no_sense(options: dict[str, Any], why: str) -> None:
    with pytest.raises(UsageError, match=why):
        Visualizer(port=0, **options)


def test_a_topic_that_is_changed_again_and_again_is_let_go(
    navigator: Callable[..., NavigatorPeer], hand: Callable[..., Hand]
) -> None:
    peer = navigator()
    page = hand(peer, publish="goal")
    page.choose("2D Goal Pose")
    topic = "tool_properties/2D Goal Pose/Topic"
    for number in range(30):
        page.client.edit(topic, f"/goal{number}")
    page.client.edit(topic, GOAL)
    page.client.settle(viser_server(page.viz))
    eventually(lambda: (GOAL, "geometry_msgs/msg/PoseStamped") in peer.advertised())
    eventually(lambda: len(peer.advertised()) <= 8)
    page.drag((0.5, 0.5), (0.6, 0.5))
    eventually(lambda: page.said == "Reached.")


def test_after_the_connection_was_lost_a_goal_goes_over_the_new_one(
    navigator: Callable[..., NavigatorPeer], hand: Callable[..., Hand]
) -> None:
    peer = navigator()
    page = hand(peer, publish="goal")
    data = session_of(page.viz).data
    assert data is not None
    page.choose("2D Goal Pose")
    page.drag((0.5, 0.5), (0.6, 0.5))
    eventually(lambda: page.said == "Reached.")
    peer.stop()
    eventually(lambda: not data.source.status.is_connected)
    page.choose("2D Goal Pose")
    page.drag((0.5, 0.5), (0.6, 0.5))
    assert "othing" in page.said and "sent" in page.said
    peer.start()
    eventually(lambda: data.source.status.is_connected)
    # What was not sent then is not sent now.
    assert len(peer.came()) == 1
    peer.listen_as(GOAL, "/bt_navigator")

    def is_sent() -> bool:
        page.choose("2D Goal Pose")
        page.drag((0.5, 0.5), (0.6, 0.5))
        return len(peer.came()) >= 2

    eventually(is_sent)


def test_a_page_that_floods_sends_no_more_than_a_hand(
    navigator: Callable[..., NavigatorPeer],
    hand: Callable[..., Hand],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    # However long it takes, all of it comes too soon after the first one.
    monkeypatch.setattr(publisher, "FASTEST", 1e9)
    peer = navigator()
    page = hand(peer, publish="goal")
    page.choose("2D Goal Pose")
    eventually(lambda: peer.advertised() != [])
    for number in range(2000):
        page.client.edit("tools/choose", ["2D Goal Pose"])
        page.client.edit("tools/send", [number, 0.0, 0.0])
    page.client.settle(viser_server(page.viz), timeout=60.0)
    assert peer.came() == [] and "too fast" in page.said


def test_stamps_are_those_of_a_robot_whose_clock_is_far_off(
    navigator: Callable[..., NavigatorPeer], hand: Callable[..., Hand]
) -> None:
    peer = navigator()
    page = hand(peer, publish="goal")
    # Of another year: its clock is not that of this machine.
    told = 1_500_000_000
    peer.offer("/tf", "tf2_msgs/msg/TFMessage")
    data = session_of(page.viz).data
    assert data is not None
    moved = transforms({"wheel": "base_link"}, told)

    def knows_its_time() -> bool:
        peer.log("/tf", moved)
        return data.stamp_ns() == told * 10**9

    eventually(knows_its_time)
    page.choose("2D Goal Pose")
    page.act("tools/send", 1.0, 0.0, 0.0)
    eventually(lambda: len(peer.came()) == 1)
    (came,) = peer.came()
    assert struct.unpack_from("<iI", came.content, 4) == (told, 0)


def test_a_type_that_the_bridge_does_not_know_is_said_in_its_words(
    navigator: Callable[..., NavigatorPeer], hand: Callable[..., Hand]
) -> None:
    words = "failed to load type support for '/goal_pose'"
    peer = navigator(refusal=words)
    page = hand(peer, publish="goal")
    page.choose("2D Goal Pose")
    page.act("tools/send", 1.0, 0.0, 0.0)
    eventually(lambda: len(peer.came()) == 1)
    page.choose("2D Goal Pose")

    def says_why() -> bool:
        page.act("tools/send", 1.0, 0.0, 0.0)
        return words in page.said

    eventually(says_why)
