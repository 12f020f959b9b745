"""A block that was copied gets the name that other files call for."""

from __future__ import annotations

from pathlib import Path

import pytest

from sambot_viz.checks import check
from sambot_viz.edits import apply_edits

WHEEL = """\
<joint name="{0}_wheel_joint" type="continuous">
<parent link="base_link"/><child link="{0}_wheel"/><axis xyz="0 1 0"/>
</joint>
<link name="{0}_wheel"/>
"""
HEAD = '<robot name="r">\n<link name="base_link"/>\n'
RIGHT = HEAD + WHEEL.format("left") + WHEEL.format("right") + "</robot>\n"
WRONG = HEAD + WHEEL.format("left") * 2 + "</robot>\n"
YAML = "drive:\n  ros__parameters:\n    right_wheel_names: [{}]\n"


@pytest.mark.parametrize(
    "named", ["right_wheel_joint", "arm_joint", "left_wheel_joint"]
)
def test_a_copied_wheel_gets_the_names_that_parameters_have(
    named: str, tmp_path: Path
) -> None:
    (tmp_path / "package.xml").write_text("<package><name>r</name></package>")
    (tmp_path / "drive.yaml").write_text(YAML.format(named))
    model = tmp_path / "robot.urdf"
    model.write_text(WRONG)

    problems = [p for p in check(model) if p.code.endswith("-duplicate")]

    assert [p.line for p in problems] == [7, 10]
    edits = [edit for problem in problems for edit in problem.edits]
    fixed = apply_edits(edits, WRONG)
    assert fixed == (RIGHT if named == "right_wheel_joint" else WRONG)
