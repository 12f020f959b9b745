"""Steps of a joint: made at a pace, and how long each took until it was seen."""

from __future__ import annotations

import statistics
import time
from collections.abc import Iterable, Sequence

from protocol_client import ProtocolClient

Times = list[tuple[float, float]]
"""Pairs of a time [s] and the joint's position then, both rising."""

RECORD = """(() => {
  const row = document.querySelector('[data-row="ROW"]');
  // Where it is out of sight it has its slider from now on.
  row.focus();
  const handle = row.querySelector("input[type=range]");
  window.benchmarkSeen = [];
  new MutationObserver(() => benchmarkSeen.push(
    [(performance.timeOrigin + performance.now()) / 1000, Number(handle.value)],
  )).observe(handle, { attributes: true });
})()"""
"""Has a page note when ROW shows another position, by `time.time`."""


def drag(
    client: ProtocolClient, joint: str, values: Iterable[float], pace: float
) -> tuple[Times, Times]:
    """Move a joint as a user does; returns the steps by `perf_counter` and by `time`.

    Args:
        client: the user.
        joint: name of the joint.
        values: where to, one after the other [rad].
        pace: how many in a second [1/s].
    """
    row = f"j/{joint}"
    # The port is open before the robot is there.
    client.wait_until(lambda: row in client.rows)
    by_counter: Times = []
    by_clock: Times = []
    start = time.perf_counter()
    for number, value in enumerate(values, 1):
        time.sleep(max(0.0, start + number / pace - time.perf_counter()))
        by_counter.append((time.perf_counter(), value))
        by_clock.append((time.time(), value))
        client.edit(row, value, gesture=1)
    return by_counter, by_clock


def delays(sent: Times, seen: Times, close: float) -> list[float]:
    """How long each step took until it, or a later one, was seen [s].

    Args:
        sent: the steps, with rising values.
        seen: what was seen when.
        close: a value that is so near is the same.
    """
    arrived = iter(seen)
    at, value = next(arrived)
    found: list[float] = []
    for start, wanted in sent:
        while at < start or value < wanted - close:
            at, value = next(arrived)
        found.append(at - start)
    return found


def p95(times: Sequence[float]) -> float:
    """What 95 % of some times stay below."""
    return statistics.quantiles(times, n=20)[-1]


def report(name: str, times: Sequence[float]) -> float:
    """Print some times; returns what 95 % of them stay below [s]."""
    middle, slow = statistics.median(times), p95(times)
    most = 1000 * max(times)
    print(
        f"  {name}: p50 {1000 * middle:.1f} ms, p95 {1000 * slow:.1f} ms, "
        f"longest {most:.0f} ms"
    )
    return slow
