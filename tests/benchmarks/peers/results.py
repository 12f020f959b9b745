"""What was found, as it is kept: JSON that a later run reads and completes."""

from __future__ import annotations

import os
import platform
import statistics
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from datetime import date
from pathlib import Path

import msgspec
from tests.benchmarks.peers.checkers import Verdict
from tests.benchmarks.peers.viewers import Found


@dataclass(frozen=True, slots=True)
class Spread:
    """The values of a measure in few words, in its own unit.

    Attributes:
        median: the middle one.
        half: half the distance between the quarters; None with fewer than three values.
        least: the smallest.
        most: the largest.
        count: how many there are.
        ratio: of the median to this program's; None where that is not known or 0.
    """

    median: float
    half: float | None
    least: float
    most: float
    count: int
    ratio: float | None


@dataclass(slots=True)
class Column:
    """What a table says of one program.

    Attributes:
        spreads: by measure.
        hosts: other hosts that its page has asked; None when no browser has opened it.
        reasons: why something was not measured.
    """

    spreads: dict[str, Spread]
    hosts: list[str] | None
    reasons: dict[str, str]

    def median(self, measure: str) -> float | None:
        """The middle value; None when there is none."""
        spread = self.spreads.get(measure)
        return None if spread is None else spread.median


Columns = dict[str, Column]
"""By name of the program; this one is the first."""


@dataclass(frozen=True, slots=True)
class Run:
    """When and where a part was measured.

    Attributes:
        date: of the day.
        machine: without names.
        seconds: how long the part took.
    """

    date: str
    machine: str
    seconds: float


@dataclass(slots=True)
class Results:
    """All that is known; every part is that of its last run.

    Attributes:
        runs: by robot for viewers, by `PARTS` otherwise.
        viewers: by robot.
        versions: of all peers.
        sizes: what each takes on the disk [MB].
        absent: peers that were not measured, with the reason.
        checkers: by name.
        recordings: by name.
        recording_size: of the file [MB].
        growth: by plot and line, the points (count, computing of a step [ms]).
    """

    runs: dict[str, Run] = field(default_factory=dict[str, Run])
    viewers: dict[str, Columns] = field(default_factory=dict[str, Columns])
    versions: dict[str, str] = field(default_factory=dict[str, str])
    sizes: dict[str, float] = field(default_factory=dict[str, float])
    absent: dict[str, str] = field(default_factory=dict[str, str])
    checkers: dict[str, Verdict] = field(default_factory=dict[str, Verdict])
    recordings: Columns = field(default_factory=Columns)
    recording_size: float = 0.0
    growth: dict[str, dict[str, list[tuple[float, float]]]] = field(
        default_factory=dict[str, dict[str, list[tuple[float, float]]]]
    )

    def ran(self, part: str, seconds: float) -> None:
        """Note that a part was measured now, on this machine."""
        self.runs[part] = Run(date.today().isoformat(), machine(), round(seconds))


def columns(found: Mapping[str, Found]) -> Columns:
    """Medians and spread of what was found, with ratios to the first one."""
    made: Columns = {}
    for name, one in found.items():
        ours = next(iter(made.values()), None)
        made[name] = Column(
            {key: _spread(key, values, ours) for key, values in one.values.items()},
            sorted(one.hosts) if one.values.get("size") else None,
            dict(one.reasons),
        )
    return made


def _spread(key: str, values: Sequence[float], ours: Column | None) -> Spread:
    median = statistics.median(values)
    base = median if ours is None else ours.median(key)
    half = None
    if len(values) > 2:
        quarters = statistics.quantiles(values, n=4)
        half = _short((quarters[2] - quarters[0]) / 2)
    least, most = _short(min(values)), _short(max(values))
    ratio = _short(median / base) if base else None
    return Spread(_short(median), half, least, most, len(values), ratio)


def _short(value: float) -> float:
    """Four digits: the fifth differs from run to run."""
    return float(f"{value:.4g}")


def machine() -> str:
    """What it runs on, without names."""
    return (
        f"{os.cpu_count()} cores, {platform.machine()}, {platform.system()}, "
        f"Python {platform.python_version()}, software WebGL"
    )


def read(path: Path) -> Results:
    """What earlier runs have left; nothing when there is no file.

    Raises:
        msgspec.MsgspecError: the file is not what `write` has written.
    """
    if not path.is_file():
        return Results()
    return msgspec.json.decode(path.read_bytes(), type=Results)


def write(results: Results, path: Path) -> None:
    """Keep medians, spread and ratios, for `read` and for other programs."""
    path.parent.mkdir(parents=True, exist_ok=True)
    text = msgspec.json.format(msgspec.json.encode(results), indent=1)
    path.write_bytes(text + b"\n")
