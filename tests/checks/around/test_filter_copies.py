"""Lines of a filter that were copied: their number, their kind and their rows."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from sambot_viz.checks import check
from sambot_viz.edits import apply_edits

Copied = Callable[[str], Path]
MODEL, EKF = "urdf/cart.urdf.xacro", "config/ekf.yaml"
ROWS = """\
    imu0_config: [false, false, false,
                  true,  true,  true,
"""


@pytest.mark.parametrize(
    ("right", "wrong", "line", "cause", "hint"),
    [
        (
            "imu0",
            "odom0",
            18,
            "odom0 is given to ekf_filter_node twice",
            "write imu0 for odom0 in line 18 and the lines that belong to it",
        ),
        (
            "imu0",
            "odom1",
            18,
            "reads demo/imu as Odometry for odom1",
            "write imu0 for odom1, in all its lines",
        ),
        (
            "odom0: demo/odom",
            "odom0: demo/imu",
            12,
            "reads demo/imu as Odometry for odom0",
            "write /demo/odom",
        ),
        (
            ROWS,
            "    imu0_config: [true,  true,  true,\n"
            "                  false, false, false,\n",
            19,
            "uses position, which sensor_msgs/Imu does not have, and nothing of "
            "orientation, the row beside it",
            "exchange these three values with those of orientation, the row below",
        ),
    ],
)
def test_the_edit_restores_what_was_copied(
    copied: Copied, right: str, wrong: str, line: int, cause: str, hint: str
) -> None:
    package = copied("gz")
    text = (package / EKF).read_text("utf-8")
    changed = text.replace(right, wrong)
    (package / EKF).write_text(changed, "utf-8")

    (problem,) = check(package / MODEL)

    assert (problem.line, problem.hint) == (line, hint)
    assert cause in problem.message
    (package / EKF).write_text(apply_edits(problem.edits, changed), "utf-8")
    assert check(package / MODEL) == []


def test_a_row_beside_one_in_use_is_superfluous(copied: Copied) -> None:
    package = copied("gz")
    text = (package / EKF).read_text("utf-8")
    changed = text.replace("imu0_config: [false", "imu0_config: [true")
    (package / EKF).write_text(changed, "utf-8")

    (problem,) = check(package / MODEL)

    assert problem.hint == "write false for these values"
