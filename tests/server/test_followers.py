"""Followers show what an origin broadcasts through a router of zenoh."""

from __future__ import annotations

import itertools
import json
import re
import sys
import threading
from collections.abc import Callable, Iterator
from contextlib import ExitStack, suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest
import zenoh
from a_certificate import self_signed, tls_settings
from inside import session_of
from live_peers import WAIT
from page_rows import PageRows, decode
from patience import until
from protocol_client import CAMERA_ASKED, ROW_PATCH, ProtocolClient
from websockets.exceptions import InvalidStatus
from websockets.sync.client import connect
from websockets.typing import Subprotocol
from zenoh_peer import ZenohPeer

from sambot_viz import UsageError, Visualizer
from sambot_viz.options import Options
from sambot_viz.server.channel import SUBPROTOCOL
from sambot_viz.server.followers.follower import MOST_BEHIND, follow
from sambot_viz.server.followers.wire import VERSION, Label, Snapshot
from sambot_viz.server.listener import Listener, listen
from sambot_viz.sources.broadcast_place import (
    BroadcastPlace,
    origin_of,
    parse_place,
)

LEFT = "drivewhl_l_joint"
MOVED = ("SetOrientationMessage", "SetPositionMessage")


@dataclass
class FollowerServer:
    """A follower that serves pages."""

    listener: Listener
    protocol: Callable[..., ProtocolClient]

    @property
    def port(self) -> int:
        return self.listener.viser.get_port()

    def page(self) -> ProtocolClient:
        """Open a page, and wait until it shows what its origin shows."""
        client = self.protocol(self.port)
        client.wait_until(lambda: follows(client), WAIT)
        client.settle(self.listener.viser)
        return client


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
def follower(
    place: str, protocol: Callable[..., ProtocolClient]
) -> Iterator[Callable[..., FollowerServer]]:
    """Start followers: ``follower(token="word")``."""
    with ExitStack() as stack:

        def start(**options: object) -> FollowerServer:
            made = Options(follow=place, port=0, **options)  # type: ignore[arg-type]
            listener = stack.enter_context(listen(made))
            stack.callback(follow(made, listener))
            return FollowerServer(listener, protocol)

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
        there = {"names/session", "role/me"} <= client.rows.keys()
        return there and state(client)["trouble"] == ""
    return False


def said(client: ProtocolClient) -> str:
    """What a page says that has nothing else yet."""
    with suppress(StopIteration):
        return trouble(client)
    return ""


def leads_to(client: ProtocolClient) -> str:
    """The address of the origin in a page; "" when it has none yet."""
    with suppress(StopIteration):
        return state(client)["origin"]
    return ""


def poses(client: ProtocolClient) -> dict[tuple[str, str], Any]:
    """Where a page has its nodes, by their names."""
    found = (m for m in client.messages if m.type in MOVED)
    return {
        (m.type, m.fields["name"]): m.fields.get("wxyz", m.fields.get("position"))
        for m in found
    }


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
    client = follower().page()
    client.wait_until(lambda: nodes(client) == nodes(here) != set())
    # The view of the config, as each new page is asked for it.
    asked = [m.fields for m in client.messages if m.type == CAMERA_ASKED]
    assert asked[-1]["camera"]["look_at"] == pytest.approx([0.0, 0.0, 0.0], abs=1.0)
    here_mark, mark = here.mark(), client.mark()
    origin.set_joint_positions({LEFT: 1.0})
    client.wait_until(lambda: client.rows[f"j/{LEFT}"]["value"] == pytest.approx(1.0))
    here.wait_until(lambda: len(moved_since(here, here_mark)) == 1)
    client.wait_until(lambda: len(moved_since(client, mark)) == 1)
    [there] = [m for m in here.since(here_mark) if m.type in MOVED]
    [moved] = [m for m in client.since(mark) if m.type in MOVED]
    assert moved.fields["name"] == there.fields["name"]
    assert moved.fields["wxyz"] == pytest.approx(there.fields["wxyz"])


def test_a_page_only_looks_and_leads_to_its_origin(
    make_viz: Callable[..., Visualizer],
    place: str,
    follower: Callable[..., FollowerServer],
) -> None:
    origin = make_viz(broadcast=place, presenter="presenter-secret", token="the-token")
    client = follower().page()
    assert client.rows["role/me"]["value"]["control"] is False
    port = origin.server.viser.get_port()
    assert state(client)["origin"] == f"http://127.0.0.1:{port}"
    client.edit(f"j/{LEFT}", 1.0)
    client.act("role/request", "Ada")
    client.settle_channel()
    assert origin.joint_positions[LEFT] == 0.0
    assert [p.name for p in session_of(origin).roles.people.values()] == ["Followers"]
    assert not any(p.requests for p in session_of(origin).roles.people.values())


def test_without_a_presenter_a_page_of_a_follower_has_no_control_either(
    make_viz: Callable[..., Visualizer],
    place: str,
    follower: Callable[..., FollowerServer],
) -> None:
    make_viz(broadcast=place)
    client = follower().page()
    assert client.rows["role/me"]["value"]["control"] is False


def test_a_balancer_may_give_the_connections_of_a_page_to_two_followers(
    make_viz: Callable[..., Visualizer],
    place: str,
    follower: Callable[..., FollowerServer],
) -> None:
    make_viz(broadcast=place)
    first, second = follower(), follower()
    page = first.page()
    with connect(
        f"ws://127.0.0.1:{second.port}/?ticket={page.ticket}",
        subprotocols=[Subprotocol(SUBPROTOCOL)],
    ) as channel:
        rows = PageRows()
        while not {"session", "browser"} <= rows.scopes.keys():
            patch = decode(channel.recv(timeout=WAIT))
            if patch["of"] != "camera":
                rows.take(patch)


def test_who_comes_later_sees_what_is_there_then(
    make_viz: Callable[..., Visualizer],
    place: str,
    follower: Callable[..., FollowerServer],
) -> None:
    origin = make_viz(broadcast=place)
    first = follower()
    client = first.page()
    origin.set_joint_positions({LEFT: 1.0})
    client.wait_until(lambda: client.rows[f"j/{LEFT}"]["value"] == 1.0)
    for server in (first, follower()):
        later = server.page()
        later.wait_until(lambda later=later: poses(later) == poses(client))
        assert nodes(later) == nodes(client)
        assert later.rows[f"j/{LEFT}"]["value"] == 1.0


def test_a_lost_frame_is_made_good_by_a_snapshot_that_disturbs_no_page(
    make_viz: Callable[..., Visualizer],
    place: str,
    router: ZenohPeer,
    follower: Callable[..., FollowerServer],
) -> None:
    origin = make_viz(broadcast=place)
    client = follower().page()
    mark = client.mark()
    # A frame that is not the next one: what is between has been lost.
    key = parse_place(place, "--follow").frames
    start = origin_of(router.tokens("sambot-viz/arm/origin/**")[0])[0]
    router.put(key, b"", Label(start, 10**6, "scene").packed())
    origin.set_joint_positions({LEFT: 1.0})
    client.wait_until(lambda: client.rows[f"j/{LEFT}"]["value"] == 1.0, WAIT)
    client.wait_until(lambda: len(moved_since(client, mark)) == 1)
    assert not [m.type for m in client.since(mark) if "props" in m.fields]


ORIGIN = "abc"
ROWS = b'{"of": "session", "all": true, "panels": {"p": [{"id": "p/a", "value": 1}]}}'


def origin_of_bytes(
    router: ZenohPeer, place: str, *replies: bytes | None
) -> BroadcastPlace:
    """An origin that answers with these before it does with a snapshot."""
    parsed = parse_place(place, "--follow")
    whole = Snapshot(ORIGIN, 1, "http://origin", [], [ROWS]).packed()
    router.answer(parsed.snapshot, itertools.chain(replies, itertools.repeat(whole)))
    router.declare(parsed.token(ORIGIN, VERSION))
    return parsed


@pytest.mark.parametrize(
    "lost", [None, b"", Snapshot("a", 1, "", [], []).packed()[:-1]]
)
def test_a_snapshot_that_is_lost_on_its_way_is_asked_for_again(
    lost: bytes | None,
    router: ZenohPeer,
    place: str,
    follower: Callable[..., FollowerServer],
    protocol: Callable[..., ProtocolClient],
) -> None:
    origin_of_bytes(router, place, lost)
    client = protocol(follower().port)
    client.wait_until(lambda: leads_to(client) == "http://origin", WAIT)
    assert trouble(client) == "" and client.rows["p/a"]["value"] == 1


@pytest.mark.parametrize("days", [-1, 1])
def test_the_clocks_of_the_machines_may_differ(
    days: int,
    router: ZenohPeer,
    place: str,
    follower: Callable[..., FollowerServer],
    protocol: Callable[..., ProtocolClient],
) -> None:
    parsed = origin_of_bytes(router, place)
    client = protocol(follower().port)
    client.wait_until(lambda: leads_to(client) == "http://origin", WAIT)
    for number, value in ((2, 5), (3, 7)):
        row = b'{"of": "session", "rows": {"p/a": {"value": %d}}}' % value
        label = Label(ORIGIN, number, "rows").packed()
        router.put(parsed.frames, row, label, days_ahead=days if number == 2 else 0)
    client.wait_until(lambda: client.rows["p/a"]["value"] == 7, WAIT)
    assert trouble(client) == ""


def test_a_slow_follower_gets_the_newest_and_no_queue(
    make_viz: Callable[..., Visualizer],
    place: str,
    follower: Callable[..., FollowerServer],
) -> None:
    origin = make_viz(broadcast=place)
    server = follower()
    client = server.page()
    mark = client.mark()
    busy = threading.Event()
    loop = server.listener.viser.get_event_loop()
    loop.call_soon_threadsafe(busy.wait, WAIT)
    other = follower().page()
    other_mark, steps = other.mark(), MOST_BEHIND + 20
    for number in range(1, steps + 1):
        origin.set_joint_positions({LEFT: number / 1000})
        # Each is sent by itself.
        other.wait_until(
            lambda number=number: len(moved_since(other, other_mark)) == number
        )
    busy.set()
    client.wait_until(
        lambda: client.rows[f"j/{LEFT}"]["value"] == pytest.approx(steps / 1000), WAIT
    )
    client.settle(server.listener.viser)
    assert 0 < len(moved_since(client, mark)) <= MOST_BEHIND
    assert poses(client) == poses(other)


def test_an_origin_that_ends_leaves_its_last_picture_and_the_next_one_replaces_it(
    make_viz: Callable[..., Visualizer],
    place: str,
    follower: Callable[..., FollowerServer],
) -> None:
    origin = make_viz(broadcast=place)
    server = follower()
    client = server.page()
    there = nodes(client)
    origin.stop()
    client.wait_until(lambda: "The origin has ended" in trouble(client), WAIT)
    assert nodes(client) == there
    again = make_viz(broadcast=place)
    client.wait_until(lambda: follows(client), WAIT)
    # The connection to viser may be behind that of the rows.
    client.settle(server.listener.viser)
    client.wait_until(lambda: nodes(client) == there)
    client.settle(server.listener.viser)
    mark = client.mark()
    again.set_joint_positions({LEFT: 1.0})
    client.wait_until(lambda: len(moved_since(client, mark)) == 1)
    assert not client.closed


def test_a_router_that_starts_again_is_found_by_both_ends(
    make_viz: Callable[..., Visualizer],
    place: str,
    router: ZenohPeer,
    follower: Callable[..., FollowerServer],
) -> None:
    origin = make_viz(broadcast=place)
    client = follower().page()
    mark = client.mark()
    router.stop()
    client.wait_until(lambda: bool(trouble(client)), WAIT)
    origin.set_joint_positions({LEFT: 1.0})
    router.start()
    client.wait_until(lambda: follows(client), WAIT)
    client.wait_until(lambda: client.rows[f"j/{LEFT}"]["value"] == 1.0)
    assert not [m.type for m in client.since(mark) if "props" in m.fields]


def test_of_two_origins_of_one_name_the_first_one_stays(
    make_viz: Callable[..., Visualizer],
    place: str,
    follower: Callable[..., FollowerServer],
    caplog: pytest.LogCaptureFixture,
) -> None:
    first = make_viz(broadcast=place)
    client = follower().page()
    second = make_viz(broadcast=place)
    until(lambda: "another server broadcasts to" in caplog.text, WAIT)
    second.set_joint_positions({LEFT: 2.0})
    first.set_joint_positions({LEFT: 1.0})
    client.wait_until(lambda: client.rows[f"j/{LEFT}"]["value"] == 1.0)
    first.stop()
    # It begins when the first one has ended.
    client.wait_until(lambda: client.rows[f"j/{LEFT}"]["value"] == 2.0, WAIT)


def test_an_origin_of_another_version_is_refused_in_words(
    router: ZenohPeer,
    follower: Callable[..., FollowerServer],
    protocol: Callable[..., ProtocolClient],
) -> None:
    router.declare("sambot-viz/arm/origin/abc/0.0.1-viser1.0.0")
    client = protocol(follower().port)
    client.wait_until(lambda: "has version 0.0.1-viser1.0.0" in said(client), WAIT)
    assert trouble(client).endswith("install the same one for both")


def test_a_follower_waits_for_an_origin_and_for_a_router(
    router: ZenohPeer,
    follower: Callable[..., FollowerServer],
    protocol: Callable[..., ProtocolClient],
) -> None:
    router.stop()
    client = protocol(follower().port)
    start = "start the router there with `zenohd`"
    client.wait_until(lambda: start in said(client), WAIT)
    router.start()
    client.wait_until(lambda: "Nobody broadcasts" in said(client), WAIT)


def test_a_router_behind_tls_is_trusted_by_its_certificate(
    make_viz: Callable[..., Visualizer],
    protocol: Callable[..., ProtocolClient],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    caplog: pytest.LogCaptureFixture,
) -> None:
    key, certificate = self_signed(tmp_path)
    router = ZenohPeer(
        protocol="tls", has_nodes=False, **tls_settings(key, certificate)
    )
    plain = f"{router.uri}/arm"
    secure = plain.replace("zenoh:", "zenoh+tls:")
    wrong = make_viz(broadcast=plain)
    options = Options(follow=secure, port=0)
    with listen(options) as listener:
        stop = follow(options, listener)
        client = protocol(listener.viser.get_port())
        # What both say to write is right.
        client.wait_until(lambda: f"--follow {plain}" in said(client), WAIT)
        until(lambda: f"If it speaks TLS, --broadcast {secure}" in caplog.text, WAIT)
        wrong.stop()
        monkeypatch.setenv("SSL_CERT_FILE", str(certificate))
        origin = make_viz(broadcast=secure)
        client.wait_until(lambda: follows(client), WAIT)
        origin.stop()
        stop()
    router.stop()


def test_a_follower_asks_for_its_token_as_every_server_does(
    follower: Callable[..., FollowerServer],
    protocol: Callable[..., ProtocolClient],
) -> None:
    server = follower(token="a-secret")
    with pytest.raises(InvalidStatus, match="401"):
        protocol(server.port)
    assert protocol(server.port, path="?token=a-secret")


@pytest.mark.skipif(sys.platform != "linux", reason="the loopback has another name")
@pytest.mark.parametrize("own_machine", ["lo", "eth99"])
def test_the_router_of_the_documents_lets_only_its_own_machine_broadcast(
    own_machine: str,
    repository: Path,
    make_viz: Callable[..., Visualizer],
    protocol: Callable[..., ProtocolClient],
) -> None:
    config = zenoh.Config.from_file(str(repository / "deploy" / "zenoh-router.json5"))
    rules = config.get_json("access_control").replace('"lo"', f'"{own_machine}"')
    router = ZenohPeer(has_nodes=False, access_control=json.loads(rules))
    options = Options(follow=f"{router.uri}/arm", port=0)
    with listen(options) as listener:
        stop = follow(options, listener)
        origin = make_viz(broadcast=options.follow)
        client = protocol(listener.viser.get_port())
        if own_machine == "lo":
            client.wait_until(lambda: follows(client), WAIT)
        else:
            client.wait_until(lambda: "Nobody broadcasts" in said(client), WAIT)
            assert router.tokens("sambot-viz/**") == []
        origin.stop()
        stop()
    router.stop()


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"follow": "zenoh://h:7447"}, "write --follow zenoh://HOST:7447/NAME"),
        ({"broadcast": "foxglove://h/a"}, "write --broadcast zenoh://HOST:7447/NAME"),
        ({"broadcast": "zenoh://h/a", "session": "private"}, "all browsers share"),
        ({"follow": "zenoh://h/a", "model": "a.urdf"}, "leave MODEL out"),
        ({"follow": "zenoh://h/a", "presenter": ""}, "leave --presenter out"),
        ({"follow": "zenoh://h/a", "metrics": True}, "leave --metrics out"),
    ],
)
def test_what_cannot_be_is_refused_with_what_to_write(
    options: dict[str, Any], words: str
) -> None:
    with pytest.raises(UsageError, match=re.escape(words)):
        Options(**options)
