"""No page is open: what only a page shows is neither asked for nor decoded."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from hand_clock import HandClock
from inside import session_alone_of, viser_server
from live_peers import eventually
from protocol_client import ProtocolClient, wait_for_workers
from robot_peer import BusyPeer, square_peer

from sambot_viz import Visualizer
from sambot_viz.session.data.robot_data import AGEING_PERIOD, RESTS_AFTER
from sambot_viz.sources.message import Recorded
from sambot_viz.topics.decoding import Decoding

Connect = Callable[..., ProtocolClient]
SHOWN = {"/scan", "/odom"}
"""What displays draw of the recording, and of the robot."""


@pytest.fixture
def decoded(monkeypatch: pytest.MonkeyPatch) -> Counter[str]:
    """How many messages of each topic were decoded since."""
    counts: Counter[str] = Counter()
    decode = Decoding.decode

    def counted(self: Decoding, message: Recorded, kept: Any = None) -> Any:
        counts[message.topic] += 1
        return decode(self, message, kept)

    monkeypatch.setattr(Decoding, "decode", counted)
    return counts


@pytest.fixture
def peer(repository: Path) -> Iterator[BusyPeer]:
    with square_peer(repository, BusyPeer) as peer:
        yield peer


def open_page(viz: Visualizer, protocol: Connect) -> ProtocolClient:
    page = protocol(viz.viser.get_port())
    page.settle(viser_server(viz))
    return page


def shown(viz: Visualizer) -> dict[str, list[str]]:
    """The statuses of the displays of data, by topic."""
    return {
        str(display.config.get("Topic")): [
            status.text for status in display.status.rows.values()
        ]
        for display in session_alone_of(viz).scene.displays
        if display.is_data
    }


def test_data_of_a_recording_are_decoded_when_a_page_comes(
    repository: Path, decoded: Counter[str], protocol: Connect, hand_clock: HandClock
) -> None:
    with Visualizer(repository / "assets" / "square.mcap", port=0) as viz:
        decoded.clear()
        viz.player.jump(5.0)
        data = session_alone_of(viz).data
        assert data is not None and data.player is not None
        data.player.advance(2.0)
        viz.player.jump(8.0)
        assert set(shown(viz)) == SHOWN
        assert not SHOWN & decoded.keys()
        # The robot goes on moving for programs.
        assert viz.frames.lookup("odom", "base_link").translation[0] > 0.9

        page = open_page(viz, protocol)
        viz.player.pause()
        assert decoded["/scan"] >= 1
        at_8 = shown(viz)
        assert all("received" in texts[0] for texts in at_8.values())

        # A page that is loaded again finds all in its place.
        page.close()
        decoded.clear()
        wait_for_workers()
        page = open_page(viz, protocol)
        wait_for_workers()
        assert not SHOWN & decoded.keys()

        page.close()
        eventually(lambda: not session_alone_of(viz).clients.all)
        # Only then it is put off, from the clock as it is.
        wait_for_workers()
        hand_clock.advance(RESTS_AFTER)
        wait_for_workers()
        viz.player.jump(3.0)
        viz.player.jump(8.0)
        assert not SHOWN & decoded.keys()
        open_page(viz, protocol)
        viz.player.pause()
        viz.player.jump(8.0)
        assert decoded["/scan"] >= 1
        assert shown(viz) == at_8


def test_large_data_of_a_robot_are_asked_for_when_a_page_comes(
    peer: BusyPeer, decoded: Counter[str], protocol: Connect, hand_clock: HandClock
) -> None:
    with Visualizer(source=peer.uri, port=0) as viz:
        session = session_alone_of(viz)

        def goes_on(condition: Callable[[], object]) -> None:
            """Wait for what takes time."""

            def holds() -> object:
                hand_clock.advance(AGEING_PERIOD)
                # Else the clock runs away, and what has just come is old already.
                wait_for_workers()
                return condition()

            eventually(holds)

        # The displays are there, and what is not large has been asked for.
        goes_on(lambda: set(shown(viz)) == SHOWN)
        goes_on(lambda: {"/odom", "/tf", "/tf_static"} <= set(peer.subscribed()))
        goes_on(lambda: viz.frames.lookup("odom", "base_link").translation[0] > 0.9)
        assert "/scan" not in peer.subscribed()
        assert decoded["/scan"] == 0

        page = open_page(viz, protocol)
        goes_on(lambda: "/scan" in peer.subscribed())
        goes_on(lambda: decoded["/scan"])

        goes_on(lambda: "received" in shown(viz)["/scan"][0])

        page.close()
        goes_on(lambda: not session.clients.all)
        goes_on(lambda: "/scan" not in peer.subscribed())
        # What holds for who comes late is not lost.
        assert {"/tf", "/tf_static", "/joint_states"} <= set(peer.subscribed())
        open_page(viz, protocol)
        goes_on(lambda: "/scan" in peer.subscribed())
