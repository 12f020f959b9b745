"""Nodes with another clock than the simulator beside them, also from includes."""

from __future__ import annotations

from pathlib import Path

import pytest
from manifests import manifest

from sambot_viz.checks import check

MANIFEST = manifest()
NAV2 = '<include file="$(find-pkg-share nav2_bringup)/launch/navigation_launch.py">'
GAZEBO = '<include file="$(find-pkg-share ros_gz_sim)/launch/gz_sim.launch.py"/>'
ARGUMENT = '<arg name="use_sim_time" value="{}"/>'
NODE = """\
<node pkg="robot_localization" exec="ekf_node">
<param name="use_sim_time" value="true"/></node>
"""


def found(folder: Path, launch: str) -> list[str]:
    """Return what is found in a package with one launch file."""
    (folder / "launch").mkdir()
    (folder / "package.xml").write_text(MANIFEST)
    (folder / "launch" / "a.launch.xml").write_text(f"<launch>\n{launch}\n</launch>")
    problems = [p for p in check(folder) if p.code == "sim-time-off"]
    return [f"{p.line}: {p.message}" for p in problems]


@pytest.mark.parametrize("beside", [GAZEBO, NODE])
def test_a_launch_file_of_nav2_that_is_not_told_the_time(
    tmp_path: Path, beside: str
) -> None:
    (message,) = found(tmp_path, f"{NAV2}</include>\n{beside}")
    assert message.startswith("2: controller_server, smoother_server, planner_server")
    assert "use_sim_time is false" in message


def test_a_time_in_a_file_that_nav2_may_rewrite_proves_nothing(tmp_path: Path) -> None:
    (tmp_path / "nav2.yaml").write_text(
        "planner_server:\n  ros__parameters:\n    use_sim_time: true\n"
    )
    file = '<arg name="params_file" value="$(find-pkg-share robot)/nav2.yaml"/>'
    assert found(tmp_path, f"{NAV2}{file}</include>") == []


@pytest.mark.parametrize(
    "launch",
    [
        f"{NAV2}{ARGUMENT.format('true')}</include>{GAZEBO}",
        f"{ARGUMENT.format('true')}{NAV2}</include>{GAZEBO}",
        f"{NAV2}</include>",
    ],
)
def test_one_clock_is_right(tmp_path: Path, launch: str) -> None:
    assert found(tmp_path, launch) == []
