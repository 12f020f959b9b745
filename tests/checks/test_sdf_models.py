"""Checks say what to write in the language of the model."""

from __future__ import annotations

from pathlib import Path

from sambot_viz import Problem, check

LINKS = '<link name="a"/><link name="b"/>'


def checked(tmp_path: Path, content: str) -> dict[str, Problem]:
    model = tmp_path / "r.sdf"
    model.write_text(f'<sdf version="1.8"><model name="r">{content}</model></sdf>')
    return {problem.code: problem for problem in check(model)}


def joint(child: str, axis: str, pose: str = "") -> str:
    return (
        f'<joint name="{child}_joint" type="revolute"><parent>a</parent>'
        f"<child>{child}</child>{pose}<axis><xyz>0 1 0</xyz>{axis}</axis></joint>"
    )


def test_limits_in_degrees_are_told_as_sdf_writes_them(tmp_path: Path) -> None:
    limit = "<limit><lower>-90</lower><upper>90</upper></limit>"
    problem = checked(tmp_path, LINKS + joint("b", limit))["limit-in-degrees"]

    assert problem.hint == "write <lower>-1.5708</lower> and <upper>1.5708</upper>"
    assert "SDF uses radians" in problem.message


def test_a_mesh_in_millimetres_is_told_as_sdf_writes_it(tmp_path: Path) -> None:
    mesh = "v 0 0 0\nv 0 250 0\nv 250 0 250\nf 1 2 3\n"
    (tmp_path / "part.obj").write_text(mesh)
    shape = "<geometry><mesh><uri>part.obj</uri></mesh></geometry>"
    link = f'<link name="a"><visual name="v">{shape}</visual></link>'

    hint = checked(tmp_path, link)["mesh-size"].hint
    assert "<scale>0.001 0.001 0.001</scale>" in hint


def test_a_wheel_without_limits_is_judged_as_a_continuous_one(tmp_path: Path) -> None:
    ball = (
        '<link name="b"><pose relative_to="b_joint"/><collision name="c"><geometry>'
        "<sphere><radius>0.1</radius></sphere></geometry></collision></link>"
    )
    ground = (
        '<joint name="f" type="fixed"><parent>a</parent><child>base_footprint</child>'
        '<pose relative_to="a"/></joint><link name="base_footprint"/>'
    )
    wheel = joint("b", "", '<pose relative_to="a">0 0 0.5 0 0 0</pose>')
    found = checked(tmp_path, f'<link name="a"/>{ball}{ground}{wheel}')

    assert "0.4 m above" in found["wheel-not-on-ground"].message


def test_a_macro_that_is_never_called_is_told_in_sdf_too(tmp_path: Path) -> None:
    model = tmp_path / "r.sdf"
    model.write_text(
        '<sdf version="1.8" xmlns:xacro="http://www.ros.org/wiki/xacro">'
        '<model name="r"><link name="a"/><xacro:macro name="wheel">'
        '<link name="b"/></xacro:macro></model></sdf>'
    )
    assert [problem.code for problem in check(model)] == ["unused-macro"]
