"""What follows from a finding is not shown: the model is read again with its edits."""

from __future__ import annotations

from pathlib import Path

from sambot_viz.checks import check
from sambot_viz.edits import apply_edits
from sambot_viz.robot.model import load_robot

XACRO = 'xmlns:xacro="http://www.ros.org/wiki/xacro"'
BOX = '<visual><geometry><box size="{}"/></geometry></visual>'
WHEEL = (
    '<link name="wheel">{}<collision><geometry><sphere radius="{}"/></geometry>'
    '</collision></link>\n<joint name="j" type="continuous"><parent '
    'link="base_footprint"/><child link="wheel"/><origin xyz="0 0 0.05"/>'
    '<axis xyz="0 1 0"/></joint>\n'
)


def test_a_length_through_a_property_and_a_macro_is_changed_where_it_is_written(
    tmp_path: Path,
) -> None:
    text = (
        f'<robot name="r" {XACRO}>\n<xacro:property name="side" value="420"/>\n'
        '<xacro:macro name="body" params="name high">\n'
        f'<link name="${{name}}">{BOX.format("${side} ${side/2} ${high}")}</link>\n'
        '</xacro:macro>\n<xacro:body name="a" high="180"/>\n</robot>'
    )
    file = tmp_path / "r.urdf.xacro"
    file.write_text(text, "utf-8")
    (problem,) = check(file)
    assert problem.code == "shape-size"
    better = apply_edits(problem.edits, text)
    assert better == text.replace('"420"', '"0.42"').replace('"180"', '"0.18"')
    file.write_text(better, "utf-8")
    assert check(file) == []


def test_a_wheel_off_the_ground_follows_from_its_cut_off_radius(tmp_path: Path) -> None:
    text = (
        '<sdf version="1.8"><model name="r">\n<link name="a"><visual name="v">'
        "<geometry><sphere><radius>0,5</radius></sphere></geometry></visual></link>\n"
        "</model></sdf>"
    )
    file = tmp_path / "r.sdf"
    file.write_text(text, "utf-8")
    assert [problem.code for problem in check(file)] == ["sdf-number-cut-off"]


def test_what_stays_with_the_edits_of_another_finding_is_shown(tmp_path: Path) -> None:
    wheel = WHEEL.format("", "0.05 ").replace("0 0 0.05", "0 0 0.2")
    text = f'<robot name="r">\n<link name="base_footprint"/>\n{wheel}</robot>'
    file = tmp_path / "r.urdf"
    file.write_text(text, "utf-8")
    codes = {problem.code for problem in check(file)}
    assert codes == {"number-with-blank", "wheel-not-on-ground"}


def test_a_robot_is_read_again_with_other_texts_of_its_files(tmp_path: Path) -> None:
    part = tmp_path / "part.xacro"
    part.write_text(f'<robot {XACRO}><link name="a"/></robot>', "utf-8")
    model = tmp_path / "r.urdf.xacro"
    include = f'<robot name="r" {XACRO}><xacro:include filename="part.xacro"/></robot>'
    model.write_text(include, "utf-8")
    robot = load_robot(model)
    assert robot.edited is not None
    other = robot.edited({str(part): f'<robot {XACRO}><link name="b"/></robot>'})
    assert list(other.links) == ["b"]
    text = include.replace('name="r"', 'name="other"')
    assert robot.edited({str(model): text}).name == "other"
    assert list(load_robot(model).links) == ["a"]
