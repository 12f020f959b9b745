"""The switch ends each motion with zero velocities, also when it is closed."""

from __future__ import annotations

import threading

import pytest
from live_peers import WAIT, eventually

from sambot_viz.publishing import dead_mans_switch
from sambot_viz.publishing.dead_mans_switch import ZEROS, DeadMansSwitch, Hand


def test_who_closes_waits_for_zeros_that_take_long(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(dead_mans_switch, "SILENCE", 600.0)
    sent: list[tuple[float, float]] = []
    late = threading.Event()

    def send(linear: float, angular: float) -> None:
        if sent and not linear:
            assert late.wait(WAIT)
        sent.append((linear, angular))

    switch = DeadMansSwitch(send, (1.0, 1.0), lambda hand, why: None)
    switch.hold(Hand(1, 1), 1.0, 0.0)
    eventually(lambda: sent and sent[-1][0] > 0.0)
    join, waited = threading.Thread.join, list[float | None]()

    def joined(thread: threading.Thread, timeout: float | None = None) -> None:
        waited.append(timeout)
        late.set()
        join(thread, timeout)

    monkeypatch.setattr(threading.Thread, "join", joined)
    switch.close()
    assert sent[-ZEROS:] == [(0.0, 0.0)] * ZEROS
    assert waited == [dead_mans_switch.LONGEST_STOP]
