"""Parameters of well-known nodes that make no sense are found, and mended."""

from __future__ import annotations

from pathlib import Path

import pytest

from sambot_viz.checks import check
from sambot_viz.edits import apply_edits
from sambot_viz.errors import Problem

RIGHT = """\
amcl:
  ros__parameters:
    min_particles: 500
    max_particles: 2000
    robot_model_type: nav2_amcl::DifferentialMotionModel
    laser_model_type: likelihood_field
controller_server:
  ros__parameters:
    controller_frequency: 20.0
    goal_checker_plugins: ["goals"]
    controller_plugins: [FollowPath]
    goals:
      plugin: nav2_controller::SimpleGoalChecker
      stateful: true
      xy_goal_tolerance: 0.25
    FollowPath:
      plugin: dwb_core::DWBLocalPlanner
      sim_time: 1.7
      acc_lim_x: 2.5
      decel_lim_theta: -3.2
      critics: [GoalAlign, PathDist]
      GoalAlign.scale: 24.0
local_costmap:
  local_costmap:
    ros__parameters:
      robot_radius: 0.26
      update_frequency: 5.0
      plugins: [obstacle_layer, inflation_layer]
      obstacle_layer:
        plugin: nav2_costmap_2d::ObstacleLayer
        observation_sources: scan
        scan:
          topic: /scan
          sensor_frame: base_scan
          raytrace_max_range: 3.0
      inflation_layer:
        inflation_radius: 0.55
        plugin: nav2_costmap_2d::InflationLayer
planner_server:
  ros__parameters:
    planner_plugins: ["GridBased"]
    GridBased:
      plugin: nav2_navfn_planner::NavfnPlanner
behavior_server:
  ros__parameters:
    behavior_plugins: [spin]
    spin:
      plugin: nav2_behaviors::Spin
velocity_smoother:
  ros__parameters:
    feedback: OPEN_LOOP
    max_velocity: [0.26, 0.0, 1.0]
    max_decel: [-2.5, 0.0, -3.0]
controller_manager:
  ros__parameters:
    update_rate: 100
    drive:
      type: diff_drive_controller/DiffDriveController
drive:
  ros__parameters:
    left_wheel_names: [left]
    right_wheel_names: [right]
    wheel_radius: 0.1
    linear.x.max_velocity: .NAN
ekf_filter_node:
  ros__parameters:
    frequency: 30.0
    base_link_frame: base_link
    two_d_mode: true
    odom0: odom
    odom0_config: [false, false, false, false, false, false, true,
                   true, false, false, false, true, false, false, false]
my_node:
  ros__parameters:
    gains: [1.0, 0.5]
"""

INFLATION = """\
      inflation_layer:
        inflation_radius: 0.55
"""


def found(folder: Path, text: str) -> list[Problem]:
    (folder / "package.xml").write_text("<package><name>r</name></package>")
    (folder / "r.urdf").write_text('<robot name="r"><link name="base_link"/></robot>')
    (folder / "params.yaml").write_text(text)
    codes = ("parameter-", "nav2-", "frame-slash")
    return [p for p in check(folder / "r.urdf") if p.code.startswith(codes)]


def test_right_parameters_have_no_finding(tmp_path: Path) -> None:
    assert found(tmp_path, RIGHT) == []


@pytest.mark.parametrize(
    ("severity", "right", "wrong", "cause"),
    [
        (
            "warning",
            "min_particles: 500\n    max_particles: 2000",
            "min_particles: 2000\n    max_particles: 500",
            "min_particles is 2000, which is more than max_particles, 500 (line 4)",
        ),
        (
            "error",
            "stateful: true\n      xy_goal_tolerance: 0.25",
            "stateful: 0.25\n      xy_goal_tolerance: true",
            "each has the type of the other",
        ),
        (
            "error",
            "nav2_amcl::DifferentialMotionModel",
            "differential",
            "has no plugin",
        ),
        ("error", "DifferentialMotionModel", "DifferentialMotionModl", "has no plugin"),
        ("warning", "likelihood_field", "likelihod_field", "does not use this value"),
        ("error", "OPEN_LOOP", "OPEN_LOP", "it stops with an error"),
        ("error", "2d::InflationLayer", "2d/InflationLayer", "has no plugin"),
        ("error", "nav2_costmap_2d::Infl", "costmap_2d::Infl", "has no plugin"),
        (
            "error",
            "nav2_navfn_planner::NavfnPlanner",
            "nav2_navfn_planner/NavfnPlanner",
            "after Iron, and this file has plugins that came later",
        ),
        ("error", "[GoalAlign,", "[GoalAlgin,", "no TrajectoryCritic GoalAlgin"),
        (
            "warning",
            'goal_checker_plugins: ["goals"]',
            "goal_checker_plugin: goals",
            "no parameter goal_checker_plugin after Foxy, but goal_checker_plugins",
        ),
        ("warning", "raytrace_max_range", "raytrace_range", "after Foxy"),
        ("warning", "robot_radius", "robot_raduis", "no parameter robot_raduis"),
        ("error", "radius: 0.26", "radius: 0,26", 'the text "0,26"'),
        ("error", "radius: 0.26", "radius: 0.26 m", 'the text "0.26 m"'),
        ("error", "update_frequency: 5.0", "update_frequency: 5.0Hz", "5.0Hz"),
        ("error", "min_particles: 500", "min_particles: 500.0", "needs a whole number"),
        ("error", "scale: 24.0", "scale: 24", "the whole number 24"),
        ("error", "[FollowPath]", "FollowPath", "a list of texts"),
        ("error", "[0.26, 0.0, 1.0]", "[0.26, 0, 1]", "a list with the whole number 0"),
        ("error", "[1.0, 0.5]", "[1, 0.5]", "only lists with items of one type"),
        ("error", "mode: true", 'mode: "true"', 'the text "true"'),
        ("warning", "link_frame: base_link", "link_frame: /base_link", "a slash"),
        ("warning", "sensor_frame: base_scan", "sensor_frame: /base_scan", "a slash"),
        ("info", "frequency: 30.0", "frequency: 0.033", "usually at least 1"),
        ("warning", "theta: -3.2", "theta: 3.2", "needs negative numbers"),
        ("warning", "lim_x: 2.5", "lim_x: -2.5", "needs positive numbers"),
        ("error", "[-2.5, 0.0, -3.0]", "[2.5, 0.0, 3.0]", "it stops with an error"),
        ("warning", "  sim_time", "  sim_tme", "no parameter sim_tme"),
        ("warning", "x.max_velocity", "x.max_velocty", "no parameter max_velocty"),
        (
            "warning",
            INFLATION,
            "      inflation_radius: 0.55\n      inflation_layer:\n",
            "has no parameter inflation_radius, but inflation_layer has",
        ),
    ],
)
def test_a_parameter_that_a_node_cannot_use_has_an_edit_that_mends_it(
    tmp_path: Path, severity: str, right: str, wrong: str, cause: str
) -> None:
    assert right in RIGHT
    text = RIGHT.replace(right, wrong, 1)

    (problem,) = found(tmp_path, text)

    assert problem.severity == severity
    assert cause in problem.message
    assert apply_edits(problem.edits, text) == RIGHT


@pytest.mark.parametrize(
    ("severity", "right", "wrong", "cause", "hint"),
    [
        ("info", "xy_goal_tolerance: 0.25", "xy_goal_tolerance: 25.0", "at most 2", ""),
        ("info", "frequency: 30.0", "frequency: 0.0", "usually at least 1", ""),
        ("info", "radius: 0.26", "radius: -0.26", "usually at least 0", ""),
        ("error", "wheel_radius: 0.1", "wheel_radius: 0.0", "only more than 0", ""),
        ("error", ", false]", "]", "has 14 values", "add false at the end"),
        ("error", ", false]", ", false, true]", "has 16 values", "delete the last"),
        ("error", "config: [false", 'config: ["a", false', "", ""),
        ("error", "[0.26, 0.0, 1.0]", "[0.26, 0.0]", "needs 3", "add 0.0"),
        (
            "warning",
            "frequency: 30.0",
            "frequency: 30.0\n    frequency: 9.0",
            "30.0",
            "",
        ),
        (
            "error",
            "[obstacle_layer, inf",
            "[voxels, obstacle_layer, inf",
            "nothing says the plugin of voxels",
            "add voxels: with its plugin:",
        ),
    ],
)
def test_a_parameter_that_a_node_cannot_use_is_explained(
    tmp_path: Path, severity: str, right: str, wrong: str, cause: str, hint: str
) -> None:
    assert right in RIGHT
    problem, *_ = found(tmp_path, RIGHT.replace(right, wrong, 1))
    assert problem.severity == severity
    assert cause in problem.message
    assert hint in problem.hint


def test_a_name_that_only_old_distributions_have_is_noted(tmp_path: Path) -> None:
    text, _, _ = RIGHT.partition("controller_server:")
    right = "nav2_amcl::DifferentialMotionModel"
    old = text.replace(right, "differential")
    (problem,) = found(tmp_path, old)
    assert (problem.severity, problem.code) == ("info", "nav2-plugin")
    assert problem.message.endswith(f"after Galactic, and later it is {right}")
    assert apply_edits(problem.edits, old) == text


@pytest.mark.parametrize(
    ("right", "other"),
    [
        ("nav2_navfn_planner::NavfnPlanner", "my_planner::Planner"),
        ("  sim_time: 1.7", "  my_weight: 1.7"),
        ("radius: 0.26", "radius: ROBOT_RADIUS"),
        ("radius: 0.26", "radius: $(var radius)"),
        ("[obstacle_layer, inflation_layer]", "[static_layer]"),
        (
            "controller_frequency: 20.0",
            'progress_checker_plugins: ["progress_checker"]',
        ),
    ],
)
def test_what_a_node_may_have_is_not_reported(
    tmp_path: Path, right: str, other: str
) -> None:
    assert right in RIGHT
    assert found(tmp_path, RIGHT.replace(right, other, 1)) == []
