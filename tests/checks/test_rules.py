from __future__ import annotations

import struct
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from sambot_viz.checks import check, check_robot
from sambot_viz.checks.model.mesh_files import MeshFiles
from sambot_viz.errors import Problem
from sambot_viz.geometry import rotation_from_rpy
from sambot_viz.robot.model import load_robot

Checked = Callable[..., list[Problem]]

TWO_LINKS = '<link name="a"/>\n<link name="b"/>\n'


@pytest.fixture
def checked(tmp_path: Path) -> Checked:
    """Checks a robot with these lines after <robot …>; returns one code or all."""

    def run(body: str, code: str = "", name: str = "r.urdf") -> list[Problem]:
        file = tmp_path / name
        xmlns = ' xmlns:xacro="http://www.ros.org/wiki/xacro"'
        head = f'<robot name="r"{xmlns if name.endswith("xacro") else ""}>'
        file.write_text(f"{head}\n{body}\n</robot>\n")
        found = check(file)
        wrong = [p for p in found if p.severity == "error" and p.file == str(file)]
        assert not code or not wrong, wrong
        return [p for p in found if p.code == code] if code else found

    return run


def joint(inner: str, kind: str = "revolute") -> str:
    return (
        f'{TWO_LINKS}<joint name="j" type="{kind}">\n<parent link="a"/>\n'
        f'<child link="b"/>\n{inner}\n</joint>'
    )


def limit(lower: str, upper: str) -> str:
    return f'<limit lower="{lower}" upper="{upper}" effort="1" velocity="1"/>'


def visual(inner: str) -> str:
    return f'<link name="a">\n<visual>\n{inner}\n</visual>\n</link>'


@pytest.mark.parametrize(
    ("lower", "upper", "degrees"),
    [
        ("-90", "90", True),
        ("0", "45", True),
        ("-180", "22.5", True),
        ("-1.57", "1.57", False),
        ("-6.2832", "6.2832", False),
        ("-12.566", "12.566", False),
        ("-10", "10", False),
        ("-1e16", "1e16", False),
        ("-10000", "10000", False),
        ("0", "0", False),
    ],
)
def test_limits_look_like_degrees_only_when_round_and_beyond_a_turn(
    checked: Checked, lower: str, upper: str, degrees: bool
) -> None:
    assert bool(checked(joint(limit(lower, upper)), "limit-in-degrees")) is degrees


def test_a_prismatic_joint_may_have_large_limits(checked: Checked) -> None:
    body = joint(limit("-90", "90"), "prismatic")

    assert checked(body, "limit-in-degrees") == []


@pytest.mark.parametrize(
    ("rpy", "degrees"),
    [
        ("90 0 0", True),
        ("0 -45 180", True),
        ("1.5708 0 3.14159", False),
        ("7.854 0 0", False),
        ("0 0 6.2832", False),
        ("1 2 3", False),
    ],
)
def test_rpy_looks_like_degrees_only_when_round_and_beyond_a_turn(
    checked: Checked, rpy: str, degrees: bool
) -> None:
    body = joint(f'<origin rpy="{rpy}"/>', "fixed")

    assert bool(checked(body, "rpy-in-degrees")) is degrees


def test_the_rpy_of_an_inertia_is_pointed_at(checked: Checked) -> None:
    body = (
        '<link name="a">\n<inertial>\n<origin rpy="0 0 90"/>\n<mass value="1"/>\n'
        '<inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/>\n</inertial>'
        "\n</link>"
    )

    (problem,) = checked(body, "rpy-in-degrees")
    assert problem.line == 4


WHEEL = """
<link name="base_link"/>
<link name="base_footprint"/>
<link name="wheel"><visual><origin rpy="1.5708 0 0"/>
<geometry><cylinder radius="0.1" length="0.02"/></geometry></visual></link>
<joint name="f" type="fixed"><parent link="base_link"/><child link="base_footprint"/>
<origin xyz="0 0 {foot}"/></joint>
<joint name="w" type="continuous"><parent link="base_link"/><child link="wheel"/>
<origin xyz="0 0.2 {wheel}"/><axis xyz="0 1 0"/></joint>
"""


@pytest.mark.parametrize(
    ("foot", "wheel", "said"),
    [
        ("-0.15", "-0.05", ""),
        ("-0.15", "-0.052", ""),
        ("-0.15", "-0.042", ""),
        ("-0.15", "0", "0.05 m above"),
        ("-0.1", "-0.05", "0.05 m below"),
    ],
)
def test_a_wheel_has_to_touch_the_ground_of_base_footprint(
    checked: Checked, foot: str, wheel: str, said: str
) -> None:
    found = checked(WHEEL.format(foot=foot, wheel=wheel), "wheel-not-on-ground")

    assert [said in p.message for p in found] == ([True] if said else [])


def test_all_wheels_off_the_ground_are_one_warning(checked: Checked) -> None:
    second = (
        '<link name="wheel2"><visual><geometry><sphere radius="0.1"/></geometry>'
        '</visual></link><joint name="w2" type="continuous"><parent link="base_link"/>'
        '<child link="wheel2"/><origin xyz="0 -0.2 0"/><axis xyz="0 1 0"/></joint>'
    )
    body = WHEEL.format(foot="-0.15", wheel="0.02") + second

    (problem,) = checked(body, "wheel-not-on-ground")
    assert problem.message.startswith("the wheels wheel and wheel2 end 0.07 m above")


def test_a_turning_laser_is_not_a_wheel(checked: Checked) -> None:
    body = WHEEL.format(foot="-0.15", wheel="0.5").replace('"0 1 0"', '"0 0 1"')

    assert checked(body, "wheel-not-on-ground") == []


DISC = (
    '<link name="a"/><link name="b"><visual><origin xyz="0 0 0.1" rpy="{rpy}"/>'
    '<geometry><cylinder radius="0.1" length="{length}"/></geometry></visual></link>'
    '<joint name="j" type="continuous"><parent link="a"/><child link="b"/>'
    '<axis xyz="{axis}"/></joint>'
)


@pytest.mark.parametrize(
    ("rpy", "axis", "advice"),
    [
        ("0 0 0", "0 1 0", 'lay it down: <origin xyz="0 0 0.1" rpy="1.5708 0 0"/>'),
        ("0 0 0", "-2 0 0", 'lay it down: <origin xyz="0 0 0.1" rpy="0 1.5708 0"/>'),
        ("0 0 0", "0.6 0.8 0", "turn the shape so that its z axis is along the axle"),
        ("1.5708 0 0", "1 0 0", 'write <axis xyz="0 1 0"/>'),
    ],
)
def test_a_wheel_across_its_axle_turns_end_over_end(
    checked: Checked, rpy: str, axis: str, advice: str
) -> None:
    body = DISC.format(rpy=rpy, axis=axis, length="0.04")
    (problem,) = checked(body, "wheel-across-axle")
    assert problem.message.startswith("the wheel b turns end over end: joint j turns")
    assert advice in problem.hint


WHEEL_OF_SEVERAL = (
    '<link name="w{n}"><visual><origin rpy="{rpy}"/>'
    '<geometry><cylinder radius="0.1" length="0.04"/></geometry></visual></link>'
    '<joint name="j{n}" type="continuous"><parent link="a"/><child link="w{n}"/>'
    '<origin xyz="{xyz}"/><axis xyz="{axis}"/></joint>'
)
BESIDE = ["0 0.2 0", "0 -0.2 0"]
IN_FRONT = [f"0.3 {xyz[2:]}" for xyz in BESIDE]
LAID, TURNED = 'rpy="1.5708 0 0"', '<axis xyz="0 1 0"/>'


@pytest.mark.parametrize("places", [BESIDE, BESIDE + IN_FRONT])
@pytest.mark.parametrize(
    ("rpy", "axis", "advice"),
    [
        # The places of the wheels say what is wrong: the shapes, the axes, or both.
        ("0 1.5708 0", "0 1 0", [LAID]),
        ("0 0 0", "0 1 0", [LAID]),
        ("1.5708 0 0", "1 0 0", [TURNED]),
        ("0 0 0", "1 0 0", [LAID, TURNED]),
    ],
)
def test_an_axle_goes_through_two_wheels(
    checked: Checked, places: list[str], rpy: str, axis: str, advice: list[str]
) -> None:
    body = '<link name="a"/>' + "".join(
        WHEEL_OF_SEVERAL.format(n=n, rpy=rpy, axis=axis, xyz=xyz)
        for n, xyz in enumerate(places)
    )

    (problem,) = checked(body, "wheel-across-axle")

    assert [text for text in (LAID, TURNED) if text in problem.hint] == advice
    body = body.replace(f'rpy="{rpy}"', LAID if LAID in advice else f'rpy="{rpy}"')
    right = body.replace(f'<axis xyz="{axis}"/>', TURNED)
    assert checked(right, "wheel-across-axle") == []


@pytest.mark.parametrize(
    ("rpy", "axis", "length"),
    [
        ("1.5708 0 0", "0 1 0", "0.04"),
        # What swivels about z, and a long roller that is turned about its middle.
        ("1.5708 0 0", "0 0 1", "0.04"),
        ("0 0 0", "0 1 0", "0.4"),
    ],
)
def test_what_turns_about_its_middle_line_and_what_is_no_wheel_are_right(
    checked: Checked, rpy: str, axis: str, length: str
) -> None:
    body = DISC.format(rpy=rpy, axis=axis, length=length)
    assert checked(body, "wheel-across-axle") == []


@pytest.mark.parametrize(
    ("name", "axis"),
    [("left_wheel", "0 1 0"), ("caster_wheel", None), ("disc", None)],
)
def test_only_a_wheel_that_does_not_swivel_is_told_to_lie_across_an_upright_axle(
    checked: Checked, name: str, axis: str | None
) -> None:
    body = DISC.format(rpy="1.5708 0 0", axis="0 0 1", length="0.04")

    problems = checked(body.replace('"b"', f'"{name}"'), "wheel-across-axle")

    advice = [] if axis is None else [f'write <axis xyz="{axis}"/>']
    assert [problem.hint for problem in problems] == advice


def test_names_that_differ_in_case_name_both(checked: Checked) -> None:
    body = joint("", "fixed").replace('"b"', '"A"')

    (problem,) = checked(body, "names-differ-in-case")
    assert problem.message.startswith("the link names a (line 2) and A differ")
    assert problem.line == 3


MACRO = '<xacro:macro name="m" params="n">\n<link name="${n}"/>\n</xacro:macro>\n'


@pytest.mark.parametrize(
    "call",
    [
        '<xacro:m n="a"/>',
        '<xacro:call macro="m" n="a"/>',
        '<xacro:property name="x" value="m"/><xacro:call macro="${x}" n="a"/>',
    ],
)
def test_a_macro_that_is_called_somehow_is_not_unused(
    checked: Checked, call: str
) -> None:
    assert checked(MACRO + call, "unused-macro", "r.xacro") == []


def test_a_macro_of_an_included_library_may_stay_unused(
    checked: Checked, tmp_path: Path
) -> None:
    (tmp_path / "lib.xacro").write_text(
        f'<robot xmlns:xacro="http://www.ros.org/wiki/xacro">{MACRO}</robot>'
    )

    assert (
        checked(
            '<xacro:include filename="lib.xacro"/>\n<link name="a"/>',
            "unused-macro",
            "r.xacro",
        )
        == []
    )


BARE = 'Node(parameters=[{"robot_description": Command(["xacro ", "r.urdf"])}])\n'
BY_NAME = """\
text = Command(["xacro ", "r.urdf"])
Node(parameters=[{"robot_description": text}])
"""
WRAPPED = BARE.replace("Command(", "ParameterValue(Command(").replace(
    "])}", "]), value_type=str)}"
)


@pytest.fixture
def launched(checked: Checked, tmp_path: Path) -> Checked:
    """Checks a robot of a package with a launch file with this text."""

    def run(body: str, launch: str, name: str = "urdf/r.urdf") -> list[Problem]:
        (tmp_path / "package.xml").write_text("<package><name>p</name></package>")
        for folder in ("urdf", "launch"):
            (tmp_path / folder).mkdir(exist_ok=True)
        (tmp_path / "launch/display.launch.py").write_text(launch)
        return checked(body, "launch-text-as-yaml", name)

    return run


TODO = '<link name="a"/>\n<!-- fine:yes#2 -->\n<!-- TODO: b -->\n<!-- c #1 -->'


@pytest.mark.parametrize("launch", [BARE, BY_NAME])
def test_a_bare_command_makes_text_that_yaml_cannot_read_a_warning(
    launched: Checked, launch: str
) -> None:
    (problem,) = launched(TODO, launch)

    assert problem.line == 4
    assert "display.launch.py line 1" in problem.message
    assert "“TODO: b”" in problem.message
    assert "ParameterValue(Command([…]), value_type=str)" in problem.hint


@pytest.mark.parametrize(
    ("named", "reported"),
    [("r.urdf", 1), ("r.urdf.xacro", 0), ("other.urdf", 0), ("$(arg model)", 1)],
)
def test_only_the_model_that_the_command_names_is_reported(
    launched: Checked, named: str, reported: int
) -> None:
    assert len(launched(TODO, BARE.replace("r.urdf", named))) == reported


@pytest.mark.parametrize("launch", ["", WRAPPED, "no Python at all ("])
def test_without_a_bare_command_no_text_stops_a_launch(
    launched: Checked, launch: str
) -> None:
    assert launched(TODO, launch) == []


@pytest.mark.parametrize(
    "body", ['<link name="a"/>', '\t<link name="a"/>', '<!-- a:b --><link name="a"/>']
)
def test_text_that_yaml_reads_as_text_stops_no_launch(
    launched: Checked, body: str
) -> None:
    assert launched(body, BARE) == []


@pytest.mark.parametrize(
    "body",
    [
        '<!-- A: gone with the macro -->\n<xacro:m n="a"/>',
        '<xacro:m n="a"/>\n<xacro:if value="false"><!-- A: gone --></xacro:if>',
        "<xacro:m n=\"${'a: b'[0]}\"/>",
    ],
)
def test_text_that_xacro_removes_stops_no_launch(launched: Checked, body: str) -> None:
    launch = BARE.replace("r.urdf", "r.xacro")
    assert launched(MACRO + body, launch, "urdf/r.xacro") == []


def test_many_comments_are_searched_in_one_pass(launched: Checked) -> None:
    body = "<!-- x -->\n" * 100_000 + '<link name="a"/>'

    assert launched(body, "") == []


def test_the_inertia_of_a_real_body_is_accepted(checked: Checked) -> None:
    body = joint("", "fixed").replace(
        '<link name="b"/>',
        '<link name="b"><inertial><mass value="1"/><inertia ixx="0.02" ixy="0" ixz="0" '
        'iyy="0.01" iyz="0" izz="0.01"/></inertial></link>',
    )

    assert checked(body) == []


@pytest.mark.parametrize(
    ("masses", "wrong"),
    [
        ((15, 0.125), []),
        ((15, 125), ["lidar"]),
        ((15_000, 125), ["base", "lidar"]),
        # A small shape may stand for a large part.
        ((150, 20), []),
    ],
)
def test_a_mass_in_grams_is_more_than_metal_and_than_all_others(
    checked: Checked, masses: tuple[float, float], wrong: list[str]
) -> None:
    links = "".join(
        f'<link name="{name}"><visual><geometry><box size="{size}"/></geometry>'
        f'</visual><inertial><mass value="{mass}"/><inertia ixx="9" iyy="9" izz="9" '
        'ixy="0" ixz="0" iyz="0"/></inertial></link>'
        for name, size, mass in zip(
            ("base", "lidar"), ("0.4 0.3 0.2", "0.05 0.05 0.05"), masses, strict=True
        )
    )
    joint = '<joint name="j" type="fixed"><parent link="base"/><child link="lidar"/>'

    found = checked(f"{links}{joint}</joint>", "mass-in-grams")

    assert [p.message.split()[1] for p in found] == wrong


@pytest.mark.parametrize(
    ("mass", "inertia", "said"),
    [
        ("-1", (1, 0, 0, 1, 0, 1), "mass -1 is negative"),
        ("1", (-1, 0, 0, 1, 0, 1), "negative"),
        ("1", (1, 5, 0, 1, 0, 1), 'ixy="5" is too large for ixx="1" iyy="1" izz="1"'),
        ("1", (2, 0.9, 0, 2, 0.9, 1), 'ixy="0.9" iyz="0.9" are too large for ixx="2"'),
        ("1", (5, 0, 0, 1, 0, 1), "link b: one principal moment of inertia is larger"),
        # Without its products it is as impossible.
        ("1", (5, 0.1, 0, 1, 0, 1), "link b: one principal moment of inertia is"),
    ],
)
def test_an_impossible_inertia_is_reported_with_the_reason(
    checked: Checked, mass: str, inertia: tuple[float, ...], said: str
) -> None:
    names = ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")
    values = " ".join(f'{n}="{v}"' for n, v in zip(names, inertia, strict=True))
    body = joint("", "fixed").replace(
        '<link name="b"/>',
        f'<link name="b"><inertial><mass value="{mass}"/><inertia {values}/>'
        "</inertial></link>",
    )

    (problem,) = checked(body, "inertia-impossible")
    assert said in problem.message


def stl(*corners: tuple[float, float, float]) -> bytes:
    triangle = struct.pack("<12fH", 0, 0, 1, *(x for c in corners for x in c), 0)
    return bytes(80) + struct.pack("<I", 1) + triangle


BROKEN = {
    "cut.stl": bytes(80) + struct.pack("<I", 10) + bytes(100),
    "text.dae": b"not XML",
    "bad.glb": b"glTF" + bytes(30),
    "empty.obj": b"",
}


@pytest.mark.parametrize("name", BROKEN)
def test_a_mesh_file_that_cannot_be_read_is_an_error(
    checked: Checked, tmp_path: Path, name: str
) -> None:
    (tmp_path / name).write_bytes(BROKEN[name])

    (problem,) = checked(visual(f'<geometry><mesh filename="{name}"/></geometry>'))

    assert problem.severity == "error"
    assert problem.code in ("mesh-broken", "mesh-empty")
    assert problem.message.startswith(f"link a: the mesh {name}: ")
    assert problem.line == 4
    assert problem.hint


def test_a_git_lfs_pointer_is_a_warning(checked: Checked, tmp_path: Path) -> None:
    (tmp_path / "0.stl").write_text("version https://git-lfs.github.com/spec/v1\n")

    (problem,) = checked(visual('<geometry><mesh filename="0.stl"/></geometry>'))

    assert (problem.severity, problem.code) == ("warning", "mesh-lfs-pointer")


def test_meshes_that_take_too_long_are_named_and_not_read(tmp_path: Path) -> None:
    (tmp_path / "p.stl").write_bytes(b"broken")
    file = tmp_path / "r.urdf"
    body = visual('<geometry><mesh filename="p.stl"/></geometry>')
    file.write_text(f'<robot name="r">{body}</robot>')

    (problem,) = check_robot(load_robot(file), mesh=MeshFiles(longest=-1))

    assert (problem.severity, problem.code) == ("info", "mesh-not-checked")
    assert "p.stl" in problem.message


def test_a_ground_plane_may_be_large(checked: Checked, tmp_path: Path) -> None:
    (tmp_path / "p.obj").write_text("v 0 0 0\nv 30 0 0\nv 0 30 0\nf 1 2 3\n")

    assert checked(visual('<geometry><mesh filename="p.obj"/></geometry>')) == []


def test_a_mesh_in_millimetres_gets_the_scale_it_needs(
    checked: Checked, tmp_path: Path
) -> None:
    (tmp_path / "p.stl").write_bytes(stl((0, 0, 0), (200, 0, 0), (0, 30, 4)))
    body = visual('<geometry><mesh filename="p.stl"{}/></geometry>')

    (problem,) = checked(body.format(""), "mesh-size")
    assert problem.hint.startswith('write scale="0.001 0.001 0.001"')
    assert checked(body.format(' scale="0.001 0.001 0.001"'), "mesh-size") == []


def test_a_robot_that_is_loaded_can_be_checked_without_reading_it_again(
    tmp_path: Path,
) -> None:
    file = tmp_path / "r.urdf"
    file.write_text(f'<robot name="r">\n{joint(limit("-90", "90"))}\n</robot>\n')

    robot = load_robot(file)

    assert check_robot(robot, file) == check(file)


def test_errors_come_first_then_warnings_then_notes(checked: Checked) -> None:
    body = joint(f'{limit("-90", "90")}\n<axis xyz="0 0 0"/>').replace('"b"', '"b b"')

    severities = [p.severity for p in checked(body)]

    assert severities == ["error", "warning", "info", "info"] or severities == [
        "error",
        "warning",
        "info",
    ]


def test_a_missing_model_is_a_problem_and_not_an_exception(
    tmp_path: Path,
) -> None:
    (problem,) = check(tmp_path / "nothing.urdf")

    assert problem.severity == "error"


def test_a_property_left_by_an_old_xacro_is_harmless(checked: Checked) -> None:
    body = '<property name="left_over" value="1"/>\n<link name="a"/>'

    assert checked(body) == []


def test_an_include_without_its_prefix_is_a_warning(checked: Checked) -> None:
    (problem,) = checked('<include filename="b.xacro"/>\n<link name="a"/>')

    assert problem.code == "xacro-prefix-missing"


@pytest.mark.parametrize(
    ("shape", "better"),
    [
        ('<box size="420 310 180"/>', "0.42 0.31 0.18"),
        ('<cylinder radius="350" length="200"/>', "0.35 0.2"),
        ('<sphere radius="300"/>', "0.3"),
        ('<sphere radius="30"/>', "0.3"),
        ('<box size="100 100 0.1"/>', None),
        ('<box size="30 0.2 3"/>', None),
        ('<box size="2 2 2"/>', None),
    ],
)
def test_shapes_in_another_unit_are_as_large_as_a_house(
    checked: Checked, shape: str, better: str | None
) -> None:
    found = checked(visual(f"<geometry>{shape}</geometry>"), "shape-size")

    assert [p.hint for p in found] == ([f"write metres: {better}"] if better else [])


def test_the_one_wheel_that_floats_is_to_be_moved(checked: Checked) -> None:
    def robot(height: str) -> str:
        sphere = '<visual><geometry><sphere radius="0.1"/></geometry></visual>'
        return '<link name="base_footprint"/>\n' + "\n".join(
            f'<link name="{side}">{sphere}</link>\n<joint name="{side}_joint" '
            f'type="continuous"><parent link="base_footprint"/><child link="{side}"/>'
            f'<origin xyz="0 {y} {z}"/><axis xyz="0 1 0"/></joint>'
            for side, y, z in (("left", "0.2", "0.1"), ("right", "-0.2", height))
        )

    (problem,) = checked(robot("0.15"))

    assert problem.message == (
        "the wheel right ends 0.05 m above the ground, which left touches"
    )
    assert problem.hint == (
        "lower the origin of joint right_joint by 0.05 m, or correct the radius"
    )
    assert checked(robot("0.1")) == []


def cart(weight: str = "0.1 0 0", caster: str = "-0.2 0 0", more: str = "") -> str:
    """Two wheels of radius 0.05 at x = 0, a caster, and a weight of 2 kg."""
    ball = '<geometry><sphere radius="0.05"/></geometry>'
    inertial = (
        f'<inertial><origin xyz="{weight}"/><mass value="2"/><inertia ixx="1" ixy="0" '
        'ixz="0" iyy="1" iyz="0" izz="1"/></inertial>'
    )
    links = "".join(
        f'<link name="{name}"><visual>{ball}</visual></link>'
        f'<joint name="{name}_joint" type="{kind}"><parent link="base_link"/>'
        f'<child link="{name}"/><origin xyz="{at}"/><axis xyz="0 1 0"/></joint>'
        for name, kind, at in (
            ("left", "continuous", "0 0.1 0"),
            ("right", "continuous", "0 -0.1 0"),
            ("caster", "fixed", caster),
        )
    )
    return f'<link name="base_link">{inertial}</link>{links}{more}'


BATTERY = """
<link name="battery"><collision><geometry><box size=".1 .1 .01"/></geometry></collision>
</link><joint name="battery_joint" type="fixed"><parent link="base_link"/>
<child link="battery"/><origin xyz="-0.1 0 0.1"/></joint>
"""


def test_a_weight_in_front_of_the_wheels_makes_a_robot_fall(checked: Checked) -> None:
    (problem,) = checked(cart(), "falls-over")
    assert problem.severity == "warning"
    assert "0.1 m beyond what it stands on, which is left, right and caster" in (
        problem.message
    )


def test_a_caster_in_the_air_is_named_where_the_robot_needs_it(
    checked: Checked,
) -> None:
    (problem,) = checked(cart(caster="0.2 0 0.05"), "wheel-not-on-ground")
    assert problem.severity == "warning"
    assert problem.message == (
        "the robot falls over: caster ends 0.05 m above the ground, which left and "
        "right touch, and its centre of mass is not above them"
    )
    assert problem.hint == (
        "lower the origin of joint caster_joint by 0.05 m, or correct the radius"
    )
    for height in ("0", "0.01"):
        assert checked(cart(caster=f"0.2 0 {height}"), "wheel-not-on-ground") == []


def test_a_caster_of_a_negative_size_is_not_also_in_the_air(checked: Checked) -> None:
    before, _, after = cart(caster="0.2 0 0.05").rpartition('"0.05"')
    text = f'{before}"-0.03"{after}'
    assert checked(text, "wheel-not-on-ground") == []
    assert len(checked(text, "size-not-positive")) == 1


@pytest.mark.parametrize(
    ("body", "why"),
    [
        (cart(weight="0.002 0 0", caster="0.2 0 0.05"), "it balances"),
        (cart(caster="0.2 0 0.05").replace("caster", "lamp"), "it is no caster"),
        (cart(caster="0.2 0 0.05", more=BATTERY), "a weight is missing"),
        (
            cart(
                caster="0.2 0 0.05",
                more='<link name="nose"><visual><geometry><sphere radius="0.05"/>'
                '</geometry></visual></link><joint name="n" type="fixed"><parent '
                'link="base_link"/><child link="nose"/><origin xyz="0.2 0 0.01"/>'
                "</joint>",
            ),
            "something else is near the ground",
        ),
        (
            cart(
                caster="0.2 0 0.05",
                more='<link name="world"/><joint name="w" type="fixed"><parent '
                'link="world"/><child link="base_link"/></joint>',
            ),
            "it is fixed",
        ),
    ],
)
def test_a_caster_in_the_air_may_be_right(
    checked: Checked, body: str, why: str
) -> None:
    assert checked(body, "wheel-not-on-ground") == [], why


@pytest.mark.parametrize(
    ("body", "why"),
    [
        (cart(weight="-0.05 0 0"), "it stands"),
        (cart(weight="0.002 0 0"), "it nearly stands"),
        (cart(caster="-0.2 0 0.3"), "it stands on two wheels, and balances"),
        (cart(more=BATTERY), "a weight is missing"),
        (
            cart(
                more='<link name="nose"><visual><geometry><sphere radius="0.05"/>'
                '</geometry></visual></link><joint name="n" type="fixed"><parent '
                'link="base_link"/><child link="nose"/><origin xyz="0.2 0 0.01"/>'
                "</joint>"
            ),
            "a second caster, 10 mm higher, catches it",
        ),
        (
            cart(
                more='<link name="nose"><visual><geometry><mesh filename="no.stl"/>'
                '</geometry></visual></link><joint name="n" type="fixed"><parent '
                'link="base_link"/><child link="nose"/></joint>'
            ),
            "a shape is not known",
        ),
        (
            cart(
                more='<link name="world"/><joint name="w" type="fixed"><parent '
                'link="world"/><child link="base_link"/></joint>'
            ),
            "it is fixed",
        ),
    ],
)
def test_a_robot_falls_only_where_that_is_certain(
    checked: Checked, body: str, why: str
) -> None:
    assert checked(body, "falls-over") == [], why


@pytest.mark.parametrize(
    ("moments", "wrong"),
    [
        ((1.0, 2.0, 2.99), False),
        ((1.0, 2.0, 3.04), True),
        ((2.0, 2.0, 4.0), False),
        ((1.0, 1.0, 2.03), True),
        ((0.0, 5.0, 5.0), False),
        ((-0.02, 1.0, 1.0), True),
        ((3.0, 3.0, 3.0), False),
    ],
)
@pytest.mark.parametrize("size", [1e-9, 1.0, 1e9])
@pytest.mark.parametrize("rpy", [(0, 0, 0), (0.3, 0, 0), (0.4, -1.1, 2.0)])
def test_principal_moments_are_found_however_the_body_is_turned(
    checked: Checked,
    moments: tuple[float, ...],
    wrong: bool,
    size: float,
    rpy: tuple[float, float, float],
) -> None:
    R = np.array(rotation_from_rpy(*rpy))
    tensor: list[list[float]] = (R @ np.diag(moments) @ R.T * size).tolist()
    rows = {"x": 0, "y": 1, "z": 2}
    values = " ".join(
        f'i{a}{b}="{tensor[rows[a]][rows[b]]!r}"'
        for a, b in ("xx", "xy", "xz", "yy", "yz", "zz")
    )
    body = joint("", "fixed").replace(
        '<link name="b"/>',
        f'<link name="b"><inertial><mass value="1"/><inertia {values}/>'
        "</inertial></link>",
    )
    assert bool(checked(body, "inertia-impossible")) is wrong


@pytest.mark.parametrize(
    ("shape", "formula"),
    [
        ('<cylinder radius="0.1" length="0.04"/>', "izz = m r² / 2"),
        ('<sphere radius="0.1"/>', "2 m r² / 5"),
        ('<box size="1 1 1"/>', "ixx = m (y² + z²) / 12"),
        ('<mesh filename="a.stl"/>', "ixx = m (y² + z²) / 12"),
    ],
)
def test_an_inertia_is_taken_from_the_own_shape(
    checked: Checked, shape: str, formula: str
) -> None:
    inertia = '<inertia ixx="1" ixy="0.1" ixz="0" iyy="1" iyz="0" izz="9"/>'
    body = joint("", "fixed").replace(
        '<link name="b"/>',
        f'<link name="b"><inertial><mass value="1"/>{inertia}</inertial>'
        f"<visual><geometry>{shape}</geometry></visual></link>",
    )
    (problem,) = checked(body, "inertia-impossible")
    assert formula in problem.hint


def test_links_of_one_macro_with_an_impossible_inertia_are_one_problem(
    tmp_path: Path,
) -> None:
    names = ("left", "right", "third", "fourth")
    calls = "".join(f'\n<xacro:finger name="{name}"/>' for name in names)
    path = tmp_path / "hand.urdf.xacro"
    path.write_text(
        '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">'
        '<link name="base_link"/><xacro:macro name="finger" params="name">'
        '<link name="${name}"><inertial><mass value="0.036"/><inertia ixx="2.4e-06" '
        'ixy="1e-06" ixz="1e-06" iyy="2.4e-06" iyz="1e-06" izz="7.5e-07"/></inertial>'
        '</link><joint name="${name}_joint" type="fixed"><parent link="base_link"/>'
        f'<child link="${{name}}"/></joint></xacro:macro>{calls}</robot>'
    )
    (problem,) = (p for p in check(path) if p.code == "inertia-impossible")
    assert problem.line == 1
    assert problem.message.startswith(
        "links left (line 2), right (line 3), third (line 4) and fourth (line 5): "
    )
    assert 'ixy="1e-06" ixz="1e-06" iyz="1e-06" are too large' in problem.message
    assert problem.hint.startswith("write 0 for ixy, ixz and iyz")


@pytest.mark.parametrize(
    ("caster", "depth"), [("0.2 0 -0.1", "0.1 m"), ("0.2 0 -0.03", "0.03 m")]
)
def test_a_caster_below_the_floor_of_the_wheels_is_raised(
    checked: Checked, caster: str, depth: str
) -> None:
    (problem,) = checked(cart(caster=caster), "wheel-not-on-ground")

    assert problem.severity == "warning"
    assert problem.message == (
        f"caster ends {depth} below the floor on which left and right stand: the "
        "robot is tilted"
    )
    assert [edit.text for edit in problem.edits] == ["0"]


@pytest.mark.parametrize(
    ("body", "why"),
    [
        (cart(caster="0.2 0 -0.01"), "a little lower"),
        (cart(caster="0.2 0 -0.1").replace("caster", "hook"), "it is no caster"),
    ],
)
def test_a_part_below_the_wheels_may_be_right(
    checked: Checked, body: str, why: str
) -> None:
    assert checked(body, "wheel-not-on-ground") == [], why


COPIED = """<link name="a">
<visual>
<origin rpy="1.5708 0 0"/>
<geometry>{0}</geometry>
</visual>
<collision>
{1}<geometry>{0}</geometry>
</collision>
</link>"""


@pytest.mark.parametrize(
    ("shape", "origin", "lost"),
    [
        ('<cylinder radius="0.1" length="0.3"/>', "", True),
        ('<box size="0.1 0.2 0.3"/>', "", True),
        ('<sphere radius="0.1"/>', "", False),
        ('<box size="0.1 0.2 0.3"/>', '<origin xyz="0 0 0"/>', False),
    ],
)
def test_equal_shapes_of_a_link_have_the_same_origin(
    checked: Checked, shape: str, origin: str, lost: bool
) -> None:
    found = checked(COPIED.format(shape, origin), "shape-origin-missing")

    assert [p.line for p in found] == [7] * lost
    added = [edit.text for problem in found for edit in problem.edits]
    assert added == ['\n<origin rpy="1.5708 0 0"/>'] * lost
    other = COPIED.replace("1.5708", "0.2").format(shape, origin)
    assert checked(other, "shape-origin-missing") == []


def test_a_macro_puts_the_block_into_both_shapes(checked: Checked) -> None:
    block = '<xacro:insert_block name="pose"/>'
    body = f"""<xacro:macro name="body" params="*pose">
<visual>{block}<geometry><box size="1 2 3"/></geometry></visual>
<collision><geometry><box size="1 2 3"/></geometry></collision>
</xacro:macro>
<link name="a"><xacro:body><origin rpy="1.5708 0 0"/></xacro:body></link>"""

    (problem,) = checked(body, "shape-origin-missing", "r.urdf.xacro")
    assert (problem.line, problem.hint) == (4, f"add {block} into it")
