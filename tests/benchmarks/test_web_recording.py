"""A recording on a web server, against the same file on the disk.

    python -m pytest tests/benchmarks/test_web_recording.py -s

SAMBOT_VIZ_RECORDING_MB is its size, by default 200. The server is in another process of
this machine. What a network adds is the time of its round trips, as many as the
requests that are printed, and that of the bytes.
"""

from __future__ import annotations

import json
import os
import random
import statistics
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any
from urllib.request import urlopen

import pytest
from large_recording import TOPICS, write
from tests.benchmarks.conftest import start

from sambot_viz.sources.bag import Bag, open_recording

SIZE_MB = int(os.environ.get("SAMBOT_VIZ_RECORDING_MB", "200"))
OPENING = 0.02
"""Of the file may be asked for to open it, or 3 MB of a small one."""
JUMP_MB = 8.0
"""For one jump, at the median."""
MEMORY = 60.0
"""More than with the file on the disk [MB]."""
JUMPS = 30
_SERVER = """
import json, sys, threading
from pathlib import Path
from folder_server import FolderServer
server = FolderServer(Path(sys.argv[1]))
server.has_ranges = True
threading.Thread(target=server.serve_forever, daemon=True).start()
print(server.address, flush=True)
for line in sys.stdin:
    (Path(sys.argv[1]) / "asked.json").write_text(
        json.dumps([len(server.answers), server.sent])
    )
    print("written", flush=True)
"""


@dataclass
class Served:
    """A recording, by its file and by its address."""

    path: Path
    address: str
    process: subprocess.Popen[str]

    def asked(self) -> tuple[int, float]:
        """Return how many requests there were so far, and for how much [MB]."""
        assert self.process.stdin is not None and self.process.stdout is not None
        self.process.stdin.write("\n")
        self.process.stdin.flush()
        self.process.stdout.readline()
        requests, size = json.loads((self.path.parent / "asked.json").read_text())
        return requests, size / 1e6


@pytest.fixture(scope="module")
def served(
    repository: Path, tmp_path_factory: pytest.TempPathFactory
) -> Iterator[Served]:
    folder = tmp_path_factory.mktemp("web")
    path = folder / "run.mcap"
    write(path, SIZE_MB * 10**6)
    with subprocess.Popen(
        [sys.executable, "-c", _SERVER, str(folder)],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
        env={**os.environ, "PYTHONPATH": str(repository / "tests" / "support")},
    ) as process:
        assert process.stdout is not None
        address = process.stdout.readline().strip()
        yield Served(path, f"{address}run.mcap", process)
        process.kill()
    path.unlink()


def opened(place: Path | str) -> Bag:
    """Open a recording as a page does: all its messages are found."""
    bag = open_recording(place)
    while not bag.index_more():
        pass
    return bag


def first_picture(place: Path | str) -> None:
    """Open a recording, and read the first message of each topic."""
    with opened(place) as bag:
        for topic in TOPICS:
            assert bag.next(topic, 0) is not None


def test_opening_asks_for_the_index_and_the_first_chunks(
    served: Served, compare: Callable[..., Any]
) -> None:
    before = served.asked()
    first_picture(served.address)
    requests, size = (b - a for a, b in zip(before, served.asked(), strict=True))
    print(f"\nopening and first messages: {requests} requests, {size:.1f} MB")
    assert size < max(3.0, OPENING * SIZE_MB)
    compare(
        "to the first messages, by address against a file",
        lambda: first_picture(served.address),
        lambda: first_picture(served.path),
        rounds=5,
    )


def test_a_jump_asks_for_the_chunks_of_its_time(served: Served) -> None:
    rng = random.Random(2)
    with opened(served.address) as web, opened(served.path) as file:
        first, last = file.start_ns or 0, file.end_ns or 0
        times = [rng.randrange(first + 10**9, last) for _ in range(JUMPS)]
        before = served.asked()
        ours, theirs = ([jump_s(bag, at) for at in times] for bag in (web, file))
        requests, size = (b - a for a, b in zip(before, served.asked(), strict=True))
    print(
        f"\njump p50 {statistics.median(ours) * 1e3:.1f} ms, worst "
        f"{max(ours) * 1e3:.1f}; of the file {statistics.median(theirs) * 1e3:.1f} ms; "
        f"{requests / JUMPS:.1f} requests and {size / JUMPS:.2f} MB each"
    )
    assert size / JUMPS < JUMP_MB


def jump_s(bag: Bag, at: int) -> float:
    """Return how long it takes to get what the displays of six topics show [s]."""
    begin = time.perf_counter()
    for topic in TOPICS:
        assert bag.last(topic, at) is not None
    return time.perf_counter() - begin


def test_playing_on_reads_ahead_and_nothing_twice(served: Served) -> None:
    with opened(served.address) as bag:
        begin_ns = bag.start_ns or 0
        before, count, size = served.asked(), 0, 0
        begin = time.perf_counter()
        for message in bag.messages(begin_ns, begin_ns + 20 * 10**9):
            count += 1
            size += len(message.payload)
        seconds = time.perf_counter() - begin
    requests, asked = (b - a for a, b in zip(before, served.asked(), strict=True))
    print(
        f"\n20 s of {count} messages, {size / 1e6:.0f} MB, in {seconds:.2f} s: "
        f"{requests} requests, {asked:.0f} MB"
    )
    assert asked < 1.5 * size / 1e6 + 2


def test_it_takes_little_more_memory_than_a_file(served: Served) -> None:
    web, file = own_memory(served.address), own_memory(served.path)
    print(f"\nmemory: {web:.0f} MB by address, {file:.0f} MB of the file")
    assert web - file < MEMORY


def test_the_page_is_there_as_soon(served: Served, compare: Callable[..., Any]) -> None:
    def page(source: object) -> float:
        command = (sys.executable, "-m", "sambot_viz", "--source", str(source))
        with start([*command, "--port", "0"]) as server:
            urlopen(server.url, timeout=60.0).close()
            return server.opened

    compare(
        "command to page, by address against a file",
        lambda: page(served.address),
        lambda: page(served.path),
        rounds=3,
    )


def own_memory(place: Path | str) -> float:
    """Return what opening a recording, playing and jumping take at most [MB]."""
    script = (
        "import sys, numpy, zstandard, lz4.frame, requests\n"
        "from sambot_viz.sources.bag import open_bag\n"
        "def peak():\n"
        "    lines = open('/proc/self/status').read().splitlines()\n"
        "    (line,) = [line for line in lines if line.startswith('VmHWM')]\n"
        "    return int(line.split()[1]) / 1024\n"
        "before = peak()\n"
        "with open_bag(sys.argv[1]) as bag:\n"
        "    for n, m in enumerate(bag.messages()):\n"
        "        if n > 5000: break\n"
        "    for at in range(bag.start_ns, bag.end_ns, 10**10):\n"
        "        [bag.last(topic, at) for topic in bag.topics]\n"
        "print(peak() - before)\n"
    )
    command = [sys.executable, "-c", script, str(place)]
    done = subprocess.run(command, check=True, capture_output=True, text=True)
    return float(done.stdout)
