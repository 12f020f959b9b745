"""``sambot-viz class``: the addresses that it prints, and what it refuses."""

from __future__ import annotations

import urllib.request
from pathlib import Path

import pytest
from lesson_files import BASE
from program import serving

from sambot_viz.cli import main

Capture = pytest.CaptureFixture[str]


def test_a_class_is_served_at_two_addresses(tmp_path: Path) -> None:
    words = ("class", str(BASE), "--dir", "monday", "--port", "0")
    with serving(*words, cwd=tmp_path) as program:
        whose, students = program.stdout.readline().split()
        assert whose == "students:"
        whose, teacher = program.stdout.readline().split()
        assert whose == "teacher:" and teacher.startswith(f"{students}/board?present=")
        with urllib.request.urlopen(students, timeout=30.0) as answer:
            assert b"sambot/board/name.js" in answer.read()
        code, _, said = program.end()
        assert code == 0 and "the students' files are in monday" in said


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["nav2-frist-robot"], "did you mean 'nav2-first-robot'?"),
        (["nav2-first-robot", "--track", "xacro"], "has no track 'xacro'"),
        (["nav2-first-robot", "--dir", "a-file/x"], "cannot write into 'a-file/x'"),
    ],
)
def test_a_class_that_cannot_be_shown_says_why(
    words: list[str],
    message: str,
    capsys: Capture,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "a-file").touch()
    assert main(["class", *words, "--port", "0"]) == 2
    assert message in capsys.readouterr().err
