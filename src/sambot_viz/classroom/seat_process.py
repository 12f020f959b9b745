"""A process with seats, as seen from the program of the class."""

from __future__ import annotations

import asyncio
import json
import sys
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from sambot_viz.classroom.seat_state import SeatState
from sambot_viz.errors import ServerError, UsageError

_LONGEST_START = 60.0
"""Longest time that a seat may take to start [s]."""
_LONGEST_END = 10.0
_LONGEST_LINE = 2**20


@dataclass(frozen=True, slots=True)
class SeatAddress:
    """The address of a student's page, and the secrets that open it.

    Attributes:
        port: port on this machine.
        student: secret of the student.
        viewer: secret of viewers.
    """

    port: int
    student: str
    viewer: str


class SeatProcess:
    """A child process with some students' seats; restarted if it has died.

    Args:
        lesson: file of the lesson.
        track: track of the lesson.
        tell: receives the number of a student and the student's progress.

    Attributes:
        seats: the open seats, by student number.
    """

    def __init__(
        self,
        lesson: Path,
        track: str | None,
        tell: Callable[[int, SeatState], object],
    ) -> None:
        self._first = {"lesson": str(lesson), "track": track}
        self._tell = tell
        self._process: asyncio.subprocess.Process | None = None
        self._reading: asyncio.Task[None] | None = None
        self._starting = asyncio.Lock()
        self._ended = False
        self._waiting: dict[int, asyncio.Future[SeatAddress]] = {}
        self.seats: dict[int, SeatAddress] = {}

    async def start(self) -> None:
        """Start the process, unless it runs.

        Raises:
            ServerError: the process has been closed.
        """
        async with self._starting:
            if self._reading is not None and not self._reading.done():
                return
            if self._ended:
                raise ServerError("the class ends")
            self.seats.clear()
            self._process = await asyncio.create_subprocess_exec(
                *(sys.executable, "-X", "utf8", "-m", "sambot_viz.classroom.seats"),
                stdin=asyncio.subprocess.PIPE,
                stdout=asyncio.subprocess.PIPE,
                limit=_LONGEST_LINE,
                # Ctrl-C goes to the program of the class, which then ends this process.
                start_new_session=True,
            )
            self._send(self._first)
            self._reading = asyncio.create_task(self._read(self._process))

    async def open(self, number: int, folder: Path) -> SeatAddress:
        """Open the seat of a student, unless it is open.

        Raises:
            UsageError: the student's files are not writable.
            ServerError: the process does not answer.
        """
        await self.start()
        if number in self.seats:
            return self.seats[number]
        waiting = self._waiting.get(number)
        if waiting is None:
            waiting = asyncio.get_running_loop().create_future()
            self._waiting[number] = waiting
            self._send({"do": "open", "number": number, "folder": str(folder)})
        try:
            return await asyncio.wait_for(asyncio.shield(waiting), _LONGEST_START)
        except asyncio.TimeoutError as error:
            raise ServerError("the page of a student does not begin") from error
        finally:
            self._waiting.pop(number, None)

    def order(self, what: str, number: int, **fields: str) -> None:
        """Send an order for a student; do nothing if the student has no seat."""
        if number in self.seats:
            self._send({"do": what, "number": number, **fields})

    async def close(self) -> None:
        """End the process, which first notifies its pages and saves unsaved texts."""
        self._ended = True
        process = self._process
        if process is None or process.stdin is None:
            return
        process.stdin.close()
        if not self.seats:
            process.kill()
        try:
            await asyncio.wait_for(process.wait(), _LONGEST_END)
        except asyncio.TimeoutError:
            process.kill()
            await process.wait()

    def _send(self, order: dict[str, Any]) -> None:
        assert self._process is not None and self._process.stdin is not None
        self._process.stdin.write(f"{json.dumps(order)}\n".encode())

    async def _read(self, process: asyncio.subprocess.Process) -> None:
        assert process.stdout is not None
        async for line in process.stdout:
            self._take(json.loads(line))
        for waiting in self._waiting.values():
            if not waiting.done():
                waiting.set_exception(ServerError("the page of a student has ended"))

    def _take(self, answer: dict[str, Any]) -> None:
        number = answer.get("number", 0)
        waiting = self._waiting.get(number)
        if "state" in answer:
            self._tell(number, SeatState.read(answer["state"]))
        elif waiting is None or waiting.done():
            return
        elif "refused" in answer:
            waiting.set_exception(UsageError(answer["refused"]))
        elif "port" in answer:
            seat = SeatAddress(answer["port"], answer["student"], answer["viewer"])
            self.seats[number] = seat
            waiting.set_result(seat)
