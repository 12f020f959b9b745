"""What the first finding says can be done at once, and nothing contradicts it."""

from __future__ import annotations

from pathlib import Path

import pytest

from sambot_viz import check
from sambot_viz.errors import Problem

URDF = """<robot name="b">
<link name="base"/>
<link name="lidar_link"/>
<joint name="j" type="fixed"><parent link="base"/><child link="lidar_link"/></joint>
</robot>
"""
SDF = """<sdf version="1.8"><model name="b">
<link name="base"/>
<link name="lidar_link"><pose relative_to="j"/></link>
<joint name="j" type="fixed"><parent>base</parent><child>lidar_link</child>
<pose relative_to="base"/></joint>
</model></sdf>
"""
BOTH = pytest.mark.parametrize(("name", "text"), [("b.urdf", URDF), ("b.sdf", SDF)])


def checked(folder: Path, name: str, text: str) -> list[Problem]:
    model = folder / name
    model.write_text(text)
    return check(model)


@pytest.mark.parametrize(
    ("name", "root"),
    [
        ("a.sdf", "<sdf "),
        ("a.sdf.xacro", "<sdf "),
        ("a.urdf", "<robot>"),
        ("a.urdf.xacro", "<robot>"),
    ],
)
def test_an_empty_file_is_told_its_own_root(
    tmp_path: Path, name: str, root: str
) -> None:
    (problem,) = checked(tmp_path, name, " \n")

    assert problem.code == "model-empty"
    assert problem.hint.startswith(f"write {root}")


@BOTH
@pytest.mark.parametrize("written", ["lidar link", "lidar  link", "Lidar link"])
def test_a_blank_in_a_link_name_is_corrected_in_the_link(
    tmp_path: Path, name: str, text: str, written: str
) -> None:
    wrong = text.replace('name="lidar_link"', f'name="{written}"')

    (problem,) = checked(tmp_path, name, wrong)

    assert (problem.code, problem.line) == ("link-name-blank", 3)
    fix = problem.hint.removeprefix("write ")
    assert checked(tmp_path, name, wrong.replace(f'name="{written}"', fix)) == []


@BOTH
def test_a_blank_that_is_everywhere_is_only_a_note(
    tmp_path: Path, name: str, text: str
) -> None:
    (problem,) = checked(tmp_path, name, text.replace("lidar_link", "lidar link"))

    assert (problem.code, problem.severity) == ("name-with-blank", "info")
    assert problem.hint.startswith('write name="lidar_link", and the same wherever')


@pytest.mark.parametrize(
    ("right", "wrong"),
    [
        ("<child>lidar_link</child>", "<child>lidar_lnk</child>"),
        ("<parent>base</parent>", "<parent>bsae</parent>"),
    ],
)
def test_the_near_link_is_written_as_sdf_has_it(
    tmp_path: Path, right: str, wrong: str
) -> None:
    (problem,) = checked(tmp_path, "b.sdf", SDF.replace(right, wrong))

    assert problem.hint == f"write {right}"


def test_a_link_that_nothing_is_like_is_not_guessed(tmp_path: Path) -> None:
    (problem, *_) = checked(tmp_path, "b.sdf", SDF.replace(">base<", ">xyzzy<"))

    assert problem.hint == 'correct the name, or add <link name="xyzzy"/>'
