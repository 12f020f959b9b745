"""Problems on the terminal."""

from __future__ import annotations

import io
from pathlib import Path

import pytest

from sambot_viz import problem_text
from sambot_viz.cli import main
from sambot_viz.errors import Problem
from sambot_viz.problem_text import problem_lines


def warning(number: int) -> Problem:
    return Problem("warning", "some-code", f"number {number}", "fix it")


def written(problems: list[Problem], **options: object) -> list[str]:
    out = io.StringIO()
    problem_text.write(problems, out, **options)  # type: ignore[arg-type]
    return out.getvalue().splitlines()


def test_a_problem_has_its_place_its_line_and_a_mark(tmp_path: Path) -> None:
    file = tmp_path / "r.urdf"
    file.write_text("<robot>\n  <link/>\n")

    text = problem_text.in_words(
        Problem("error", "some-code", "no name", "give it one", str(file), 2, 3)
    )

    assert text.splitlines() == [
        f"{file}:2:3: error[some-code]: no name; give it one",
        "    2 |   <link/>",
        "          ^",
    ]


def test_the_lines_are_read_again_after_a_save(tmp_path: Path) -> None:
    file = tmp_path / "r.urdf"
    problem = Problem("error", "some-code", "text", "", str(file), 1)
    file.write_text("first")
    assert problem_lines(problem) == [(1, "first")]
    file.write_text("second one")
    assert problem_lines(problem) == [(1, "second one")]
    file.unlink()
    assert problem_lines(problem) == []


def test_the_lines_around_a_problem_have_their_numbers(tmp_path: Path) -> None:
    file = tmp_path / "r.urdf"
    file.write_text("one\n\n\tthree  \nfour\nfive\nsix\n" + 300 * "x")

    def around(line: int, context: int = 2) -> list[tuple[int, str]]:
        problem = Problem("error", "some-code", "text", "", str(file), line, 1)
        return problem_lines(problem, context)

    assert around(3, 1) == [(2, ""), (3, " three"), (4, "four")]
    assert [number for number, _ in around(1)] == [1, 2, 3]
    assert [number for number, _ in around(6)] == [4, 5, 6, 7]
    assert around(7, 0) == [(7, 160 * "x")]
    assert around(8) == []
    assert problem_lines(Problem("error", "some-code", "no place")) == []


def test_errors_come_first() -> None:
    error = Problem("error", "some-code", "worst")
    assert written([warning(1), error])[0] == "error[some-code]: worst"


def test_ten_problems_are_written_whole() -> None:
    assert len(written([warning(n) for n in range(10)])) == 10


def test_of_more_than_ten_the_rest_is_counted_with_the_command_for_all() -> None:
    lines = written([warning(n) for n in range(24)], model="my robot.urdf")

    assert len(lines) == 11
    assert lines[-1] == "14 more; to see all of them: sambot-viz check 'my robot.urdf'"


def test_problems_of_one_cause_are_one_line_with_their_number() -> None:
    meshes = [
        Problem("warning", "mesh-not-found", f"{n}", "fix it", cause="package arm")
        for n in range(24)
    ]
    assert written(meshes, model="r.urdf") == [
        "warning[mesh-not-found]: 24 meshes of package arm: not found; fix it",
        "to see each of them: sambot-viz check r.urdf",
    ]
    assert len(written(meshes, most=None)) == 24


def test_the_problems_of_a_config_are_printed_by_another_command() -> None:
    doubts = [
        Problem("warning", "config-value", f"{n}", "fix it", "my own.rviz", n)
        for n in range(1, 13)
    ]
    last = written(doubts, model="r.urdf")[-1]
    assert last == "2 more; to see all of them: sambot-viz config 'my own.rviz'"


def test_check_prints_all(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "r.urdf"
    links = "".join(f'<link name="arm {n}"/>' for n in range(12))
    joints = "".join(
        f'<joint name="j{n}" type="fixed"><parent link="arm 0"/>'
        f'<child link="arm {n}"/></joint>'
        for n in range(1, 12)
    )
    file.write_text(f'<robot name="r">{links}{joints}</robot>')

    main(["check", str(file)])

    assert capsys.readouterr().out.count("info[name-with-blank]") == 12
