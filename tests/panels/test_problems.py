"""The Problems panel: one row for each cause, with what is below it."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from panel_rows import commands_of, data_of, edit, rows_of

from sambot_viz import Problem, limits
from sambot_viz.errors import Edit
from sambot_viz.panels.panel import Panel
from sambot_viz.panels.problems.problems_panel import ProblemsPanel
from sambot_viz.panels.rows.row import Row
from sambot_viz.session import Session

INFO = Problem("info", "i", "worth knowing")
WARNING = Problem("warning", "w", "hm")
ERROR = Problem("error", "e", "no")
SHOWN = {"old": False, "checking": False}


@pytest.fixture
def remade() -> list[Panel]:
    return []


@pytest.fixture
def panel(session: Session, remade: list[Panel]) -> ProblemsPanel:
    return ProblemsPanel(session.problems, session.history, remade.append)


def listed(panel: ProblemsPanel) -> list[Row]:
    return [row for row in panel.rows() if not row.parent and row.kind == "note"]


def below(panel: ProblemsPanel, row: Row) -> list[Row]:
    return [found for found in rows_of(panel).values() if found.parent == row.id]


def count(panel: ProblemsPanel) -> Any:
    return data_of(panel)["problems/count"]


def unfold(panel: ProblemsPanel, row: Row) -> None:
    edit(panel, "problems/unfold", [row.id])


def test_without_problems_it_says_so(panel: ProblemsPanel) -> None:
    assert [row.value for row in listed(panel)] == ["No problems."]
    assert count(panel) == {"error": 0, "warning": 0, "info": 0, **SHOWN}


def test_until_the_rules_have_run_it_does_not_say_that_there_are_none(
    panel: ProblemsPanel, session: Session
) -> None:
    robot = session.robot.model
    assert robot is not None
    session.show_robot(replace(robot))
    assert [(row.value, row.level) for row in listed(panel)] == [("Checking…", None)]
    assert count(panel)["checking"] is True
    session.checks.run()
    assert [row.value for row in listed(panel)] == ["No problems."]
    assert count(panel)["checking"] is False


def test_errors_come_first_and_all_are_counted(
    panel: ProblemsPanel, session: Session
) -> None:
    session.problems.set_model([INFO, WARNING, ERROR, ERROR])
    assert [(row.value, row.level) for row in listed(panel)] == [
        ("no", "error"),
        ("hm", "warn"),
        ("worth knowing", "info"),
    ]
    assert count(panel) == {"error": 1, "warning": 1, "info": 1, **SHOWN}


def test_the_first_error_shows_its_remedy_lines_and_path(
    panel: ProblemsPanel, session: Session, tmp_path: Path
) -> None:
    model = tmp_path / "model.urdf"
    model.write_text("<robot>\n  <lnk/>\n</robot>\n", "utf-8")
    session.problems.set_model(
        [Problem("error", "e", "no <lnk>", "write <link>", str(model), 2, 3)]
    )
    (row,) = listed(panel)
    assert row.expanded
    assert row.extra == {"place": "model.urdf:2", "lazy": False, "about": "e"}
    hint, lines, place = below(panel, row)
    assert hint.value == "To fix it: write <link>"
    assert lines.value == [(1, "<robot>"), (2, "  <lnk/>"), (3, "</robot>")]
    assert lines.extra == {"line": 2, "column": 3}
    assert place.value == f"{model}:2:3"


def test_other_problems_show_that_when_they_are_unfolded(
    panel: ProblemsPanel, session: Session, remade: list[Panel]
) -> None:
    session.problems.set_model([Problem("warning", "w", "hm", "do that")])
    (row,) = listed(panel)
    assert not row.expanded
    assert row.extra == {"place": "", "lazy": True, "about": "w"}
    assert below(panel, row) == []
    unfold(panel, row)
    assert remade == [panel]
    assert [found.value for found in below(panel, row)] == ["To fix it: do that"]
    # The row is the same one when other problems come and go.
    session.problems.set_model([ERROR, Problem("warning", "w", "hm", "do that")])
    assert listed(panel)[1].id == row.id
    assert len(below(panel, row)) == 1


def test_problems_of_one_cause_are_one_row_with_their_number(
    panel: ProblemsPanel, session: Session
) -> None:
    session.problems.set_model(
        Problem.at(
            None,
            "warning",
            "mesh-not-found",
            f"mesh {number} was not found",
            "add --package-path",
            cause="package arm",
        )
        for number in range(52)
    )
    (row,) = listed(panel)
    assert row.value == "52 meshes of package arm: not found"
    assert count(panel)["warning"] == 1
    unfold(panel, row)
    values = [found.value for found in below(panel, row)]
    assert values[0] == "To fix it: add --package-path"
    assert values[1:] == [f"mesh {number} was not found" for number in range(52)]


def test_of_very_many_problems_the_rest_is_counted(
    panel: ProblemsPanel, session: Session
) -> None:
    session.problems.set_model(
        [
            Problem("warning", "w", f"number {i}")
            for i in range(limits.PROBLEM_ROWS.value + 50)
        ]
    )
    rows = listed(panel)
    assert len(rows) == limits.PROBLEM_ROWS.value + 1
    assert rows[-1].value == "and 50 more"
    assert count(panel)["warning"] == limits.PROBLEM_ROWS.value + 50


def test_a_mistake_in_a_save_is_added_to_what_is_known(
    panel: ProblemsPanel, session: Session
) -> None:
    session.problems.set_model([WARNING, INFO])
    session.problems.set_saves("model", [ERROR, WARNING])
    values = [row.value for row in listed(panel)]
    assert values == [
        "Your file has an error; showing the last version that worked.",
        "no",
        "hm",
        "worth knowing",
    ]
    assert count(panel)["old"] is True
    session.problems.set_saves("model", [])
    assert [row.value for row in listed(panel)] == ["hm", "worth knowing"]


def test_a_remark_that_has_moved_to_another_line_is_listed_once(
    panel: ProblemsPanel, session: Session
) -> None:
    session.problems.set_model([Problem("warning", "w", "hm", "", "a.urdf", 7)])
    session.problems.set_saves(
        "model", [ERROR, Problem("warning", "w", "hm", "", "a.urdf", 8)]
    )
    places = [(row.extra or {}).get("place") for row in listed(panel)]
    assert places == [None, "", "a.urdf:8"]


def test_only_rows_of_the_list_can_be_unfolded(
    panel: ProblemsPanel, remade: list[Panel]
) -> None:
    edit(panel, "problems/unfold", ["anything"])
    assert remade == []


def test_a_text_of_a_file_is_safe_to_show(
    panel: ProblemsPanel, session: Session, tmp_path: Path
) -> None:
    model = tmp_path / "<img src=x>.urdf"
    model.write_text("\u202e<b>", "utf-8")
    problem = Problem("error", "e", "\ud800 \u202e", "\u202e", str(model), 1)
    session.problems.set_model([problem])
    for row in rows_of(panel).values():
        shown = str(row.json())
        assert "\ud800" not in shown
        assert "\u202e" not in shown


def test_a_fix_of_one_text_can_be_copied(
    panel: ProblemsPanel, session: Session
) -> None:
    edits = (Edit("a.urdf", 0, 3, "base_link"), Edit("a.urdf", 8, 9, "base_link"))
    fixed = replace(Problem("error", "e", "no", "write base_link"), edits=edits)
    session.problems.set_model([fixed])
    (hint,) = below(panel, *listed(panel))
    assert hint.value == "To fix it: write base_link"
    assert hint.extra == {"copy": "base_link"}
    assert "problems/apply" not in commands_of(panel)


def test_a_fix_of_several_texts_is_not_copied(
    panel: ProblemsPanel, session: Session
) -> None:
    edits = (Edit("a.urdf", 0, 3, "x"), Edit("a.urdf", 8, 9, "y"))
    fixed = replace(Problem("error", "e", "no", "write x and y"), edits=edits)
    session.problems.set_model([fixed])
    (hint,) = below(panel, *listed(panel))
    assert hint.extra is None


def test_others_than_those_at_the_disk_copy_no_folder_of_it(
    session: Session, tmp_path: Path
) -> None:
    panel = ProblemsPanel(session.problems, session.history, lambda _: None, False)
    edits = (Edit("a.urdf", 0, 3, str(tmp_path / "a.stl")),)
    fixed = replace(Problem("error", "e", "no", "write the path"), edits=edits)
    session.problems.set_model([fixed])
    (hint,) = below(panel, *listed(panel))
    assert hint.extra is None
