"""Problems of one cause are one group, and are written for people."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from sambot_viz import check
from sambot_viz.cli import main
from sambot_viz.errors import Problem
from sambot_viz.outlet import Line
from sambot_viz.problems import (
    group_problems,
    in_order,
    problem_in_words,
    problem_lines,
    write_problems,
)
from sambot_viz.robot.model import load_robot


def missing(number: int, package: str = "arm") -> Problem:
    return Problem(
        "warning",
        "mesh-not-found",
        f"the mesh {number}.stl was not found",
        f"add --package-path FOLDER-THAT-HOLDS-{package}",
        "r.urdf",
        number,
        cause=f"package {package}",
    )


def test_the_meshes_of_a_missing_package_are_one_group() -> None:
    problems = [missing(number) for number in range(1, 53)]

    (group,) = group_problems(problems)

    assert group.message == "52 meshes of package arm: not found"
    assert group.hint == "add --package-path FOLDER-THAT-HOLDS-arm"
    assert (group.severity, group.problems) == ("warning", tuple(problems))
    assert group.first.line == 1


def test_two_packages_are_two_groups_and_one_mesh_keeps_its_own_words() -> None:
    first, second = group_problems([missing(1), missing(2, "leg"), missing(3)])

    assert first.message == "2 meshes of package arm: not found"
    assert second.message == "the mesh 2.stl was not found"


def test_another_remedy_is_another_group() -> None:
    one = missing(1)
    other = Problem("warning", one.code, "m", "put it there", cause=one.cause)

    assert len(group_problems([one, other])) == 2


def test_what_comes_from_one_place_of_a_macro_is_one_group() -> None:
    calls = [
        Problem("error", "number-malformed", f"call {n}", "h", "r.xacro", 5, 3)
        for n in range(4)
    ]

    (group,) = group_problems(calls)

    assert group.message == "call 0 (and 3 more like it)"


def test_different_places_and_different_codes_stay_apart() -> None:
    problems = [
        Problem("error", "number-malformed", "a", "h", "r.urdf", 5, 3),
        Problem("error", "number-malformed", "a", "h", "r.urdf", 6, 3),
        Problem("error", "number-malformed", "a", "h", "r.urdf", 5, 30),
        Problem("error", "color-range", "a", "h", "r.urdf", 5, 3),
        Problem("error", "color-range", "b"),
        Problem("error", "color-range", "c"),
    ]

    assert [group.problems for group in group_problems(problems)] == [
        (problem,) for problem in problems
    ]


def test_a_cause_alone_joins_nothing_for_codes_that_are_not_in_the_table() -> None:
    problems = [
        Problem("info", "name-with-blank", "a", "h", "r.urdf", line, cause="blank")
        for line in (1, 2)
    ]

    assert len(group_problems(problems)) == 2


def test_each_problem_comes_once_and_errors_come_first() -> None:
    info, error = Problem("info", "i", "note"), Problem("error", "e", "no")
    warning = Problem("warning", "w", "hm")

    assert in_order([info, warning, error, info]) == [error, warning, info]


def test_the_cause_is_no_part_of_the_json() -> None:
    assert set(missing(1).as_json()) == {
        "severity",
        "code",
        "message",
        "hint",
        "file",
        "line",
        "column",
        "edits",
    }


def test_joints_that_name_one_missing_link_are_one_group(tmp_path: Path) -> None:
    links = "".join(f'<link name="l{n}"/>\n' for n in range(5))
    parents = ("l0", "base", "base", "base")
    joints = "".join(
        f'<joint name="j{n}" type="fixed"><parent link="{parent}"/>'
        f'<child link="l{n}"/></joint>\n'
        for n, parent in enumerate(parents, 1)
    )
    file = tmp_path / "r.urdf"
    file.write_text(f'<robot name="r">\n{links}{joints}</robot>')

    groups = [g for g in group_problems(check(file)) if len(g.problems) > 1]

    assert [g.message for g in groups] == [
        "3 joints have the parent link base, which does not exist; ROS refuses the "
        "model"
    ]


def test_meshes_that_were_not_downloaded_are_one_group(tmp_path: Path) -> None:
    shapes = ""
    for number in range(9):
        pointer = tmp_path / f"{number}.stl"
        pointer.write_text("version https://git-lfs.github.com/spec/v1\n")
        shapes += (
            f'<visual><geometry><mesh filename="{number}.stl"/></geometry></visual>'
        )
    file = tmp_path / "r.urdf"
    file.write_text(f'<robot name="r"><link name="a">{shapes}</link></robot>')

    problems = check(file)
    (group,) = group_problems(problems)

    assert load_robot(file).problems == ()
    assert len(problems) == 9
    assert group.message == (
        "9 meshes have the same problem: this is a git-LFS pointer, not the mesh itself"
    )
    assert group.hint == "run 'git lfs pull' in its repository"


def warning(number: int) -> Problem:
    return Problem("warning", "some-code", f"number {number}", "fix it")


def written(problems: list[Problem], **options: Any) -> list[str]:
    lines: list[str] = []

    def write(*several: Line) -> None:
        lines.extend(map(plain, several))

    write_problems(problems, write, **options)
    return lines


def plain(line: Line) -> str:
    parts = (line,) if isinstance(line, str) else line
    return "".join(part if isinstance(part, str) else part.words for part in parts)


def test_a_problem_has_its_place_its_line_and_a_mark(tmp_path: Path) -> None:
    file = tmp_path / "r.urdf"
    file.write_text("<robot>\n  <link/>\n")

    lines = problem_in_words(
        Problem("error", "some-code", "no name", "give it one", str(file), 2, 3)
    )

    assert [plain(line) for line in lines] == [
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


def test_check_writes_one_cause_once_with_the_lines_of_all(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file, other = tmp_path / "r.xacro", tmp_path / "s.xacro"
    head = '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">\n'
    joint = '<joint name="{0}" type="fixed">\n<parent link="bse"/>\n'
    joint += '<child link="{0}"/></joint><link name="{0}"/>\n'
    other.write_text(f"{head}{joint.format('c')}</robot>")
    file.write_text(
        f'{head}<link name="base"/>\n{joint.format("a")}{joint.format("b")}'
        f'<xacro:include filename="s.xacro"/>\n</robot>'
    )
    assert main(["check", str(file)]) == 1
    lines = capsys.readouterr().out.splitlines()
    assert lines[0].startswith(
        f"{file}:4:1: error[joint-parent-unknown]: 3 joints have the parent"
    )
    assert lines[1:] == [
        '    4 | <parent link="bse"/>',
        "        ^",
        '    7 | <parent link="bse"/>',
        f"{other}:3:1:",
        '    3 | <parent link="bse"/>',
    ]


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
