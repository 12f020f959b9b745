"""A value of another type than a node reads is found, and the advice mends it."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from sambot_viz.checks import check

MODEL = "urdf/cart.urdf.xacro"
EKF = "config/ekf.yaml"
NAV2 = "config/nav2_params.yaml"

Copied = Callable[[str], Path]

FIRST_ROW = "[true,  true,  true,"
LAST_ROWS = """\
                   false, false, true,
                   false, false, false]
    imu0:"""


@pytest.mark.parametrize(
    ("file", "right", "wrong", "cause", "hint", "better"),
    [
        (EKF, "30.0", "30", "the whole number 30", "write 30.0", "30.0"),
        (
            EKF,
            "frequency: 30.0",
            'frequency: "30"',
            'the text "30"',
            "write 30.0",
            "frequency: 30.0",
        ),
        (EKF, "mode: false", "mode: False,", '"False,"', "write false", "mode: false"),
        (EKF, "mode: false", "mode: 0", "number 0", "write false", "mode: false"),
        (
            EKF,
            "publish_tf: true",
            'publish_tf: "true"',
            'the text "true"',
            "write true without quotation marks",
            "publish_tf: true",
        ),
        (
            EKF,
            "odom0: demo/odom",
            "odom0: [demo/odom]",
            "a list with one item",
            "write demo/odom",
            "odom0: demo/odom",
        ),
        (
            EKF,
            FIRST_ROW,
            '["true",  true,  true,',
            'a list with "true"',
            "write true without quotation marks",
            FIRST_ROW,
        ),
        (
            EKF,
            LAST_ROWS,
            "                   false false, true,\n"
            "                   false, false, false]\n    imu0:",
            'a list with "false false"',
            "write false, false: a comma is missing",
            LAST_ROWS,
        ),
        (
            EKF,
            LAST_ROWS,
            "                   false, false, true]\n    imu0:",
            "has 12 values, but ekf_filter_node needs 15",
            "add false, false, false at the end of the list",
            "                   false, false, true, false, false, false]\n    imu0:",
        ),
        (
            EKF,
            LAST_ROWS,
            LAST_ROWS.replace("true,", "true, true,"),
            "has 16 values",
            "delete one in this line",
            LAST_ROWS,
        ),
        (
            EKF,
            LAST_ROWS,
            LAST_ROWS.replace("false, false, true,", "false, true,"),
            "but ekf_filter_node needs 15: this line has fewer than the others",
            "write one more in this line",
            LAST_ROWS,
        ),
        (
            NAV2,
            "use_sim_time: True",
            'use_sim_time: "True"',
            'the text "True"',
            "write true",
            "use_sim_time: true",
        ),
        (NAV2, "radius: 0.3", 'radius: "0.3"', "the text", "write 0.3", "radius: 0.3"),
        (
            NAV2,
            "robot_base_frame: base_link",
            "robot_base_frame:",
            "robot_base_frame is empty",
            "write robot_base_frame: base_link",
            "robot_base_frame: base_link",
        ),
    ],
)
def test_a_value_of_another_type(
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

    assert (problem.code, problem.severity) == ("parameter-type", "error")
    assert problem.file == str(package / file)
    assert cause in problem.message
    assert hint in problem.hint
    (package / file).write_text(text.replace(right, better, 1))
    assert check(package / MODEL) == []


@pytest.mark.parametrize(
    ("file", "right", "other"),
    [
        (EKF, "30.0", "3e1"),
        (EKF, "30.0", "$(var frequency)"),
        (EKF, "two_d_mode: false", "two_d_mode: off"),
        (EKF, "odom0: demo/odom", "odom0: 'demo/odom'"),
        (NAV2, "robot_radius: 0.3", "robot_radius: <radius>"),
        (NAV2, "robot_radius: 0.3", "robot_radius: 0.3\n      width: 3"),
        (NAV2, "    scan_topic: scan", "    scan_topic: scan\n    max_particles: 2000"),
    ],
)
def test_what_ros_reads_is_not_reported(
    copied: Copied, file: str, right: str, other: str
) -> None:
    package = copied("gz")
    text = (package / file).read_text()
    assert right in text
    (package / file).write_text(text.replace(right, other, 1))
    assert check(package / MODEL) == []
