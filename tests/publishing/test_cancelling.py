"""A goal is cancelled, by who has control or by STOP, or it is said why not."""

from __future__ import annotations

import struct
from collections.abc import Callable, Iterator
from typing import Any

import pytest
from inside import session_of, viser_server
from live_peers import eventually, knows_takers
from navigator_peer import NavigatorPeer
from protocol_client import ProtocolClient

from sambot_viz import Visualizer

CANCEL = "/navigate_to_pose/_action/cancel_goal"


def reply(code: int) -> bytes:
    """A CancelGoal_Response with a goal for success, else without, as CDR."""
    goals = 0 if code else 1
    head = b"\0\1\0\0" + code.to_bytes(1, "little") + b"\0\0\0"
    return head + goals.to_bytes(4, "little") + bytes(24 * goals)


NONE = b"\0\1\0\0" + bytes(8)
"""Success, of no goal."""


@pytest.fixture
def peer() -> Iterator[NavigatorPeer]:
    made = NavigatorPeer(statuses=(1, 2))
    yield made
    made.stop()


@pytest.fixture
def viz(peer: NavigatorPeer) -> Iterator[Visualizer]:
    with Visualizer(source=peer.uri, port=0, publish="") as viz:
        data = session_of(viz).data
        assert data is not None
        eventually(lambda: data.source.status.is_connected)
        eventually(lambda: "map" in session_of(viz).scene.context.tree.frames)
        knows_takers(data.source, peer)
        yield viz


@pytest.fixture
def client(viz: Visualizer, protocol: Callable[..., ProtocolClient]) -> ProtocolClient:
    client = protocol(viz.viser.get_port())
    client.settle(viser_server(viz))
    viz.publish_goal(1.0, 0.0, 0.0)
    eventually(lambda: goal(viz, client) == "on the way")
    return client


def goal(viz: Visualizer, client: ProtocolClient) -> str:
    client.settle(viser_server(viz))
    row: dict[str, Any] = client.rows.get("live/goal", {"value": ""})
    return str(row["value"])


@pytest.mark.parametrize("command", ["live/cancel", "live/stop"])
def test_a_goal_is_cancelled(
    peer: NavigatorPeer, viz: Visualizer, client: ProtocolClient, command: str
) -> None:
    peer.serve(CANCEL, reply=reply(0))
    # The service may be told of later than the topics.
    eventually(lambda: CANCEL in peer.calls() or client.act(command))
    assert set(peer.calls()) == {CANCEL}
    peer.tell(5)
    eventually(lambda: goal(viz, client) == "")


@pytest.mark.parametrize(
    ("answer", "why"),
    [
        (reply(1), "the robot refuses it"),
        (reply(2), "no such goal"),
        (reply(3), "has ended already"),
        (b"\0\1", "makes no sense"),
        (NONE, "cancels no goal"),
    ],
)
def test_what_is_not_cancelled_says_why_and_is_on_the_way(
    peer: NavigatorPeer,
    viz: Visualizer,
    client: ProtocolClient,
    answer: bytes,
    why: str,
) -> None:
    peer.serve(CANCEL, reply=answer)

    def told() -> bool:
        client.act("live/cancel")
        return why in goal(viz, client)

    eventually(told)
    assert goal(viz, client).startswith("not cancelled: ")


def test_a_bridge_that_hides_the_service_says_what_shows_it(
    viz: Visualizer, client: ProtocolClient
) -> None:
    client.act("live/cancel")
    eventually(lambda: "include_hidden:=true" in goal(viz, client))


def test_a_goal_that_ends_can_be_cancelled_no_longer(
    peer: NavigatorPeer, viz: Visualizer, client: ProtocolClient
) -> None:
    peer.tell(4)
    eventually(lambda: goal(viz, client) == "")
    client.act("live/cancel")
    client.settle(viser_server(viz))
    assert peer.calls() == []


FEEDBACK = "/navigate_to_pose/_action/feedback"
DEFINITION = """
unique_identifier_msgs/UUID goal_id
nav2_msgs/NavigateToPose_Feedback feedback
================================================================================
MSG: unique_identifier_msgs/UUID
uint8[16] uuid
================================================================================
MSG: nav2_msgs/NavigateToPose_Feedback
geometry_msgs/PoseStamped current_pose
builtin_interfaces/Duration navigation_time
builtin_interfaces/Duration estimated_time_remaining
int16 number_of_recoveries
float32 distance_remaining
"""


def test_it_is_said_how_far_a_goal_is(
    peer: NavigatorPeer, viz: Visualizer, client: ProtocolClient
) -> None:
    kind = "nav2_msgs/action/NavigateToPose_FeedbackMessage"
    peer.offer(FEEDBACK, kind, DEFINITION)
    pose = bytes(8) + b"\x01\0\0\0\0" + bytes(3) + bytes(56)
    tail = struct.pack("<iIiIhxxf", 3, 0, 12, 0, 0, 3.25)
    mine = bytes([2] * 16)
    peer.log(FEEDBACK, b"\0\1\0\0" + bytes([9] * 16) + pose + tail)

    def told() -> bool:
        # Each is looked at when some time has gone by since the last.
        peer.log(FEEDBACK, b"\0\1\0\0" + mine + pose + tail)
        return goal(viz, client) == "on the way: 3.2 m, about 12 s left"

    eventually(told)


def test_a_goal_that_goes_on_after_stop_is_said(
    viz: Visualizer, client: ProtocolClient
) -> None:
    client.act("live/stop")

    def said() -> str:
        client.settle(viser_server(viz))
        return str(client.row("live/state")["value"]["goal"])

    eventually(lambda: said().startswith("not cancelled: "))
    assert goal(viz, client) == said()


def test_a_cancel_has_a_line_with_who_pressed_it(
    viz: Visualizer, client: ProtocolClient
) -> None:
    client.act("live/cancel")

    def line() -> Any:
        client.settle(viser_server(viz))
        return client.row("sent/lines")["value"][0]

    eventually(lambda: line()["topic"] == CANCEL)
    assert (line()["who"], line()["values"]) == ("Viewer 1", "cancel all")
