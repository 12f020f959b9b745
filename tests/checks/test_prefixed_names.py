"""Names that are right only as long as the prefix is empty."""

from __future__ import annotations

from pathlib import Path

import pytest

from sambot_viz.checks import check
from sambot_viz.edits import apply_edits
from sambot_viz.errors import Problem

MODEL = """<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">
<xacro:arg name="prefix" default=""/>
<xacro:property name="p" value="$(arg prefix)"/>
<link name="${p}base"/><link name="${p}arm"/><link name="${p}tool"/>
<joint name="${p}j" type="continuous"><parent link="${p}base"/>
<child link="${p}arm"/></joint>
<joint name="${p}k" type="continuous"><parent link="${p}arm"/>
<child link="${p}tool"/><mimic joint="${p}j"/></joint>
</robot>
"""


def named(model: Path, text: str) -> list[Problem]:
    model.write_text(text)
    return [p for p in check(model) if p.code == "name-without-prefix"]


@pytest.mark.parametrize("written", ["${p}", "$(arg prefix)"])
@pytest.mark.parametrize(
    "name", ['parent link="${p}base"', 'child link="${p}arm"', 'mimic joint="${p}j"']
)
def test_a_name_lacks_the_prefix_of_its_part(
    name: str, written: str, tmp_path: Path
) -> None:
    model, text = tmp_path / "r.urdf.xacro", MODEL.replace("${p}", written)
    name = name.replace("${p}", written)
    assert named(model, text) == []

    (problem,) = named(model, text.replace(name, name.replace(written, "")))

    assert problem.hint == f"write {name.partition(' ')[2]}"
    assert apply_edits(problem.edits, model.read_text()) == text


def test_a_name_that_a_part_has_needs_no_prefix(tmp_path: Path) -> None:
    text = MODEL.replace('parent link="${p}base"', 'parent link="base"')
    macro = '<xacro:macro name="m" params="name"><link name="${name}"/></xacro:macro>'
    call = '<xacro:m name="base"/>'
    more = text.replace('<link name="${p}base"/>', f"{macro}{call}")
    assert named(tmp_path / "r.urdf.xacro", more) == []
