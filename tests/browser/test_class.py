"""A class in browsers: a name is typed, the board follows, the teacher looks."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import closing
from pathlib import Path

import pytest
from a_class import Browser, a_class, write
from recorded_page import RecordedPage

from sambot_viz.classroom.classroom import Classroom
from sambot_viz.export.chromium import Chromium

pytestmark = pytest.mark.browser

WRONG = '<robot name="<b>"><link name="base_link"/></robot>'
BUTTON = (
    "[...document.querySelectorAll('button')].find(b => b.textContent.trim() === %r)"
)


@pytest.fixture
def room(tmp_path: Path) -> Iterator[Classroom]:
    with a_class(tmp_path / "class") as room:
        yield room


@pytest.fixture
def open_page(chromium: Chromium) -> Iterator[Callable[[str], RecordedPage]]:
    pages: list[RecordedPage] = []

    def open_it(url: str) -> RecordedPage:
        pages.append(RecordedPage.create(chromium.devtools, timeout=60.0))
        pages[-1].set_viewport(1400, 900)
        pages[-1].goto(url)
        return pages[-1]

    yield open_it
    for page in pages:
        assert page.exceptions == []
        page.close()


def has(text: str) -> str:
    return f"document.body.innerText.includes({text!r})"


def press(page: RecordedPage, name: str) -> None:
    page.wait_for(BUTTON % name)
    page.evaluate(f"{BUTTON % name}.click()")


def test_a_name_is_typed_and_the_teacher_looks_at_the_page(
    room: Classroom, open_page: Callable[[str], RecordedPage]
) -> None:
    board = open_page(room.board_url)
    board.wait_for(has("Nobody is here yet"))
    assert "present" not in board.evaluate("location.href")
    student = open_page(f"{room.url}/?view=none")
    student.wait_for("document.activeElement.name === 'name'")
    student.evaluate("document.querySelector('input').value = '<i>Ada</i>'")
    student.keyboard.press("Enter")
    board.wait_for(has("<i>Ada</i>"), 60.0)
    board.wait_for(has("1 student, 1 here"), 60.0)
    with closing(Browser(room)) as bob:
        bob.join("Bob")
        write(bob.page(), WRONG)
        board.wait_for("document.querySelector('tbody tr .step')")
        press(board, "Look")
        board.wait_for("document.querySelector('iframe')?.contentDocument")
        inside = "document.querySelector('iframe').contentDocument"
        board.wait_for(f"{inside}.querySelector('.lesson')", 60.0)
        press(board, "Close")
        press(board, "Message to all")
        board.evaluate("document.querySelector('textarea').value = 'Look <up>'")
        press(board, "Send")
        student.wait_for(has("Look <up>"), 30.0)
        press(board, "Show to all")
        board.wait_for(BUTTON % "Shown to all")
        student.wait_for(f"{has('The teacher shows')} || {has('Your robot is shown')}")
