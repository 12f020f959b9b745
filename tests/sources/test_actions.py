"""Goals of actions, over every transport: followed to their end, or refused."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from action_peers import (
    ACTION,
    INNER,
    KIND,
    ActionPeer,
    DdsAction,
    FoxgloveAction,
    RosbridgeAction,
    ZenohAction,
)
from live_peers import FoxglovePeer, LivePeer, cdr_string, eventually
from rosbridge_peer import RosbridgePeer

from sambot_viz.errors import SourceError
from sambot_viz.messages import MessageTypes
from sambot_viz.sources.bag import open_recording
from sambot_viz.sources.joined import JoinedSources
from sambot_viz.sources.live.followed_goal import FOLLOWED
from sambot_viz.sources.playback import RecordingPlayback
from sambot_viz.sources.prefixed_source import PrefixedSource
from sambot_viz.sources.registry import open_source
from sambot_viz.sources.source import GoalReport, OutgoingAction, Source

Open = Callable[[str], Source]
GOAL = "geometry_msgs/PoseStamped pose\nstring behavior_tree"
STATUS = f"{INNER}/status"


@pytest.fixture(params=[FoxgloveAction, RosbridgeAction, ZenohAction, DdsAction])
def robot(request: pytest.FixtureRequest) -> Iterator[ActionPeer]:
    made = request.param()
    yield made
    made.peer.stop()


@pytest.fixture
def source(robot: ActionPeer, opened: Open) -> Source:
    made = opened(robot.peer.uri)
    made.subscribe(STATUS, lambda message: None)
    return made


def action(source: Source, name: str = ACTION) -> OutgoingAction:
    """The action, when it is known that the robot has it."""
    found: list[OutgoingAction] = []
    eventually(lambda: found.append(source.action(name, KIND)) or True)
    return found[-1]


def fields(x: float, y: float) -> dict[str, Any]:
    pose = {"position": {"x": x, "y": y, "z": 0.0}}
    stamp = {"sec": 1, "nanosec": 2}
    return {"pose": {"header": {"stamp": stamp, "frame_id": "map"}, "pose": pose}}


def send(to: OutgoingAction, x: float = 1.0, y: float = 2.0) -> list[GoalReport]:
    """Send a goal, and return where its reports come."""
    return send_and_cancel(to, x, y)[0]


def send_and_cancel(
    to: OutgoingAction, x: float = 1.0, y: float = 2.0
) -> tuple[list[GoalReport], Callable[[], object]]:
    """Send a goal, and return where its reports come, and what cancels it."""
    made = fields(x, y)
    if to.encoding == "json":
        content = json.dumps({**made, "behavior_tree": ""}).encode()
    else:
        shape = MessageTypes().shape("nav2_msgs/NavigateToPose_Goal", GOAL)
        content = shape.as_cdr(made)
    reports: list[GoalReport] = []
    return reports, to.send(content, reports.append)


def last(reports: list[GoalReport]) -> GoalReport:
    """The end of a goal, when it has come."""
    eventually(lambda: reports[-1].is_last)
    return reports[-1]


def test_a_goal_is_followed_to_its_end(robot: ActionPeer, source: Source) -> None:
    reports = send(action(source), 1.5, -2.0)
    eventually(lambda: robot.places() == [(1.5, -2.0)])
    assert robot.frames() == ["map"]
    robot.go(3.25)
    eventually(lambda: reports[-1].feedback is not None)
    assert (reports[-1].status, reports[-1].is_last) == (2, False)
    robot.end(4)
    assert last(reports).status == 4
    assert not last(reports).refusal
    result = last(reports).result
    assert result is not None and result.content
    # Nothing is said behind the end.
    count = len(reports)
    more = send(action(source))
    eventually(lambda: len(robot.places()) == 2)
    robot.end(6, 208)
    assert last(more).status == 6
    assert len(reports) == count


def test_a_goal_that_is_not_taken_says_so(robot: ActionPeer, source: Source) -> None:
    to = action(source)
    robot.reject()
    assert "reject" in last(send(to)).refusal


def test_a_goal_is_cancelled(robot: ActionPeer, source: Source) -> None:
    reports, cancel = send_and_cancel(action(source))
    eventually(lambda: robot.places())
    cancel()
    eventually(lambda: robot.cancelled() >= 1)
    robot.end(5)
    assert last(reports).status == 5


def test_a_goal_that_is_cancelled_at_once_is_cancelled_when_the_robot_has_it(
    robot: ActionPeer, source: Source
) -> None:
    robot.hesitate()
    reports, cancel = send_and_cancel(action(source))
    cancel()
    eventually(lambda: robot.places())
    robot.go(1.0)
    eventually(lambda: robot.cancelled() >= 2)
    robot.end(5)
    assert last(reports).status == 5


def test_a_goal_holds_up_nothing_else(robot: ActionPeer, source: Source) -> None:
    send(action(source))
    eventually(lambda: robot.places())
    outgoing = source.advertise("/cmd_vel", "std_msgs/msg/String")
    is_json = outgoing.encoding == "json"
    outgoing.send(b'{"data": "stop"}' if is_json else cdr_string("stop"))
    eventually(lambda: [one.topic for one in robot.peer.came()] == ["/cmd_vel"])
    # Nor does it hold up another goal, which takes its place.
    send(action(source), 7.0, 8.0)
    eventually(lambda: robot.places()[1:] == [(7.0, 8.0)])


def test_a_goal_is_followed_as_long_as_the_connection_lasts(
    robot: ActionPeer, source: Source
) -> None:
    to = action(source)
    reports = send(to)
    eventually(lambda: robot.places())
    robot.peer.stop()
    assert "connection" in last(reports).refusal
    eventually(lambda: not source.status.is_connected)
    with pytest.raises(SourceError):
        source.action(ACTION, KIND)
    # Nothing is sent again.
    robot.peer.start()
    action(source)
    assert len(robot.places()) == 1


def test_closing_the_source_ends_the_goal(robot: ActionPeer, source: Source) -> None:
    reports = send(action(source))
    eventually(lambda: robot.places())
    source.close()
    assert last(reports).refusal == "the connection was lost"


def test_a_robot_without_the_action_says_what_would_show_it(
    peer: LivePeer, opened: Open
) -> None:
    peer.advertise(STATUS)
    source = opened(peer.uri)
    source.subscribe(STATUS, lambda message: None)
    eventually(lambda: STATUS in source.topics())
    why = {
        "foxglove": "include_hidden:=true",
        "rosbridge": "Jazzy",
        "zenoh": "the robot has no service",
        "dds": "the robot has no service",
    }[peer.uri.partition(":")[0]]
    with pytest.raises(SourceError, match=why):
        source.action(ACTION, KIND)
    if isinstance(peer, RosbridgePeer):
        # It was asked once, of a type that no robot has.
        eventually(lambda: peer.asked("send_action_goal"))
        (asked,) = peer.asked("send_action_goal")
        assert asked["action"] == ACTION and asked["action_type"] != KIND
        with pytest.raises(SourceError, match="no action /other"):
            source.action("/other", KIND)


def test_a_recording_takes_no_goal(repository: Path) -> None:
    recording = open_recording(repository / "assets/square.mcap")
    source = RecordingPlayback(recording, "r")
    with pytest.raises(SourceError, match="is a recording"):
        source.action(ACTION, KIND)
    recording.close()


def test_a_robot_with_a_prefix_has_the_action_under_it(robot: ActionPeer) -> None:
    first = FoxglovePeer()
    own = PrefixedSource(open_source(robot.peer.uri), "a")
    joined = JoinedSources([open_source(first.uri), own])
    joined.open()
    try:
        joined.subscribe(f"/a{STATUS}", lambda message: None)
        to = action(joined, f"/a{ACTION}")
        assert (to.frame_prefix, to.name) == ("a", ACTION)
        send(to)
        eventually(lambda: robot.places())
    finally:
        joined.close()
        first.stop()


def test_the_newest_goals_are_followed_where_a_robot_never_answers(
    robot: ActionPeer, source: Source
) -> None:
    to = action(source)
    every = [send(to, float(number)) for number in range(FOLLOWED + 1)]
    eventually(lambda: every[0])
    assert last(every[0]).refusal == "newer goals are followed"
    eventually(lambda: len(robot.places()) >= FOLLOWED)
    assert not any(every[1:])
