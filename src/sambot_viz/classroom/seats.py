"""The program of a few seats: `python -m sambot_viz.classroom.seats`.

It runs as a separate process, so that the seats of a class use all cores and one
student's text cannot block the whole class. Orders arrive as lines of JSON on standard
input, answers leave as lines on standard output. It ends when either stream closes.
"""

from __future__ import annotations

import json
import os
import signal
import sys
import threading
from functools import partial
from pathlib import Path
from typing import Any

from sambot_viz.classroom.seat import Seat
from sambot_viz.classroom.seat_state import SeatState
from sambot_viz.errors import SambotVizError
from sambot_viz.lessons.read_lesson import open_lesson


class Seats:
    """Seats by student number, and the stream for their answers.

    Args:
        out: receives lines.
    """

    def __init__(self, out: Any) -> None:
        self._out, self._lock = out, threading.Lock()
        self._seats: dict[int, Seat] = {}

    def run(self, lines: Any) -> None:
        """Carry out orders until the input ends."""
        first = json.loads(next(lines))
        self._lesson, self._track = open_lesson(first["lesson"]), first["track"]
        self._answer(ready=True)
        for line in lines:
            self._take(json.loads(line))
        for seat in self._seats.values():
            seat.close()

    def _take(self, order: dict[str, Any]) -> None:
        number = order["number"]
        if order["do"] == "open":
            self._open(number, Path(order["folder"]))
        elif number in self._seats and order["do"] == "say":
            self._seats[number].page.say(order["text"])
        elif number in self._seats and order["do"] == "point":
            self._seats[number].page.point_to(order["link"], order["name"])

    def _open(self, number: int, folder: Path) -> None:
        tell = partial(self._tell, number)
        try:
            seat = Seat(self._lesson, folder, self._track, tell)
        except SambotVizError as error:
            self._answer(number=number, refused=str(error))
            return
        self._seats[number] = seat
        self._answer(
            number=number,
            port=seat.port,
            student=seat.student_secret,
            viewer=seat.viewer_secret,
        )

    def _tell(self, number: int, state: SeatState) -> None:
        self._answer(number=number, state=state.as_json())

    def _answer(self, **fields: Any) -> None:
        with self._lock:
            self._out.write(f"{json.dumps(fields)}\n")
            self._out.flush()


def main() -> None:
    """Serve seats until standard input ends."""
    # A service manager sends SIGTERM to all processes of a class. This process ends
    # with the program of the class, once the texts of its students are saved.
    signal.signal(signal.SIGTERM, signal.SIG_IGN)
    # Only answers may go to this stream.
    out = os.fdopen(os.dup(1), "w", encoding="utf-8")
    os.dup2(2, 1)
    Seats(out).run(iter(sys.stdin.readline, ""))


if __name__ == "__main__":
    main()
