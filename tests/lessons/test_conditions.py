"""Each kind of condition has an example that holds, and some that do not."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from lesson_files import unmet

from sambot_viz import bundled, load_robot
from sambot_viz.lessons.conditions.kinds import KINDS
from sambot_viz.lessons.work import Work

PACKAGE = (
    Path(__file__).parents[1]
    / "data"
    / "lessons"
    / "nav2-first-robot"
    / "sam_bot_description"
)
MODEL = PACKAGE / "src" / "description" / "sam_bot_description.urdf"
LOCAL = "node: local_costmap/local_costmap"

HOLD = [
    "robot: {name: sam_bot, root: base_link}",
    "link: {name: [base_link, imu_link]}",
    "link: {name: base_footprint, visual: false, inertial: true}",
    "joint: {name: drivewhl_l_joint, type: [continuous], axis: [0, 1, 0]}",
    "joint: {name: drivewhl_l_joint, along: [0, -2, 0], xyz: [-0.12, 0.18, -0.05]}",
    "joint: {name: imu_joint, parent: base_link, child: imu_link, rpy: [0, 0, 0]}",
    "transform: {from: base_footprint, to: lidar_link, xyz: [0, 0, 0.27]}",
    "transform: {from: base_link, to: imu_link, xyz: [0, 0, 0.0108]}",
    "transform: {from: base_link, to: lidar_link, rpy: [0, 0, 0.008]}",
    "shape: {link: base_link, box: [0.42, 0.31, 0.18], of: collision, xyz: [0, 0, 0]}",
    "shape: {link: front_caster, sphere: 0.06}",
    "shape: {link: drivewhl_l_link, cylinder: [0.1, 0.04], along: [0, 1, 0]}",
    "color: {link: base_link, rgba: [0, 1, 1, 1]}",
    "collision: {links: [base_link, front_caster], within: 0.01}",
    "ground: {links: [drivewhl_l_link, front_caster]}",
    "mass: {link: front_caster, kg: 0.5}",
    "mass: {kg: 16.5}",
    "inertia: {links: [drivewhl_l_link, front_caster]}",
    "inertia: {links: base_footprint, shape_of: base_link}",
    "balance: {tilt: 5}",
    "property: {name: wheel_radius, uses: 4}",
    "macro: {name: wheel, calls: 2}",
    "file: {name: 'config/*.yaml', has: [ekf_filter_node]}",
    "file: {name: [setup.py, CMakeLists.txt]}",
    "sensor: {link: imu_link, type: imu, rate: '1e2', topic: /demo/imu}",
    "plugin: {name: DiffDrive, values: {wheel_separation: ['0.36']}}",
    "node: {package: robot_localization, executable: ekf_node}",
    "topic: {name: /demo/odom, type: nav_msgs/msg/Odometry, published: yes, read: yes}",
    "bridge: {ros: scan, type: sensor_msgs/msg/LaserScan, direction: GZ_TO_ROS}",
    f"parameter: {{{LOCAL}, name: robot_base_frame, value: [base_link]}}",
    f"parameter: {{{LOCAL}, name: plugins, has: voxel_layer}}",
    f"parameter: {{{LOCAL}, name: width, least: 3, most: 3}}",
    "static-transform: {from: base_link, to: base_laser, xyz: [0.1, 0, 0.2]}",
    "rviz: {displays: [Grid, RobotModel, TF]}",
    "no-problem: {code: [wheel-not-on-ground, 'bridge-*']}",
    "no-errors: {but: [launch-package-unknown]}",
    "any: [mass: {kg: 1}, mass: {kg: 16.5}]",
]

DO_NOT_HOLD = [
    ("robot: {name: mybot}", "the robot is called 'sam_bot'"),
    ("robot: {root: base_footprint}", "the root link is called 'base_link'"),
    ("link: {name: base_lnk}", "no link 'base_lnk', but there is 'base_link'"),
    ("link: {name: base_link, visual: false}", "base_link has a <visual>"),
    ("link: {name: imu_link, inertial: true}", "imu_link has no <inertial>"),
    ("joint: {name: wheel_joint}", "there is no joint 'wheel_joint'"),
    ("joint: {name: imu_joint, type: revolute}", "imu_joint is fixed"),
    ("joint: {name: imu_joint, parent: lidar_link}", "the parent of imu_joint is"),
    ("joint: {name: drivewhl_l_joint, axis: [0, -1, 0]}", "is 0 1 0"),
    ("joint: {name: drivewhl_l_joint, along: [1, 0, 0]}", "is 0 1 0"),
    ("joint: {name: drivewhl_l_joint, lower: -1}", "has no <limit>"),
    ("joint: {name: imu_joint, xyz: [0, 0, 0.02]}", "which is 10 mm off"),
    ("joint: {name: imu_joint, rpy: [0, 0, 1.5708]}", "is turned by 90° too much"),
    ("transform: {from: base_link, to: camera_link, xyz: [0, 0, 0]}", "mm off"),
    ("between: {from: imu_link, to: base_link, frames: [a]}", "base_link hangs at"),
    (
        "between: {from: base_link, to: imu_link, frames: [body]}",
        "base_link → imu_link",
    ),
    ("shape: {link: base_link, sphere: 0.1}", "is a box of 0.42 0.31 0.18"),
    (
        "shape: {link: imu_link, box: [1, 1, 1]}",
        "imu_link is invisible: it has no <visual>",
    ),
    ("shape: {link: drivewhl_l_link, along: [0, 0, 1]}", "is along 0 -1 0"),
    ("shape: {link: base_link, xyz: [0, 0, 0.09]}", "is at 0 0 0 in the link"),
    ("shape: {link: base_link, mesh: body.stl}", "is a box"),
    ("color: {link: base_link, rgba: [1, 0, 0, 1]}", "base_link is 0 1 1 1"),
    ("color: {link: imu_link, rgba: [1, 0, 0, 1]}", "has no colour of its own"),
    ("collision: {links: imu_link}", "imu_link has no <collision>"),
    ("ground: {links: front_caster, frame: base_link}", "150 mm below base_link"),
    ("ground: {links: imu_link}", "imu_link has no shape"),
    ("mass: {link: base_link, kg: 15}", "the mass of base_link is 0 kg"),
    ("inertia: {links: base_link}", "base_link has no <inertial>"),
    ("inertia: {links: front_caster, shape_of: base_link}", "the moments of inertia"),
    ("balance: {tilt: 89}", "the robot falls over when the ground is tilted by"),
    ("property: {name: wheel_radius, uses: 100}", "is used"),
    ("property: {name: radius}", "the property radius is not defined"),
    ("macro: {name: wheel, calls: 3}", "the macro wheel is used 2 times"),
    ("file: {name: ekf.yml}", "there is no file ekf.yml, but there is ekf.yaml"),
    ("file: {name: ekf.yaml, has: imu1}", "config/ekf.yaml does not have 'imu1'"),
    ("sensor: {link: imu_link, type: camera}", "no such sensor, only imu"),
    ("sensor: {link: imu_link, type: imu, topic: imu}", "is demo/imu"),
    ("sensor: {link: imu_link, type: imu, values: {imu/noise: a}}", "is not given"),
    ("plugin: {name: AckermannSteering}", "the plugins of the model are: gz-sim-"),
    ("plugin: {name: DiffDrive, values: {wheel_radius: '0.2'}}", "is 0.1"),
    ("node: {package: slam_toolbox}", "the launch files start robot_state_"),
    (
        "topic: {name: /demo/odm, published: true}",
        "publishes /demo/odm, but /demo/odom",
    ),
    ("topic: {name: /demo/odom, type: x/msg/Y, published: true}", "is nav_msgs/msg/"),
    ("bridge: {ros: /lidar, type: a, direction: GZ_TO_ROS}", "carries only /clock"),
    ("bridge: {ros: /scan, type: a/msg/B, direction: ROS_TO_GZ}", "the type of /scan"),
    (f"parameter: {{{LOCAL}, name: footprnt}}", "is not given, but there is footprint"),
    (f"parameter: {{{LOCAL}, name: width, value: '5'}}", "width of local_costmap"),
    (f"parameter: {{{LOCAL}, name: width, least: 4}}", "is 3"),
    (f"parameter: {{{LOCAL}, name: plugins, has: static_layer}}", "voxel_layer and"),
    ("static-transform: {from: map, to: odom, xyz: [0, 0, 0]}", "from base_link to"),
    (
        "static-transform: {from: base_link, to: base_laser, xyz: [0, 0, 0]}",
        "0.1 0 0.2",
    ),
    ("rviz: {displays: Map}", "has no display Map"),
    ("no-problem: {code: x-*}", ""),
    ("any: [mass: {kg: 1}, mass: {kg: 2}]", "the mass of the robot is 16.5 kg"),
]


@pytest.fixture(scope="session")
def work() -> Work:
    return Work(MODEL, PACKAGE)


@pytest.mark.parametrize("condition", HOLD)
def test_a_condition_holds(tmp_path: Path, work: Work, condition: str) -> None:
    assert unmet(tmp_path, condition, work) == []


@pytest.mark.parametrize(("condition", "found"), DO_NOT_HOLD)
def test_a_condition_that_does_not_hold_says_what_was_found(
    tmp_path: Path, work: Work, condition: str, found: str
) -> None:
    said = unmet(tmp_path, condition, work)
    if condition.startswith("no-problem"):
        assert said == []
        return
    assert found in said[0].found
    assert said[0].expected


def test_every_kind_has_examples() -> None:
    kinds = {one.partition(":")[0] for one in HOLD}
    others = {"between", "recorded", "moved", "goal-reached"}
    assert kinds | others == {*KINDS, "any"}
    fail = {one.partition(":")[0] for one, _ in DO_NOT_HOLD}
    assert fail >= {*KINDS} - others - {"no-errors"}


Write = Callable[[str], Work]


@pytest.fixture
def model(tmp_path: Path) -> Write:
    def write(inside: str) -> Work:
        file = tmp_path / "robot.urdf"
        file.write_text(f'<robot name="r"><link name="a"/>{inside}</robot>')
        return Work(file, trusted=False)

    return write


def test_a_problem_of_a_code_does_not_hold(tmp_path: Path, model: Write) -> None:
    work = model(
        '<link name="b"/><joint name="j" type="fixed"><parent link="a"/>'
        '<child link="b"/><origin xyz="0 0 0" rpy="0 0 90"/></joint>'
    )
    (said,) = unmet(tmp_path, "no-problem: {code: rpy-*}", work)
    assert "looks like degrees" in said.found
    assert "1.5708" not in said.found, "that is the answer"


def test_limits_of_a_joint_are_compared(tmp_path: Path, model: Write) -> None:
    work = model(
        '<link name="b"/><joint name="j" type="revolute"><parent link="a"/>'
        '<child link="b"/><limit lower="-1" upper="1" effort="5" velocity="2"/></joint>'
    )
    good = "joint: {name: j, lower: -1, upper: 1, effort: 5, velocity: 2}"
    assert unmet(tmp_path, good, work) == []
    (said,) = unmet(tmp_path, "joint: {name: j, upper: 1.57}", work)
    assert (said.found, said.expected) == ("upper of j is 1", "1.57")


def test_frames_between_two_others_come_in_order(tmp_path: Path, model: Write) -> None:
    links = "".join(
        f'<link name="{child}"/><joint name="j_{child}" type="fixed">'
        f'<parent link="{parent}"/><child link="{child}"/></joint>'
        for parent, child in ("ab", "bc", "cd")
    )
    work = model(links)
    assert unmet(tmp_path, "between: {from: a, to: d, frames: [b, c]}", work) == []
    (said,) = unmet(tmp_path, "between: {from: a, to: d, frames: [c, b]}", work)
    assert said.found == "the frames are a → b → c → d"


def test_errors_of_the_model_do_not_hold(tmp_path: Path) -> None:
    work = Work(tmp_path / "missing.urdf", tmp_path)
    (said,) = unmet(tmp_path, "no-errors:", work)
    assert "there is no such file" in said.found


def test_a_collision_that_is_elsewhere_is_measured(
    tmp_path: Path, model: Write
) -> None:
    box = '<geometry><box size="1 1 1"/></geometry>'
    work = model(
        f'<link name="b"><visual>{box}</visual><collision><origin xyz="0.03 0 0"/>{box}'
        '</collision></link><joint name="j" type="fixed"><parent link="a"/>'
        '<child link="b"/></joint>'
    )
    (said,) = unmet(tmp_path, "collision: {links: b}", work)
    assert "is up to 30 mm away from the visual one" in said.found


def test_a_config_whose_fixed_frame_is_no_link_does_not_hold(
    tmp_path: Path, model: Write
) -> None:
    (tmp_path / "a.rviz").write_text(
        "Visualization Manager:\n  Global Options:\n    Fixed Frame: odom\n"
    )
    (said,) = unmet(tmp_path, "rviz:", model(""))
    assert said.found.endswith("is odom")


def test_a_robot_that_is_loaded_already_is_not_read_again(tmp_path: Path) -> None:
    robot = load_robot(bundled.model_path())
    work = Work(tmp_path / "not-there.urdf", tmp_path, loaded=robot, problems=())
    assert unmet(tmp_path, "robot: {name: sam_bot}", work) == []
    assert unmet(tmp_path, "no-errors:", work) == []
