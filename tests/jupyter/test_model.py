"""Which model the tile shows."""

from __future__ import annotations

from pathlib import Path

import pytest
from a_jupyter import wait_until
from inside import session_of

from sambot_viz import Visualizer
from sambot_viz.commands import lesson as lesson_command
from sambot_viz.commands.command_line import parse
from sambot_viz.jupyter.__main__ import lesson_words, model_of

ARM = '<robot name="arm"><link name="a"/></robot>'


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    for name in ("one/arm.urdf", "two/leg.urdf", "two/hand.urdf"):
        path = tmp_path / name
        path.parent.mkdir(exist_ok=True)
        path.write_text(ARM)
    return tmp_path


def test_the_model_in_the_folder_of_jupyterlab_is_shown(folder: Path) -> None:
    assert model_of(folder / "one", "") == (folder / "one", [])


def test_a_teacher_names_a_file_or_a_folder(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert model_of(folder, "two/leg.urdf")[0] == folder / "two/leg.urdf"
    assert model_of(Path("/"), str(folder / "one"))[0] == folder / "one"
    monkeypatch.setenv("HOME", str(folder))
    assert model_of(Path("/"), "~/one")[0] == folder / "one"


@pytest.mark.parametrize(
    ("place", "named", "why"),
    [
        ("two", "", "several models in the folder"),
        ("", "three", "SAMBOT_VIZ_MODEL: no model '"),
        ("one", "no.urdf", "SAMBOT_VIZ_MODEL: no model '"),
    ],
)
def test_otherwise_the_log_says_why_it_is_the_bundled_robot(
    folder: Path, capsys: pytest.CaptureFixture[str], place: str, named: str, why: str
) -> None:
    model, notes = model_of(folder / place, named)
    assert model is None
    # Pupils do not read the log: the page says that the teacher's model is missing.
    assert [why in note.message for note in notes] == [True] * bool(named)
    said = capsys.readouterr().err
    assert said.startswith("sambot-viz: note: the bundled sam_bot is shown; ")
    assert why in said


@pytest.mark.parametrize(
    ("lesson", "named", "own"),
    [
        ("nav2-first-robot", "", "nav2-first-robot"),
        ("~/course/first/", "", "first"),
        ("nav2-first-robot", "~/lesson", "~/lesson"),
    ],
)
def test_a_lesson_is_shown_in_the_folder_of_the_student(
    folder: Path, lesson: str, named: str, own: str
) -> None:
    words = lesson_words(folder, lesson, named)
    where = folder / Path(own).expanduser()
    assert words[2:] == ["--report", "--dir", str(where)]
    assert words[:2] == ["lesson", str(Path(lesson).expanduser())]
    given = parse(lesson_command.parser(), words[1:])[0]
    assert given.report and given.dir == str(where)


def test_the_page_shows_what_is_noted_beside_the_problems_of_the_model(
    folder: Path,
) -> None:
    _, notes = model_of(folder, "three")
    with Visualizer(folder / "one", notes=notes) as viz:
        problems = session_of(viz).problems
        wait_until(lambda: notes[0] in problems.of_model)
