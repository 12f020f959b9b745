"""What a process takes of the machine: computing and memory, on Linux."""

from __future__ import annotations

import os
import re
import time
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

import pytest


@dataclass(frozen=True)
class Usage:
    """What a process has taken so far.

    Attributes:
        cpu: time that its threads have computed [s].
        memory: that it has now [MB].
        peak: the most memory that it had since `forget_peak` [MB].
        at: when this was (`time.perf_counter`) [s].
    """

    cpu: float
    memory: float
    peak: float
    at: float

    def share_since(self, before: Usage) -> float:
        """Of one core, since then: 0.5 is half of it."""
        return (self.cpu - before.cpu) / (self.at - before.at)


def usage(process: int) -> Usage:
    """What a process has taken so far; without Linux the test is skipped.

    Raises:
        OSError: there is no such process.
    """
    if not Path("/proc").is_dir():
        pytest.skip("reads /proc")
    folder = Path("/proc") / str(process)
    fields = (folder / "stat").read_text("utf-8").rpartition(")")[2].split()
    cpu = (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")
    text = (folder / "status").read_text("utf-8")
    found = [re.search(rf"{name}:\s+(\d+)", text) for name in ("VmRSS", "VmHWM")]
    if None in found:
        raise ProcessLookupError(f"process {process} has ended")
    memory, peak = (int(one[1]) / 1024 for one in found if one is not None)
    return Usage(cpu, memory, peak, time.perf_counter())


def family(process: int) -> Iterator[int]:
    """The number of a process, and those of all that it has started."""
    yield process
    for children in (Path("/proc") / str(process)).glob("task/*/children"):
        with suppress(OSError):
            for child in children.read_text("utf-8").split():
                yield from family(int(child))


def family_usage(process: int) -> Usage:
    """What a process and all that it has started have taken so far.

    What has ended meanwhile does not count.
    """
    parts: list[Usage] = []
    for member in family(process):
        with suppress(OSError):
            parts.append(usage(member))
    return Usage(
        sum(part.cpu for part in parts),
        sum(part.memory for part in parts),
        sum(part.peak for part in parts),
        time.perf_counter(),
    )


def forget_peak(process: int) -> None:
    """Let the peak begin at the present memory."""
    (Path("/proc") / str(process) / "clear_refs").write_text("5", "utf-8")
