"""Two changes of a text are merged, and nothing of either is lost."""

from __future__ import annotations

import random
from pathlib import Path

import pytest
from lower_limit import lower

from sambot_viz.session.editor.buffer import Buffer
from sambot_viz.session.editor.three_way import segments


def changed(lines: list[str], chance: random.Random) -> list[str]:
    made = list(lines)
    for _ in range(chance.randint(0, 3)):
        start = chance.randint(0, len(made))
        count = chance.randint(0, 2)
        made[start : start + count] = chance.choices("abcxyz", k=chance.randint(0, 2))
    return made


def text(lines: list[str], chance: random.Random) -> str:
    return "\n".join(lines) + chance.choice(["", "\n"])


def test_the_parts_are_the_three_texts_and_one_change_alone_is_taken() -> None:
    chance = random.Random(1)
    for _ in range(2000):
        lines = chance.choices("abc", k=chance.randint(0, 8))
        base = text(lines, chance)
        mine, theirs = (text(changed(lines, chance), chance) for _ in range(2))
        parts = [*segments(base, mine, theirs)]
        columns = ("".join(column) for column in zip(*parts, strict=True))
        assert (*columns,) == (base, mine, theirs)
        for same in (base, mine):
            merged = "".join(part.merged for part in segments(base, mine, same))
            assert merged == mine
        # Lines are not joined.
        ends = [p.merged for p in parts if p.merged][:-1]
        assert all(part.endswith("\n") for part in ends), (base, mine, theirs)


@pytest.mark.parametrize(
    ("mine", "theirs", "merged"),
    [
        ("A\nb\nc\n", "a\nB\nc\n", "A\nB\nc\n"),
        ("a\nx\nb\nc\n", "a\nb\nc\ny\n", "a\nx\nb\nc\ny\n"),
        ("a\nc\n", "a\nb\nC\n", "a\nC\n"),
        ("a\nB\nc\n", "a\nB\nc\nd\n", "a\nB\nc\nd\n"),
        ("a\nx\nb\nc\n", "a\ny\nb\nc\n", None),
        ("a\nc\n", "a\nB\nc\n", None),
    ],
)
def test_changes_of_other_lines_are_merged(
    mine: str, theirs: str, merged: str | None
) -> None:
    parts = [*segments("a\nb\nc\n", mine, theirs)]
    conflicts = [part for part in parts if part.is_conflict]
    if merged is None:
        assert len(conflicts) == 1 and conflicts[0].theirs in theirs
    else:
        assert not conflicts and "".join(part.merged for part in parts) == merged


def test_a_file_that_comes_back_or_would_be_too_long_loses_nothing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    file = tmp_path / "a.urdf"
    file.write_text("a\nb\nc\n")
    buffer = Buffer.opened(file, file.name)
    # Some programs write a file anew: for a moment there is none.
    file.unlink()
    assert buffer.look() and buffer.text == "a\nb\nc\n" and buffer.is_changed
    file.write_text("a\nb\nC\n")
    assert buffer.look() and buffer.text == "a\nb\nC\n" and not buffer.is_changed
    buffer.take("A1\nb\nC\n")
    lower(monkeypatch, "EDITED_TEXT", 8)
    file.write_text("a\nb\nC\nd\n")
    assert buffer.look() and buffer.text == "A1\nb\nC\n" and buffer.theirs is not None
    ((extent, added),) = buffer.conflicts
    assert (extent, added) == ((7, 7), "d\n")
