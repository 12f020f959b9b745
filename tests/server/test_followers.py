"""Followers show what an origin broadcasts through a router of zenoh."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import ExitStack, suppress
from dataclasses import dataclass

import pytest
from live_peers import WAIT
from protocol_client import ROW_PATCH, ProtocolClient
from zenoh_peer import ZenohPeer

from sambot_viz import Visualizer
from sambot_viz.options import Options
from sambot_viz.server.followers.start import follow
from sambot_viz.server.listener import Listener, listen

LEFT = "drivewhl_l_joint"
MOVED = ("SetOrientationMessage", "SetPositionMessage")


@dataclass
class FollowerServer:
    """A follower that serves pages."""

    listener: Listener

    @property
    def port(self) -> int:
        return self.listener.viser.get_port()


@pytest.fixture
def router() -> Iterator[ZenohPeer]:
    """A router, which forwards and knows nothing."""
    peer = ZenohPeer(has_nodes=False)
    yield peer
    peer.stop()


@pytest.fixture
def place(router: ZenohPeer) -> str:
    return f"{router.uri}/arm"


@pytest.fixture
def follower(place: str) -> Iterator[Callable[..., FollowerServer]]:
    """Start followers: ``follower(token="word")``."""
    with ExitStack() as stack:

        def start(**options: object) -> FollowerServer:
            made = Options(follow=place, port=0, **options)  # type: ignore[arg-type]
            listener = stack.enter_context(listen(made))
            stack.callback(follow(made, listener))
            return FollowerServer(listener)

        yield start


def nodes(client: ProtocolClient) -> set[str]:
    """The nodes of the scene that a page has."""
    made, gone = set[str](), "RemoveSceneNodeMessage"
    for one in client.messages:
        name = one.fields.get("name", "")
        if one.type == gone:
            made.discard(name)
        elif "props" in one.fields and name:
            made.add(name)
    return made


def state(client: ProtocolClient) -> dict[str, str]:
    """What a page knows of its origin."""
    patches = (m.fields for m in reversed(client.messages) if m.type == ROW_PATCH)
    [row] = next(p["panels"]["follower"] for p in patches if p["of"] == "follower")
    return row["value"]


def trouble(client: ProtocolClient) -> str:
    """Why a page does not show what its origin shows now; "" when it does."""
    return state(client)["trouble"]


def follows(client: ProtocolClient) -> bool:
    """Whether a page shows what its origin shows now."""
    with suppress(StopIteration):
        return state(client)["trouble"] == "" and "names/session" in client.rows
    return False


def moved_since(client: ProtocolClient, mark: int) -> list[str]:
    """The types of the messages that have moved something."""
    return [m.type for m in client.since(mark) if m.type in MOVED]


def test_a_follower_shows_the_scene_and_the_moved_joint_of_its_origin(
    make_viz: Callable[..., Visualizer],
    place: str,
    follower: Callable[..., FollowerServer],
    protocol: Callable[..., ProtocolClient],
) -> None:
    origin = make_viz(broadcast=place)
    here = protocol(origin.server.viser.get_port())
    client = protocol(follower().port)
    client.wait_until(lambda: follows(client), WAIT)
    client.wait_until(lambda: nodes(client) == nodes(here) != set())
    here_mark, mark = here.mark(), client.mark()
    origin.set_joint_positions({LEFT: 1.0})
    client.wait_until(lambda: client.rows[f"j/{LEFT}"]["value"] == pytest.approx(1.0))
    here.wait_until(lambda: len(moved_since(here, here_mark)) == 1)
    client.wait_until(lambda: len(moved_since(client, mark)) == 1)
    [there] = [m for m in here.since(here_mark) if m.type in MOVED]
    [moved] = [m for m in client.since(mark) if m.type in MOVED]
    assert moved.fields["name"] == there.fields["name"]
    assert moved.fields["wxyz"] == pytest.approx(there.fields["wxyz"])
