"""What travels to the browsers of a running viewer, message by message."""

from __future__ import annotations

import math
from collections.abc import Callable
from urllib.parse import urlsplit

import pytest
from hand_clock import HandClock
from inside import node_of, viser_server
from protocol_client import ROW_PATCH, ProtocolClient, wait_for_workers

from sambot_viz import Visualizer

JOINT, LINK = "drivewhl_l_joint", "drivewhl_l_link"
TRANSFORMS = ("SetOrientationMessage", "SetPositionMessage")


@pytest.fixture
def join(
    viz: Visualizer, protocol: Callable[[int], ProtocolClient]
) -> Callable[[], ProtocolClient]:
    """Connect one more client that has received everything there is."""

    def connect() -> ProtocolClient:
        client = protocol(urlsplit(viz.url).port or 0)
        client.settle(viser_server(viz))
        return client

    return connect


def turned(client: ProtocolClient, node: str, angle: float) -> bool:
    """Whether the last pose that the client got turns the node about y by `angle`."""
    turns = [
        message.fields["wxyz"]
        for message in client.messages
        if message.type == "SetOrientationMessage" and message.fields["name"] == node
    ]
    wanted = (math.cos(angle / 2), 0.0, math.sin(angle / 2), 0.0)
    return turns != [] and turns[-1] == pytest.approx(wanted, abs=1e-5)


def test_one_step_of_a_joint_is_a_pose_and_a_changed_row_to_each_browser(
    viz: Visualizer, join: Callable[[], ProtocolClient]
) -> None:
    first, second, third = clients = [join() for _ in range(3)]
    for client in clients:
        client.settle(viser_server(viz))
    marks = [client.mark() for client in clients]
    first.edit(first.id_of("joints", JOINT), 0.5)
    first.wait_until(lambda: viz.joint_positions[JOINT] == pytest.approx(0.5))
    # What asks for rows while they are changed gets them in two parts.
    wait_for_workers()
    for client in clients:
        client.settle(viser_server(viz))
    for client, mark in zip(clients, marks, strict=True):
        sent = client.since(mark)
        (pose,) = (message for message in sent if message.type in TRANSFORMS)
        change, *own = (message for message in sent if message.type == ROW_PATCH)
        assert len(sent) == 2 + len(own)
        assert pose.fields["name"] == node_of(viz, LINK)
        assert pose.size < 200
        assert change.fields["of"] == "session" and change.frame_size < 120
        # The one who did it can undo it now.
        assert len(own) == (client is first)
    for client in (first, second, third):
        assert client.shown("joints", JOINT) == pytest.approx(0.5)


def test_an_idle_server_sends_nothing(
    hand_clock: HandClock, viz: Visualizer, join: Callable[[], ProtocolClient]
) -> None:
    client = join()
    mark = client.mark()
    for _ in range(20):
        hand_clock.advance(60.0)
        client.settle(viser_server(viz))
    assert client.since(mark) == []


@pytest.mark.parametrize("attempt", range(5))
def test_fifty_quick_steps_end_with_row_pose_and_api_equal(
    viz: Visualizer, join: Callable[[], ProtocolClient], attempt: int
) -> None:
    first, second = join(), join()
    row = first.id_of("joints", JOINT)
    for step in range(1, 51):
        first.edit(row, round(step * 0.01 + attempt * 0.1, 6), gesture=attempt + 1)
    last = 0.5 + attempt * 0.1
    for client in (first, second):
        # Poses of a stream go out at the config's Frame Rate, the last one included.
        client.wait_until(lambda c=client: turned(c, node_of(viz, LINK), last))
        client.settle(viser_server(viz))
        assert turned(client, node_of(viz, LINK), last)
    assert viz.joint_positions[JOINT] == pytest.approx(last)
    for client in (first, second):
        # Rows of a stream go out at a rate of their own.
        client.wait_until(
            lambda c=client: c.shown("joints", JOINT) == pytest.approx(last)
        )
    T = viz.frames.lookup("base_link", LINK).matrix
    assert T[0, 0] == pytest.approx(math.cos(last))


def test_a_position_set_from_python_reaches_the_rows(
    viz: Visualizer, join: Callable[[], ProtocolClient]
) -> None:
    client = join()
    viz.set_joint_positions({JOINT: -1.25})
    client.wait_until(lambda: client.shown("joints", JOINT) == pytest.approx(-1.25))


def test_a_browser_that_comes_later_sees_the_present_state(
    viz: Visualizer, join: Callable[[], ProtocolClient]
) -> None:
    viz.set_joint_positions({JOINT: 0.75})
    late = join()
    late.wait_until(lambda: late.shown("joints", JOINT) == pytest.approx(0.75))


def test_the_robot_is_sent_before_the_rows(
    join: Callable[[], ProtocolClient],
) -> None:
    client = join()
    assert client.rows
    types = [message.type for message in client.messages]
    assert types.index("BoxMessage") < types.index(ROW_PATCH)
    assert types.index("CylinderMessage") < types.index(ROW_PATCH)
