"""A line of parameters at another level, and inputs of filters, are mended."""

from __future__ import annotations

from pathlib import Path

import pytest
from edited import edited_files
from manifests import manifest

from sambot_viz.checks import check
from sambot_viz.errors import Problem

MANIFEST = manifest()
TELEOP = """\
teleop_twist_joy_node:
  ros__parameters:
    axis_linear:
      x: 1
    scale_linear:
      x: 0.5
    axis_angular:
      yaw: 0
    scale_angular:
      yaw: 0.5
    enable_button: 6
"""
MUX = """\
twist_mux:
  ros__parameters:
    topics:
      navigation:
        topic: cmd_vel
        timeout: 0.5
        priority: 10
      joystick:
        topic: cmd_vel_joy
        timeout: 0.5
        priority: 100
"""
SERVER = """\
controller_server:
  ros__parameters:
    controller_plugins: [FollowPath]
    FollowPath:
      plugin: nav2_mppi_controller::MPPIController
      vx_max: 0.5
"""
FILTER = """\
ekf_filter_node:
  ros__parameters:
    odom0: odom
    odom0_config: [false, false, false,
                   false, false, false,
                   true,  true,  false,
                   false, false, true,
                   false, false, false]
    imu0: imu
    imu0_config: [false, false, false,
                  false, false, true,
                  false, false, false,
                  false, false, true,
                  false, false, false]
    imu0_differential: false
"""
INSIDE = "      plugin: nav2_mppi_controller::MPPIController\n      vx_max: 0.5\n"
ENTRY = "        topic: cmd_vel\n        timeout: 0.5\n        priority: 10\n"


def found(folder: Path, text: str) -> list[Problem]:
    (folder / "package.xml").write_text(MANIFEST)
    (folder / "params.yaml").write_text(text)
    return [p for p in check(folder) if p.code != "package-without-model"]


GPIO = """\
gpio_controller:
  ros__parameters:
    command_interfaces:
      flange:
        - interfaces: [vacuum, light]
"""
"""A list with one name, whose value is a list: ROS reads flange.interfaces."""


@pytest.mark.parametrize("text", [TELEOP, MUX, SERVER, FILTER, GPIO])
def test_lines_at_their_levels_have_no_finding(tmp_path: Path, text: str) -> None:
    assert found(tmp_path, text) == []


@pytest.mark.parametrize(
    ("text", "right", "wrong", "line", "cause"),
    [
        (TELEOP, "    enable", "      enable", 11, "enable_button is inside scale_ang"),
        (TELEOP, "    axis_angular:\n", "", 7, "the line axis_angular: is missing"),
        (TELEOP, "    scale_linear:\n", "", 5, "the line scale_linear: is missing"),
        (MUX, ENTRY, ENTRY.replace("        ", "      "), 5, "topic is beside navig"),
        (MUX, "navigation:", "- name: navigation", 4, "joystick beside it is a name"),
        (MUX, "joystick:", "- name: joystick", 8, "navigation beside it is a name"),
        (SERVER, INSIDE, INSIDE.replace("      ", "    "), 5, "plugin is beside Follo"),
        (SERVER, "    FollowPath:\n", "", 4, "the line FollowPath: is missing"),
        (
            SERVER,
            "    FollowPath:\n" + INSIDE,
            "  FollowPath:\n" + INSIDE.replace("      ", "    "),
            4,
            "FollowPath is beside ros__parameters (line 2), not below it",
        ),
    ],
)
def test_a_line_goes_to_its_level(
    tmp_path: Path, text: str, right: str, wrong: str, line: int, cause: str
) -> None:
    assert right in text
    problems = found(tmp_path, text.replace(right, wrong, 1))
    problem = next(p for p in problems if cause in p.message)
    assert problem.line == line
    edited = edited_files(problem.edits)[str(tmp_path / "params.yaml")]
    assert edited.decode() == text


def test_a_list_of_names_and_values_becomes_names(tmp_path: Path) -> None:
    wrong = MUX.replace("navigation:", "- name: navigation")
    (problem,) = found(tmp_path, wrong.replace("joystick:", "- name: joystick"))
    assert (problem.severity, problem.line) == ("error", 4)
    edited = edited_files(problem.edits)[str(tmp_path / "params.yaml")]
    assert edited.decode() == MUX


def test_a_second_entry_without_a_name(tmp_path: Path) -> None:
    (problem,) = found(tmp_path, MUX.replace("      joystick:\n", ""))
    assert (problem.line, problem.edits) == (8, ())
    assert "topic, timeout and priority are in navigation (line 4)" in problem.message


def test_an_empty_value_is_found_for_any_node(tmp_path: Path) -> None:
    (problem,) = found(tmp_path, "mine:\n  ros__parameters:\n    a: 1\n    b:\n")
    assert (problem.code, problem.line) == ("parameter-type", 4)


ODOM = "true,  true,  false,\n                   false, false, true,"
IMU = "[false, false, false,\n                  false, false, true,\n"


@pytest.mark.parametrize(
    ("right", "wrong", "severity", "line", "cause"),
    [
        (IMU, IMU.replace("[false", "[true"), "info", 10, "imu0_config uses position"),
        ("imu0", "imu1", "warning", 9, "does not read imu1, because there is no imu0"),
        ("odom0", "odom2", "warning", 3, "does not read odom2, because there is no"),
        (
            "true,\n                   false, false, false]\n    imu0: ",
            "true,\n                   true, false, false]\n    imu0: ",
            "info",
            8,
            "odom0_config uses linear acceleration, which nav_msgs/Odometry does not",
        ),
    ],
)
def test_an_input_that_the_filter_does_not_use(
    tmp_path: Path, right: str, wrong: str, severity: str, line: int, cause: str
) -> None:
    assert right in FILTER
    (problem,) = found(tmp_path, FILTER.replace(right, wrong))
    assert (problem.code, problem.severity) == ("ekf-config", severity)
    assert cause in problem.message
    assert problem.line == line
    edited = edited_files(problem.edits)[str(tmp_path / "params.yaml")]
    assert edited.decode() == FILTER


def test_a_sensor_of_which_nothing_is_used(tmp_path: Path) -> None:
    first, _, imu = FILTER.partition("imu0_config")
    rows = imu.replace("true,", "false,").replace("[false", "[true")
    (problem,) = found(tmp_path, f"{first}imu0_config{rows}")
    assert (problem.severity, problem.edits) == ("warning", ())
    assert "and nothing else: ekf_filter_node does not use this sensor" in (
        problem.message
    )


def test_numbers_for_truths_are_no_unused_sensor(tmp_path: Path) -> None:
    first, _, imu = FILTER.partition("imu0_config")
    rows, behind, rest = imu.partition("imu0_differential")
    rows = rows.replace("true", "1").replace("false", "0")
    (problem,) = found(tmp_path, f"{first}imu0_config{rows}{behind}{rest}")
    assert (problem.code, problem.severity) == ("parameter-type", "error")


def test_a_missing_comma_of_a_list_is_written_at_its_line(tmp_path: Path) -> None:
    wrong = FILTER.replace(
        "false,\n                   true,  true",
        "false\n" + " " * 19 + "true,  true",
        1,
    )
    assert wrong != FILTER
    (problem,) = found(tmp_path, wrong)
    edited = edited_files(problem.edits)[str(tmp_path / "params.yaml")]
    assert edited.decode() == FILTER
