"""What the reader says beside the robot: what ROS drops, and what it refuses."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from lower_limit import lower

from sambot_viz import Problem, Robot, RobotError, check, load_robot
from sambot_viz.drive.driven_wheels import find_wheel_pair
from sambot_viz.joints import JointState
from sambot_viz.robot.parts import Box, MeshFile

TWO = '<link name="a"/><link name="b"/>'


def sdf(content: str, version: str = "1.9", model: str = 'name="r"') -> str:
    return f'<sdf version="{version}"><model {model}>{content}</model></sdf>'


def joint(content: str = "", kind: str = "revolute", name: str = "j") -> str:
    return (
        f'<joint name="{name}" type="{kind}"><parent>a</parent><child>b</child>'
        f"{content}</joint>"
    )


def axis(lower: str, upper: str) -> str:
    limit = f"<lower>{lower}</lower><upper>{upper}</upper>"
    return f"<axis><xyz>0 1 0</xyz><limit>{limit}</limit></axis>"


def with_code(robot: Robot, code: str) -> list[Problem]:
    return [problem for problem in robot.problems if problem.code == code]


def refusal(text: str) -> list[Problem]:
    with pytest.raises(RobotError) as error:
        load_robot(text)
    return [p for p in error.value.problems if p.severity == "error"]


@pytest.mark.parametrize(
    ("kind", "lower", "upper", "expected"),
    [
        ("revolute", "-inf", "inf", (-math.pi, math.pi)),
        ("revolute", "-1e16", "1e16", (-math.pi, math.pi)),
        ("prismatic", "-inf", "inf", (-1.0, 1.0)),
        ("revolute", "-1", "inf", (-1.0, math.pi)),
        ("revolute", "4", "inf", (4.0, 4.0 + math.pi)),
        ("prismatic", "-inf", "0.5", (-1.0, 0.5)),
        ("prismatic", "-inf", "-3", (-4.0, -3.0)),
        ("revolute", "nan", "nan", (-math.pi, math.pi)),
    ],
)
def test_a_joint_without_an_end_gets_a_slider_and_one_warning(
    kind: str, lower: str, upper: str, expected: tuple[float, float]
) -> None:
    robot = load_robot(sdf(TWO + joint(axis(lower, upper), kind)))

    moved = robot.joints["j"]
    assert moved.type == kind
    assert moved.range == pytest.approx(expected)
    assert moved.range[0] <= moved.start <= moved.range[1]
    (warning,) = with_code(robot, "sdf-limit-not-finite")
    assert warning.severity == "warning"


def test_a_joint_with_limits_has_no_warning() -> None:
    robot = load_robot(sdf(TWO + joint(axis("-1", "2"))))

    assert robot.joints["j"].range == (-1.0, 2.0)
    assert robot.problems == ()


def test_the_fix_for_a_wheel_leaves_no_warning() -> None:
    robot = load_robot(sdf(TWO + joint("<axis><xyz>0 1 0</xyz></axis>", "continuous")))

    assert robot.problems == ()


def test_the_frame_of_a_link_is_at_its_joint_and_its_shapes_move_back() -> None:
    body = (
        '<pose>1 2 3 0 0 0</pose><visual name="v"><geometry><box/></geometry></visual>'
    )
    robot = load_robot(
        sdf(
            f'<link name="a"/><link name="b">{body}</link>'
            + joint("<pose>0 0 -1 0 0 0</pose>", "fixed")
        )
    )

    np.testing.assert_allclose(robot.joints["j"].origin.xyz, (1, 2, 2))
    np.testing.assert_allclose(robot.links["b"].visuals[0].origin.xyz, (0, 0, 1))


@pytest.mark.parametrize("pitch", [90.0, -90.0, 89.9999999])
def test_a_pose_that_looks_straight_up_keeps_its_rotation(pitch: float) -> None:
    pose = f'<pose degrees="true">0 0 0 30 {pitch} 40</pose>'
    visual = f'<visual name="v">{pose}<geometry><box/></geometry></visual>'
    origin = load_robot(sdf(f'<link name="a">{visual}</link>')).links["a"].visuals[0]

    # R = Rz(yaw) Ry(pitch) Rx(roll), written out by hand.
    r, p, y = (math.radians(angle) for angle in (30.0, pitch, 40.0))
    Rx = np.array(
        [[1, 0, 0], [0, math.cos(r), -math.sin(r)], [0, math.sin(r), math.cos(r)]]
    )
    Ry = np.array(
        [[math.cos(p), 0, math.sin(p)], [0, 1, 0], [-math.sin(p), 0, math.cos(p)]]
    )
    Rz = np.array(
        [[math.cos(y), -math.sin(y), 0], [math.sin(y), math.cos(y), 0], [0, 0, 1]]
    )
    np.testing.assert_allclose(origin.origin.matrix[:3, :3], Rz @ Ry @ Rx, atol=1e-9)


def test_a_nested_model_is_placed_by_a_frame_of_its_own() -> None:
    arm = (
        '<model name="arm" placement_frame="hand"><pose>0 0 1 0 0 0</pose>'
        '<link name="x"/><frame name="hand"><pose>0 0 5 0 0 0</pose></frame></model>'
    )
    link = '<link name="b"><pose relative_to="arm::x"/></link>'
    robot = load_robot(sdf(f'<link name="a"/>{arm}{link}{joint(kind="fixed")}'))

    np.testing.assert_allclose(robot.joints["j"].origin.xyz, (0, 0, -4))
    assert set(robot.links) == {"a", "b"}
    (warning,) = with_code(robot, "sdf-nested-model")
    assert "arm" in warning.message


def test_models_that_are_nested_too_deep_are_said_to_be_left_out(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    lower(monkeypatch, "NESTED_MODELS", 2)
    deepest = '<model name="d"><link name="y"/></model>'
    inner = f'<model name="c"><link name="x"/>{deepest}</model>'
    nested = f'<model name="b"><link name="x"/>{inner}</model>'
    robot = load_robot(sdf(f'<link name="a"/>{nested}'))

    said = [w.message for w in with_code(robot, "sdf-nested-model")]
    (left_out,) = (message for message in said if "not read" in message)
    assert "inside c" in left_out and "more than 2 levels" in left_out
    assert set(robot.links) == {"a"}


def test_sensors_plugins_and_lights_are_one_note_for_each_kind() -> None:
    link = (
        '<link name="a"><gravity>false</gravity>'
        '<sensor name="s" type="imu"><unknown/></sensor>'
        '<sensor name="t" type="camera"/><light name="l" type="point"/></link>'
        '<plugin filename="x" name="p"><anything size="1"/></plugin>'
        '<ros2_control name="c" type="system"/>'
    )
    robot = load_robot(sdf(link))

    assert {p.severity for p in robot.problems} == {"info"}
    said = [problem.message for problem in robot.problems]
    assert len(said) == 5
    assert "2 sensors (s, t)" in said[0]


def test_a_wrong_number_in_a_sensor_refuses_the_robot_at_its_line() -> None:
    text = sdf(
        '\n<link name="a">\n<sensor name="s" type="imu">\n'
        "<update_rate>fast</update_rate></sensor></link>"
    )
    (error,) = refusal(text)

    assert error.line == 4
    assert "sensor s of link a" in error.message


NOISE = "<noise{}><type>{}</type></noise>"
SCAN = """<scan><horizontal><samples>1</samples><min_angle>0</min_angle>
<max_angle>1</max_angle></horizontal></scan><range><min>0</min><max>1</max></range>"""


@pytest.mark.parametrize(
    ("kind", "content"),
    [
        ("gpu_lidar", f"<lidar>{SCAN}{NOISE.format('', 'gauss')}</lidar>"),
        ("ray", f"<ray>{SCAN}{NOISE.format('', 'gauss')}</ray>"),
        ("magnetometer", "<magnetometer><x><noise type='gauss'/></x></magnetometer>"),
    ],
)
def test_an_unknown_noise_of_these_sensors_is_taken_for_none(
    kind: str, content: str
) -> None:
    """libsdformat drops what it finds wrong with their noise."""
    robot = load_robot(
        sdf(f'<link name="a"><sensor name="s" type="{kind}">{content}</sensor></link>')
    )

    said, _ = robot.problems
    assert (said.code, said.severity) == ("sdf-value-default", "info")
    assert "'gaussian'" in said.message


@pytest.mark.parametrize(
    "content",
    [
        "<imu><angular_velocity><x><noise type='gauss'/></x></angular_velocity></imu>",
        "<altimeter><vertical_position><noise type='gauss'/></vertical_position>"
        "</altimeter>",
    ],
)
def test_an_unknown_noise_of_other_sensors_refuses_the_robot(content: str) -> None:
    kind = content[1 : content.index(">")]
    sensor = f'<sensor name="s" type="{kind}">{content}</sensor>'
    (error,) = refusal(sdf(f'<link name="a">{sensor}</link>'))

    assert error.code == "sdf-value"


def test_the_material_is_mixed_and_named_as_ros_does() -> None:
    visual = (
        '<visual name="v"><geometry><box/></geometry><material>'
        "<ambient>1 1 1 1</ambient><diffuse>1 0.5 0 0.25</diffuse></material></visual>"
    )
    material = load_robot(sdf(f'<link name="a">{visual}</link>')).links["a"].visuals[0]

    assert material.material is not None
    assert material.material.name == "av"
    assert material.material.rgba == pytest.approx((1.0, 0.8, 0.4, 0.6))


def test_a_mesh_of_a_model_is_found_as_that_of_a_package(tmp_path: Path) -> None:
    (tmp_path / "arm" / "meshes").mkdir(parents=True)
    (tmp_path / "arm" / "package.xml").write_text("<package><name>arm</name></package>")
    mesh = tmp_path / "arm" / "meshes" / "a.obj"
    mesh.write_text("v 0 0 0\nv 0 0 1\nv 0 1 0\nf 1 2 3\n")
    uri = "<mesh><uri>model://arm/meshes/a.obj</uri></mesh>"
    visual = f'<visual name="v"><geometry>{uri}</geometry></visual>'
    model = tmp_path / "arm" / "arm.sdf"
    model.write_text(sdf(f'<link name="a">{visual}</link>'))

    robot = load_robot(model)

    geometry = robot.links["a"].visuals[0].geometry
    assert isinstance(geometry, MeshFile)
    assert geometry.path == mesh
    (warning,) = with_code(robot, "file-model-scheme")
    assert "package://" in warning.hint


def test_a_pose_in_round_large_angles_is_meant_as_degrees() -> None:
    visual = '<visual name="v"><pose>0 0 0 90 0 0</pose><geometry><box/></geometry>'
    robot = load_robot(sdf(f'<link name="a">{visual}</visual></link>'))

    (warning,) = with_code(robot, "rpy-in-degrees")
    assert 'degrees="true"' in warning.hint


@pytest.mark.parametrize(("angle", "hint"), [("3.1416", "180"), ("-1.5708", "-90")])
def test_a_part_of_pi_is_no_angle_in_degrees(angle: str, hint: str) -> None:
    visual = '<visual name="v"><pose degrees="true">0 0 0 {} 0 0</pose>{}</visual>'
    box = "<geometry><box><size>1 1 1</size></box></geometry>"

    wrong, right = (
        load_robot(sdf(f'<link name="a">{visual.format(value, box)}</link>'))
        for value in (angle, hint)
    )

    (warning,) = with_code(wrong, "rpy-in-degrees")
    assert warning.hint == f"write {hint} for it, or delete degrees"
    assert with_code(right, "rpy-in-degrees") == []


def test_all_errors_of_a_file_are_told_together() -> None:
    text = sdf(
        '<pose>1 0 0 0 0 0</pose><link name="a"><pose relative_to="x"/></link>'
        '<link name="a"/><visual/><link name="b"/><link name="c"><visual/></link>'
        + joint("", "hinge")
        + '<include><uri>model://n</uri></include><joint name="k" type="fixed"/>'
    )
    codes = {problem.code for problem in refusal(text)}

    assert codes >= {
        "sdf-model-pose",
        "sdf-frame-unknown",
        "sdf-name-taken",
        "sdf-include",
        "attribute-missing",
        "joint-type-unknown",
        "joint-without-parent",
    }


def test_frames_that_are_attached_to_each_other_are_refused() -> None:
    frames = (
        '<link name="a"/>'
        '<frame name="f" attached_to="g"><pose relative_to="a"/></frame>'
        '<frame name="g" attached_to="f"><pose relative_to="a"/></frame>'
    )
    assert "attached to each other" in refusal(sdf(frames))[0].message


def test_a_ring_beside_the_root_is_named_as_a_ring() -> None:
    ends = ("a", "b"), ("c", "d"), ("d", "c")
    links = "".join(f'<link name="{name}"/>' for name in "abcd")
    joints = "".join(
        f'<joint name="j{n}" type="fixed">'
        f"<parent>{p}</parent><child>{c}</child></joint>"
        for n, (p, c) in enumerate(ends)
    )
    (error,) = refusal(sdf(links + joints))

    assert error.code == "joint-ring"


def test_the_root_of_a_refused_model_is_where_all_links_hang_from() -> None:
    links = '<link name="b"/><link name="c"/><link name="a"/>'
    second = '<joint name="k" type="fixed"><parent>b</parent><child>c</child></joint>'
    (error,) = refusal(sdf(links + joint(kind="fixed") + second))

    assert 'canonical_link="a"' in error.hint


def test_xacro_in_sdf_is_expanded_and_places_are_those_of_the_user(
    tmp_path: Path,
) -> None:
    model = tmp_path / "r.sdf.xacro"
    model.write_text(
        '<sdf version="1.8" xmlns:xacro="http://www.ros.org/wiki/xacro">\n'
        '<model name="r">\n<xacro:arg name="side" default="1"/>\n'
        '<link name="a"><visual name="v"><geometry><box>\n'
        "<size>$(arg side) ${2 * 1} 3m</size></box></geometry></visual></link>\n"
        "</model></sdf>"
    )

    robot = load_robot(model, xacro_args={"side": "7"})

    (shape,) = robot.links["a"].visuals
    assert shape.geometry == Box((7.0, 2.0, 3.0))
    assert shape.place is not None
    assert (shape.place.file, shape.place.line) == (str(model), 4)


def test_a_substitution_in_plain_sdf_goes_through_xacro_as_in_ros(
    tmp_path: Path,
) -> None:
    model = tmp_path / "r.sdf"
    model.write_text(sdf('<link name="a"><pose>${1 + 1} 0 0 0 0 0</pose></link>'))

    assert load_robot(model).root == "a"


def test_the_text_is_kept_as_sdf_and_there_is_a_urdf_of_it() -> None:
    text = sdf(TWO + joint(axis("-inf", "inf")))
    robot = load_robot(text)

    assert robot.description == text
    assert robot.language == "sdf"
    again = load_robot(robot.urdf)
    assert again.joints["j"].range == robot.joints["j"].range
    assert robot.to_yourdfpy().robot.name == "r"


@pytest.mark.parametrize("name", ["mbot", "mbot_frames", "mbot_classic"])
def test_the_urdf_of_a_robot_reads_as_the_same_robot(name: str) -> None:
    data = Path(__file__).parents[2] / "data" / "sdf" / "ours"
    robot = load_robot(data / f"{name}.sdf")
    again = load_robot(robot.urdf)

    assert list(again.links) == list(robot.links)
    middle = {
        n: (a + b) / 2 for n in robot.joint_names for a, b in [robot.joints[n].range]
    }
    poses, same = (r.forward_kinematics(middle) for r in (robot, again))
    for link, T in poses.items():
        np.testing.assert_allclose(T, same[link], atol=1e-9)
    for link in robot.links.values():
        for shape, other in zip(
            link.visuals, again.links[link.name].visuals, strict=True
        ):
            np.testing.assert_allclose(
                shape.origin.matrix, other.origin.matrix, atol=1e-9
            )
            if shape.material is not None:
                assert other.material is not None
                assert other.material.rgba == pytest.approx(shape.material.rgba)


def test_every_link_has_an_inertia_and_that_of_the_root_is_no_finding() -> None:
    data = Path(__file__).parents[2] / "data" / "sdf" / "ours" / "mbot.sdf"
    assert load_robot(data).links["base_link"].inertial is not None
    assert not [p for p in check(data) if p.code == "inertia-on-root"]


def test_wheels_with_limits_of_inf_drive_and_turn_as_continuous_ones_do() -> None:
    text = (Path(__file__).parents[3] / "assets" / "sam_bot.sdf").read_text("utf-8")
    limit = "<limit><lower>-inf</lower><upper>inf</upper></limit></axis>"
    text = text.replace('type="continuous"', 'type="revolute"')
    robot = load_robot(text.replace("</axis>", limit))

    assert all(robot.joints[name].endless for name in robot.joint_names)
    pair = find_wheel_pair(robot)
    assert (pair.left, pair.right) == ("drivewhl_l_joint", "drivewhl_r_joint")
    state = JointState(robot)
    state.set("drivewhl_l_joint", 40.0)
    assert state.over_limit() == ()


@pytest.mark.parametrize(
    ("moments", "refused"),
    [
        ("1 0 0 1 0 2", False),
        ("1 0 0 1 0 2.000000000001", True),
        ("1 1.1 0 1 0 1", True),
        ("0 0 0 0 0 0", False),
        ("1 0 0 1 0 nan", True),
        ("1 inf 0 1 0 1", True),
        ("inf 0 0 1 0 1", False),
        ("1 0 0 inf 0 1", True),
    ],
)
def test_an_inertia_is_refused_where_libsdformat_refuses_it(
    moments: str, refused: bool
) -> None:
    tags = ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")
    values = zip(tags, moments.split(), strict=True)
    inertia = "".join(f"<{tag}>{value}</{tag}>" for tag, value in values)
    body = f"<inertial><inertia>{inertia}</inertia></inertial>"
    text = sdf(f'<link name="a">{body}</link>')

    if refused:
        assert [problem.code for problem in refusal(text)] == ["sdf-inertia"]
    else:
        assert load_robot(text).root == "a"


@pytest.mark.parametrize("name", ["world", "__model__", "a::b"])
def test_the_name_of_the_model_may_be_reserved_too(name: str) -> None:
    (error,) = refusal(sdf('<link name="a"/>', model=f'name="{name}"'))

    assert error.code == "sdf-name-reserved"


def test_a_joint_that_is_its_own_child_is_refused() -> None:
    text = sdf(TWO + joint(kind="fixed").replace("<child>b", "<child>j"))

    assert "sdf-joint-to-frame" in {problem.code for problem in refusal(text)}


def test_a_frame_that_is_to_be_a_link_is_told_to_become_one() -> None:
    text = (
        '<sdf version="1.8"><model name="r"><link name="a"/>\n'
        '<frame name="f" attached_to="a"/>\n'
        '<joint name="j" type="fixed"><pose relative_to="a">0 0 1 0 0 0</pose>'
        "<parent>a</parent><child>f</child></joint></model></sdf>"
    )
    (problem,) = (p for p in refusal(text) if p.code == "sdf-joint-to-frame")
    link = '<link name="f"><pose relative_to="j"/></link>'
    assert problem.hint == f"make it a link: write {link} for the <frame> in line 2"
    better = text.replace('<frame name="f" attached_to="a"/>', link)
    assert load_robot(better).problems == ()


def test_a_nested_model_without_links_is_refused() -> None:
    (error,) = refusal(sdf('<link name="a"/><model name="m"/>'))

    assert "m has no links" in error.message
    static = '<model name="m"><static>true</static></model>'
    assert load_robot(sdf(f'<link name="a"/>{static}')).root == "a"


@pytest.mark.parametrize(("version", "refused"), [("1.4", True), ("1.8", False)])
def test_an_old_axis_needs_its_direction(version: str, refused: bool) -> None:
    text = sdf(TWO + joint("<axis/>", "continuous"), version)

    if refused:
        assert "has no <xyz>" in refusal(text)[0].message
    else:
        assert load_robot(text).joints["j"].axis == (0.0, 0.0, 1.0)


@pytest.mark.parametrize(
    ("shape", "is_black"),
    [
        ("<mesh><uri>a.dae</uri></mesh>", False),
        ("<mesh><uri>a.OBJ</uri></mesh>", False),
        ("<mesh><uri>a.stl</uri></mesh>", True),
        ("<sphere><radius>1</radius></sphere>", True),
    ],
)
def test_a_material_that_a_mesh_of_colours_overrides_is_not_said_to_be_black(
    shape: str, is_black: bool
) -> None:
    script = "<script><uri>model://a/materials</uri><name>A/B</name></script>"
    robot = load_robot(
        sdf(
            f'<link name="a"><visual name="v"><geometry>{shape}</geometry>'
            f"<material>{script}</material></visual></link>"
        )
    )
    assert bool(with_code(robot, "material-without-colour")) == is_black
