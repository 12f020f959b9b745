"""URDF is read as ROS reads it, and each mistake is reported."""

from pathlib import Path

import pytest

from sambot_viz.errors import Problem, RobotError
from sambot_viz.robot.model import Robot, load_robot
from sambot_viz.robot.parts import Box, Capsule, Material

LIMIT = '<limit lower="-1" upper="1" effort="1" velocity="1"/>'
BOX = '<geometry><box size="1 2 3"/></geometry>'


def load(inside: str, head: str = 'name="r"') -> Robot:
    return load_robot(f"<robot {head}>\n{inside}\n</robot>")


def refused(inside: str, head: str = 'name="r"') -> tuple[Problem, ...]:
    with pytest.raises(RobotError) as caught:
        load(inside, head)
    return tuple(p for p in caught.value.problems if p.severity == "error")


def codes(problems: tuple[Problem, ...]) -> list[str]:
    return [problem.code for problem in problems]


def link(inside: str) -> str:
    return f'<link name="a">{inside}</link>'


def visual(geometry: str, more: str = "") -> str:
    return link(f"<visual>{more}<geometry>{geometry}</geometry></visual>")


def joint(inside: str, kind: str = 'type="continuous"') -> str:
    return (
        f'<link name="a"/><link name="b"/><joint name="j" {kind}>'
        f'<parent link="a"/><child link="b"/>{inside}</joint>'
    )


def test_a_robot_is_read_with_its_defaults():
    robot = load(joint(""))
    j = robot.joints["j"]

    assert (robot.name, robot.root, list(robot.links)) == ("r", "a", ["a", "b"])
    assert (j.axis, j.limit, j.mimic) == ((1, 0, 0), None, None)
    assert (j.origin.xyz, j.origin.rpy) == ((0, 0, 0), (0, 0, 0))
    assert robot.problems == ()


@pytest.mark.parametrize(
    ("inside", "head", "code"),
    [
        (link(""), "", "robot-without-name"),
        (link(""), 'name="r" version="1.1"', "robot-version"),
        (link(""), 'name="r" version="1"', "robot-version"),
        ("", 'name="r"', "robot-without-links"),
        (f"<group>{link('')}</group>", 'name="r"', "links-not-direct"),
        (link("") + link(""), 'name="r"', "link-duplicate"),
        (link("") + "<link/>", 'name="r"', "link-without-name"),
        ('<link name=""/>', 'name="r"', "link-without-name"),
        (link("") + '<link name="z"/>', 'name="r"', "root-not-unique"),
        ('<material name="m"><color rgba="1 0 0 1"/></material>' * 2 + link(""),
         'name="r"', "material-duplicate"),
    ],
)  # fmt: skip
def test_a_robot_that_ros_refuses_has_one_error(inside: str, head: str, code: str):
    assert codes(refused(inside, head)) == [code]


@pytest.mark.parametrize(
    ("text", "code"),
    [
        (joint("").replace(' name="j"', ""), "joint-without-name"),
        (joint("", ""), "joint-without-type"),
        (joint("", 'type="hinge"'), "joint-type-unknown"),
        (joint("", 'type="Fixed"'), "joint-type-unknown"),
        (joint("", 'type="fixed "'), "joint-type-unknown"),
        (joint("").replace('<parent link="a"/>', ""), "joint-without-parent"),
        (joint("").replace('<child link="b"/>', ""), "joint-without-child"),
        (joint("").replace('<child link="b"/>', "<child>b</child>"),
         "joint-child-without-link"),
        (joint("").replace('child link="b"', 'child link="z"'), "joint-child-unknown"),
        (joint("", 'type="revolute"'), "limit-missing"),
        (joint("", 'type="prismatic"'), "limit-missing"),
        (joint('<limit effort="1"/>'), "limit-incomplete"),
        (joint('<limit velocity="1"/>', 'type="fixed"'), "limit-incomplete"),
        (joint(LIMIT.replace("-1", "-pi"), 'type="revolute"'), "number-malformed"),
        (joint('<origin xyz="0 0"/>'), "number-malformed"),
        (joint('<origin xyz="1,2,3"/>'), "number-malformed"),
        (joint('<origin rpy="0 0 pi/2"/>'), "number-malformed"),
        (joint('<origin xyz=""/>'), "number-malformed"),
        (joint('<axis xyz="0 1"/>'), "number-malformed"),
        (joint("<mimic/>"), "mimic-without-joint"),
        (joint('<mimic joint="j" multiplier="x"/>'), "number-malformed"),
        (joint("<safety_controller/>"), "safety-controller-incomplete"),
        (joint("<dynamics/>"), "dynamics-empty"),
        (joint('<dynamics damping="x"/>'), "number-malformed"),
        (joint('<calibration rising="x"/>'), "number-malformed"),
    ],
)  # fmt: skip
def test_a_wrong_joint_rejects_the_model(text: str, code: str):
    assert code in codes(refused(text))


def test_all_errors_are_reported_together_each_on_its_line():
    found = refused(
        '<link name="a"/>\n<link name="b"/>\n'
        '<joint name="j" type="hinge">\n<parent link="a"/><child link="b"/></joint>\n'
        '<joint name="k" type="revolute">\n<parent link="a"/>\n<child link="c"/>\n'
        '<origin xyz="1 2"/></joint>'
    )
    assert {(p.code, p.line) for p in found} == {
        ("joint-type-unknown", 4),
        ("limit-missing", 6),
        ("joint-child-unknown", 8),
        ("number-malformed", 9),
    }


@pytest.mark.parametrize(
    ("text", "code", "severity"),
    [
        (joint("<axis/>"), "axis-without-xyz", "error"),
        (joint('<axis rpy="0 0 1"/>'), "axis-without-xyz", "error"),
        (joint('<axis xyz="0 0 0"/>'), "axis-zero", "error"),
        (joint('<limit effort="1" velocity="1"/>', 'type="revolute"'),
         "limit-without-range", "warning"),
        (joint('<limit lower="-1" effort="1" velocity="1"/>', 'type="revolute"'),
         "limit-without-range", "warning"),
        (joint('<limit effort="0" velocity="0"/>', 'type="revolute"'),
         "limit-without-range", "warning"),
        (joint('<limit lower="1" upper="-1" effort="1" velocity="1"/>',
               'type="revolute"'), "limit-reversed", "warning"),
        (joint('<mimic joint="zz"/>'), "mimic-joint-unknown", "error"),
        (joint('<mimic joint="j"/>'), "mimic-ring", "error"),
        (joint("<origin/><origin/>"), "origin-twice", "warning"),
        ('<link name="/a"/>', "link-name-slash", "warning"),
        (visual("<capsule radius='1' length='2'/>"), "geometry-capsule", "warning"),
        (visual("<box size='1 1 1'/><sphere radius='1'/>"),
         "geometry-more-than-one", "warning"),
        (visual("<sphere radius='1.0 '/>"), "number-with-blank", "warning"),
        (visual("<box size='1\t1\n1'/>"), "numbers-with-tab", "warning"),
        (visual("<mesh filename='no.stl'/>"), "mesh-not-found", "warning"),
    ],
)  # fmt: skip
def test_a_mistake_that_ros_accepts_is_drawn_and_reported(
    text: str, code: str, severity: str
):
    problems = load(text).problems
    assert [(p.code, p.severity) for p in problems] == [(code, severity)]
    assert all(p.hint for p in problems)


@pytest.mark.parametrize(
    ("third", "hint"),
    [
        ('<mimic joint="j"/>', 'write joint="j"'),
        ("", "delete the <mimic> of one of them"),
    ],
)
def test_a_joint_that_mimics_itself_gets_the_only_one_beside_it(third: str, hint: str):
    other = '<link name="{0}"/><joint name="j{0}" type="continuous"><parent link="a"/>'
    other += '<child link="{0}"/>{1}</joint>'
    text = joint("") + other.format("c", '<mimic joint="jc"/>')
    problems = load(text + other.format("d", third)).problems
    assert [p.hint for p in problems if p.code == "mimic-ring"] == [hint]


@pytest.mark.parametrize("leader", ["zz", "j", "i"])
def test_the_mimic_of_a_joint_that_cannot_move_is_read_by_nobody(leader: str):
    """joint_state_publisher skips the joint before it looks at <mimic>."""
    text = joint(f'<mimic joint="{leader}"/>', 'type="fixed"')
    other = joint("", 'name="i" type="fixed"').partition("<joint")[2]
    other = other.replace('name="j" ', "").replace('"b"', '"c"')
    robot = load(f'{text}<link name="c"/><joint {other}')
    assert (set(robot.joints), robot.problems) == ({"i", "j"}, ())


@pytest.mark.parametrize(
    ("text", "code", "severity"),
    [
        (link("<visual/>"), "geometry-empty", "warning"),
        (visual(""), "geometry-empty", "warning"),
        (visual("<cone/>"), "geometry-unknown", "warning"),
        (visual("<box/>"), "attribute-missing", "error"),
        (visual("<box size='1 1'/>"), "number-malformed", "error"),
        (visual("<box size='1 1 1 1'/>"), "number-malformed", "error"),
        (visual("<box size='1,1,1'/>"), "number-malformed", "error"),
        (visual("<box size='1 1 nan'/>"), "number-malformed", "error"),
        (visual("<box size='1 1 inf'/>"), "number-malformed", "error"),
        (visual("<box size='1m 1 1'/>"), "number-malformed", "error"),
        (visual("<sphere/>"), "attribute-missing", "error"),
        (visual("<sphere diameter='1'/>"), "sphere-diameter", "error"),
        (visual("<cylinder radius='1' height='1'/>"), "cylinder-height", "error"),
        (visual("<mesh/>"), "attribute-missing", "error"),
        (visual("<mesh filename='m.stl' scale='0.001'/>"), "number-malformed", "error"),
        (visual("<box size='1 1 1'/>", "<origin xyz='1 2'/>"),
         "number-malformed", "error"),
        (link(f"<visual>{BOX}<material/></visual>"), "material-without-name", "error"),
        (link(f"<inertial/><visual>{BOX}</visual>"), "inertial-without-mass",
         "warning"),
        (link(f"<inertial><mass value='1'/></inertial><visual>{BOX}</visual>"),
         "inertial-without-inertia", "warning"),
        (link("<inertial><mass value='1'/><inertia ixx='1'/></inertial>"),
         "inertia-incomplete", "warning"),
        (link("<inertial><mass>1</mass></inertial>"), "attribute-missing", "warning"),
    ],
)  # fmt: skip
def test_a_wrong_shape_is_left_out_and_the_robot_stays(
    text: str, code: str, severity: str
):
    robot = load(text)
    assert robot.links["a"].visuals == ()
    assert [(p.code, p.severity) for p in robot.problems] == [(code, severity)]


def test_a_broken_visual_drops_only_the_rest_of_its_link():
    broken = "<visual><geometry><box/></geometry></visual>"
    robot = load(
        f'<link name="a"><visual>{BOX}</visual>{broken}<visual>{BOX}</visual>'
        f"<collision>{BOX}</collision></link>"
        f'<link name="b"><collision>{BOX}</collision></link>'
        '<joint name="j" type="fixed"><parent link="a"/><child link="b"/></joint>'
    )
    assert [shape.geometry for shape in robot.links["a"].visuals] == [Box((1, 2, 3))]
    assert robot.links["a"].collisions == ()
    assert len(robot.links["b"].collisions) == 1
    assert "the 1 visual and 1 collision after it" in robot.problems[0].message


def test_a_capsule_is_drawn_although_ros_does_not_know_it():
    robot = load(visual('<capsule radius="0.5" length="2"/>'))
    assert robot.links["a"].visuals[0].geometry == Capsule(0.5, 2)


def test_unknown_elements_and_a_namespace_are_accepted_without_a_warning():
    robot = load(
        link("<sensor/>") + "<gazebo/><transmission/><ros2_control/><foo/>",
        'name="r" xmlns="http://www.ros.org"',
    )
    assert robot.problems == ()


def test_a_broken_axis_on_a_fixed_joint_is_ignored():
    assert load(joint('<axis xyz="x"/>', 'type="fixed"')).problems == ()


def test_an_axis_is_normalised():
    axis = load(joint('<axis xyz="0 3 4"/>')).joints["j"].axis
    assert axis == pytest.approx((0, 0.6, 0.8))


def test_another_root_element_is_named():
    with pytest.raises(RobotError, match=r"a Gazebo model \(<model> on line 1\)"):
        load_robot('<model name="m"/>')
    robot = load_robot(f'<urdf><robot name="r">{link("")}</robot></urdf>')
    assert codes(robot.problems) == ["robot-not-root"]


# --- the tree -----------------------------------------------------------------


def edge(name: str, parent: str, child: str) -> str:
    return (
        f'<joint name="{name}" type="fixed"><parent link="{parent}"/>'
        f'<child link="{child}"/></joint>'
    )


def links(names: str) -> str:
    return "".join(f'<link name="{name}"/>' for name in names)


def test_a_ring_beside_the_root_is_left_out_with_an_error():
    robot = load(links("wab") + edge("j", "a", "b") + edge("k", "b", "a"))
    assert (robot.root, list(robot.links), dict(robot.joints)) == ("w", ["w"], {})
    assert "a → b → a" in robot.problems[0].message


def test_a_ring_without_a_root_is_refused():
    found = refused(links("ab") + edge("j", "a", "b") + edge("k", "b", "a"))
    assert codes(found) == ["joint-ring"]


def test_of_two_parents_the_joint_that_sorts_last_wins():
    robot = load(
        links("abc") + edge("k", "a", "b") + edge("z", "a", "c") + edge("j", "b", "c")
    )
    assert robot.joints.keys() == {"k", "z"}
    assert codes(robot.problems) == ["link-two-parents"]


def test_a_joint_to_itself_leaves_its_link_out():
    robot = load(links("ab") + edge("j", "a", "a"))
    assert (robot.root, list(robot.links)) == ("b", ["b"])
    assert codes(robot.problems) == ["joint-to-itself"]


def test_of_two_joints_to_themselves_no_other_link_is_guessed():
    robot = load(links("abc") + edge("j", "a", "a") + edge("k", "a", "a"))
    assert codes(robot.problems) == ["joint-to-itself", "joint-to-itself"]
    assert not any(problem.edits for problem in robot.problems)


def test_a_ring_of_one_link_is_refused_without_an_endless_loop():
    assert codes(refused(links("a") + edge("j", "a", "a"))) == ["joint-to-itself"]


def test_the_cause_is_reported_without_its_consequences():
    text = links("abc") + edge("j", "a", "b")
    typo = edge("k", "b", "cc")
    unread = edge("k", "b", "c").replace("fixed", "hinge")
    assert codes(refused(text + typo)) == ["joint-child-unknown"]
    assert codes(refused(text + unread)) == ["joint-type-unknown"]


def test_part_of_a_robot_is_drawn_with_an_empty_parent_link():
    robot = load(links("b") + edge("j", "base", "b"))
    assert (robot.root, list(robot.links)) == ("base", ["base", "b"])
    assert codes(robot.problems) == ["joint-parent-elsewhere"]


# --- materials ----------------------------------------------------------------

RED = '<color rgba="1 0 0 1"/>'
GREEN = '<color rgba="0 1 0 1"/>'


def material(name: str, inside: str = "") -> str:
    return f'<material name="{name}">{inside}</material>'


def shown(*materials: str, before: str = "", after: str = "") -> Robot:
    """A link with one visual for each material text, and one collision."""
    visuals = "".join(f"<visual>{BOX}{m}</visual>" for m in materials)
    body = f"<collision>{BOX}</collision>"
    return load(f'{before}<link name="a">{visuals}{body}</link>{after}')


def colours(robot: Robot, name: str = "a") -> list[object]:
    materials = [shape.material for shape in robot.links[name].visuals]
    return [m.rgba if m is not None else None for m in materials]


def test_a_global_material_overrides_an_inline_one_in_any_order():
    robot = shown(material("m", RED), after=material("m", GREEN))
    assert colours(robot) == [(0, 1, 0, 1)]
    assert codes(robot.problems) == ["material-redefined"]


def test_an_inline_material_is_known_after_its_definition():
    robot = shown(
        material("m"),
        material("m", RED),
        material("m", GREEN),
        material("m"),
    )
    red = (1, 0, 0, 1)
    assert colours(robot) == [None, red, red, red]
    assert codes(robot.problems) == ["material-undefined", "material-redefined"]


def test_a_visual_without_a_material_takes_the_last_one_of_its_link():
    robot = shown("", material("m", RED), "", material("n", GREEN))
    red, green = (1, 0, 0, 1), (0, 1, 0, 1)
    assert colours(robot) == [None, red, red, green]
    assert robot.links["a"].collisions[0].material == Material("n", green)


def test_an_empty_name_colours_this_visual_only():
    assert colours(shown(material("", RED))) == [(1, 0, 0, 1)]


@pytest.mark.parametrize(
    ("color", "code", "rgba"),
    [
        ('<color rgba="1 0 0"/>', "color-count", (0, 0, 0, 1)),
        ('<color rgba="1 0 0 1 1"/>', "color-count", (0, 0, 0, 1)),
        ('<color rgba="255 128 0 255"/>', "color-range", None),
        ('<color rgba="red"/>', "color-malformed", None),
        ('<color rgba="1,0,0,1"/>', "color-malformed", None),
        ('<color r="1"/>', "color-without-rgba", None),
    ],
)
def test_a_wrong_colour_is_read_as_ros_reads_it(color: str, code: str, rgba: object):
    robot = shown(material("m", color))
    assert colours(robot) == [rgba]
    assert codes(robot.problems) == [code]


@pytest.mark.parametrize(
    ("rgba", "better"),
    [
        ("255 128 0 255", "1 0.502 0 1"),
        ("0 100 50 100", "0 1 0.5 1"),
        ("0.8 10 0 1", "0.8 1 0 1"),
        ("-0.5 0 0 1", "0.5 0 0 1"),
        ("50 20 0 1", None),
        ("500 20 0 1", None),
    ],
)
def test_a_colour_is_scaled_only_from_a_range_that_is_certain(
    rgba: str, better: str | None
):
    (problem,) = shown(material("m", f'<color rgba="{rgba}"/>')).problems
    written = f'rgba="{better}"' if better else "four numbers from 0 to 1"
    assert problem.hint == f"write {written}"


@pytest.mark.parametrize(
    ("kind", "limit", "ends"),
    [
        ("revolute", "", 'lower="-1.57" upper="1.57"'),
        # Metres: a gripper does not open by three of them.
        ("prismatic", "", 'lower="0" upper="0.1"'),
        ("prismatic", '<limit effort="1" velocity="1"/>', 'lower="0" upper="0.1"'),
        ("prismatic", '<limit lower="0.5" effort="1" velocity="1"/>', 'upper="0.6"'),
        ("revolute", '<limit effort="1" velocity="1"/>', 'lower="-1.57" upper="1.57"'),
    ],
)
def test_limits_that_are_missing_are_advised_in_the_size_of_the_joint(
    kind: str, limit: str, ends: str
) -> None:
    text = joint(limit, f'type="{kind}"')
    found = load(text).problems if limit else refused(text)
    assert any(ends in problem.hint for problem in found)


def test_a_global_material_without_colour_is_black():
    robot = shown(material("m"), before=material("m"))
    assert colours(robot) == [(0, 0, 0, 1)]
    assert codes(robot.problems) == ["material-without-colour"]


def test_a_material_with_only_a_texture_has_no_colour():
    robot = shown(material("m", '<texture filename="t.png"/>'))
    found = robot.links["a"].visuals[0].material
    assert found == Material("m", None, "t.png")
    assert codes(robot.problems) == ["texture-not-found"]


@pytest.mark.parametrize(
    ("inside", "instead"),
    [
        (edge("k", "b", "c") + edge("m", "c", "z"), ""),
        (edge("k", "z", "c"), "parent"),  # a and z would be roots
        (edge("k", "b", "z"), "child"),  # a and c would be
        (edge("k", "b", "z") + edge("m", "z", "c"), ""),
    ],
    ids=["child", "parent", "misspelt child", "in the middle"],
)
def test_a_missing_link_is_to_be_added_only_where_this_helps(inside: str, instead: str):
    text = links("abc") + edge("j", "a", "b") + inside
    hints = {problem.hint for problem in refused(text)}

    assert hints == (
        {'correct the name, or add <link name="z"/>'}
        if not instead
        else {f"name a link of this robot as the {instead}"}
    )
    if not instead:
        assert len(load(text + links("z")).links) == 4


@pytest.mark.parametrize(
    ("text", "better"),
    [
        ("0.1, 0, 0.3", "0.1 0 0.3"),
        ("0.1,0,0.3", "0.1 0 0.3"),
        ("1,2,3", "1 2 3"),
        ("0 0 0,3", "0 0 0.3"),
        ("0,1 0,2 0,3", "0.1 0.2 0.3"),
        ("0,1; 0,2; -0,3", "0.1 0.2 -0.3"),
        ("0,1, 0,2, 0,3", "0.1 0.2 0.3"),
        ("0,1,2,3", None),
    ],
)
def test_commas_are_read_as_the_number_of_numbers_needs(text: str, better: str | None):
    problems = refused(joint(f'<origin xyz="{text}"/>'))

    if better is None:
        assert problems[0].hint == "give three numbers with blanks between them"
        return
    assert problems[0].hint == f'write "{better}"'
    assert load(joint(f'<origin xyz="{better}"/>')).problems == ()


@pytest.mark.parametrize(
    ("rgba", "better"),
    [
        ("1,0,0", "1 0 0 1"),
        ("1, 0, 0, 1", "1 0 0 1"),
        ("0,5 0,5 0,5 1", "0.5 0.5 0.5 1"),
    ],
)
def test_a_colour_with_commas_gets_four_numbers(rgba: str, better: str):
    def painted(value: str) -> Robot:
        material = f'<material name="m"><color rgba="{value}"/></material>'
        return load(visual("<box size='1 1 1'/>", material))

    assert painted(rgba).problems[0].hint == f'write rgba="{better}"'
    assert painted(better).problems == ()


@pytest.mark.parametrize(
    ("ends", "added"),
    [
        ("", 'lower="-1.57" upper="1.57"'),
        ('lower="-1"', 'upper="1.57"'),
        ('lower="4"', 'upper="5"'),
        ('upper="-3"', 'lower="-4"'),
    ],
)
def test_the_ends_that_a_range_lacks_fit_the_one_that_it_has(ends: str, added: str):
    def limited(more: str) -> Robot:
        limit = f'<limit {more} effort="1" velocity="1"/>'
        return load(joint(limit, 'type="revolute"'))

    (problem,) = limited(ends).problems
    assert problem.severity == "warning"
    assert "joint_state_publisher leaves the joint out" in problem.message
    assert problem.hint == f"add {added}"
    assert limited(f"{ends} {added}").problems == ()


def test_a_forgotten_dollar_is_named():
    problems = load(visual('<box size="{length} 1 2"/>')).problems

    assert problems[0].hint == 'write "${length} 1 2"'


CHAIN = """<link name="base"/><link name="arm_link"/><link name="hand"/>
<joint name="j1" type="fixed"><parent link="base"/><child link="arm_link"/></joint>
<joint name="j2" type="fixed"><parent link="arm_link"/><child link="hand"/></joint>
"""


@pytest.mark.parametrize(
    ("right", "wrong", "code"),
    [
        (
            '<parent link="arm_link"/>',
            '<parent link="arm_lnk"/>',
            "joint-parent-unknown",
        ),
        ('<child link="arm_link"/>', '<child link="armlink"/>', "joint-child-unknown"),
        ('<child link="hand"/>', '<child link="hand "/>', "joint-child-unknown"),
        ('<link name="hand"/>', '<link name="hand "/>', "link-name-blank"),
        ('<link name="hand"/>', '<link name=" hand"/>', "link-name-blank"),
        ('<link name="hand"/>', '<link name="base"/>', "link-duplicate"),
        ('<link name="hand"/>', "<link/>", "link-without-name"),
        ('type="fixed"', 'type="fixd"', "joint-type-unknown"),
    ],
)
def test_the_advice_for_a_wrong_name_is_the_right_one_and_the_only_problem(
    right: str, wrong: str, code: str
):
    assert load(CHAIN).problems == ()

    (problem,) = refused(CHAIN.replace(right, wrong, 1))

    words = right.split()[-1].strip("/>")
    assert problem.code == code
    assert (
        problem.hint.removeprefix("write <link ")
        .removeprefix("write ")
        .startswith(words)
    )


@pytest.mark.parametrize("gone", ['type="fixed"', '<parent link="base"/>'])
def test_a_link_without_its_joint_is_not_called_another_root(gone: str):
    text = CHAIN.replace(gone, "", 1)

    assert len(refused(text)) == 1


def test_a_link_that_is_not_connected_gets_the_joint_that_does_it():
    text = CHAIN.replace('<link name="hand"/>', '<link name="hand"/><link name="cup"/>')

    (problem,) = refused(text)

    _, _, written = problem.hint.partition(": ")
    assert load(f"{text}{written}").problems == ()


def test_links_that_one_macro_call_repeats_are_one_problem(tmp_path: Path):
    model = tmp_path / "r.xacro"
    model.write_text(
        '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">\n'
        '<xacro:macro name="part" params="name">\n<link name="${name}"/>\n'
        '<joint name="${name}_joint" type="fixed"><parent link="base"/>\n'
        '<child link="${name}"/></joint>\n</xacro:macro>\n<link name="base"/>\n'
        '<xacro:part name="left"/>\n<xacro:part name="left"/>\n</robot>\n'
    )
    with pytest.raises(RobotError) as caught:
        load_robot(model)

    (problem,) = caught.value.problems
    assert problem.code == "link-duplicate"
    assert problem.hint == "give the macro call on line 9 another name"


@pytest.mark.parametrize(
    "inertial",
    [
        '<mass>15</mass><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/>',
        "<mass><value>15</value></mass>"
        '<inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/>',
    ],
)
def test_a_value_as_text_is_written_as_an_attribute(inertial: str):
    (problem,) = load(link(f"<inertial>{inertial}</inertial>")).problems

    assert problem.hint == 'write <mass value="15"/>'


def test_the_material_that_was_meant_comes_first():
    materials = '<material name="blue"><color rgba="0 0 1 1"/></material>'
    text = materials + visual("<box size='1 1 1'/>", '<material name="bleu"/>')

    (problem,) = load(text).problems

    assert problem.hint.startswith('write <material name="blue"/>, or ')
