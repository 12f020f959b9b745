"""What it costs to receive from a robot, by transport, before anything is drawn.

    python -m pytest tests/benchmarks/test_transports.py -s

The robot has a process of its own. What is measured is the processor time of this one,
of all its threads, as a part of one core.
"""

from __future__ import annotations

import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import pytest
from live_peers import Inbox
from patience import until

from sambot_viz.sources.registry import open_source

SECONDS = 5.0
LOADS = {
    "30 joints at 1 kHz": (1000, 1200),
    "a cloud of 1.6 MB at 10 Hz": (10, 1_600_000),
}
"""Messages in a second, and the size of each [bytes]."""
PEERS = {
    "zenoh": "zenoh_peer.ZenohPeer",
    "dds": "dds_peer.DdsPeer",
    "foxglove": "live_peers.FoxglovePeer",
}

TALKER = f"""
import importlib, sys, time
sys.path.insert(0, {str(Path(__file__).parents[1] / "support")!r})
module, name = sys.argv[1].split(".")
peer = getattr(importlib.import_module(module), name)()
peer.advertise("/words")
print(peer.uri, flush=True)
for line in sys.stdin:
    rate, size, count = map(int, line.split())
    words, start = "x" * size, time.perf_counter()
    for at in (n / rate for n in range(count)):
        time.sleep(max(0.0, start + at - time.perf_counter()))
        peer.publish("/words", words)
"""


@pytest.fixture(params=PEERS)
def talker(request: pytest.FixtureRequest) -> Iterator[subprocess.Popen[str]]:
    process = subprocess.Popen(
        [sys.executable, "-c", TALKER, PEERS[request.param]],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
    )
    yield process
    process.kill()
    process.communicate()


@pytest.mark.parametrize("load", LOADS)
def test_receiving_costs_a_part_of_a_core(
    talker: subprocess.Popen[str], load: str
) -> None:
    assert talker.stdin is not None and talker.stdout is not None
    rate, size = LOADS[load]
    uri, came = talker.stdout.readline().strip(), Inbox()
    source = open_source(uri)
    source.subscribe("/words", came)
    source.open()
    try:
        until(lambda: "/words" in source.topics(), 40.0)
        count = int(rate * SECONDS)
        talker.stdin.write(f"10 10 10\n{rate} {size} {count}\n")
        talker.stdin.flush()
        until(lambda: len(came.messages) >= 10, 40.0)
        used, begun = time.process_time(), time.perf_counter()
        last = begun + SECONDS
        until(
            lambda: len(came.messages) >= count + 10 or time.perf_counter() > last, 60.0
        )
        share = (time.process_time() - used) / (time.perf_counter() - begun)
        got = len(came.messages) - 10
        kind = uri.partition(":")[0]
        print(f"  {kind}: {load}: {share:.1%} of a core, {got} of {count} came")
    finally:
        source.close()
