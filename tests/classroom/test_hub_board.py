"""The board of a class on a hub: users, folders on a shared volume, and reports."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterator
from contextlib import closing
from dataclasses import replace
from functools import partial
from pathlib import Path
from urllib.error import HTTPError
from urllib.parse import urlsplit
from urllib.request import Request, urlopen

import pytest
from a_class import MODEL, BoardRows, write
from a_hub_api import HubApi, a_hub_api
from lesson_files import BASE
from lower_limit import lower
from patience import patience
from protocol_client import ProtocolClient

from sambot_viz import Visualizer
from sambot_viz.classroom import hub_roll
from sambot_viz.classroom.hub import Hub
from sambot_viz.classroom.hub_board import HubBoard
from sambot_viz.classroom.hub_roll import HubRoll
from sambot_viz.classroom.seat_state import STATE_FILE, SeatState
from sambot_viz.classroom.student_page import reported
from sambot_viz.errors import ServerError, UsageError
from sambot_viz.inputs import Inputs
from sambot_viz.lessons.progress import PROGRESS_FILE
from sambot_viz.lessons.read_lesson import open_lesson
from sambot_viz.lessons.study import Study
from sambot_viz.options import Options

LESSON = open_lesson(BASE)
WRONG = '<robot name="ada"><link name="base_link"/></robot>'
RUNS = {"ready": True, "pending": None}
STATE = SeatState(1, "The body", 0, 0.0, errors=2, first="No <robot>.", pages=1)


@pytest.fixture
def hub() -> Iterator[HubApi]:
    with a_hub_api() as running:
        yield running


class Hand:
    """A clock that the test moves."""

    def __init__(self) -> None:
        self.now = 0.0

    def __call__(self) -> float:
        return self.now


def a_folder(root: Path, name: str, state: SeatState | None = STATE) -> Path:
    """Make the folder of a student, with a report of the page."""
    folder = root / name
    folder.mkdir(parents=True)
    if state is not None:
        state.report(folder)
    return folder


def seen(roll: HubRoll) -> dict[str, SeatState]:
    """Name of each student → the state on the board."""
    states = roll.look(LESSON)
    return {roll.students[number].name: state for number, state in states.items()}


def test_each_student_is_a_row_whatever_server_they_are_on(
    hub: HubApi, tmp_path: Path
) -> None:
    hub.servers |= {
        "ada": RUNS,
        "ben": {"ready": False, "pending": "spawn"},
        "cleo": None,
        "dan": RUNS,
        "eve": None,
    }
    for name in ("ada", "ben", "cleo", "gone"):
        a_folder(tmp_path, name)
    found = seen(HubRoll(tmp_path, Hub(hub.api, hub.token)))
    servers = {name: (state.server, state.pages) for name, state in found.items()}
    assert servers == {
        "ada": ("", 1),
        "ben": ("starts", 0),
        "cleo": ("no server", 0),
        # A server without a page of the lesson, and a user whom the hub has no longer.
        "dan": ("no folder yet", 0),
        "gone": ("", 1),
    }
    assert {state.errors for name, state in found.items() if name != "dan"} == {2}


def test_a_folder_with_the_name_of_a_pod_is_that_of_its_user(
    hub: HubApi, tmp_path: Path
) -> None:
    name = "José.Ruiz@example.org"
    mark = hashlib.sha256(name.encode()).hexdigest()[:8]
    a_folder(tmp_path, f"jos-ruiz-example-org---{mark}")
    hub.servers[name] = RUNS
    assert seen(HubRoll(tmp_path, Hub(hub.api, hub.token))).keys() == {name}


def test_a_student_keeps_the_row_when_the_folder_comes(
    hub: HubApi, tmp_path: Path
) -> None:
    hub.servers["ada"] = RUNS
    roll = HubRoll(tmp_path, Hub(hub.api, hub.token))
    assert [*roll.look(LESSON)] == [1]
    a_folder(tmp_path, "ada")
    assert roll.look(LESSON)[1].errors == 2


def test_a_page_that_reports_no_more_does_not_answer(
    hub: HubApi, tmp_path: Path
) -> None:
    hub.servers["ada"] = RUNS
    folder, clock = a_folder(tmp_path, "ada"), Hand()
    roll = HubRoll(tmp_path, Hub(hub.api, hub.token), clock)
    assert seen(roll)["ada"].server == ""
    clock.now += hub_roll.SILENT + 1
    assert seen(roll)["ada"].server == "does not answer"
    STATE.report(folder)
    assert seen(roll)["ada"].server == ""
    # Nobody has the page open: nothing is to be reported.
    replace(STATE, pages=0).report(folder)
    clock.now += hub_roll.SILENT + 1
    assert seen(roll)["ada"].server == ""


@pytest.mark.parametrize(
    "written",
    [
        "",
        "[]",
        "{",
        "[" * 100_000,
        '{"errors": true, "pages": 1e999, "changed": NaN, "first": 3, "since": -1}',
        '{"errors": "2", "title": "x", "points": 99, "step": 2, "server": "x"}',
    ],
)
def test_what_a_student_writes_into_the_report_does_no_harm(
    written: str, tmp_path: Path
) -> None:
    folder = a_folder(tmp_path, "ada", None)
    honest = SeatState.on_disk(LESSON, folder)
    (folder / STATE_FILE).write_text(written)
    # A new file changes the time of the folder.
    found = SeatState.on_disk(LESSON, folder)
    assert found == replace(honest, since=found.since)
    (folder / STATE_FILE).write_text(json.dumps({"first": "a\x1b[31m\u202e" * 99}))
    first = SeatState.on_disk(LESSON, folder).first
    assert first.startswith("a\ufffd[31m\ufffda") and len(first) <= 201


def test_a_hub_that_does_not_answer_leaves_the_rows_and_says_so(
    hub: HubApi, tmp_path: Path
) -> None:
    hub.servers["ada"] = RUNS
    a_folder(tmp_path, "ada")
    clock = Hand()
    roll = HubRoll(tmp_path, Hub(hub.api, hub.token), clock)
    assert seen(roll).keys() == {"ada"} and not roll.trouble
    asked = hub.asked
    assert seen(roll) and hub.asked == asked, "the hub is not asked at every look"
    hub.status = 503
    clock.now += hub_roll.ASKED
    assert seen(roll).keys() == {"ada"}
    assert roll.trouble == "the hub does not list its users (status 503)"
    hub.status = 200
    clock.now += hub_roll.ASKED
    assert seen(roll) and not roll.trouble


def test_the_board_says_which_scopes_its_service_lacks(hub: HubApi) -> None:
    with pytest.raises(ServerError, match="the scopes list:users, read:servers"):
        Hub(hub.api, "another").users()


PAGE = '{"items": [%s], "_pagination": {"next": null}}'


@pytest.mark.parametrize(
    "body",
    [
        b"",
        b"[]",
        b'{"items": 3}',
        b"[" * 100_000,
        *((PAGE % item).encode() for item in ("3", "{}", '{"name": 1, "servers": 2}')),
    ],
)
def test_an_answer_that_is_not_a_hubs_is_refused(hub: HubApi, body: bytes) -> None:
    hub.body = body
    with pytest.raises(ServerError, match="as expected"):
        Hub(hub.api, hub.token).users()


def test_an_answer_above_the_limit_is_not_read(
    hub: HubApi, monkeypatch: pytest.MonkeyPatch
) -> None:
    lower(monkeypatch, "HUB_ANSWER", 100)
    hub.body = b" " * 101
    with pytest.raises(ServerError, match="does not list its users"):
        Hub(hub.api, hub.token).users()


def test_more_students_than_the_limit_are_counted_and_said(
    hub: HubApi, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    lower(monkeypatch, "HUB_STUDENTS", 2)
    for name in ("ada", "ben", "cleo"):
        a_folder(tmp_path, name)
    roll = HubRoll(tmp_path, Hub(hub.api, hub.token))
    assert len(seen(roll)) == 2
    assert roll.trouble == "only the first 2 students are shown"


def test_the_board_is_a_service_that_its_teacher_opens(
    hub: HubApi, tmp_path: Path
) -> None:
    hub.servers["ada"] = RUNS
    folder = a_folder(tmp_path, "ada")
    options = Options(presenter="the-secret-of-the-teacher", base_path="/services/b")
    where = Hub(hub.api, hub.token)
    with HubBoard(options, LESSON, tmp_path, None, where) as board:
        address = board.board_url
        assert urlsplit(address).path == "/services/b/board"
        base = address.partition("/board")[0]
        with pytest.raises(HTTPError) as refused:
            urlopen(f"{base}/board/")
        refused.value.close()
        assert refused.value.code == 401
        known = {"Authorization": f"Bearer {options.presenter}"}

        def ask(path: str, **more: str) -> str:
            request = Request(f"{base}{path}", headers={**known, **more})
            with urlopen(request, timeout=patience(30.0)) as answer:
                return answer.read().decode("utf-8-sig")

        assert LESSON.title in ask("/board/")
        with pytest.raises(HTTPError) as refused:
            # No page of a student can be reached from here.
            ask("/board/say?number=1&text=hello", **{"Sambot-Class": "1"})
        refused.value.close()
        rows = Request(f"{base}/board/rows", headers=known)
        with urlopen(rows, timeout=patience(30.0)) as lines:
            shown = BoardRows(lines)
            assert not shown.head["reaches"]
            assert (shown.rows[1]["name"], shown.rows[1]["errors"]) == ("ada", 2)
            passed = {LESSON.name: {LESSON.steps[0].name: {"tries": 1, "passed": True}}}
            (folder / PROGRESS_FILE).write_text(json.dumps(passed))
            shown.until(lambda: shown.rows[1]["step"] == 2)
        assert "ada,ada,2," in ask("/board/class.csv")


def test_a_page_reports_its_state_into_the_folder_of_the_student(
    tmp_path: Path,
) -> None:
    study = Study.begun(LESSON, tmp_path / "ada")
    inputs = Inputs(Options().learning(study), may_be_broken=True)
    look = partial(SeatState.on_disk, LESSON, study.folder)
    with Visualizer.of_inputs(inputs) as viz, reported(study, viz):
        with closing(ProtocolClient(viz.viser.get_port())) as page:
            page.wait_until(lambda: "lesson/text" in page.rows)
            write(page, WRONG)
            # Saved without a button, and reported.
            page.wait_until(lambda: (study.folder / MODEL).read_text() == WRONG)
            page.wait_until(lambda: look().pages == 1 and look().unmet > 0)
            assert look().changed > 0
    assert look().pages == 0 and look().unmet > 0


def test_without_a_hub_the_command_says_what_is_missing(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.delenv("JUPYTERHUB_API_URL", raising=False)
    with pytest.raises(UsageError, match="JUPYTERHUB_API_URL"):
        Hub.of_environment()
    monkeypatch.setenv("JUPYTERHUB_API_URL", "http://hub:8081/hub/api/")
    monkeypatch.setenv("JUPYTERHUB_API_TOKEN", "secret")
    monkeypatch.setenv("JUPYTERHUB_SERVICE_PREFIX", "/services/board/")
    hub = Hub("http://hub:8081/hub/api", "secret", "/services/board")
    assert Hub.of_environment() == hub
