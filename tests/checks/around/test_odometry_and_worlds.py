"""What nobody publishes, and systems that a world does not have."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from sambot_viz.checks import check

MODEL = "urdf/cart.urdf.xacro"
LAUNCH = "launch/display.launch.py"
EKF, WORLD = "config/ekf.yaml", "world/room.sdf"
SENSORS = '<plugin filename="gz-sim-sensors-system" name="gz::sim::systems::Sensors"/>'
PHYSICS = '<plugin filename="gz-sim-physics-system" name="gz::sim::systems::Physics"/>'
PHYSICS += (
    '<plugin filename="gz-sim-user-commands-system" '
    'name="gz::sim::systems::UserCommands"/>'
)
IMU = '<plugin filename="gz-sim-imu-system" name="gz::sim::systems::Imu"/>'

Copied = Callable[[str], Path]


@pytest.mark.parametrize(
    ("right", "wrong", "reason", "hint"),
    [
        ("publish_tf: true", "publish_tf: false", "publish_tf is false", "write true"),
        ("world_frame: odom", "world_frame: map", "world_frame is map", "write odom"),
    ],
)
def test_a_filter_that_is_told_not_to_publish(
    copied: Copied, right: str, wrong: str, reason: str, hint: str
) -> None:
    package = copied("gz")
    text = (package / EKF).read_text()
    assert right in text
    (package / EKF).write_text(text.replace(right, wrong))

    (problem,) = check(package / MODEL)

    assert (problem.code, problem.file) == (
        "odometry-unpublished",
        str(package / EKF),
    )
    assert "local_costmap needs (nav2_params.yaml line 19)" in problem.message
    assert problem.message.endswith(f"because {reason}")
    assert problem.hint == hint
    key = wrong.split()[0]
    (package / EKF).write_text(text.replace(right, f"{key} {hint.split()[1]}"))
    assert check(package / MODEL) == []


def test_another_node_may_publish_it(copied: Copied) -> None:
    package = copied("gz")
    ekf, launch = package / EKF, package / LAUNCH
    ekf.write_text(ekf.read_text().replace("publish_tf: true", "publish_tf: false"))
    node = 'Node(package="wheel_odometry", executable="odometry"),'
    launch.write_text(
        launch.read_text().replace("            bridge,", f"            bridge, {node}")
    )
    assert check(package / MODEL) == []


def test_a_mapper_needs_somebody_who_publishes_odometry(copied: Copied) -> None:
    package = copied("gz")
    launch = package / LAUNCH
    text = launch.read_text("utf-8")
    mapper = (
        'Node(package="slam_toolbox", executable="async_slam_toolbox_node"),\n'
        "            robot_state_publisher,"
    )
    launch.write_text(text.replace("robot_state_publisher,", mapper), "utf-8")
    assert check(package / MODEL) == []

    without = launch.read_text("utf-8").replace("            robot_localization,\n", "")
    start = without.index("    robot_localization = Node")
    without = without[:start] + without[without.index("    rviz = Node") :]
    launch.write_text(without, "utf-8")
    (package / EKF).unlink()

    found = [p for p in check(package / MODEL) if p.code == "odometry-unpublished"]

    assert [p.message for p in found] == [
        "no node publishes the transform from odom to base_link, which slam_toolbox "
        "needs"
    ]


@pytest.mark.parametrize(
    ("systems", "sensor", "better"),
    [
        (PHYSICS + SENSORS, "imu", PHYSICS + SENSORS),
        (PHYSICS + IMU, "lidar", PHYSICS + IMU),
    ],
)
def test_a_world_without_a_system_of_a_sensor(
    copied: Copied, systems: str, sensor: str, better: str
) -> None:
    package = copied("gz")
    world = package / WORLD
    text = world.read_text()
    assert SENSORS in text
    world.write_text(text.replace(SENSORS, systems))

    (problem,) = check(package / MODEL)

    assert (problem.code, problem.file) == ("world-system", str(world))
    assert problem.line == 3
    assert f"which the sensor {sensor}" in problem.message
    assert "cart.urdf.xacro line" in problem.message
    added = problem.hint.removeprefix("add ").removesuffix(" to the world")
    world.write_text(text.replace(SENSORS, better + added))
    assert check(package / MODEL) == []


@pytest.mark.parametrize("systems", ["", SENSORS, PHYSICS + SENSORS + IMU])
def test_a_world_with_its_systems_or_without_a_list(
    copied: Copied, systems: str
) -> None:
    package = copied("gz")
    world = package / WORLD
    world.write_text(world.read_text().replace(SENSORS, systems))
    assert check(package / MODEL) == []
