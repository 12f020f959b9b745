"""A running class: its port, its seats and its board."""

from __future__ import annotations

import asyncio
import os
import threading
from pathlib import Path

from sambot_viz import limits
from sambot_viz.classroom.board import Board
from sambot_viz.classroom.board_pages import Orders
from sambot_viz.classroom.front import LOOK, Front
from sambot_viz.classroom.roll import Roll, Student
from sambot_viz.classroom.seat_process import SeatAddress, SeatProcess
from sambot_viz.errors import UsageError, did_you_mean
from sambot_viz.lessons.lesson import Lesson
from sambot_viz.options import Options
from sambot_viz.robot.packages.package_index import package_name, package_of
from sambot_viz.server.listener import bound_socket, page_url

MOST_PROCESSES = 8


class Classroom:
    """Serves a class, from `start` to `stop`.

    Args:
        options: address to listen on, and the secrets.
        lesson: the lesson; later changes of its files have no effect.
        folder: folder of the class, which holds a folder for each student.
        track: track of the lesson; None for the first.
        processes: number of processes for the seats; None for one per core.

    Raises:
        UsageError: the folder is not writable, or the lesson has no such track.
        ServerError: the address cannot be listened on.
    """

    def __init__(
        self,
        options: Options,
        lesson: Lesson,
        folder: Path,
        track: str | None = None,
        processes: int | None = None,
    ) -> None:
        if track is not None and track not in lesson.tracks:
            near = did_you_mean(track, lesson.tracks)
            raise UsageError(f"the lesson {lesson.name} has no track '{track}'; {near}")
        _refuse_package(folder)
        self.options = options
        self._socket = bound_socket(options)
        named = self._socket.getsockname()
        self._port = 0 if options.unix_socket is not None else int(named[1])
        try:
            self._roll = Roll(folder)
            # A visitor who arrives before the loop runs waits for it.
            self._socket.listen()
        except BaseException:
            self._socket.close()
            raise
        self._board = Board(lesson, self._roll, track)
        count = processes or min(os.cpu_count() or 1, MOST_PROCESSES)
        self._processes = [
            SeatProcess(lesson.file, track, self._board.take) for _ in range(count)
        ]
        orders = Orders(self._say, self._show)
        self._front = Front(options, self._roll, self._board, self._seat_of, orders)
        self._loop = asyncio.new_event_loop()
        self._stopped = threading.Event()
        self._thread = threading.Thread(
            target=self._run, name="sambot-viz-class", daemon=True
        )

    def start(self) -> None:
        """Start listening."""
        self._thread.start()

    def stop(self) -> None:
        """Save the texts of the students, and free the port."""
        if self._thread.is_alive():
            self._loop.call_soon_threadsafe(self._end.set)
            self._thread.join()
        self._socket.close()

    @property
    def port(self) -> int:
        """The port it listens on; 0 for a socket in the file system."""
        return self._port

    @property
    def url(self) -> str:
        """The address for students."""
        return page_url(self.options, "", self._port)

    @property
    def board_url(self) -> str:
        """The secret address of the teacher."""
        return page_url(self.options, "", self._port, "/board", presenter=True)

    def __enter__(self) -> Classroom:
        """Start."""
        self.start()
        return self

    def __exit__(self, *_: object) -> None:
        """Stop."""
        self.stop()

    # On the loop

    def _run(self) -> None:
        asyncio.set_event_loop(self._loop)
        self._end = asyncio.Event()
        self._loop.run_until_complete(self._serve())
        self._loop.close()

    async def _serve(self) -> None:
        server = await asyncio.start_server(
            self._front.serve, sock=self._socket, limit=limits.CLASS_REQUEST.value
        )
        # Students keep the lesson of the start, even if its files change.
        starting = asyncio.gather(*(each.start() for each in self._processes))
        await self._end.wait()
        self._front.state = "stopping"
        await starting
        # The seats notify their pages through the connections that end with them.
        await asyncio.gather(*(each.close() for each in self._processes))
        server.close()
        await self._front.close()

    async def _seat_of(self, student: Student) -> SeatAddress:
        process = self._process_of(student.number)
        is_new = student.number not in process.seats
        seat = await process.open(student.number, self._roll.folder / student.folder)
        if is_new and self._board.shown:
            self._point(student.number)
        return seat

    def _process_of(self, number: int) -> SeatProcess:
        return self._processes[number % len(self._processes)]

    def _say(self, number: int, sentence: str) -> None:
        for each in [number] if number else self._roll.students:
            self._process_of(each).order("say", each, text=sentence)

    def _show(self, number: int) -> None:
        self._board.show(number)
        self._front.end_looks()
        for each in self._roll.students:
            self._point(each)

    def _point(self, number: int) -> None:
        """Tell students whose page is shown to the class."""
        shown = self._board.shown
        name = self._roll.students[shown].name if shown else ""
        link = f"{LOOK.strip('/')}/{shown}/" if shown and shown != number else ""
        self._process_of(number).order("point", number, link=link, name=name)


def _refuse_package(folder: Path) -> None:
    """Refuse a folder inside a package: each student would get all files of it.

    Raises:
        UsageError: the folder lies in a package.
    """
    package = package_of(folder / "lesson.yaml")
    if package_name(package) is not None:
        raise UsageError(
            f"'{folder}' is in the package '{package}', whose files each student could "
            "write: name a folder that is in no package with --dir"
        )
