"""Names within Nav2's parameters that do not meet are found, and mended."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from edited import edited_files
from manifests import manifest

from sambot_viz.checks import check
from sambot_viz.errors import Problem

MODEL = "urdf/cart.urdf.xacro"
NAV2 = "config/nav2_params.yaml"
SOURCES = "observation_sources: scan"
LAYER = """\
      plugins: ["voxel_layer"]
      voxel_layer:
        plugin: "nav2_costmap_2d::VoxelLayer"
"""
ONCE = """\
global_costmap:
  ros__parameters:
    global_frame: map
    robot_base_frame: base_link
    use_sim_time: True
    robot_radius: 0.3
"""
TWICE = """\
global_costmap:
  global_costmap:
    ros__parameters:
      global_frame: map
      robot_base_frame: base_link
      use_sim_time: True
      robot_radius: 0.3
"""

MANIFEST = manifest()

Copied = Callable[[str], Path]


@pytest.mark.parametrize(
    ("code", "right", "wrong", "line", "cause", "hint", "better"),
    [
        (
            "nav2-section",
            SOURCES,
            "observation_sources: laser",
            24,
            "observation_sources names laser, but the section is called scan (line 25)",
            "write scan",
            SOURCES,
        ),
        (
            "nav2-section",
            "      voxel_layer:\n",
            LAYER.replace('["voxel', '["obstacle'),
            23,
            "plugins names obstacle_layer, but the section is called voxel_layer",
            "write voxel_layer",
            LAYER,
        ),
        ("nav2-node-name", "amcl:", "Amcl:", 1, "no node Amcl", "write amcl:", "amcl:"),
        (
            "nav2-node-name",
            "bt_navigator:",
            "bt_navigater:",
            9,
            "Nav2 has no node bt_navigater",
            "write bt_navigator:",
            "bt_navigator:",
        ),
        (
            "nav2-node-name",
            TWICE,
            ONCE,
            29,
            "here the name is only once",
            "write a line global_costmap: below it, and two blanks more before each "
            "line that follows",
            TWICE,
        ),
        (
            "nav2-node-name",
            "global_costmap:\n  global_costmap:",
            "global_costmap:\n  global_costmp:",
            30,
            "global_costmap reads its parameters below global_costmap: and again "
            "global_costmap:, but this is global_costmap: and global_costmp:",
            "write global_costmap:",
            "global_costmap:\n  global_costmap:",
        ),
        (
            "nav2-plugin",
            "      voxel_layer:\n",
            LAYER.replace("::VoxelLayer", "::VoxlLayer"),
            25,
            "Nav2 has no plugin nav2_costmap_2d::VoxlLayer: local_costmap stops with",
            "write nav2_costmap_2d::VoxelLayer",
            LAYER,
        ),
        (
            "parameters-yaml",
            TWICE,
            TWICE.replace("  global_costmap:\n", "")
            + "  global_costmap_client:\n    ros__parameters:\n      a: 1\n",
            29,
            "global_costmap: has to be there twice, and the second, two blanks further "
            "in, is missing",
            "add a line global_costmap: below this one, with 2 blanks before it",
            TWICE,
        ),
        (
            "parameter-unknown",
            "scan_topic: scan",
            "scan_topc: scan",
            7,
            "amcl has no parameter scan_topc, but scan_topic, which is not given",
            "write scan_topic",
            "scan_topic: scan",
        ),
        (
            "parameter-value",
            'data_type: "LaserScan"',
            'data_type: "Laserscan"',
            27,
            "local_costmap knows only LaserScan and PointCloud2: it stops",
            "write LaserScan",
            'data_type: "LaserScan"',
        ),
        (
            "parameter-value",
            'data_type: "LaserScan"',
            'data_type: "sensor_msgs/LaserScan"',
            27,
            "local_costmap knows only LaserScan and PointCloud2: it stops",
            "write LaserScan",
            'data_type: "LaserScan"',
        ),
        (
            "frame-slash",
            "robot_base_frame: base_link",
            "robot_base_frame: /base_link",
            13,
            "bt_navigator asks for the frame /base_link",
            "write base_link",
            "robot_base_frame: base_link",
        ),
        (
            "sim-time-off",
            "use_sim_time: True",
            "use_sim_time: False",
            3,
            "amcl uses the time of the computer, but bt_navigator (line 11)",
            "write true",
            "use_sim_time: true",
        ),
    ],
)
def test_a_name_that_nothing_has(
    copied: Copied,
    code: str,
    right: str,
    wrong: str,
    line: int,
    cause: str,
    hint: str,
    better: str,
) -> None:
    package = copied("gz")
    nav2 = package / NAV2
    text = nav2.read_text()
    assert right in text
    nav2.write_text(text.replace(right, wrong, 1))

    (problem,) = check(package / MODEL)

    assert (problem.code, problem.file) == (code, str(nav2))
    assert cause in problem.message
    assert problem.hint == hint
    assert problem.line == line
    nav2.write_text(text.replace(right, better, 1))
    assert check(package / MODEL) == []


@pytest.mark.parametrize(
    ("right", "other"),
    [
        (SOURCES, 'observation_sources: ""'),
        (SOURCES, f"{SOURCES} bumper\n        bumper:\n          data_type: LaserScan"),
        (
            "      voxel_layer:\n",
            '      plugins: ["static_layer"]\n      voxel_layer:\n',
        ),
        ("amcl:", "my_localizer:"),
        ("amcl:", "cart/amcl:"),
        ("    use_sim_time: True\n", ""),
    ],
)
def test_what_nav2_reads_is_not_reported(
    copied: Copied, right: str, other: str
) -> None:
    package = copied("gz")
    nav2 = package / NAV2
    text = nav2.read_text()
    assert right in text
    nav2.write_text(text.replace(right, other, 1))
    assert check(package / MODEL) == []


SERVER = """\
controller_server:
  ros__parameters:
    controller_plugins: [FollowPath]
    goal_checker_plugins: [general_goal_checker]
    general_goal_checker:
      plugin: nav2_controller::SimpleGoalChecker
    FollowPath:
      plugin: nav2_mppi_controller::MPPIController
      motion_model: DiffDrive
local_costmap:
  local_costmap:
    ros__parameters:
      plugins: [obstacle_layer, inflation_layer]
      obstacle_layer:
        plugin: nav2_costmap_2d::ObstacleLayer
        observation_sources: laser
        laser:
          data_type: LaserScan
      inflation_layer:
        plugin: nav2_costmap_2d::InflationLayer
        inflation_radius: 0.55
"""


@pytest.mark.parametrize(
    ("right", "wrong", "line", "cause"),
    [
        (
            "    FollowPath:",
            "    followPath:",
            7,
            "controller_plugins names FollowPath (line 3), but this section is called",
        ),
        (
            "[FollowPath]",
            "[followPath]",
            3,
            "controller_plugins names followPath, but the section is called FollowPath",
        ),
        (
            "[general_goal_checker]",
            "[goal_checker]",
            4,
            "names goal_checker, but the section is called general_goal_checker",
        ),
        (
            "    general_goal_checker:",
            "    goal_checker:",
            5,
            "names general_goal_checker (line 4), but this section is called",
        ),
        ("DiffDrive", "Diffdrive", 9, "knows only DiffDrive, Omni and Ackermann"),
        ("DiffDrive", "omni", 9, "knows only DiffDrive, Omni and Ackermann"),
        (
            """\
      inflation_layer:
        plugin: nav2_costmap_2d::InflationLayer
        inflation_radius: 0.55
""",
            """\
        inflation_layer:
          plugin: nav2_costmap_2d::InflationLayer
          inflation_radius: 0.55
""",
            19,
            "plugins names inflation_layer (line 13), but this section is inside",
        ),
        (
            "        laser:\n          data",
            "      laser:\n        data",
            17,
            "names laser (line 16), but this section is beside obstacle_layer",
        ),
        (
            "      inflation_layer:\n",
            "",
            19,
            "obstacle_layer has a second plugin here: the line inflation_layer: is",
        ),
    ],
)
def test_a_section_with_another_name_or_level_is_mended(
    tmp_path: Path, right: str, wrong: str, line: int, cause: str
) -> None:
    file = tmp_path / "nav2_params.yaml"
    (tmp_path / "package.xml").write_text(MANIFEST)
    file.write_text(SERVER)
    assert _problems(tmp_path) == []
    assert right in SERVER
    file.write_text(SERVER.replace(right, wrong, 1))

    first, *_ = _problems(tmp_path)

    assert (first.line, cause in first.message) == (line, True), first.message
    right = SERVER.replace(right, "Omni") if wrong == "omni" else SERVER
    assert edited_files(first.edits)[str(file)].decode() == right


@pytest.mark.parametrize(
    "other", ["my_model\n      my_model: {plugin: mine::Model}", "Ackermann"]
)
def test_a_motion_model_of_ones_own(tmp_path: Path, other: str) -> None:
    (tmp_path / "package.xml").write_text(MANIFEST)
    text = SERVER.replace("DiffDrive", other)
    (tmp_path / "nav2_params.yaml").write_text(text)
    assert _problems(tmp_path) == []


TWO = "[inflation_layer, obstacle_layer]"
"""The layers in the order in which nothing is inflated."""


def test_the_inflation_layer_is_the_last(tmp_path: Path) -> None:
    (tmp_path / "package.xml").write_text(MANIFEST)
    file = tmp_path / "nav2_params.yaml"
    file.write_text(SERVER.replace("[obstacle_layer, inflation_layer]", TWO))

    (problem,) = _problems(tmp_path)

    assert (problem.code, problem.line) == ("costmap-layers", 13)
    assert edited_files(problem.edits)[str(file)].decode() == SERVER


@pytest.mark.parametrize(("other", "severity"), [("0.55", "warning"), ("0.4", "info")])
def test_an_inflation_that_fills_the_costmap(
    tmp_path: Path, other: str, severity: str
) -> None:
    (tmp_path / "package.xml").write_text(MANIFEST)
    _, _, local = SERVER.partition("local_costmap:\n")
    both = f"local_costmap:\n{local}global_costmap:\n{local}".replace(
        "  local_costmap:\n    ros__parameters:\n      plugins: [obstacle_layer, infl",
        "  {}_costmap:\n    ros__parameters:\n      width: 3\n      plugins: "
        "[obstacle_layer, infl",
    ).format("local", "global")
    first, _, rest = both.partition("inflation_radius: 0.55")
    text = f"{first}inflation_radius: 55.0{rest.replace('0.55', other)}"
    (tmp_path / "nav2_params.yaml").write_text(text)

    (problem,) = _problems(tmp_path)

    assert (problem.code, problem.severity) == ("costmap-layers", severity)
    assert bool(problem.edits) == (severity == "warning")


LOCAL = f"""\
      global_frame: odom
      rolling_window: true
      width: 3
      footprint: "[[0.2, 0.15], [0.2, -0.15], [-0.2, -0.15], [-0.2, 0.15]]"
{SERVER.partition("ros__parameters:")[2].partition("    ros__parameters:")[2][1:]}"""
GLOBAL = """\
global_costmap:
  global_costmap:
    ros__parameters:
      plugins: [inflation_layer]
      robot_radius: 0.3
      inflation_layer: {plugin: nav2_costmap_2d::InflationLayer, inflation_radius: 0.3}
"""
COSTMAPS = f"local_costmap:\n  local_costmap:\n    ros__parameters:\n{LOCAL}{GLOBAL}"
ROLLING = "      rolling_window: true\n"


@pytest.mark.parametrize(
    ("right", "wrong", "line", "cause"),
    [
        ("window: true", "window: false", 5, "rolling_window of local_costmap is fal"),
        (f"odom\n{ROLLING}", "odom\n", 4, "is missing, which means false"),
        ("radius: 0.55", "radius: 0.1", 16, "inscribed radius of the footprint (line"),
        ("radius: 0.3}", "radius: 0.2}", 22, "but the robot_radius (line 21) is 0.3"),
    ],
)
def test_a_costmap_that_misses_obstacles(
    tmp_path: Path, right: str, wrong: str, line: int, cause: str
) -> None:
    (tmp_path / "package.xml").write_text(MANIFEST)
    file, text = tmp_path / "nav2_params.yaml", COSTMAPS
    file.write_text(text)
    assert _problems(tmp_path) == []
    assert right in text
    file.write_text(text.replace(right, wrong, 1))

    (problem,) = _problems(tmp_path)

    assert (problem.code, problem.severity) == ("costmap-layers", "warning")
    assert (problem.line, cause in problem.message) == (line, True), problem
    file.write_bytes(edited_files(problem.edits)[str(file)])
    assert _problems(tmp_path) == []


@pytest.mark.parametrize(
    ("right", "other"),
    [
        (ROLLING, "      rolling_window: false\n      origin_x: -1.5\n"),
        (f"odom\n{ROLLING}", "map\n"),
        (ROLLING, "      rolling_window: $(var rolling)\n"),
        ("radius: 0.55", "radius: 0.1\n        enabled: false"),
        ("radius: 0.3}", "radius: 0.2, enabled: false}"),
    ],
)
def test_a_costmap_that_is_meant_so(tmp_path: Path, right: str, other: str) -> None:
    (tmp_path / "package.xml").write_text(MANIFEST)
    assert right in COSTMAPS
    (tmp_path / "nav2_params.yaml").write_text(COSTMAPS.replace(right, other, 1))
    assert _problems(tmp_path) == []


def test_a_text_for_a_list_is_no_list_of_names(tmp_path: Path) -> None:
    (tmp_path / "package.xml").write_text(MANIFEST)
    text = SERVER.replace("[obstacle_layer, inflation_layer]", '"obstacle_layer, b"')
    (tmp_path / "nav2_params.yaml").write_text(text)
    assert [p.code for p in _problems(tmp_path)] == ["parameter-type"]


def _problems(package: Path) -> list[Problem]:
    return [p for p in check(package) if p.code != "package-without-model"]
