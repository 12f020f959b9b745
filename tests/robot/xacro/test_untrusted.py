"""Expressions and paths that the untrusted mode refuses."""

from pathlib import Path

import pytest

from sambot_viz.errors import RobotError
from sambot_viz.robot.model import load_robot

HEAD = '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">'


def load(inside: str, folder: Path | None = None) -> str:
    """Name of the root link of an untrusted model."""
    model: Path | str = f"{HEAD}{inside}</robot>"
    if folder is not None:
        path = folder / "m.xacro"
        path.write_text(str(model), "utf-8")
        model = path
    return load_robot(model, trusted=False).root


def refusal(inside: str, folder: Path | None = None) -> str:
    with pytest.raises(RobotError) as caught:
        load(inside, folder)
    return str(caught.value)


@pytest.mark.parametrize(
    "expression",
    [
        "open('/etc/hostname')",
        "__import__('os')",
        "().__class__",
        "(lambda: ().__class__)()",
        "[c for c in (1, 2)]",
        "list(c for c in (1, 2))",
        "(lambda: xacro.load_yaml.__globals__)()",
        "xacro.load_yaml.func_globals",
        "'{0.real}'.format(1)",
        "'a'.upper()",
        "python.vars(xacro)",
        "python.type('X', (), dict())",
        "9**9**9",
        "'a' * 10**8",
        "(0,) * 10**8",
        "f'{1}'",
        "_sambot_get(1, 'real')",
    ],
)
def test_an_expression_cannot_reach_python(expression: str):
    quoted = expression.replace('"', "&quot;")
    assert "error" in refusal(f'<link name="${{{quoted}}}"/>')


def test_ordinary_expressions_still_work():
    text = (
        '<xacro:property name="r" value="0.5"/>'
        '<xacro:property name="names" value="${dict(left=1, right=[2, 3])}"/>'
        '<link name="l${int(math.sin(pi / 2) * 2**3 + r * 2)}'
        "${names['right'][1]}${max(1, 2) if r &lt; 1 else 0}${len('ab' * 2)}\"/>"
    )
    assert load(text) == "l9324"


def test_a_yaml_file_beside_the_model_is_read_with_dots(tmp_path: Path):
    (tmp_path / "c.yaml").write_text("wheel: {radius: !degrees 180, name: left}")
    text = (
        '<xacro:property name="c" value="${xacro.load_yaml(\'c.yaml\')}"/>'
        '<link name="${c.wheel.name}_${round(c.wheel.radius, 2)}"/>'
    )
    assert load(text, tmp_path) == "left_3.14"


def test_the_evaluator_of_eval_substitutions_is_restricted_too():
    close = '<xacro:property name="close" value=")"/>'
    text = f"{close}<link name=\"$(eval open('/etc/hostname'${{close}})\"/>"
    assert "error" in refusal(text)
    assert load('<link name="a$(eval 1 + 1)"/>') == "a2"


@pytest.mark.parametrize(
    "inside",
    [
        '<xacro:include filename="/etc/hostname"/>',
        '<xacro:include filename="../secret.xacro"/>',
        '<xacro:include filename="link.xacro"/>',
        '<xacro:include filename="sub/*/../../../secret.xacro"/>',
        "<link name=\"${xacro.load_yaml('/etc/hostname')}\"/>",
        "<link name=\"${xacro.load_yaml('../secret.xacro')}\"/>",
        "<link name=\"${xacro.load_yaml('link.xacro')}\"/>",
    ],
)
def test_files_outside_the_models_folder_are_not_read(inside: str, tmp_path: Path):
    secret = tmp_path / "secret.xacro"
    secret.write_text(f'{HEAD}<link name="secret"/></robot>')
    folder = tmp_path / "model"
    folder.mkdir()
    (folder / "link.xacro").symlink_to(secret)

    message = refusal(inside, folder)

    assert "climbs out" in message or "outside the model's folder" in message


def test_files_beside_the_model_are_read(tmp_path: Path):
    (tmp_path / "part.xacro").write_text(f'{HEAD}<link name="part"/></robot>')
    assert load('<xacro:include filename="part.xacro"/>', tmp_path) == "part"


def test_the_environment_is_empty(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setenv("MY_PREFIX", "front")
    assert load('<link name="$(optenv MY_PREFIX none)"/>') == "none"
    assert load('<link name="$(optenv HOME none)"/>') == "none"


def test_a_mesh_outside_the_model_and_its_packages_is_not_found(tmp_path: Path):
    (tmp_path / "secret.stl").write_text("solid")
    folder = tmp_path / "model"
    folder.mkdir()
    (folder / "near.stl").write_text("solid")
    model = folder / "m.urdf"
    shapes = "".join(
        f'<visual><geometry><mesh filename="{name}"/></geometry></visual>'
        for name in ("near.stl", "../secret.stl", str(tmp_path / "secret.stl"))
    )
    model.write_text(f'<robot name="r"><link name="a">{shapes}</link></robot>')

    def found(trusted: bool) -> list[bool]:
        visuals = load_robot(model, trusted=trusted).links["a"].visuals
        return [shape.geometry.path is not None for shape in visuals]  # type: ignore[union-attr]

    assert found(trusted=True) == [True, True, True]
    assert found(trusted=False) == [True, False, False]


def test_a_text_has_no_folder_to_read_from(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    (tmp_path / "part.xacro").write_text(f'{HEAD}<link name="part"/></robot>')
    monkeypatch.chdir(tmp_path)
    assert "outside the model's folder" in refusal(
        '<xacro:include filename="part.xacro"/>'
    )
