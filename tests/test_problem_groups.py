"""Problems of one cause are one group with a number and one remedy."""

from __future__ import annotations

from pathlib import Path

from sambot_viz import check
from sambot_viz.errors import Problem
from sambot_viz.problem_groups import group_problems, in_order
from sambot_viz.robot import load_robot


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
