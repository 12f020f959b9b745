"""A live robot moves as long as a hand holds it, and is stopped whatever happens."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from base_peer import CMD_VEL, TWIST, BasePeer
from inside import session_of, viser_server
from live_peers import eventually, knows_takers
from protocol_client import ProtocolClient

from sambot_viz import Visualizer
from sambot_viz.errors import SourceError
from sambot_viz.publishing import dead_mans_switch
from sambot_viz.publishing.driver import NOT_REACHED


@pytest.fixture
def peers() -> Iterator[Callable[..., BasePeer]]:
    made: list[BasePeer] = []

    def make(*args: Any, **options: Any) -> BasePeer:
        made.append(BasePeer(*args, **options))
        return made[-1]

    yield make
    for peer in made:
        peer.stop()


class Driven:
    """A program that may drive a robot, with pages."""

    def __init__(
        self, peer: BasePeer, protocol: Callable[..., ProtocolClient], **options: Any
    ) -> None:
        self.peer, self._protocol = peer, protocol
        self._token = options.get("presenter", "")
        self.viz = Visualizer(source=peer.uri, port=0, publish="", **options)
        data = session_of(self.viz).data
        assert data is not None
        eventually(lambda: data.source.status.is_connected)
        eventually(lambda: CMD_VEL in data.source.topics() or not peer.has_type)
        # A press that came before that would have ended.
        knows_takers(data.source, peer)

    def presenter(self) -> ProtocolClient:
        return self.page(f"/?token={self._token}")

    def page(self, path: str = "") -> ProtocolClient:
        client = self._protocol(self.viz.viser.get_port(), path=path)
        client.settle(viser_server(self.viz))
        return client

    def state(self, client: ProtocolClient) -> dict[str, Any]:
        client.settle(viser_server(self.viz))
        state: dict[str, Any] = client.row("live/state")["value"]
        return state


@pytest.fixture
def drive(
    protocol: Callable[..., ProtocolClient],
) -> Iterator[Callable[..., Driven]]:
    made: list[Driven] = []

    def make(peer: BasePeer, **options: Any) -> Driven:
        made.append(Driven(peer, protocol, **options))
        return made[-1]

    yield make
    for one in made:
        one.viz.stop()


@pytest.fixture(autouse=True)
def patient(monkeypatch: pytest.MonkeyPatch) -> Callable[[], None]:
    """A hand may say nothing for long, until the test wants it as it is.

    On a busy machine these clients would be too slow.
    """
    real = dead_mans_switch.SILENCE
    monkeypatch.setattr(dead_mans_switch, "SILENCE", 600.0)
    return lambda: monkeypatch.setattr(dead_mans_switch, "SILENCE", real)


def hold_until(client: ProtocolClient, press: int, done: Callable[[], bool]) -> None:
    """Say that a key is held, until something has happened."""

    def held() -> bool:
        client.act("live/hold", press, 1.0, -0.5)
        return done()

    eventually(held)


def moves(peer: BasePeer) -> bool:
    return bool(peer.speeds()) and peer.speeds()[-1] == pytest.approx((0.2, -0.25))


@pytest.mark.parametrize("kind", [TWIST, "geometry_msgs/msg/TwistStamped"])
def test_a_key_that_is_held_drives_and_letting_go_stops(
    peers: Callable[..., BasePeer], drive: Callable[..., Driven], kind: str
) -> None:
    peer = peers(kind)
    client = drive(peer).page()
    hold_until(client, 1, lambda: moves(peer))
    client.act("live/release", 1)
    eventually(peer.rests)
    speeds = peer.speeds()
    assert {one.type_name for one in peer.came()} == {kind}
    assert len(peer.came()[0].content) == (52 if kind == TWIST else 68)
    # It begins gently, and there are three zeros and no more.
    linear = [x for x, _ in speeds]
    assert linear[:-3] == sorted(linear[:-3]) and speeds[-4] != (0.0, 0.0)


def test_a_page_that_says_nothing_more_has_let_go(
    peers: Callable[..., BasePeer],
    drive: Callable[..., Driven],
    patient: Callable[[], None],
) -> None:
    peer = peers()
    driven = drive(peer)
    client = driven.page()
    hold_until(client, 1, lambda: moves(peer))
    patient()
    eventually(peer.rests)
    eventually(lambda: "nothing was heard" in driven.state(client)["why"])
    came = len(peer.came())
    # A page that was only held up goes on; its key has to be pressed again.
    client.act("live/hold", 1, 1.0, 1.0)
    client.settle(viser_server(driven.viz))
    assert driven.state(client)["client"] is None
    assert len(peer.came()) == came


def test_a_page_that_is_closed_stops_the_robot(
    peers: Callable[..., BasePeer], drive: Callable[..., Driven]
) -> None:
    peer = peers()
    driven = drive(peer)
    client, other = driven.page(), driven.page()
    hold_until(client, 1, lambda: moves(peer))
    client.close()
    eventually(peer.rests)
    eventually(lambda: driven.state(other)["why"])


def test_two_pages_at_once_stop_the_robot_and_either_may_press_again(
    peers: Callable[..., BasePeer], drive: Callable[..., Driven]
) -> None:
    peer = peers()
    driven = drive(peer)
    one, two = driven.page(), driven.page()
    hold_until(one, 1, lambda: moves(peer))
    two.act("live/hold", 1, 1.0, 0.0)
    two.settle(viser_server(driven.viz))
    assert driven.state(one)["why"] == "two pages drove it at once"
    eventually(peer.rests)
    for client in (one, two):
        client.act("live/hold", 1, 1.0, 0.0)
        client.settle(viser_server(driven.viz))
        assert driven.state(client)["client"] is None
    hold_until(two, 2, lambda: moves(peer))


def test_a_viewer_does_not_drive_and_may_stop_the_robot(
    peers: Callable[..., BasePeer], drive: Callable[..., Driven]
) -> None:
    peer = peers()
    driven = drive(peer, presenter="a-long-word")
    viewer, helper = driven.page(), driven.page()
    viewer.act("live/hold", 1, 1.0, 0.0)
    viewer.settle(viser_server(driven.viz))
    assert "iew only" in str(viewer.row("notice")["value"]["text"])
    assert peer.came() == []
    roles = session_of(driven.viz).roles
    presenter = driven.presenter()
    number = helper.row("role/me")["value"]["client"]
    presenter.act("role/give", number)
    hold_until(helper, 1, lambda: moves(peer))
    viewer.act("live/stop")
    eventually(peer.rests)
    name = viewer.row("role/me")["value"]["name"]
    eventually(lambda: driven.state(viewer)["why"] == f"{name} pressed STOP")
    # Control is back with the presenter.
    assert not roles.may_edit(number)


def test_who_loses_control_drives_no_longer(
    peers: Callable[..., BasePeer], drive: Callable[..., Driven]
) -> None:
    peer = peers()
    driven = drive(peer, presenter="a-long-word")
    helper, presenter = driven.page(), driven.presenter()
    presenter.act("role/give", helper.row("role/me")["value"]["client"])
    hold_until(helper, 1, lambda: moves(peer))
    presenter.act("role/take-back")
    hold_until(helper, 1, peer.rests)
    assert "no control now" in driven.state(presenter)["why"]


def test_a_session_that_hangs_neither_keeps_the_robot_going_nor_delays_its_stop(
    peers: Callable[..., BasePeer],
    drive: Callable[..., Driven],
    patient: Callable[[], None],
) -> None:
    peer = peers()
    driven = drive(peer)
    client = driven.page()
    with session_of(driven.viz).lock:
        hold_until(client, 1, lambda: moves(peer))
        client.act("live/release", 1)
        eventually(peer.rests)
        hold_until(client, 2, lambda: moves(peer))
        client.act("live/stop")
        eventually(peer.rests)
        hold_until(client, 3, lambda: moves(peer))
        # And says nothing more.
        patient()
        eventually(peer.rests)


def test_the_end_of_the_program_stops_the_robot(
    peers: Callable[..., BasePeer], drive: Callable[..., Driven]
) -> None:
    peer = peers()
    driven = drive(peer)
    hold_until(driven.page(), 1, lambda: moves(peer))
    driven.viz.stop()
    eventually(peer.rests)


def test_nothing_is_sent_again_after_a_connection_was_lost(
    peers: Callable[..., BasePeer], drive: Callable[..., Driven]
) -> None:
    peer = peers()
    driven = drive(peer)
    client = driven.page()
    hold_until(client, 1, lambda: moves(peer))
    peer.stop()
    hold_until(client, 1, lambda: driven.state(client)["client"] is None)
    peer.start()
    data = session_of(driven.viz).data
    assert data is not None
    eventually(lambda: data.source.status.is_connected)
    came = len(peer.came())
    client.act("live/hold", 1, 1.0, -0.5)
    client.settle(viser_server(driven.viz))
    assert len(peer.came()) == came
    peer.listen_as(CMD_VEL, "/base")
    knows_takers(data.source, peer)
    hold_until(client, 2, lambda: moves(peer))


def comes_back(driven: Driven) -> None:
    """Break the connection while nobody drives, and wait until there is another."""
    peer, data = driven.peer, session_of(driven.viz).data
    assert data is not None
    peer.stop()
    eventually(lambda: not data.source.status.is_connected)
    peer.start()
    eventually(lambda: data.source.status.is_connected)
    peer.listen_as(CMD_VEL, "/base")
    knows_takers(data.source, peer)


def test_the_first_stop_after_a_lost_connection_stops_the_robot(
    peers: Callable[..., BasePeer], drive: Callable[..., Driven]
) -> None:
    peer = peers()
    driven = drive(peer)
    client = driven.page()
    client.act("live/stop")
    eventually(peer.rests)
    comes_back(driven)
    came = len(peer.came())
    client.act("live/stop")
    eventually(lambda: peer.speeds()[came:] == [(0.0, 0.0)] * 3)


def test_the_first_press_after_a_lost_connection_drives(
    peers: Callable[..., BasePeer], drive: Callable[..., Driven]
) -> None:
    peer = peers()
    driven = drive(peer)
    client = driven.page()
    hold_until(client, 1, lambda: moves(peer))
    client.act("live/release", 1)
    eventually(peer.rests)
    comes_back(driven)
    hold_until(client, 2, lambda: moves(peer))


def loses(driven: Driven) -> None:
    """Break the connection, and wait until that is known."""
    data = session_of(driven.viz).data
    assert data is not None
    driven.peer.stop()
    eventually(lambda: not data.source.status.is_connected)


def test_a_stop_that_does_not_reach_the_robot_is_said(
    peers: Callable[..., BasePeer],
    drive: Callable[..., Driven],
    capsys: pytest.CaptureFixture[str],
) -> None:
    driven = drive(peers())
    client = driven.page()
    assert driven.state(client)["failure"] == ""
    loses(driven)
    client.act("live/stop")
    eventually(lambda: driven.state(client)["failure"] == NOT_REACHED)

    def line() -> Any:
        client.settle(viser_server(driven.viz))
        return client.row("sent/lines")["value"][0]

    eventually(lambda: line()["values"] == f"error: {NOT_REACHED}")
    assert f"Viewer 1: error: {NOT_REACHED}" in capsys.readouterr().err
    with pytest.raises(SourceError, match="it may keep its last speed"):
        driven.viz.stop_robot()


def test_a_robot_that_is_lost_while_it_drives_is_not_said_to_be_stopped(
    peers: Callable[..., BasePeer], drive: Callable[..., Driven]
) -> None:
    peer = peers()
    driven = drive(peer)
    client = driven.page()
    hold_until(client, 1, lambda: moves(peer))
    loses(driven)
    hold_until(client, 1, lambda: driven.state(client)["client"] is None)
    eventually(lambda: driven.state(client)["failure"] == NOT_REACHED)
    comes_back(driven)
    came = len(peer.came())
    client.act("live/stop")
    eventually(lambda: peer.speeds()[came:] == [(0.0, 0.0)] * 3)
    assert driven.state(client)["failure"] == ""


def test_a_stop_at_rest_is_sent_whoever_seems_to_listen(
    peers: Callable[..., BasePeer], drive: Callable[..., Driven]
) -> None:
    peer = peers()
    driven = drive(peer)
    client = driven.page()
    client.act("live/stop")
    eventually(lambda: len(peer.came()) == 3)
    peer.listen_as("/another", "/base")
    data = session_of(driven.viz).data
    assert data is not None
    knows_takers(data.source, peer)
    client.act("live/stop")
    eventually(lambda: len(peer.came()) == 6)


@pytest.mark.parametrize("kind", [TWIST, "geometry_msgs/msg/TwistStamped"])
def test_the_type_is_asked_where_the_robot_does_not_say_it(
    peers: Callable[..., BasePeer], drive: Callable[..., Driven], kind: str
) -> None:
    peer = peers("")
    driven = drive(peer)
    client = driven.page()
    client.act("live/hold", 1, 1.0, 0.0)
    client.settle(viser_server(driven.viz))
    assert "hoose the type" in str(client.row("notice")["value"]["text"])
    assert peer.advertised() == []
    client.edit("live/type", kind.rpartition("/")[2])
    client.settle(viser_server(driven.viz))
    hold_until(client, 2, lambda: moves(peer))
    assert {one.type_name for one in peer.came()} == {kind}


def test_what_nobody_takes_is_said(
    peers: Callable[..., BasePeer], drive: Callable[..., Driven]
) -> None:
    peer = peers()
    peer.listen_as("/another", "/base")
    assert peer.server is not None
    driven = drive(peer)
    client = driven.page()
    client.act("live/hold", 1, 1.0, 0.0)
    eventually(lambda: "nobody has subscribed" in driven.state(client)["why"])
    # The next press is refused before anything is sent.
    client.act("live/hold", 2, 1.0, 0.0)
    client.settle(viser_server(driven.viz))
    assert "start the robot's base" in str(client.row("notice")["value"]["text"])


def test_a_robot_that_seems_to_listen_no_more_is_stopped_all_the_same(
    peers: Callable[..., BasePeer], drive: Callable[..., Driven]
) -> None:
    peer = peers()
    driven = drive(peer)
    client = driven.page()
    hold_until(client, 1, lambda: moves(peer))
    # What a bridge tells of its graph is not always what is there.
    peer.listen_as("/another", "/base")
    eventually(peer.rests)
    eventually(lambda: "nobody has subscribed" in driven.state(client)["why"])


def test_a_robot_whose_bridge_complains_is_stopped_all_the_same(
    peers: Callable[..., BasePeer], drive: Callable[..., Driven]
) -> None:
    peer = peers()
    driven = drive(peer)
    client = driven.page()
    hold_until(client, 1, lambda: moves(peer))
    peer.complain("/cmd_vel: the bridge is out of sorts")
    eventually(peer.rests)
    eventually(lambda: "out of sorts" in driven.state(client)["why"])


@pytest.mark.parametrize(
    "values", [(1, float("nan"), 0.0), (1, 2.0, 0.0), (1, 0.0), ("1", 0.0, 0.0)]
)
def test_what_is_no_hand_drives_nothing(
    peers: Callable[..., BasePeer],
    drive: Callable[..., Driven],
    values: tuple[Any, ...],
) -> None:
    peer = peers()
    driven = drive(peer)
    client = driven.page()
    client.act("live/hold", *values)
    client.settle(viser_server(driven.viz))
    assert peer.came() == []


def test_without_leave_nobody_drives(
    peers: Callable[..., BasePeer], protocol: Callable[..., ProtocolClient]
) -> None:
    peer = peers()
    with Visualizer(source=peer.uri, port=0, publish="goal") as viz:
        client = protocol(viz.viser.get_port())
        client.settle(viser_server(viz))
        client.act("live/hold", 1, 1.0, 0.0)
        client.settle(viser_server(viz))
        assert "start with --publish drive" in client.row("live/off")["value"]
    assert peer.came() == [] and peer.advertised() == []


def test_each_new_velocity_is_in_the_log(
    peers: Callable[..., BasePeer], drive: Callable[..., Driven], tmp_path: Path
) -> None:
    peer, log = peers(), tmp_path / "sent.jsonl"
    client = drive(peer, publish_log=log).page()
    hold_until(client, 1, lambda: moves(peer))
    client.act("live/release", 1)
    eventually(peer.rests)

    def last() -> dict[str, Any]:
        found: dict[str, Any] = json.loads(log.read_text().splitlines()[-1])
        return found

    eventually(lambda: last()["values"] == [0.0, 0.0])
    assert (last()["topic"], last()["who"]) == (CMD_VEL, "Viewer 1")


def test_the_zeros_of_a_stop_are_those_of_who_pressed_it(
    peers: Callable[..., BasePeer], drive: Callable[..., Driven], tmp_path: Path
) -> None:
    peer, log = peers(), tmp_path / "sent.jsonl"
    driven = drive(peer, publish_log=log)
    client, other = driven.page(), driven.page()

    def zeros_of(who: str) -> bool:
        lines = [json.loads(line) for line in log.read_text().splitlines()]
        told = [one["who"] for one in lines if one["topic"] == CMD_VEL]
        return bool(told[-1] == who and lines[-1]["values"] in ([0.0, 0.0], {}))

    client.act("live/stop")
    eventually(lambda: zeros_of("Viewer 1"))
    hold_until(client, 1, lambda: moves(peer))
    other.act("live/stop")
    eventually(lambda: zeros_of("Viewer 2"))
