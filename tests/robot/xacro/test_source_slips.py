"""Slips in xacro's own words: the problem names them, and its advice is enough."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path

import pytest

from sambot_viz import check
from sambot_viz.errors import Problem

MODEL = """<?xml version="1.0"?>
<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:arg name="arm" default="true"/>
  <xacro:arg name="kind" default="kind1"/>
  <xacro:property name="size" value="0.5"/>
  <xacro:property name="all" value="${xacro.load_yaml('config/sizes.yaml')}"/>
  <xacro:include filename="wheel.xacro"/>
  <xacro:include filename="$(arg kind)/part.xacro"/>
  <link name="base"/>
  <xacro:wheel name="left" parent="base">
    <origin xyz="0 ${size/2} 0"/>
  </xacro:wheel>
  <xacro:if value="$(arg arm)">
    <link name="arm">
      <visual>
        <geometry>
          <sphere radius="${all['arm']['size']}"/>
        </geometry>
      </visual>
    </link>
    <joint name="arm_joint" type="fixed">
      <parent link="base"/>
      <child link="arm"/>
    </joint>
  </xacro:if>
</robot>
"""
WHEEL = """<robot xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:macro name="wheel" params="name parent *origin">
    <link name="${name}_wheel"/>
    <joint name="${name}_joint" type="fixed">
      <parent link="${parent}"/>
      <child link="${name}_wheel"/>
      <xacro:insert_block name="origin"/>
    </joint>
  </xacro:macro>
</robot>
"""
FILES = {
    "r.urdf.xacro": MODEL,
    "wheel.xacro": WHEEL,
    "config/sizes.yaml": "arm:\n  size: 0.1\n",
    "kind1/part.xacro": "<robot/>",
}
Change = Callable[..., list[Problem]]


@pytest.fixture
def changed(tmp_path: Path) -> Change:
    """Checks the package with one text of one file exchanged."""

    def run(file: str = "r.urdf.xacro", old: str = "", new: str = "") -> list[Problem]:
        for name, text in FILES.items():
            path = tmp_path / name
            path.parent.mkdir(parents=True, exist_ok=True)
            assert old in FILES[file]
            path.write_text(text.replace(old, new, 1) if name == file else text)
        return check(tmp_path / "r.urdf.xacro")

    return run


def test_the_package_of_these_tests_is_good(changed: Change) -> None:
    assert changed() == []


SLIPS = [
    ("r.urdf.xacro", "<xacro:include filename=", "<xacro:inculde filename="),
    ("r.urdf.xacro", "<xacro:property name", "<xacro:proprety name"),
    ("r.urdf.xacro", "<xacro:arg name", "<xacro:rag name"),
    ("r.urdf.xacro", "<xacro:include filename=", "<include filename="),
    ("r.urdf.xacro", "<xacro:property name", "<property name"),
    ("r.urdf.xacro", "<xacro:arg name", "<arg name"),
]


@pytest.mark.parametrize(("file", "right", "wrong"), SLIPS)
def test_a_misspelt_word_of_xacro_is_named_at_its_line(
    changed: Change, file: str, right: str, wrong: str
) -> None:
    (problem,) = changed(file, right, wrong)

    line = FILES[file][: FILES[file].index(right)].count("\n") + 1
    assert (problem.line, problem.severity) == (line, "error")
    assert problem.hint.startswith(f"write {right.split()[0]}")


@pytest.mark.parametrize("prefix", ["Xacro", "XACRO", "xarco", "xaco"])
@pytest.mark.parametrize("tag", ["property", "if", "wheel"])
def test_a_misspelt_prefix_is_answered_with_the_right_one(
    changed: Change, tmp_path: Path, prefix: str, tag: str
) -> None:
    wrong = MODEL.replace(f"xacro:{tag}", f"{prefix}:{tag}")
    problems = changed("r.urdf.xacro", MODEL, wrong)

    lines = wrong.splitlines()
    for problem in problems:
        opening, *closing = re.findall(r"xacro:\w+", problem.hint)
        assert problem.line is not None
        lines[problem.line - 1] = lines[problem.line - 1].replace(
            f"{prefix}:{tag}", opening
        )
        for right in closing:
            end = lines.index(f"  </{prefix}:{tag}>")
            lines[end] = f"  </{right}>"
    assert problems
    assert "example.org" not in str(problems)
    (tmp_path / "r.urdf.xacro").write_text("\n".join(lines))
    assert check(tmp_path / "r.urdf.xacro") == []


@pytest.mark.parametrize(
    ("wrong", "fix"),
    [
        ("xacro:marco", "write <xacro:macro …>"),
        ("xacro:mcaro", "write <xacro:macro …>"),
        ("macro", "write <xacro:macro …> and </xacro:macro>"),
    ],
)
def test_a_macro_without_its_name_is_named_at_its_line(
    changed: Change, tmp_path: Path, wrong: str, fix: str
) -> None:
    changed()
    wheel = tmp_path / "wheel.xacro"
    wheel.write_text(WHEEL.replace("xacro:macro", wrong))

    (problem,) = check(tmp_path / "r.urdf.xacro")

    assert problem.file == str(wheel)
    assert (problem.line, problem.hint) == (2, fix)


@pytest.mark.parametrize(
    ("file", "right", "wrong"),
    [
        ("r.urdf.xacro", 'value="0.5"', 'vlaue="0.5"'),
        ("r.urdf.xacro", 'default="true"', 'defualt="true"'),
        ("r.urdf.xacro", 'filename="wheel.xacro"', 'file="wheel.xacro"'),
        ("r.urdf.xacro", 'filename="wheel.xacro"', 'filname="wheel.xacro"'),
        ("r.urdf.xacro", 'value="$(arg arm)"', 'valeu="$(arg arm)"'),
        ("wheel.xacro", 'params="name parent *origin"', 'parms="name parent *origin"'),
        ("wheel.xacro", 'name="origin"', 'nmae="origin"'),
        (
            "wheel.xacro",
            'params="name parent *origin"',
            'params="name, parent, *origin"',
        ),
        ("wheel.xacro", 'name="origin"', 'name="orign"'),
        ("r.urdf.xacro", 'value="0.5"', 'value="0.5m"'),
        ("r.urdf.xacro", 'value="0.5"', 'value="0,5"'),
    ],
)
def test_the_advice_is_the_text_that_was_right(
    changed: Change, file: str, right: str, wrong: str
) -> None:
    (problem,) = changed(file, right, wrong)

    line = FILES[file][: FILES[file].index(right)].count("\n") + 1
    assert (Path(problem.file or "").name, problem.line) == (file, line)
    assert re.match(rf"write {re.escape(right)}(?:$|;)", problem.hint)


@pytest.mark.parametrize(
    ("file", "right", "wrong", "line", "hint"),
    [
        ("r.urdf.xacro", "['size']", "['siez']", 17, "write size, or add siez"),
        ("r.urdf.xacro", "sizes.yaml", "size.yaml", 6, "write sizes.yaml"),
        ("r.urdf.xacro", '"wheel.xacro', '"whel.xacro', 7, "write wheel.xacro"),
        ("config/sizes.yaml", "  size", "\tsize", 2, "write blanks instead of the tab"),
        (
            "r.urdf.xacro",
            '"kind1"',
            '"kindX"',
            8,
            "give it on the command line: kind:=k",
        ),
        ("r.urdf.xacro", '"wheel.xacro', '"r.urdf.xacro', 7, "correct the name of the"),
        ("r.urdf.xacro", "$(arg arm)", "$(arg amr)", 13, "did you mean $(arg arm)?"),
        (
            "r.urdf.xacro",
            "size/2",
            "siez/2",
            11,
            "did you mean size (defined on line 5)",
        ),
    ],
)
def test_the_cause_comes_with_what_was_meant(
    changed: Change, file: str, right: str, wrong: str, line: int, hint: str
) -> None:
    (problem,) = changed(file, right, wrong)

    assert problem.line == line
    assert problem.hint.startswith(hint)


ENDLESS = """<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">
<xacro:property name="half" value="${{1 / 2}}"/>
<xacro:include filename="part.xacro"/>
<xacro:macro name="still" params="of"><link name="${{of}}"/></xacro:macro>
{0}<xacro:still of="a"/>
<xacro:include filename="r.urdf.xacro"/>
{1}
</robot>
"""
CALLED = """<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">
<xacro:macro name="still" params="of"><link name="${{of}}"/></xacro:macro>
<xacro:macro name="again" params="of">
<xacro:still of="${{of}}"/>
{0}<xacro:still of="${{of}}"/>
<xacro:again of="${{of}}"/>{1}
</xacro:macro>
<xacro:again of="a"/>
</robot>
"""


@pytest.mark.parametrize("around", range(5))
@pytest.mark.parametrize(
    ("model", "message"),
    [(ENDLESS, "this file includes itself"), (CALLED, "the macro again calls itself")],
)
def test_what_goes_on_for_ever_is_named_wherever_python_gives_up(
    tmp_path: Path, model: str, message: str, around: int
) -> None:
    (tmp_path / "part.xacro").write_text("<robot><link name='b'/></robot>")
    path = tmp_path / "r.urdf.xacro"
    # Each element around it takes more of Python's depth.
    path.write_text(model.format("<a>" * around, "</a>" * around))

    (problem,) = check(path)

    assert problem.message == f"the expansion never ends: {message}"
    assert (problem.file, problem.line) == (str(path), 6)


def test_a_block_without_its_prefix_in_a_joint_is_named(changed: Change) -> None:
    problems = changed("wheel.xacro", "<xacro:insert_block", "<insert_block")

    assert [(p.line, p.code, p.hint) for p in problems] == [
        (7, "xacro-prefix-missing", "write <xacro:insert_block>")
    ]


def test_an_argument_in_the_name_of_a_package_is_named(
    changed: Change, tmp_path: Path
) -> None:
    package = tmp_path / "blue_description"
    package.mkdir()
    (tmp_path / ".git").mkdir()  # the search for packages ends here
    (package / "package.xml").write_text(
        "<package><name>blue_description</name></package>"
    )
    (tmp_path / "package.xml").write_text("<package><name>own</name></package>")
    text = '<xacro:arg name="model" default=""/>\n<xacro:property name="m" '
    text += (
        'value="$(arg model)"/>\n<xacro:include filename="$(find ${m}_description)/x"/>'
    )

    (problem,) = changed("r.urdf.xacro", '<link name="base"/>', text)

    assert problem.code == "xacro-argument-placeholder"
    assert problem.hint == "give it on the command line: model:=blue"


@pytest.mark.parametrize("right", ["${size}", "$(arg kind)"])
def test_a_name_in_round_brackets_is_answered_with_the_right_ones(
    changed: Change, right: str
) -> None:
    name = re.sub(r"\W|arg ", "", right)

    (problem,) = changed("r.urdf.xacro", "$(arg arm)", f"$({name})")

    assert problem.hint.startswith(f"write {right}; ")


def test_a_property_whose_name_and_value_are_exchanged_is_named(
    changed: Change,
) -> None:
    right = '<xacro:property name="size" value="0.5"/><link name="base"/>'
    wrong = right.replace('"size"', '"0.5"').replace('value="0.5"', 'value="size"')

    (problem,) = changed("r.urdf.xacro", '<link name="base"/>', wrong)

    assert problem.code == "xacro-property-name"
    assert problem.hint == 'write name="size" value="0.5"'


def test_a_definition_that_is_used_nowhere_gets_the_name_that_is(
    changed: Change,
) -> None:
    box = (
        '<collision><geometry><box size="${width} ${width} 1"/></geometry></collision>'
    )
    text = f'<xacro:property name="width1" value="1"/><link name="base">{box}</link>'

    (problem,) = changed("r.urdf.xacro", '<link name="base"/>', text)

    assert problem.hint.startswith('write name="width" on line')
    assert [edit.text for edit in problem.edits] == ["width"]
