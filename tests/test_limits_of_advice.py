"""Above a limit of what is looked through for advice, the error is there without it."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from lower_limit import lower

from sambot_viz import load_robot
from sambot_viz.checks.around.files.yaml_repair import fault_in
from sambot_viz.errors import RobotError

BROKEN = '<robot name="r">\n  <link name="a">\n</robot>\n'
XACRO = """<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:property name="width" value="0.1 m"/>
  <link name="${width*1.0}"/>
</robot>
"""
YAML = "a:\n  b: 1\n  c 2\n"


def said_of(path: Path) -> str:
    """The errors and warnings of a model, with what to do about them."""
    try:
        problems = load_robot(path).problems
    except RobotError as error:
        problems = error.problems
    return " ".join(f"{problem.message}; {problem.hint}" for problem in problems)


def xml_size(folder: Path) -> tuple[int, str]:
    (folder / "r.urdf").write_text(BROKEN)
    return len(BROKEN), said_of(folder / "r.urdf")


def xacro_size(folder: Path) -> tuple[int, str]:
    (folder / "r.urdf.xacro").write_text(XACRO)
    return len(XACRO), said_of(folder / "r.urdf.xacro")


def yaml_size(folder: Path) -> tuple[int, str]:
    del folder
    fault = fault_in(YAML)
    return len(YAML), "" if fault is None else f"{fault.cause}; {fault.hint}"


def folders_of_a_package(folder: Path) -> tuple[int, str]:
    inside = folder / "x" / "meshes"
    inside.mkdir(parents=True, exist_ok=True)
    (folder / "package.xml").write_text("<package><name>p</name></package>")
    (inside / "m.stl").write_bytes(b"")
    shape = '<geometry><mesh filename="package://p/meshes/m.stl"/></geometry>'
    link = f'<link name="a"><visual>{shape}</visual></link>'
    (folder / "r.urdf").write_text(f'<robot name="r">{link}</robot>')
    return 2, said_of(folder / "r.urdf")


@pytest.mark.parametrize(
    ("name", "case", "advice", "without"),
    [
        ("XML_EXPLAINED", xml_size, "is never closed", "mismatched tag"),
        ("XACRO_SOURCE", xacro_size, 'write value="0.1"', "can't multiply"),
        ("YAML_REPAIRED", yaml_size, "colon", "correct this line"),
        ("NEAR_FOLDERS", folders_of_a_package, "x/meshes", "no such file"),
    ],
)
def test_just_above_a_limit_of_advice_the_error_is_there_without_it(
    name: str,
    case: Callable[[Path], tuple[int, str]],
    advice: str,
    without: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    most, _ = case(tmp_path)
    lower(monkeypatch, name, most)
    assert advice in case(tmp_path)[1]
    lower(monkeypatch, name, most - 1)
    _, said = case(tmp_path)
    assert without in said
    assert advice not in said
