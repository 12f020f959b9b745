"""A misspelt name is reported first, with the right word, and without what follows."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

import pytest
from work import calls_of

from sambot_viz import check
from sambot_viz.errors import Problem, RobotError
from sambot_viz.robot.model import load_robot

GOOD = """<robot name="studbot">
  <material name="blue">
    <color rgba="0 0 0.8 1"/>
  </material>
  <link name="base">
    <visual name="shell">
      <origin xyz="0 0 0.02" rpy="0 0 0"/>
      <geometry>
        <box size="0.4 0.3 0.2"/>
      </geometry>
      <material name="blue"/>
    </visual>
    <collision>
      <geometry>
        <cylinder radius="0.2" length="0.2"/>
      </geometry>
    </collision>
  </link>
  <link name="arm">
    <inertial>
      <mass value="2"/>
      <inertia ixx="0.1" ixy="0" ixz="0" iyy="0.1" iyz="0" izz="0.1"/>
    </inertial>
    <visual>
      <geometry>
        <sphere radius="0.1"/>
      </geometry>
    </visual>
  </link>
  <joint name="shoulder" type="revolute">
    <parent link="base"/>
    <child link="arm"/>
    <origin xyz="0 0 0.3"/>
    <axis xyz="0 1 0"/>
    <limit lower="-1" upper="1" effort="10" velocity="1"/>
    <dynamics damping="0.1" friction="0.2"/>
    <calibration rising="0.1"/>
    <safety_controller soft_lower_limit="-1" soft_upper_limit="1" k_velocity="9"/>
  </joint>
  <link name="finger"/>
  <joint name="knuckle" type="continuous">
    <parent link="arm"/>
    <child link="finger"/>
    <mimic joint="shoulder" multiplier="2" offset="0.1"/>
  </joint>
</robot>
"""


def slips(name: str) -> Iterator[str]:
    """Swap two letters, leave one out, write one twice, another or a capital."""
    middle = len(name) // 2
    yield name[: middle - 1] + name[middle] + name[middle - 1] + name[middle + 1 :]
    yield name[:middle] + name[middle + 1 :]
    yield name[:middle] + name[middle - 1 :]
    yield name[:middle] + "q" + name[middle + 1 :]
    yield name.capitalize()


def found(text: str) -> tuple[Problem, ...]:
    try:
        return load_robot(text).problems
    except RobotError as error:
        return error.problems


def with_tag(tag: re.Match[str], slip: str) -> str:
    """The good model with another name for one element."""
    start, end = tag.span()
    if not tag[3]:
        end = GOOD.index(f"</{tag[1]}>", start) + len(tag[1]) + 3
    part = GOOD[start:end]
    changed = re.sub(
        rf"^<{tag[1]}|</{tag[1]}>$", lambda m: m[0].replace(tag[1], slip), part
    )
    return GOOD[:start] + changed + GOOD[end:]


def test_every_misspelt_element_is_named_first_and_alone_with_the_right_word() -> None:
    wrong: list[object] = []
    for tag in re.finditer(r"<(\w+)([^<>]*?)(/?)>", GOOD):
        line = GOOD.count("\n", 0, tag.start()) + 1
        for slip in slips(tag[1]):
            problems = found(with_tag(tag, slip))
            only = [(p.line, p.code) for p in problems]
            right = f"write <{tag[1]} …"
            if (
                only != [(line, "element-misspelt")]
                or f"<{slip}" not in problems[0].message
                or not problems[0].hint.startswith(right)
            ):
                wrong.append((slip, line, problems))
    assert wrong == []


def test_every_misspelt_attribute_is_named_first_and_alone_with_the_right_word() -> (
    None
):
    wrong: list[object] = []
    for found_name in re.finditer(r'(\w+)=("[^"]*")', GOOD):
        line = GOOD.count("\n", 0, found_name.start()) + 1
        for slip in set(slips(found_name[1])) - {found_name[1]}:
            text = GOOD[: found_name.start()] + slip + GOOD[found_name.end(1) :]
            problems = found(text)
            only = [(p.line, p.code, p.hint) for p in problems]
            if only != [
                (line, "attribute-misspelt", f"write {found_name[1]}={found_name[2]}")
            ]:
                wrong.append((slip, line, problems))
    assert wrong == []


def test_the_model_of_these_tests_is_good() -> None:
    assert found(GOOD) == ()


@pytest.mark.parametrize(
    ("old", "new", "said", "severity"),
    [
        ('<link name="finger"/>', '<Link name="finger"/>', "<link>", "error"),
        ("<parent link", "<parnt link", "<parent>", "error"),
        ("<limit ", "<limits ", "<limit>", "error"),
        ("<box size", "<box siz", "size", "error"),
        ("<axis ", "<axes ", "<axis>", "warning"),
        ("<origin xyz", "<origin pos", "xyz", "warning"),
        ("<parent link", "<parent name", "link", "error"),
        ("multiplier", "ratio", "multiplier", "warning"),
        ("<color rgba", "<color rgb", "rgba", "warning"),
        ("<mass value", "<mass kg", "value", "warning"),
    ],
)
def test_a_slip_is_as_grave_as_what_follows_from_it(
    old: str, new: str, said: str, severity: str
) -> None:
    problems = found(GOOD.replace(old, new, 1))

    assert [p.severity for p in problems] == [severity]
    assert f"did you mean {said}?" in problems[0].message


def test_a_refused_model_says_so_at_the_misspelt_name() -> None:
    text = GOOD.replace('<link name="finger"/>', '<lnk name="finger"/>')

    (problem,) = found(text)

    assert problem.message == (
        '<lnk name="finger"> is not known; did you mean <link>? ROS ignores it, so it '
        "refuses the model"
    )
    assert problem.hint == "write <link …/>"


def test_what_does_not_follow_from_the_name_stays() -> None:
    text = GOOD.replace("<child link", "<chld link", 1).replace('"blue"/>', '"bleu"/>')
    text = text.replace('<link name="finger"/>', "")

    assert [p.code for p in found(text)] == [
        "element-misspelt",
        "material-undefined",
        "joint-child-unknown",
    ]


def test_two_slips_have_each_their_own_gravity() -> None:
    text = GOOD.replace("visual", "visaul").replace("<parent link", "<parnt link", 1)

    assert [(p.code, p.severity) for p in found(text)] == [
        ("element-misspelt", "warning"),
        ("element-misspelt", "warning"),
        ("element-misspelt", "error"),
    ]


def test_slips_inside_a_misspelt_element_are_found_too() -> None:
    text = GOOD.replace("<geometry>", "<geomtry>", 1).replace(
        "</geometry>", "</geomtry>", 1
    )

    hints = [p.hint for p in found(text.replace("<box size", "<bxo sizes"))]

    assert hints == [
        "write <geometry …> and </geometry>",
        "write <box …/>",
        'write size="0.4 0.3 0.2"',
    ]


@pytest.mark.parametrize(
    "unknown",
    [
        '<joints><joint name="x"/></joints>',
        "<self_collide>1</self_collide>",
        '<sensor name="s"><orgin xyz="0 0 0"/></sensor>',
        '<gazebo><visaul/><link name="x"/></gazebo>',
        '<transmission name="t"><jiont name="shoulder"/></transmission>',
        '<x:visaul xmlns:x="u"/>',
    ],
)
def test_what_other_programs_read_is_left_alone(unknown: str) -> None:
    text = GOOD.replace("</robot>", f"{unknown}</robot>")

    assert not any("mis" in p.code for p in found(text)), found(text)


def test_a_name_beside_the_right_one_is_left_alone() -> None:
    text = GOOD.replace('velocity="1"', 'velocity="1" gear_velocity="10"').replace(
        '<axis xyz="0 1 0"/>', '<axis xyz="0 1 0"/><axes xyz="1 0 0"/>'
    )

    assert found(text) == ()


def test_an_element_is_known_by_its_attributes() -> None:
    text = GOOD.replace("<inertial>", '<inertial><orange xyz="0 0 1" rpy="0 0 0"/>')

    (problem,) = found(text)

    assert "did you mean <origin>?" in problem.message


@pytest.mark.parametrize(
    ("old", "new", "hint"),
    [
        (
            '<link name="finger"/>',
            '<link name="finger"/><visual><geometry><sphere radius="1"/></geometry>'
            "</visual>",
            'move <visual> into <link name="finger"> (line 40)',
        ),
        (
            '<sphere radius="0.1"/>',
            '<origin xyz="0 0 1"/><sphere radius="0.1"/>',
            "move <origin> out of <geometry>, directly into <visual>",
        ),
        (
            '<link name="finger"/>',
            '<link name="finger"><geometry><sphere radius="1"/></geometry></link>',
            "write <visual> before it and </visual> behind it",
        ),
        (
            '<link name="finger"/>',
            '<link name="finger"><box size="1 1 1"/></link>',
            "write <visual><geometry> before it and </geometry></visual> behind it",
        ),
        (
            '<link name="finger"/>',
            '<link name="finger"><origin xyz="1 1 1"/></link>',
            'move <origin> into <joint name="knuckle"> (line 41)',
        ),
    ],
)
def test_an_element_at_a_wrong_place_says_where_it_belongs(
    old: str, new: str, hint: str
) -> None:
    (problem,) = found(GOOD.replace(old, new))

    assert problem.code == "element-misplaced"
    assert problem.hint == hint


def test_links_after_a_misplaced_joint_are_not_called_unconnected() -> None:
    start, end = GOOD.index('  <joint name="knuckle'), GOOD.index("</robot>")
    joint = GOOD[start:end]
    text = GOOD.replace(joint, "").replace("</link>", f"{joint}</link>", 1)

    (problem,) = found(text)

    assert problem.severity == "error"
    assert problem.message.startswith('<joint name="knuckle"> means nothing in <link>')
    assert problem.hint.endswith('directly into <robot name="studbot">')


def test_a_misspelt_root_is_named() -> None:
    (problem,) = found(GOOD.replace("robot", "robto"))

    assert "did you mean <robot>?" in problem.message
    assert problem.severity == "error"


def test_a_slip_in_a_macro_is_reported_once(tmp_path: Path) -> None:
    model = tmp_path / "r.urdf.xacro"
    model.write_text(
        '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">\n'
        '<xacro:macro name="part" params="name">\n<link name="${name}">\n'
        '<visaul><geometry><sphere radius="1"/></geometry></visaul>\n</link>\n'
        '</xacro:macro>\n<xacro:part name="a"/>\n<xacro:part name="b"/>\n'
        '<joint name="j" type="fixed"><parent link="a"/><child link="b"/></joint>\n'
        "</robot>\n"
    )

    (problem,) = check(model)

    assert (problem.line, problem.code) == (4, "element-misspelt")


def test_what_a_check_finds_only_because_of_the_slip_is_kept_back(
    tmp_path: Path,
) -> None:
    model = tmp_path / "r.urdf"
    wheels = '<link name="base_footprint"/><link name="w"><visual><geometry>'
    wheels += '<sphere radius="0.1"/></geometry></visual></link>'
    joint = '<joint name="j" type="continuous"><parent link="base_footprint"/>'
    joint += '<child link="w"/><origin xyz="0 0 0.1"/><axis xyz="0 1 0"/></joint>'
    text = f'<robot name="r">{wheels}{joint}</robot>'
    model.write_text(text)
    assert check(model) == []

    model.write_text(text.replace("<origin", "<orgin"))

    assert [p.code for p in check(model)] == ["element-misspelt"]


def test_a_macro_call_without_its_prefix_inside_a_link_is_named(tmp_path: Path) -> None:
    model = tmp_path / "r.urdf.xacro"
    model.write_text(
        '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">\n'
        '<xacro:macro name="box_inertia" params="m">\n'
        '<inertia ixx="${m}" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/>\n'
        '</xacro:macro>\n<link name="a"/>\n<link name="b">\n<inertial>\n'
        '<mass value="1"/>\n<box_inertia m="1"/>\n</inertial>\n</link>\n'
        '<joint name="j" type="fixed"><parent link="a"/><child link="b"/></joint>\n'
        "</robot>\n"
    )

    (problem,) = (p for p in check(model) if p.severity != "info")

    assert (problem.line, problem.code) == (9, "xacro-prefix-missing")
    assert problem.hint == "write <xacro:box_inertia>"


@pytest.mark.parametrize(
    "parts",
    [
        ("<link>", "</link>"),
        ("<visual>", "</visual>"),
        ('<origin xyz="0 0 0"/>',),
        ('<lnk name="a"/>',),
    ],
)
def test_twice_as_many_slips_are_about_twice_the_work(parts: tuple[str, ...]) -> None:
    def work(count: int) -> int:
        robot = "".join(part * count for part in parts)
        return calls_of(
            lambda: found(f'<robot name="r"><link name="a"/>{robot}</robot>')
        )

    assert work(5000) < 3 * work(2500)
