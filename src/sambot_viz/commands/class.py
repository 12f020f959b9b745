"""``sambot-viz class``: a lesson for a whole class, and a board for its teacher."""

from __future__ import annotations

import os
from argparse import Namespace
from pathlib import Path

from sambot_viz.commands.command_line import Parser, parse
from sambot_viz.commands.lesson import add_track, lesson_of
from sambot_viz.errors import UsageError
from sambot_viz.lessons.lesson import Lesson
from sambot_viz.options import Options
from sambot_viz.outlet import write_err
from sambot_viz.waiting import wait_for

_SECRET = "SAMBOT_VIZ_PRESENTER"
"""The environment variable with the secret of the board's address."""


def run(words: list[str]) -> int:
    """Serve a class until Ctrl-C."""
    given, options = parse(parser(), words, presenter=os.environ.get(_SECRET, ""))
    lesson = lesson_of(given.lesson, ())
    folder = Path(given.dir or f"{lesson.name}-class")
    if given.hub:
        _show_board(options, lesson, folder, given)
        return 0
    # The imports are late: --help needs no server.
    from sambot_viz.classroom.classroom import Classroom
    from sambot_viz.commands.show import announce, until_signal

    with (
        until_signal() as stop,
        Classroom(options, lesson, folder, given.track) as room,
    ):
        write_err(f"sambot-viz: the students' files are in {folder}")
        whose = ("students:  ", "teacher:   ")
        announce(options, room.port, given.open, "/board", whose)
        wait_for(stop)
    return 0


def _show_board(
    options: Options, lesson: Lesson, folder: Path, given: Namespace
) -> None:
    """Serve the board of a class on a JupyterHub until Ctrl-C."""
    if not folder.is_dir():
        raise UsageError(
            f"--hub: '{folder}' is not a folder: name the one that has the students' "
            "folders with --dir"
        )
    from sambot_viz.classroom.hub import Hub
    from sambot_viz.classroom.hub_board import HubBoard
    from sambot_viz.commands.show import announce_board, until_signal

    hub = Hub.of_environment()
    if options.base_path == "/":
        options = options.having(base_path=hub.prefix)
    with (
        until_signal() as stop,
        HubBoard(options, lesson, folder, given.track, hub) as board,
    ):
        announce_board(board.options, board.port, given.open)
        wait_for(stop)


def parser() -> Parser:
    """Return the flags of the command."""
    made = Parser(
        prog="sambot-viz class",
        groups=("listen",),
        takes_model=False,
        description="Show a lesson to a class, until Ctrl-C. Two addresses are "
        "printed. Students open the first one and type a name: each has a page and a "
        "folder, and finds both again after a reload, a lost network or a restart. The "
        "second one is the teacher's board: how far each student is, what is wrong "
        "there, and a look over the shoulder.",
    )
    made.add_argument(
        "lesson",
        metavar="LESSON",
        help="name of a lesson that ships, a lesson.yaml, or its folder",
    )
    add_track(made)
    made.add_argument(
        "--dir",
        metavar="DIR",
        help="the folder of the class, with a folder for each student in it; by "
        "default a new one with the name of the lesson",
    )
    made.add_argument(
        "--hub",
        action="store_true",
        help="only the board, as a service of a JupyterHub: the students are users of "
        "the hub, whose folders are in that of --dir",
    )
    made.add_open()
    return made
