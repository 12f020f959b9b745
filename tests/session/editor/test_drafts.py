"""A text that nobody saved outlives the program, and what was saved meanwhile."""

from __future__ import annotations

from pathlib import Path

import pytest
from lower_limit import lower

from sambot_viz.session.editor.buffer import Buffer
from sambot_viz.session.editor.drafts import (
    draft_path,
    forget_draft,
    keep_draft,
    take_draft,
)

SAVED = "one\ntwo\nthree\nfour\nfive\n"
TYPED = SAVED.replace("two", "2")


@pytest.fixture
def path(tmp_path: Path) -> Path:
    path = tmp_path / "robot.urdf"
    path.write_bytes(SAVED.encode())
    buffer = Buffer.opened(path, path.name)
    buffer.take(TYPED)
    keep_draft(buffer)
    return path


def opened(path: Path) -> tuple[bool, Buffer]:
    buffer = Buffer.opened(path, path.name)
    return take_draft(buffer), buffer


def test_the_text_is_unsaved_again(path: Path) -> None:
    is_taken, buffer = opened(path)
    assert is_taken and buffer.is_changed and buffer.theirs is None
    assert (buffer.text, buffer.disk.text) == (TYPED, SAVED)
    assert path.read_text() == SAVED
    # It may end once more before somebody saves.
    keep_draft(buffer)
    assert opened(path)[1].text == TYPED
    forget_draft(path)
    assert not opened(path)[0] and [*path.parent.iterdir()] == [path]


def test_what_another_program_saved_meanwhile_is_merged(path: Path) -> None:
    path.write_text(SAVED.replace("four", "4"))
    is_taken, buffer = opened(path)
    assert is_taken and buffer.theirs is None
    assert buffer.text == TYPED.replace("four", "4")
    assert buffer.disk.data == path.read_bytes()


def test_the_same_line_changed_by_both_is_for_the_user_to_choose(path: Path) -> None:
    path.write_text(SAVED.replace("two", "zwei"))
    is_taken, buffer = opened(path)
    assert is_taken and buffer.text == TYPED
    (conflict,) = buffer.conflicts
    assert conflict.text == "zwei\n"


def test_a_text_that_was_saved_otherwise_needs_no_draft(path: Path) -> None:
    path.write_text(TYPED)
    is_taken, buffer = opened(path)
    assert not is_taken and not buffer.is_changed


@pytest.mark.parametrize("content", [b"", b"{", b"[]", b'{"base": 1, "text": 2}'])
def test_a_broken_draft_changes_nothing(path: Path, content: bytes) -> None:
    draft_path(path).write_bytes(content)
    is_taken, buffer = opened(path)
    assert not is_taken and not buffer.is_changed


def test_a_draft_that_is_too_long_changes_nothing(
    path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    before = Buffer.opened(path, path.name)
    lower(monkeypatch, "EDITED_TEXT", 3)
    assert not take_draft(before)
    assert before.text == SAVED and not before.is_changed
