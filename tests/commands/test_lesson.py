"""``sambot-viz lesson``: for students, and list, new and check for teachers."""

from __future__ import annotations

import json
import shutil
from collections.abc import Callable
from pathlib import Path

import pytest
from lesson_files import BASE, record_run
from program import address, serving
from protocol_client import ProtocolClient

from sambot_viz.cli import main
from sambot_viz.lessons.read_lesson import lesson_names

Capture = pytest.CaptureFixture[str]
SOLUTIONS = Path(__file__).parents[1] / "data" / "lessons"


def test_the_lessons_that_ship_are_listed(capsys: Capture) -> None:
    assert main(["lesson", "list"]) == 0
    text = capsys.readouterr().out
    assert "nav2-first-robot: The first robot of Nav2 (22 steps, 33 points)" in text
    assert main(["lesson", "list", "--format", "json"]) == 0
    found = json.loads(capsys.readouterr().out)["lessons"]
    assert [lesson["name"] for lesson in found] == lesson_names()


def test_a_new_lesson_passes_its_check(capsys: Capture, tmp_path: Path) -> None:
    folder = str(tmp_path / "mine")
    assert main(["lesson", "new", folder]) == 0
    assert main(["lesson", "check", folder]) == 0
    assert "the solution passes, and the start does not" in capsys.readouterr().out
    assert main(["lesson", "new", folder]) == 2
    assert "is there already" in capsys.readouterr().err


@pytest.mark.parametrize("name", lesson_names())
def test_a_lesson_that_ships_passes_with_its_solution(
    capsys: Capture, tmp_path: Path, name: str
) -> None:
    solution = tmp_path / name
    shutil.copytree(SOLUTIONS / name, solution)
    for package in solution.glob("sam_bot_description"):
        record_run(package / "recordings")
    assert main(["lesson", "check", name, "--solution", str(solution)]) == 0
    assert capsys.readouterr().out == (
        f"{name}: the solution passes, and the start does not\n"
    )


@pytest.fixture
def lesson(tmp_path: Path) -> Path:
    main(["lesson", "new", str(tmp_path / "mine")])
    return tmp_path / "mine"


def test_a_solution_that_fails_is_an_error(capsys: Capture, lesson: Path) -> None:
    model = lesson / "solution" / "robot.urdf"
    model.write_text(model.read_text().replace("0.2 0 0.05", "0.2 0 0.5"))
    assert main(["lesson", "check", str(lesson)]) == 1
    assert "the solution fails the step lamp: lamp, seen from table, is at" in (
        capsys.readouterr().out
    )


def test_a_start_that_passes_is_an_error(capsys: Capture, lesson: Path) -> None:
    text = (lesson / "solution" / "robot.urdf").read_text()
    (lesson / "start" / "robot.urdf").write_text(text)
    assert main(["lesson", "check", str(lesson)]) == 1
    assert "the start passes all steps" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("line", "said"),
    [
        ("solution: nothing", "the solution has no file robot.urdf"),
        ("start: nothing", "there is no start nothing"),
    ],
)
def test_files_that_are_not_there_are_errors(
    capsys: Capture, lesson: Path, line: str, said: str
) -> None:
    file, key = lesson / "lesson.yaml", line.partition(":")[0]
    file.write_text(file.read_text().replace(f"{key}: {key}", line))
    capsys.readouterr()
    assert main(["lesson", "check", str(file), "--format", "json"]) == 1
    problems = json.loads(capsys.readouterr().out)["problems"]
    assert said in problems[0]["message"]


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["chekc"], "did you mean 'check'?"),
        (["check"], "needs a lesson.yaml"),
        (["new"], "needs a new folder"),
        (["check", "nav2"], "no lesson 'nav2'"),
        (["check", str(BASE), "--solution", "nowhere"], "--solution nowhere"),
    ],
)
def test_usage_errors_exit_with_2(capsys: Capture, words: list[str], said: str) -> None:
    assert main(["lesson", *words]) == 2
    assert said in capsys.readouterr().err


def test_a_lesson_is_served_with_files_to_begin_with(
    tmp_path: Path, protocol: Callable[..., ProtocolClient]
) -> None:
    words = ("lesson", "nav2-first-robot", "--track", "sdf", "--dir", "mine")
    with serving(*words, "--port", "0", cwd=tmp_path) as program:
        client = protocol(int(address(program).rsplit(":", 1)[1]))
        client.wait_until(lambda: "lesson/text" in client.rows)
        assert client.rows["lesson/text"]["value"]["title"].startswith("A transform")
        assert program.end()[0] == 0
    model = tmp_path / "mine/src/description/sam_bot_description.sdf"
    assert model.read_bytes() == b""


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["chekc", "lesson.yaml"], "did you mean 'check'?"),
        (["nav2-frist-robot"], "did you mean 'nav2-first-robot'?"),
        (["nav2-first-robot", "mine"], "name your folder with --dir: --dir mine"),
        (["nav2-first-robot", "--track", "xacro"], "has no track 'xacro'"),
        (["nav2-first-robot", "--dir", "a-file"], "cannot write into 'a-file'"),
    ],
)
def test_a_lesson_that_cannot_be_shown_says_why(
    words: list[str],
    message: str,
    capsys: Capture,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "a-file").touch()
    assert main(["lesson", *words]) == 2
    assert message in capsys.readouterr().err
