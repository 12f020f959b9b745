"""A topic with quite another name than the only one of its type is found."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from sambot_viz.checks import check

MODEL = "urdf/cart.urdf.xacro"
LAUNCH = "launch/display.launch.py"
EKF, NAV2 = "config/ekf.yaml", "config/nav2_params.yaml"
BRIDGE = "config/bridge_config.yaml"

Copied = Callable[[str], Path]


@pytest.mark.parametrize(
    ("file", "right", "wrong", "cause", "hint", "better"),
    [
        (
            EKF,
            "imu0: demo/imu",
            "imu0: sensors/data",
            "the bridge publishes this Imu as /demo/imu (bridge_config.yaml line 8)",
            "write /demo/imu",
            "imu0: /demo/imu",
        ),
        (
            NAV2,
            "topic: /scan",
            "topic: /lidar",
            "the bridge publishes this LaserScan as /scan (bridge_config.yaml line 32)",
            "write /scan",
            "topic: /scan",
        ),
        (
            NAV2,
            "scan_topic: scan",
            "scan_topic: front_laser",
            "amcl reads front_laser",
            "write /scan",
            "scan_topic: /scan",
        ),
        (
            BRIDGE,
            'ros_topic_name: "/scan"',
            'ros_topic_name: "/lidar"',
            "amcl (nav2_params.yaml line 7) and all others read scan",
            "write /scan",
            'ros_topic_name: "/scan"',
        ),
        (
            NAV2,
            'data_type: "LaserScan"',
            'data_type: "PointCloud2"',
            "local_costmap reads /scan as PointCloud2, but the bridge publishes it as "
            "LaserScan (bridge_config.yaml line 32)",
            "write LaserScan",
            "data_type: LaserScan",
        ),
    ],
)
def test_a_topic_that_nobody_publishes(
    copied: Copied,
    file: str,
    right: str,
    wrong: str,
    cause: str,
    hint: str,
    better: str,
) -> None:
    package = copied("gz")
    text = (package / file).read_text()
    assert right in text
    (package / file).write_text(text.replace(right, wrong, 1))

    (problem,) = check(package / MODEL)

    assert problem.file == str(package / file)
    assert cause in problem.message
    assert problem.hint == hint
    (package / file).write_text(text.replace(right, better, 1))
    assert check(package / MODEL) == []


@pytest.mark.parametrize(
    "action",
    [
        'Node(package="lidar_driver", executable="driver"),',
        "OpaqueFunction(function=print),",
        "IncludeLaunchDescription(PythonLaunchDescriptionSource("
        'get_package_share_directory("lidar_driver") + "/a.launch.py")),',
    ],
)
def test_another_node_may_publish_it(copied: Copied, action: str) -> None:
    package = copied("gz")
    nav2, launch = package / NAV2, package / LAUNCH
    nav2.write_text(nav2.read_text().replace("topic: scan", "topic: front_laser"))
    assert [p.code for p in check(package / MODEL)] == ["topic-unknown"]
    text = launch.read_text()
    text = text.replace(
        "            bridge,", f"            bridge,\n{' ' * 12}{action}"
    )
    launch.write_text(
        text.replace("    ExecuteProcess,", "    ExecuteProcess,\n    OpaqueFunction,")
    )
    assert check(package / MODEL) == []


@pytest.mark.parametrize(
    "launch",
    [
        '<launch><node pkg="robot_localization" exec="ekf_node"/></launch>',
        '<launch><arg name="use" default="1"/><group if="$(var use)">'
        '<node pkg="robot_localization" exec="ekf_node"/></group></launch>',
    ],
)
def test_a_filter_that_a_launch_file_in_xml_starts_reads_its_topics(
    copied: Copied, launch: str
) -> None:
    package = copied("gz")
    (package / LAUNCH).unlink()
    (package / "launch" / "display.launch.xml").write_text(launch, "utf-8")
    config = package / EKF
    text = config.read_text("utf-8")
    config.write_text(text.replace("imu0: demo/imu", "imu0: demo/im"), "utf-8")
    assert "topic-unknown" in {problem.code for problem in check(package / MODEL)}


@pytest.mark.parametrize(
    ("added", "kind"),
    [
        ("pose0: demo/odom", "PoseWithCovarianceStamped"),
        ("twist0: /demo/odom", "TwistWithCovarianceStamped"),
    ],
)
def test_a_filter_reads_each_kind_of_input_as_its_type(
    copied: Copied, added: str, kind: str
) -> None:
    package = copied("gz")
    config = package / EKF
    imu = "    imu0: demo/imu"
    config.write_text(
        config.read_text("utf-8").replace(imu, f"    {added}\n{imu}"), "utf-8"
    )
    (problem,) = (p for p in check(package / MODEL) if p.code == "topic-type")
    assert f"as {kind} for {added.partition(':')[0]}, but the bridge" in problem.message
    assert "as Odometry (bridge_config.yaml line 14)" in problem.message


def test_a_bridge_that_is_not_started_publishes_nothing(copied: Copied) -> None:
    package = copied("gz")
    (package / LAUNCH).unlink()
    bridge = "$(find-pkg-share cart_description)/config/bridge_config.yaml"
    (package / "launch" / "display.launch.xml").write_text(
        '<launch><node pkg="robot_localization" exec="ekf_node"/>'
        '<node pkg="ros_gz_bridge" exec="parameter_bridge" if="false">'
        f'<param name="config_file" value="{bridge}"/></node></launch>',
        "utf-8",
    )
    config = package / EKF
    text = config.read_text("utf-8")
    config.write_text(text.replace("imu0: demo/imu", "imu0: demo/im"), "utf-8")
    assert "topic-unknown" not in {problem.code for problem in check(package / MODEL)}


def test_a_namespace_leads_a_reader_away_from_its_topic(copied: Copied) -> None:
    package = copied("gz")
    launch, config = package / LAUNCH, package / EKF
    text = launch.read_text("utf-8")
    name = '        name="ekf_filter_node",\n'
    launch.write_text(
        text.replace(name, f'{name}        namespace="robot",\n'), "utf-8"
    )
    said = config.read_text("utf-8")
    config.write_text(said.replace("ekf_filter_node", "/**/ekf_filter_node"), "utf-8")

    found = [p for p in check(package / MODEL) if p.code == "topic-unknown"]

    assert [p.hint for p in found] == ["write /demo/odom", "write /demo/imu"]
    assert found[0].message == (
        "robot/ekf_filter_node reads demo/odom, which is /robot/demo/odom by its "
        "namespace, but the bridge publishes this Odometry as /demo/odom "
        "(bridge_config.yaml line 14)"
    )


def test_topics_of_a_controller_have_its_name(copied: Copied) -> None:
    package = copied("gz")
    launch = package / LAUNCH
    spawner = (
        'Node(package="controller_manager", executable="spawner", arguments=["base"]),'
    )
    text = launch.read_text("utf-8")
    launch.write_text(
        text.replace(
            "            bridge,", f"            bridge,\n            {spawner}"
        ),
        "utf-8",
    )
    (package / "config" / "controllers.yaml").write_text(
        "controller_manager:\n  ros__parameters:\n    base:\n"
        "      type: diff_drive_controller/DiffDriveController\n",
        "utf-8",
    )
    config = package / EKF
    said = config.read_text("utf-8")
    config.write_text(said.replace("demo/odom", "base/odm"), "utf-8")

    found = [p for p in check(package / MODEL) if p.code == "topic-unknown"]

    assert "base publishes this Odometry as /base/odom" in found[0].message
