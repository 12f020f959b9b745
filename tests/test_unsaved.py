"""Models are loaded and checked as they are in an editor, not as on the disk."""

from __future__ import annotations

from pathlib import Path

import pytest

from sambot_viz import RobotError, load_robot
from sambot_viz.checks import check_robot
from sambot_viz.edits import apply_edits
from sambot_viz.problems import problem_lines
from sambot_viz.unsaved import unsaved

HEAD = '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">'
GOOD = f"""{HEAD}
<xacro:include filename="arm.xacro"/>
<link name="hull"/>
<joint name="j" type="fixed"><parent link="hull"/><child link="arm"/></joint>
</robot>
"""
ARM = f'{HEAD}<link name="arm"/></robot>'


@pytest.fixture
def model(tmp_path: Path) -> Path:
    file = tmp_path / "r.urdf.xacro"
    file.write_text("<robot", "utf-8")
    return file


def test_a_model_that_is_broken_on_the_disk_loads_as_it_is_in_the_editor(
    model: Path,
) -> None:
    texts = {str(model): GOOD, str(model.parent / "arm.xacro"): ARM}
    # The file that is included does not exist.
    assert set(load_robot(model, edited=texts).links) == {"hull", "arm"}
    with pytest.raises(RobotError):
        load_robot(model)
    model.unlink()
    assert load_robot(model, edited=texts).files[0] == model


def test_fixes_and_lines_are_those_of_the_text_in_the_editor(model: Path) -> None:
    bad = "\n\n" + GOOD.replace('parent link="hull"', 'parent link="hul"')
    texts = {str(model): bad, str(model.parent / "arm.xacro"): ARM}
    with unsaved(texts), pytest.raises(RobotError) as raised:
        load_robot(model, edited=texts)
    (problem,) = raised.value.problems
    assert apply_edits(problem.edits, bad) == "\n\n" + GOOD
    assert problem_lines(problem, 0) == []
    with unsaved(texts):
        assert problem_lines(problem, 0) == [(6, bad.split("\n")[5])]


def test_files_around_a_model_are_checked_as_they_are_in_the_editor(
    tmp_path: Path,
) -> None:
    (tmp_path / "package.xml").write_text("<package><name>p</name></package>")
    model, params = tmp_path / "r.urdf", tmp_path / "ekf.yaml"
    model.write_text('<robot name="r"><link name="base_link"/></robot>')
    good = "ekf_node:\n  ros__parameters:\n    base_link_frame: base_link\n"
    params.write_text(good)
    robot = load_robot(model)
    bad = good.replace("base_link_frame:", "base_link_frame: [")

    def found() -> list[str]:
        return [p.code for p in check_robot(robot, model) if p.file == str(params)]

    with unsaved({str(params): bad}):
        wrong = found()
    assert wrong and wrong != found()
