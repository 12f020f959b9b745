"""``sambot-viz index``: a page with the robots of a lab, one process each."""

from __future__ import annotations

import re
import shlex
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, NoReturn
from urllib.parse import urlsplit

from sambot_viz.commands.command_line import Parser, parse
from sambot_viz.commands.show import parser as parser_of_show
from sambot_viz.errors import SambotVizError, UsageError
from sambot_viz.files import reason_of
from sambot_viz.waiting import wait_for

if TYPE_CHECKING:
    from sambot_viz.lab.indexed_robot import IndexedRobot
    from sambot_viz.options import Options

ENDING = ".conf"
"""The ending of the file of a robot, which systemd reads too."""
_ROUTERS = ("zenoh://", "zenoh+")
_WORDS = re.compile(r"\s*ARGS\s*=\s*(.*)")
_EXAMPLE = "ARGS=/home/robot/my_bot --port 8081 --base-path /my_bot"


def run(words: list[str]) -> int:
    """Serve the index until Ctrl-C."""
    given, options = parse(parser(), words)
    routers = [word for word in given.source if word.startswith(_ROUTERS)]
    robots = [_of_address(word) for word in given.source if word not in routers]
    if given.folder is not None:
        robots += of_folder(Path(given.folder))
    if not robots and not routers:
        raise UsageError(
            "an index needs robots: name a folder with a file NAME.conf for each, or "
            "give --source NAME=http://127.0.0.1:8080 for each; or name a router to "
            "which they broadcast, --source zenoh://127.0.0.1:7447"
        )
    # The imports are late: --help needs no server.
    from sambot_viz.commands.show import announce, until_signal
    from sambot_viz.lab.index import RobotIndex
    from sambot_viz.sources.registry import live_address

    addresses = [live_address(router) for router in routers]

    with (
        until_signal() as stop,
        RobotIndex(options, given.title, robots, addresses) as index,
    ):
        announce(options, index.port, given.open)
        wait_for(stop)
    return 0


def parser() -> Parser:
    """Return the flags of the command."""
    made = Parser(
        prog="sambot-viz index",
        groups=("listen",),
        takes_model=False,
        description="Show a page with several robots, until Ctrl-C: the name of each, "
        "whether its page is there, and a link to it. Each robot is shown by a "
        "sambot-viz of its own, whose /readyz is asked. The links have no token in "
        "them.",
    )
    made.add_argument(
        "folder",
        metavar="FOLDER",
        nargs="?",
        help="a folder with a file NAME.conf for each robot, with a line ARGS= and the "
        "words of its sambot-viz; deploy/sambot-viz@.service starts the same files",
    )
    made.add_argument(
        "--source",
        action="append",
        default=[],
        metavar="[NAME=]ADDRESS",
        help="a robot by the address of its page, such as "
        "turtle=https://lab.example.org/turtle; or a router, zenoh://HOST:7447, with "
        "all robots that broadcast to it; may be given several times",
    )
    made.add_argument(
        "--title",
        default="Robots",
        metavar="TEXT",
        help="the heading of the page (default: %(default)s)",
    )
    made.add_open()
    return made


def _of_address(word: str) -> IndexedRobot:
    from sambot_viz.lab.indexed_robot import IndexedRobot

    name, _, address = word.partition("=")
    parts = urlsplit(address)
    if not name or parts.scheme not in ("http", "https") or not parts.hostname:
        raise UsageError(
            f"--source '{word}' is not NAME=ADDRESS of a robot's page: write it as "
            f"--source {name or 'turtle'}=http://127.0.0.1:8080"
        )
    if parts.query or parts.username or parts.fragment:
        raise UsageError(
            f"--source '{name}': leave out what is behind ? or before @ in its "
            "address: all who open the index would read that"
        )
    asked = address.rstrip("/")
    return IndexedRobot(name, asked, shown=f"{asked}/")


def of_folder(folder: Path) -> list[IndexedRobot]:
    """Return the robots of a folder, by name.

    Raises:
        UsageError: there is none, or one that cannot be shown.
    """
    if not folder.is_dir():
        raise UsageError(f"'{folder}' is not a folder; name one with a file NAME.conf")
    files = sorted(folder.glob(f"*{ENDING}"))
    if not files:
        raise UsageError(
            f"'{folder}' has no file NAME{ENDING}; write one for each robot, with a "
            f"line {_EXAMPLE}"
        )
    robots = [_of_file(file) for file in files]
    _refuse_same_port(folder, robots)
    return robots


def _of_file(file: Path) -> IndexedRobot:
    number, words = _arguments(file)
    try:
        options = parse(_parser_of_robots(), shlex.split(words))[1]
    except ValueError as error:
        raise UsageError(f"{file}:{number}: a quote is not closed: {words}") from error
    except SambotVizError as error:
        raise UsageError(f"{file}:{number}: {error}") from error
    if options.unix_socket is not None or not options.port:
        raise UsageError(
            f"{file}:{number}: the index needs to know its port: add --port 8081, and "
            "another number for each robot"
        )
    return _of_options(file.stem, options)


def _parser_of_robots() -> Parser:
    """Return the flags of a robot's page; a mistake in them is raised, not printed."""
    made = parser_of_show()

    def refuse(status: int = 0, message: str | None = None) -> NoReturn:
        del status
        said = (message or "--help and --version end the program").strip()
        raise UsageError(said.removeprefix(f"{made.prog}: error: "))

    made.exit = refuse
    return made


def _of_options(name: str, options: Options) -> IndexedRobot:
    from sambot_viz.lab.indexed_robot import IndexedRobot
    from sambot_viz.server.listener import page_url, public_url

    bare = options.having(token=None, presenter=None)
    return IndexedRobot(
        name,
        page_url(bare, "", options.port),
        f"{public_url(bare) or ''}/".lstrip("/"),
        options.host,
        options.port,
        options.base_path,
    )


def _arguments(file: Path) -> tuple[int, str]:
    """Return the words of a robot's file, and their line."""
    try:
        lines = file.read_text("utf-8").splitlines()
    except (OSError, UnicodeError) as error:
        why = reason_of(error) if isinstance(error, OSError) else "it is not UTF-8"
        raise UsageError(f"cannot read '{file}': {why}") from error
    found = [*_assigned(lines)]
    if not found:
        raise UsageError(f"{file}: no line ARGS=; write one, such as {_EXAMPLE}")
    return found[-1]


def _assigned(lines: Sequence[str]) -> Iterator[tuple[int, str]]:
    for number, line in enumerate(lines, 1):
        if match := _WORDS.fullmatch(line):
            words = match[1].strip()
            # systemd takes one pair of quotes round the whole value.
            whole = len(words) > 1 and words[0] == words[-1] and words[0] in "\"'"
            yield number, words[1:-1] if whole else words


def _refuse_same_port(folder: Path, robots: Sequence[IndexedRobot]) -> None:
    first: dict[int, str] = {}
    for robot in robots:
        other = first.setdefault(robot.port, robot.name)
        if other != robot.name:
            raise UsageError(
                f"{folder / robot.name}{ENDING}: port {robot.port} is that of {other}, "
                "too: give each robot another --port"
            )
