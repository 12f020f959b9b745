"""How soon a robot that is driven gets its zero velocity, beside thirty browsers.

    python -m pytest tests/benchmarks/test_driving.py -s

The robot says where it is thirty times a second, and all browsers show it. It is in the
process of the server, so that both share an interpreter: on its own it would be sooner.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

import numpy as np
import pytest
from base_peer import BasePeer
from crowd import Crowd
from inside import session_of, viser_server
from live_peers import eventually
from navigator_peer import transforms
from protocol_client import ProtocolClient

from sambot_viz import Visualizer

PRESSES, BROWSERS = 100, 30
LONGEST_RELEASE, LONGEST_SILENCE = 0.05, 0.4
"""Between a key that is released, or a page that is killed, and the zero [s]."""


class Timed(BasePeer):
    """Notes when velocities come, and when the last one was a zero."""

    def __init__(self) -> None:
        self.stopped = threading.Event()
        self.at = 0.0
        super().__init__()

    def on_message_data(self, *args: Any) -> None:
        super().on_message_data(*args)
        if self.speeds()[-1] == (0.0, 0.0):
            if not self.stopped.is_set():
                self.at = time.perf_counter()
            self.stopped.set()


@contextmanager
def telling(peer: Timed) -> Iterator[None]:
    """Let the robot say where it is, again and again."""
    ends = threading.Event()

    def tell() -> None:
        while not ends.wait(1 / 30):
            peer.log("/tf", transforms({"base_link": "odom"}))

    thread = threading.Thread(target=tell)
    thread.start()
    yield
    ends.set()
    thread.join()


@pytest.fixture
def peer() -> Iterator[Timed]:
    made = Timed()
    yield made
    made.stop()


def test_the_zero_after_a_release_and_after_a_page_that_was_killed(
    peer: Timed, protocol: Callable[..., ProtocolClient]
) -> None:
    peer.offer("/tf", "tf2_msgs/msg/TFMessage")
    with Visualizer(source=peer.uri, port=0, publish="drive") as viz, telling(peer):
        data = session_of(viz).data
        assert data is not None
        eventually(lambda: "/cmd_vel" in data.source.topics())
        client = protocol(viz.viser.get_port())
        client.settle(viser_server(viz))

        def drive(press: int) -> None:
            peer.stopped.clear()
            while not (peer.speeds() and peer.speeds()[-1][0] > 0.0):
                client.act("live/hold", press, 1.0, 0.0)
                time.sleep(0.05)
            peer.stopped.clear()

        with Crowd(viz.viser.get_port(), BROWSERS):
            late: list[float] = []
            for press in range(1, PRESSES + 1):
                drive(press)
                released = time.perf_counter()
                client.act("live/release", press)
                assert peer.stopped.wait(5.0)
                late.append(peer.at - released)
            p50, p99 = np.percentile(late, (50, 99))
            drive(PRESSES + 1)
            client.act("live/hold", PRESSES + 1, 1.0, 0.0)
            said = time.perf_counter()
            assert peer.stopped.wait(5.0)
            silent = peer.at - said
        print(
            f"\nrelease → zero: median {p50 * 1e3:.1f}, p99 {p99 * 1e3:.1f} ms; "
            f"last word → zero: {silent * 1e3:.0f} ms; {BROWSERS} browsers"
        )
        assert p99 < LONGEST_RELEASE and silent < LONGEST_SILENCE
