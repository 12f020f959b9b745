"""A short comparison with viser's own ViserUrdf, for every run of the tests.

Only ratios are judged, of what both did in turn on the same machine. What a busy
machine has spoilt is measured once more before it counts.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from tests.benchmarks.peers import viewers
from tests.benchmarks.peers.driven import NotMeasured
from tests.benchmarks.peers.environments import Environment
from tests.benchmarks.peers.peers import OURS, VISER_URDF, Viewer
from tests.benchmarks.peers.robots import Model
from tests.benchmarks.peers.viewers import Found

STARTS = 3


@dataclass(frozen=True, slots=True)
class Limit:
    """What a measure may be at most, as a ratio to that of ViserUrdf.

    Bytes are allowed a fifth more than on a quiet machine, times two to four times as
    much.
    """

    measure: str
    title: str
    most: float


LIMITS = (
    Limit("page", "command → page opens", 2.0),
    Limit("poses", "poses of all links", 0.15),
    Limit("delay1", "a step → 1 client", 0.5),
    Limit("delay30", "a step → all of 30 clients", 0.6),
    Limit("cpu_one", "computing of a step of one joint", 0.35),
    Limit("cpu_all", "computing of a step of all joints", 0.6),
    Limit("bytes_one", "bytes of a step of one joint", 1.2),
    Limit("bytes_all", "bytes of a step of all joints", 1.2),
    Limit("memory", "memory of the server", 1.0),
)


def run(model: Model, say: Callable[[str], object]) -> bool:
    """Measure both with one robot; True when no ratio is above its limit."""
    wrong = _exceeded(model, say)
    if wrong:
        say("once more, because something else may have been busy")
        wrong &= _exceeded(model, say)
    for title in sorted(wrong):
        say(f"slower than it was: {title}")
    return not wrong


def _exceeded(model: Model, say: Callable[[str], object]) -> set[str]:
    try:
        ours, theirs = _measure(model)
    except NotMeasured as error:
        return {f"not measured: {error}"}
    wrong: set[str] = set()
    for limit in LIMITS:
        mine, other = ours.median(limit.measure), theirs.median(limit.measure)
        if mine is None or not other:
            say(f"  {limit.title}: not measured {ours.reasons} {theirs.reasons}")
            wrong.add(limit.title)
            continue
        say(f"  {limit.title}: {mine / other:.2f} of ViserUrdf's (most {limit.most})")
        if mine / other > limit.most:
            wrong.add(limit.title)
    if ours.median("rest_messages"):
        say("  messages at rest")
        wrong.add("messages at rest")
    return wrong


def _measure(model: Model) -> tuple[Found, Found]:
    here = Environment(Path(sys.executable), None, "", 0.0)
    found: dict[Viewer, Found] = {OURS: Found(), VISER_URDF: Found()}
    for _ in range(STARTS):
        for viewer, one in found.items():
            viewers.measure_start(viewer, here, model, None, one)
    for viewer, one in found.items():
        viewers.measure_moving(viewer, here, model, one)
    return found[OURS], found[VISER_URDF]
