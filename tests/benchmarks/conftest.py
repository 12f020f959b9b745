"""Measuring fairly on a machine that does other things as well.

Absolute times say little, so two ways of doing the same are run in turn, A B A B …,
and the ratio of their medians is judged. Run this folder by itself::

    python -m pytest tests/benchmarks -s
"""

from __future__ import annotations

import re
import select
import statistics
import subprocess
import sys
import time
from collections.abc import Callable, Generator, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from urllib.parse import urlsplit

import pytest
from a_chromium import a_chromium

from sambot_viz.export.chromium import Chromium

LONGEST = 120.0
"""How long any one run may take [s]."""


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Everything in this folder is a benchmark."""
    for item in items:
        if Path(__file__).parent in item.path.parents:
            item.add_marker(pytest.mark.benchmark)


@pytest.fixture(scope="session")
def chromium() -> Iterator[Chromium]:
    """A browser for all; it draws without a GPU, so a frame takes long."""
    with a_chromium(timeout=120.0) as browser:
        yield browser


@dataclass(frozen=True)
class Comparison:
    """Times of two ways [s], in the order in which they were measured."""

    name: str
    ours: tuple[float, ...]
    theirs: tuple[float, ...]

    @property
    def ratio(self) -> float:
        """Our median divided by theirs."""
        return statistics.median(self.ours) / statistics.median(self.theirs)

    def __str__(self) -> str:
        ours, theirs = statistics.median(self.ours), statistics.median(self.theirs)
        spread = max(self.ours) - min(self.ours)
        return (
            f"{self.name}: ours {ours:.3f} s (spread {spread:.3f}), "
            f"theirs {theirs:.3f} s, ratio {self.ratio:.2f}"
        )


@pytest.fixture
def compare() -> Callable[..., Comparison]:
    """``compare(name, ours, theirs, rounds=7)``: time two functions in turn."""

    def measure(
        name: str,
        ours: Callable[[], float | None],
        theirs: Callable[[], float | None],
        rounds: int = 7,
    ) -> Comparison:
        """Time both.

        Args:
            name: what is measured.
            ours: does it our way; returns its own time [s], or None to be timed here.
            theirs: does it the way we compare with.
            rounds: how often each; one more run of each warms the caches first.
        """
        times: tuple[list[float], list[float]] = ([], [])
        for number in range(rounds + 1):
            for run, found in zip((ours, theirs), times, strict=True):
                start = time.perf_counter()
                own = run()
                taken = time.perf_counter() - start if own is None else own
                if number:
                    found.append(taken)
        result = Comparison(name, tuple(times[0]), tuple(times[1]))
        print(f"\n{result}")
        return result

    return measure


@dataclass(frozen=True)
class Started:
    """A server that was started as a process of its own.

    Attributes:
        url: what it printed.
        at: when it was started (`time.perf_counter`) [s].
        opened: how long it took until it printed its address [s].
        process: its number.
        tell: sends it a line on its standard input.
    """

    url: str
    at: float
    opened: float
    process: int
    tell: Callable[[str], object]

    @property
    def port(self) -> int:
        """Where it listens."""
        return urlsplit(self.url).port or 0


@contextmanager
def start(command: Sequence[str]) -> Generator[Started, None, None]:
    """Run a command until it prints an address on its standard output."""
    at = time.perf_counter()
    process = subprocess.Popen(
        command,
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
        text=True,
        bufsize=1,
    )
    try:
        assert process.stdin is not None
        assert process.stdout is not None
        ready, _, _ = select.select([process.stdout], [], [], LONGEST)
        line = process.stdout.readline() if ready else ""
        found = re.search(r"http://\S+", line)
        assert found is not None, f"{command} printed {line!r}"
        opened = time.perf_counter() - at
        tell = process.stdin.write
        yield Started(found.group(), at, opened, process.pid, tell)
    finally:
        process.terminate()
        process.wait(LONGEST)
        for stream in (process.stdin, process.stdout):
            if stream is not None:
                stream.close()


@pytest.fixture
def run_server() -> Callable[[Sequence[str]], object]:
    """``with run_server([...]) as started:`` a server in a process of its own."""
    return lambda arguments: start([sys.executable, *arguments])
