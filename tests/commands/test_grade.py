"""``sambot-viz grade``: verdicts as text and files, and the exit status."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from lesson_files import BASE

from sambot_viz import bundled
from sambot_viz.cli import main

Capture = pytest.CaptureFixture[str]
SAM_BOT = str(bundled.model_path())


@pytest.fixture
def broken(tmp_path: Path) -> Path:
    file = tmp_path / "robot.urdf"
    file.write_text("<robot name='sam_bot'><link name='base_link'/></robot>")
    return file


def test_a_right_model_exits_with_0(capsys: Capture) -> None:
    assert main(["grade", SAM_BOT, "--lesson", str(BASE)]) == 0
    assert capsys.readouterr().out.splitlines() == [
        "passed  1. The body (body)",
        "passed  2. A wheel (wheel)",
        "base: 2 of 2 steps hold, 5 of 5 points",
    ]


def test_a_wrong_model_exits_with_1_and_says_why(capsys: Capture, broken: Path) -> None:
    assert main(["grade", str(broken), "--lesson", str(BASE), "--step", "1"]) == 1
    assert capsys.readouterr().out.splitlines() == [
        "failed  1. The body (body)",
        "        base_link has no <visual>, and no other link has one: only axes are "
        "shown; expected: a box of 0.42 0.31 0.18",
        "base: 0 of 1 steps hold, 0 of 2 points",
    ]


def test_a_model_that_cannot_be_read_is_named_once(
    capsys: Capture, tmp_path: Path
) -> None:
    file = tmp_path / "robot.urdf"
    file.write_text("<robot name='r'/>")
    assert main(["grade", str(file), "--lesson", str(BASE)]) == 1
    out = capsys.readouterr().out
    assert out.count(str(file)) == out.count("as in the step before") == 1


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["missing.urdf", "--lesson", str(BASE)], "'missing.urdf' does not exist"),
        ([SAM_BOT, "--lesson", "nav3"], "no lesson 'nav3'"),
        ([SAM_BOT, "--lesson", str(BASE), "--step", "9"], "has no step 9"),
    ],
)
def test_usage_errors_exit_with_2(capsys: Capture, words: list[str], said: str) -> None:
    assert main(["grade", *words]) == 2
    assert said in capsys.readouterr().err


def test_a_broken_lesson_exits_with_2_and_its_problems(
    capsys: Capture, tmp_path: Path
) -> None:
    (tmp_path / "lesson.yaml").write_text("nmae: x\n")
    assert main(["grade", SAM_BOT, "--lesson", str(tmp_path)]) == 2
    assert "lesson.yaml:1:1: error[lesson-key]: a lesson has no key" in (
        capsys.readouterr().err
    )


@pytest.mark.parametrize("how", ["json", "junit", "gradescope", "prairielearn", "text"])
def test_every_format_goes_into_a_file_whose_folder_is_made(
    tmp_path: Path, broken: Path, how: str, capsys: Capture
) -> None:
    file = tmp_path / "autograder" / "results" / "results.json"
    words = ["grade", str(broken), "--lesson", str(BASE), "--format", how]
    assert main([*words, "--output", str(file)]) == 1
    assert capsys.readouterr().out == ""
    text = file.read_text("utf-8")
    assert "base_link has no" in text or "&lt;visual&gt;" in text
    if how not in ("junit", "text"):
        json.loads(text)
