"""What every driver says and does, so that all are measured in the same way.

A driver is a small program that shows a robot with one of the viewers. It runs in the
viewer's own environment, so nothing here needs more than Python itself::

    driver.py MODEL     says {"url": …, "loaded": s} as a line of JSON, and then obeys
                        lines of JSON on its standard input:
    {"do": "move", "joints": n, "value": q}                     moves the first n joints
    {"do": "pace", "joints": n, "rate": Hz, "steps": m, "pause": s}     m times, with
                        a pause after each where the viewer does not keep the rate
    {"do": "poses", "times": n}                                 poses of all links
    {"do": "robot_at"}, {"do": "changed", "value": q}           a window of its own

Times are of `time.perf_counter` [s], which on Linux is one clock for all processes.
"""

from __future__ import annotations

import json
import socket
import sys
import time
from collections.abc import Callable, Sequence
from contextlib import redirect_stdout
from typing import Any, TypeVar

Move = Callable[[Sequence[str], float], object]
Moved = Callable[[], object]


def free_port() -> int:
    """A port of the loopback interface that nobody uses now."""
    with socket.socket() as found:
        found.bind(("127.0.0.1", 0))
        return int(found.getsockname()[1])


def model_argument() -> str:
    """The model that the driver is to show."""
    return sys.argv[1]


Model = TypeVar("Model")


def least(read: Callable[[], Model]) -> tuple[Model, float]:
    """Read a model three times, with no output; returns it and the least time [s].

    The first time, a program also loads what it needs for reading.
    """
    times: list[float] = []
    for _ in range(3):
        with Loading() as loading:
            model = read()
        times.append(loading.seconds)
    return model, min(times)


class Loading:
    """``with Loading() as loading``: how long reading a model took, with no output."""

    seconds = 0.0

    def __enter__(self) -> Loading:
        self._quiet = redirect_stdout(sys.stderr)
        self._quiet.__enter__()
        self._start = time.perf_counter()
        return self

    def __exit__(self, *error: Any) -> None:
        self.seconds = time.perf_counter() - self._start
        self._quiet.__exit__(*error)


def obey(
    url: str,
    names: Sequence[str],
    move: Move | None = None,
    poses: Callable[[float], object] | None = None,
    loaded: float | None = None,
    robot_at: Callable[[], float] | None = None,
    changed: Callable[[Moved], float] | None = None,
    **more: object,
) -> None:
    """Say where the page is, and do what is asked until standard input ends.

    Args:
        url: of the page.
        names: the joints that can be moved.
        move: moves these joints to one position [rad or m].
        poses: computes the poses of all links with all joints at a position.
        loaded: how long the model took to be read [s].
        robot_at: when the robot is first seen in a window (`time.time`) [s]; a page
            is looked at from outside.
        changed: how long a step takes until the picture in that window changes [s].
        more: further facts to say.
    """
    can = {"moves": move is not None, "poses": poses is not None}
    print(json.dumps({"url": url, "loaded": loaded, **can, **more}), flush=True)
    for line in sys.stdin:
        order = json.loads(line)
        with redirect_stdout(sys.stderr):
            if order["do"] == "robot_at" and robot_at is not None:
                answer = {"clock": robot_at()}
            elif order["do"] == "changed" and changed is not None:
                value = order["value"]
                answer = {"took": changed(lambda q=value: move(names[:1], q))}
            else:
                answer = _do(order, names, move, poses)
        print(json.dumps(answer), flush=True)


def _do(
    order: dict[str, Any],
    names: Sequence[str],
    move: Move | None,
    poses: Callable[[float], object] | None,
) -> dict[str, Any]:
    moved = names[: order.get("joints", 1)]
    if order["do"] == "move" and move is not None:
        at = time.perf_counter()
        move(moved, order["value"])
        return {"at": at, "clock": time.time() - time.perf_counter() + at}
    if order["do"] == "pace" and move is not None:
        pause = order.get("pause", 0.0)
        return {"at": _pace(move, moved, order["rate"], order["steps"], pause)}
    if order["do"] == "poses" and poses is not None:
        return {"each": _each(poses, order["times"])}
    return {"error": f"cannot {order['do']}"}


def _pace(
    move: Move, names: Sequence[str], rate: float, steps: int, pause: float
) -> list[float]:
    """Move at a rate [Hz], with a pause after each step [s]; returns their starts."""
    start = time.perf_counter()
    times: list[float] = []
    for number in range(1, steps + 1):
        time.sleep(max(pause, start + number / rate - time.perf_counter()))
        times.append(time.perf_counter())
        move(names, 0.5 * number / steps)
    return times


def _each(poses: Callable[[float], object], times: int) -> float:
    """The computing of one call [s], the least of five series."""
    best = float("inf")
    for series in range(5):
        start = time.process_time()
        for number in range(times):
            poses(0.001 * (number + series * times))
        best = min(best, time.process_time() - start)
    return best / times
