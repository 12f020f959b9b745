"""The arrow at a goal that is on its way, in the scene of everyone."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import pytest
from inside import session_of, viser_server
from live_peers import WAIT, eventually
from navigator_peer import NavigatorPeer
from patience import until
from protocol_client import ProtocolClient, Received

from sambot_viz import Visualizer
from sambot_viz.errors import PublishError, PublishPaceError


@pytest.fixture
def peer() -> Iterator[NavigatorPeer]:
    made = NavigatorPeer(statuses=(1, 2))
    yield made
    made.stop()


@pytest.fixture
def viz(peer: NavigatorPeer) -> Iterator[Visualizer]:
    with Visualizer(source=peer.uri, port=0, publish="") as viz:
        session = session_of(viz)
        eventually(lambda: "base_link" in session.scene.context.tree.frames)
        fix(viz, "map")
        yield viz


@pytest.fixture
def page(viz: Visualizer, protocol: Callable[..., ProtocolClient]) -> ProtocolClient:
    """The page of somebody who has not sent the goal."""
    return protocol(viz.viser.get_port())


def fix(viz: Visualizer, frame: str) -> None:
    session = session_of(viz)
    with session.change():
        session.document.set_option("Fixed Frame", frame)


def mark(viz: Visualizer, page: ProtocolClient) -> Received | None:
    """The arrow that is shown; None for none."""
    page.settle(viser_server(viz))
    about = (m for m in page.messages if m.fields.get("name", "").endswith("/~goal"))
    last: dict[str, Received] = {}
    for message in about:
        if message.type == "RemoveSceneNodeMessage":
            last.pop(message.fields["name"], None)
        elif "props" in message.fields:
            last[message.fields["name"]] = message
    assert len(last) <= 1
    return next(iter(last.values()), None)


def goal_says(viz: Visualizer, words: str) -> bool:
    goals = session_of(viz).publisher.goals
    return goals is not None and goals.last is not None and goals.last.words == words


def test_a_goal_is_shown_from_sending_until_it_is_reached(
    peer: NavigatorPeer, viz: Visualizer, page: ProtocolClient
) -> None:
    assert mark(viz, page) is None
    viz.publish_goal(1.5, -2.0, 0.0)
    eventually(lambda: mark(viz, page) is not None)
    shown = mark(viz, page)
    assert shown is not None and shown.fields["name"] == "/~goal"
    eventually(lambda: goal_says(viz, "on the way"))
    assert mark(viz, page) is shown
    peer.tell(4)
    eventually(lambda: mark(viz, page) is None)


@pytest.mark.parametrize("status", [5, 6])
def test_a_goal_that_is_cancelled_or_given_up_is_shown_no_longer(
    peer: NavigatorPeer, viz: Visualizer, page: ProtocolClient, status: int
) -> None:
    viz.publish_goal(1.5, -2.0, 0.0)
    eventually(lambda: goal_says(viz, "on the way"))
    eventually(lambda: mark(viz, page) is not None)
    peer.tell(status)
    eventually(lambda: mark(viz, page) is None)


def test_a_goal_that_the_bridge_refuses_is_shown_no_longer_and_says_why(
    peer: NavigatorPeer, viz: Visualizer, page: ProtocolClient
) -> None:
    peer.refusal = "failed to load type support for '/goal_pose'"
    viz.publish_goal(1.5, -2.0, 0.0)
    eventually(lambda: goal_says(viz, f"the robot refuses it: {peer.refusal}"))
    eventually(lambda: mark(viz, page) is None)
    # The next one is sent again, once the refusal of the last was said.
    peer.refusal = ""
    until(lambda: viz.publish_goal(1.5, -2.0, 0.0), WAIT, not_yet=PublishError)
    eventually(lambda: goal_says(viz, "on the way"))
    eventually(lambda: mark(viz, page) is not None)


def test_the_next_goal_takes_the_place_of_the_last(
    viz: Visualizer, page: ProtocolClient
) -> None:
    viz.publish_goal(1.5, -2.0, 0.0)
    eventually(lambda: mark(viz, page) is not None)
    first = mark(viz, page)
    until(
        lambda: viz.publish_goal(3.0, 0.0, 1.0),
        WAIT,
        # A goal that comes too soon after the last one is refused.
        not_yet=PublishPaceError,
    )
    eventually(lambda: mark(viz, page) not in (None, first))


def test_a_goal_stays_in_its_frame_when_another_one_is_fixed(
    viz: Visualizer, page: ProtocolClient
) -> None:
    viz.publish_goal(1.5, -2.0, 0.0)
    eventually(lambda: mark(viz, page) is not None)
    fix(viz, "base_link")
    above = session_of(viz).scene.context.nodes.path("map")

    def name() -> str:
        shown = mark(viz, page)
        return "" if shown is None else shown.fields["name"]

    eventually(lambda: name() == f"{above}/~goal")
    # Where nothing leads to the goal it has no place in the picture.
    fix(viz, "elsewhere")
    eventually(lambda: name() == "")
    fix(viz, "map")
    eventually(lambda: name() == "/~goal")


def test_somebody_who_comes_later_sees_the_goal(
    viz: Visualizer, page: ProtocolClient, protocol: Callable[..., ProtocolClient]
) -> None:
    viz.publish_goal(1.5, -2.0, 0.0)
    eventually(lambda: mark(viz, page) is not None)
    assert mark(viz, protocol(viz.viser.get_port())) is not None
