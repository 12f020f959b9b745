"""What a process takes of the machine: computing and memory, on Linux."""

from __future__ import annotations

import os
import re
import time
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
    """What a process has taken so far; without Linux the test is skipped."""
    folder = Path("/proc") / str(process)
    if not folder.is_dir():
        pytest.skip("reads /proc")
    fields = (folder / "stat").read_text("utf-8").rpartition(")")[2].split()
    cpu = (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")
    text = (folder / "status").read_text("utf-8")
    memory, peak = (
        int(found[1]) / 1024
        for name in ("VmRSS", "VmHWM")
        if (found := re.search(rf"{name}:\s+(\d+)", text))
    )
    return Usage(cpu, memory, peak, time.perf_counter())


def forget_peak(process: int) -> None:
    """Let the peak begin at the present memory."""
    (Path("/proc") / str(process) / "clear_refs").write_text("5", "utf-8")
