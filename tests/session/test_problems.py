"""What a page lists of a session's problems."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from sambot_viz import Problem, Visualizer, bundled
from sambot_viz.inputs import load_config
from sambot_viz.session import Session

MISTAKE = Problem("error", "e", "it is broken")


@pytest.fixture
def session(tmp_path: Path) -> Iterator[Session]:
    model = tmp_path / "r.urdf"
    model.write_text('<robot name="r"><link name="a b"/></robot>')
    with Visualizer(model) as viz:
        session = viz.server.sessions.all()[0]
        own = Problem("info", "own", "a remark", "", str(model), 1)
        other = Problem("info", "other", "of a launch file", "", "a.launch.py", 3)
        without = Problem("warning", "without", "of the frames")
        session.problems.set_model((own, other, without))
        yield session


def codes(session: Session) -> list[str]:
    return [problem.code for problem in session.problems.shown.value.listed]


def test_errors_come_first(session: Session) -> None:
    assert codes(session) == ["without", "own", "other"]
    session.problems.set_saves("watch", [Problem("error", "w", "no watching")])
    assert codes(session) == ["w", "without", "own", "other"]


def test_while_a_save_has_a_mistake_all_else_stays_listed(session: Session) -> None:
    session.problems.set_saves("model", [MISTAKE])
    assert codes(session) == ["e", "without", "own", "other"]
    session.problems.set_saves("model", [])
    assert codes(session) == ["without", "own", "other"]


def test_a_note_says_what_is_shown_instead(session: Session) -> None:
    assert session.problems.shown.value.note == ""
    session.problems.set_saves("model", [MISTAKE])
    assert session.problems.shown.value.note.startswith(
        "Your file has an error; showing the last version that worked"
    )
    session.problems.set_saves("config", [MISTAKE])
    assert "config has an error" in session.problems.shown.value.note
    session.problems.set_saves("model", [])
    assert session.problems.shown.value.note.startswith("The config has an error")


def test_tools_of_a_config_that_do_not_exist_here_are_listed(tmp_path: Path) -> None:
    config = tmp_path / "own.rviz"
    text = bundled.config_path().read_text()
    tool = "rviz_default_plugins/"
    config.write_text(text.replace(f"{tool}Measure", "lab_tools/Paint"))
    with Visualizer(config=config) as viz:
        session = viz.server.sessions.all()[0]
        assert "config-tools" in codes(session)
        session.document.replace(load_config(bundled.config_path()))
        assert "config-tools" not in codes(session)
