"""What is wrong in a property is found where it is used, and is mended in it."""

from __future__ import annotations

from pathlib import Path

import pytest

from sambot_viz.checks import check
from sambot_viz.edits import apply_edits

HEAD = '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">\n'
MODEL = f"""{HEAD}<xacro:property name="front" value="front_link"/>
<xacro:property name="rear" value="rear_link"/>
<xacro:property name="mesh" value="package://r/meshes/part.obj"/>
<link name="front_link"><visual><geometry><mesh filename="${{mesh}}"/></geometry>
</visual></link>
<link name="rear_link"/>
<joint name="j" type="fixed"><parent link="front_link"/><child link="${{rear}}"/>
</joint>
</robot>
"""


@pytest.mark.parametrize(
    ("right", "wrong", "code"),
    [
        ("/meshes/part.obj", "/meshes/Part.obj", "file-letter-case"),
        ('"rear_link"/>\n<x', '"raer_link"/>\n<x', "joint-child-unknown"),
    ],
)
def test_the_property_is_mended(
    right: str, wrong: str, code: str, tmp_path: Path
) -> None:
    model = tmp_path / "r.urdf.xacro"
    (tmp_path / "package.xml").write_text("<package><name>r</name></package>")
    (tmp_path / "meshes").mkdir()
    (tmp_path / "meshes" / "part.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3")
    text = MODEL.replace(right, wrong)
    model.write_text(text)

    (problem,) = (p for p in check(model) if p.code == code)
    assert "used on line" in problem.message
    assert apply_edits(problem.edits, text) == MODEL


def test_the_property_with_the_right_value_is_written(tmp_path: Path) -> None:
    model = tmp_path / "r.urdf.xacro"
    right = MODEL.replace("</robot>", CONTROL)
    text = "${front_joint}".join(right.rsplit("${rear_joint}", 1))
    model.write_text(text)

    (problem,) = (p for p in check(model) if p.code == "control-interface")
    assert apply_edits(problem.edits, text) == right


CONTROL = """<xacro:property name="front_joint" value="joint_1"/>
<xacro:property name="rear_joint" value="joint_2"/>
<link name="x"/><link name="y"/>
<joint name="${front_joint}" type="continuous"><parent link="rear_link"/>
<child link="x"/></joint>
<joint name="${rear_joint}" type="continuous"><parent link="rear_link"/>
<child link="y"/></joint>
<ros2_control name="c" type="system">
<hardware><plugin>mock_components/GenericSystem</plugin></hardware>
<joint name="${front_joint}"><command_interface name="velocity"/>
<state_interface name="velocity"/><state_interface name="position"/></joint>
<joint name="${rear_joint}"><command_interface name="velocity"/>
<state_interface name="velocity"/><state_interface name="position"/></joint>
</ros2_control>
</robot>"""
