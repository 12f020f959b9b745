"""Thirty browsers feel like one: a step of a slider until the last one has it."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from typing import Any

from protocol_client import ProtocolClient

from sambot_viz import Visualizer

JOINT = "drivewhl_l_joint"
BROWSERS = 30


def test_thirty_browsers_get_a_step_nearly_as_soon_as_one(
    protocol: Callable[..., ProtocolClient], compare: Callable[..., Any]
) -> None:
    with Visualizer(port=0) as many, Visualizer(port=0) as one:
        crowd = [protocol(port_of(many)) for _ in range(BROWSERS)]
        alone = [protocol(port_of(one))]
        for client in crowd:
            client.settle(many.viser)
        alone[0].settle(one.viser)
        steps = iter(range(1, 1000))
        result = compare(
            "a step of a slider until the last browser has it",
            lambda: step(crowd, next(steps) / 1000),
            lambda: step(alone, next(steps) / 1000),
            rounds=20,
        )
    # Thirty connections are thirty times the work; a person notices 50 ms.
    assert result.ratio <= BROWSERS, str(result)


def port_of(viz: Visualizer) -> int:
    return int(viz.url.rsplit(":", 1)[1])


def step(clients: list[ProtocolClient], value: float) -> float:
    """Seconds from a browser's message to the pose at the last browser."""
    marks = [client.mark() for client in clients]
    row = clients[0].id_of("joints", JOINT)
    arrived: list[float] = []

    def wait(client: ProtocolClient, mark: int) -> None:
        client.wait_until(lambda: client.types(mark)["SetOrientationMessage"] > 0)
        arrived.append(time.perf_counter())

    waiting = [
        threading.Thread(target=wait, args=pair)
        for pair in zip(clients, marks, strict=True)
    ]
    for thread in waiting:
        thread.start()
    start = time.perf_counter()
    clients[0].edit(row, value)
    for thread in waiting:
        thread.join()
    return max(arrived) - start
