"""Topics of sensors, bridges and filters that do not meet are found, and mended."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from edited import edited_files

from sambot_viz.checks import check

MODEL = "urdf/cart.urdf.xacro"
BRIDGE = "config/bridge_config.yaml"
EKF = "config/ekf.yaml"
Edit = tuple[str, str, str]
Copied = Callable[[str], Path]


def edit(folder: Path, file: str, old: str, new: str) -> None:
    text = (folder / file).read_text()
    assert old in text, old
    (folder / file).write_text(text.replace(old, new, 1))


@pytest.mark.parametrize(
    ("code", "wrong", "file", "cause", "hint", "better"),
    [
        pytest.param(
            "bridge-types",
            (BRIDGE, "gz.msgs.Model", "gz.msgs.JointState"),
            BRIDGE,
            "cannot turn gz.msgs.JointState into sensor_msgs/msg/JointState",
            "write gz.msgs.Model",
            (BRIDGE, "gz.msgs.JointState", "gz.msgs.Model"),
            id="type that does not exist",
        ),
        pytest.param(
            "bridge-topic",
            (BRIDGE, 'gz_topic_name: "/demo/odom"', 'gz_topic_name: "{own}/odometry"'),
            BRIDGE,
            "but the plugin gz-sim-diff-drive-system sends /demo/odom",
            "write /demo/odom",
            (BRIDGE, 'gz_topic_name: "{own}/odometry"', 'gz_topic_name: "/demo/odom"'),
            id="name that Gazebo would make up",
        ),
        pytest.param(
            "bridge-topic",
            (MODEL, "      <topic>scan</topic>\n", ""),
            MODEL,
            "has no <topic>, so its topic in Gazebo is a long one below the name of "
            "the model, but the bridge carries /scan (bridge_config.yaml line 33)",
            "add <topic>scan</topic> to it",
            (MODEL, 'type="gpu_lidar">', 'type="gpu_lidar"><topic>scan</topic>'),
            id="sensor without topic",
        ),
        pytest.param(
            "topic-type",
            (EKF, "imu0: demo/imu", "imu0: demo/odom"),
            EKF,
            "reads demo/odom as Imu for imu0, but the bridge publishes it as Odometry",
            "write /demo/imu",
            (EKF, "imu0: demo/odom", "imu0: /demo/imu"),
            id="topic of another type",
        ),
        pytest.param(
            "parameter-unknown",
            (EKF, "odom0: demo", "odom: demo"),
            EKF,
            "ekf_filter_node has no parameter odom, but odom0",
            "write odom0",
            (EKF, "odom: demo", "odom0: demo"),
            id="misspelt sensor of a filter",
        ),
        pytest.param(
            "parameter-unknown",
            (EKF, "imu0_config", "imu0_conf"),
            EKF,
            "has no parameter imu0_conf, but imu0_config",
            "write imu0_config",
            (EKF, "imu0_conf", "imu0_config"),
            id="misspelt choice of values",
        ),
    ],
)
def test_a_mistake_is_found_and_its_fix_leaves_nothing(
    copied: Copied,
    code: str,
    wrong: Edit,
    file: str,
    cause: str,
    hint: str,
    better: Edit,
) -> None:
    package = copied("gz")
    own = "/model/cart"
    edit(package, *(part.replace("{own}", own) for part in wrong))
    (problem,) = check(package / MODEL)
    assert problem.code == code
    assert problem.file == str(package / file)
    assert cause in problem.message
    assert problem.hint == hint
    edit(package, *(part.replace("{own}", own) for part in better))
    assert check(package / MODEL) == []


def test_a_sensor_of_a_filter_has_to_say_which_values_are_used(copied: Copied) -> None:
    package = copied("gz")
    text = (package / EKF).read_text()
    start = text.index("imu0_config")
    end = text.index("]", start) + 1
    edit(package, EKF, text[start:end], "")
    (problem,) = check(package / MODEL)
    assert problem.code == "ekf-config"
    assert "no imu0_config for imu0" in problem.message
    added = problem.hint.removeprefix("add ")
    assert added.count("true") == 2 and added.count("false") == 13
    edit(package, EKF, "imu0: demo/imu", f"imu0: demo/imu\n    {added}")
    assert check(package / MODEL) == []


@pytest.mark.parametrize(
    ("file", "old", "new"),
    [
        # The drive of another model of the world.
        (BRIDGE, 'gz_topic_name: "/demo/odom"', 'gz_topic_name: "/model/dog/odometry"'),
        # A plugin that is not known may send it.
        (MODEL, "<topic>scan</topic>", "<topic>lidar</topic>"),
        (BRIDGE, "gz.msgs.Model", "our.msgs.JointState"),
        (EKF, "imu0: demo/imu", "imu0: other/imu"),
    ],
)
def test_what_may_be_meant_has_no_finding_of_its_type(
    copied: Copied, file: str, old: str, new: str
) -> None:
    package = copied("gz")
    edit(package, file, old, new)
    codes = {problem.code for problem in check(package / MODEL)}
    assert codes.isdisjoint({"topic-type", "bridge-types", "ekf-config"})
    if "dog" in new:
        assert codes == set()


@pytest.mark.parametrize(
    ("both", "first", "second"),
    [
        (
            "ros_type_name: {}\n  gz_type_name: {}",
            '"geometry_msgs/msg/TwistStamped"',
            '"gz.msgs.Twist"',
        ),
        (
            "gz_topic_name: {}\n  ros_type_name: {}",
            '"/demo/imu"',
            '"sensor_msgs/msg/Imu"',
        ),
    ],
)
def test_exchanged_values_of_a_bridge_are_undone_by_their_edit(
    copied: Copied, both: str, first: str, second: str
) -> None:
    package = copied("gz")
    text = (package / BRIDGE).read_text()
    edit(package, BRIDGE, both.format(first, second), both.format(second, first))
    found = [p for p in check(package / MODEL) if p.code == "bridge-type-unknown"]
    (problem,) = found
    path = str(package / BRIDGE)
    assert edited_files(problem.edits)[path].decode() == text
