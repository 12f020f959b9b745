"""Whether a server answers and shows something, of each kind; and how it ends."""

from __future__ import annotations

import signal
import subprocess
from collections.abc import Callable, Generator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from urllib.error import HTTPError
from urllib.parse import urlsplit
from urllib.request import Request, urlopen

import pytest
from a_class import ASKED, MODEL, Browser, a_class, shown, write
from lesson_files import BASE
from patience import patience, until
from program import rest_of, running
from protocol_client import ProtocolClient

from sambot_viz import Visualizer
from sambot_viz.inputs import Inputs
from sambot_viz.lessons.read_lesson import open_lesson
from sambot_viz.lessons.study import Study
from sambot_viz.options import Options

SECRET = "the-secret-of-the-lab"
WORDS = {"ok", "ready", "waiting", "stopping"}
TEXT = "<robot name='typed'><link name='base_link'/></robot>"
BEFORE = "<robot name='saved'><link name='base_link'/></robot>"


def ask(address: str, **headers: str) -> tuple[int, str]:
    """Status and word of an answer; it brings nothing else."""
    try:
        with urlopen(Request(address, headers=headers), timeout=patience(10)) as got:
            status, text, more = got.status, got.read().decode(), got.headers
    except HTTPError as error:
        with error:
            status, text, more = error.code, error.read().decode(), error.headers
    assert text.strip() in WORDS and "Set-Cookie" not in more
    return status, text.strip()


@contextmanager
def show(folder: Path, **options: str) -> Generator[int]:
    with Visualizer(**options) as viz:
        yield viz.viser.get_port()


@contextmanager
def lesson(folder: Path, **options: str) -> Generator[int]:
    study = Study.begun(open_lesson(BASE), folder / "mine")
    inputs = Inputs(Options(**options).learning(study), may_be_broken=True)  # pyright: ignore[reportArgumentType]
    with Visualizer.of_inputs(inputs) as viz:
        yield viz.viser.get_port()


@contextmanager
def a_whole_class(folder: Path, **options: str) -> Generator[int]:
    with a_class(folder / "class", **options) as room:
        yield room.port


@pytest.mark.parametrize("kind", [show, lesson, a_whole_class])
@pytest.mark.parametrize("options", [{}, {"token": SECRET}, {"base_path": "/robot"}])
def test_each_kind_of_server_says_that_it_answers_and_shows_something(
    kind: Callable[..., Generator[int]], options: dict[str, str], tmp_path: Path
) -> None:
    with kind(tmp_path, **options) as port:
        for base in {"", options.get("base_path", "")}:
            address = f"http://127.0.0.1:{port}{base}"
            # A probe knows neither the name of the server nor its token.
            for host in (f"127.0.0.1:{port}", "10.1.2.3", "robots.example.org"):
                assert ask(f"{address}/healthz", Host=host) == (200, "ok")
                assert ask(f"{address}/readyz?verbose", Host=host) == (200, "ready")


def test_a_server_without_a_robot_answers_and_is_not_ready(tmp_path: Path) -> None:
    model = tmp_path / "robot.urdf"
    model.write_text("<robot name='a'>")
    inputs = Inputs(Options(model, watch=True), may_be_broken=True)
    with Visualizer.of_inputs(inputs) as viz:
        address = f"http://127.0.0.1:{viz.viser.get_port()}"
        assert ask(f"{address}/healthz") == (200, "ok")
        assert ask(f"{address}/readyz") == (503, "waiting")
        model.write_text(TEXT)
        until(lambda: ask(f"{address}/readyz") == (200, "ready"))


def test_while_it_stops_a_server_answers_and_takes_no_page(viz: Visualizer) -> None:
    address = f"http://127.0.0.1:{viz.viser.get_port()}"
    found: list[object] = []

    def look() -> None:
        found.extend((ask(f"{address}/healthz"), ask(f"{address}/readyz")))
        with pytest.raises(HTTPError) as refused:
            urlopen(address, timeout=patience(10))
        with refused.value as answer:
            found.append((answer.code, answer.headers["Retry-After"]))

    sessions = viz.server.sessions
    close, sessions.close = sessions.close, lambda: (look(), close())[1]
    viz.stop()
    assert found == [(200, "ok"), (503, "stopping"), (503, "2")]


@dataclass(frozen=True)
class Program:
    """A kind of program, as a user starts it.

    Attributes:
        words: of its command line.
        file: in which a page writes; none where it writes nothing by itself.
        takes_name: whether who opens it types a name.
    """

    words: tuple[str, ...]
    file: str = ""
    takes_name: bool = False


PROGRAMS = (
    Program(("--watch",)),
    Program(("lesson", str(BASE), "--dir", "mine"), f"mine/{MODEL}"),
    Program(("class", str(BASE), "--dir", "all"), f"all/Ada/{MODEL}", takes_name=True),
)


def page_of(process: subprocess.Popen[str], program: Program) -> ProtocolClient:
    """Open the page that a program prints first."""
    assert process.stdout is not None
    address = urlsplit(process.stdout.readline().split()[-1])
    assert address.port is not None
    headers: dict[str, str] = {}
    if program.takes_name:
        asked = Request(f"http://{address.netloc}/join", headers={ASKED: "Ada"})
        with urlopen(asked, timeout=patience(60)) as joined:
            headers["Cookie"] = joined.headers["Set-Cookie"].partition(";")[0]
    client = ProtocolClient(address.port, headers=headers)
    # The program may still import, on a busy machine for long.
    client.wait_until(lambda: "names/session" in client.rows, 60.0)
    return client


@pytest.mark.parametrize("program", PROGRAMS, ids=lambda program: program.words[0])
def test_a_program_that_is_told_to_end_tells_its_pages_and_saves_texts(
    program: Program, tmp_path: Path
) -> None:
    with running(*program.words, "--port", "0", cwd=tmp_path) as process:
        page = page_of(process, program)
        if program.file:
            write(page, TEXT)
        process.send_signal(signal.SIGTERM)
        _, err = rest_of(process)
        assert process.returncode == 0 and "Traceback" not in err
        page.wait_until(lambda: page.channel_code is not None)
        assert page.channel_code == 1012, "the page knows that it may come back"
        page.close()
    if program.file:
        assert (tmp_path / program.file).read_text() == TEXT


def test_a_text_of_a_robot_is_kept_and_the_next_program_begins_with_it(
    tmp_path: Path,
) -> None:
    model = tmp_path / "robot.urdf"
    model.write_text(BEFORE)
    program = Program((str(model), "--edit"))
    draft = tmp_path / ".robot.urdf.draft"
    with running(*program.words, "--port", "0", cwd=tmp_path) as process:
        page = page_of(process, program)
        write(page, TEXT)
        process.send_signal(signal.SIGTERM)
        _, err = rest_of(process)
        assert process.returncode == 0 and "Traceback" not in err
        page.close()
    assert model.read_text() == BEFORE and draft.exists()
    with running(*program.words, "--port", "0", cwd=tmp_path) as process:
        page = page_of(process, program)
        page.act("model/show", True)
        page.wait_until(lambda: shown(page, "model/text") is not None)
        assert shown(page, "model/text")["text"] == TEXT
        assert shown(page, "model/text")["changed"]
        page.act("model/save", "robot.urdf")
        page.wait_until(lambda: model.read_text() == TEXT)
        page.wait_until(lambda: not draft.exists())
        page.close()
        process.send_signal(signal.SIGTERM)
        _, err = rest_of(process)
        assert "robot.urdf has text that was not saved when the program ended" in err
    assert not draft.exists()


def test_a_seat_outlives_what_ends_all_processes_of_a_service(tmp_path: Path) -> None:
    with a_class(tmp_path / "class") as room:
        ada = Browser(room)
        ada.join("Ada")
        page = ada.page()
        write(page, TEXT)
        (seats,) = room._processes  # pyright: ignore[reportPrivateUsage]
        child = seats._process  # pyright: ignore[reportPrivateUsage]
        assert child is not None
        child.send_signal(signal.SIGTERM)
        page.act("model/show", True)
        page.wait_until(lambda: shown(page, "model/text")["text"] == TEXT)
        assert child.returncode is None
    ada.close()
    assert (tmp_path / "class" / "Ada" / MODEL).read_text() == TEXT
