from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from sambot_viz.checks.config_against_robot import check_config
from sambot_viz.errors import Problem
from sambot_viz.robot.model import Robot, load_robot
from sambot_viz.rviz import Declarations, RvizConfig

Checked = Callable[[str], list[Problem]]

BOTH = "Visual Enabled: false\n      Collision Enabled: true"
GOOD = """\
Visualization Manager:
  Displays:
    - Class: rviz_default_plugins/RobotModel
      Description Topic:
        Depth: 1
        Durability Policy: Transient Local
        Value: /robot_description
      Enabled: true
      Name: RobotModel
  Global Options:
    Fixed Frame: base_link
"""


@pytest.fixture
def robot() -> Robot:
    return load_robot(
        '<robot name="r"><link name="base_link"/><link name="wheel_link"/>'
        '<joint name="wheel_joint" type="continuous"><parent link="base_link"/>'
        '<child link="wheel_link"/></joint></robot>'
    )


@pytest.fixture
def checked(tmp_path: Path, robot: Robot) -> Checked:
    def run(text: str) -> list[Problem]:
        file = tmp_path / "c.rviz"
        file.write_text(text)
        return check_config(robot, RvizConfig.load(file, Declarations()))

    return run


def test_a_config_that_fits_has_no_problems(checked: Checked) -> None:
    assert checked(GOOD) == []


def test_a_misspelt_class_is_the_only_finding(checked: Checked) -> None:
    (problem,) = checked(GOOD.replace("plugins/RobotModel", "plugins/RobotModle"))
    assert problem.code == "config-class"
    assert problem.line == 3
    assert problem.hint == "write rviz_default_plugins/RobotModel"
    other = GOOD.replace("  Global", "    - Class: my_plugins/RobotModels\n  Global")
    assert checked(other) == []


def test_a_class_that_is_called_after_its_message_is_corrected(
    checked: Checked,
) -> None:
    grid = "    - Class: rviz_default_plugins/OccupancyGrid\n  Global"
    (problem,) = checked(GOOD.replace("  Global", grid))
    assert (problem.code, problem.line) == ("config-class", 10)
    assert problem.hint == "write rviz_default_plugins/Map"
    assert checked(GOOD.replace("  Global", grid.replace("_default", "_my"))) == []


def test_a_robot_without_shapes_is_noted(checked: Checked) -> None:
    off = GOOD.replace(
        "Name: RobotModel", "Name: RobotModel\n      Visual Enabled: false"
    )
    (problem,) = checked(off)
    assert (problem.severity, problem.line) == ("info", 10)
    assert problem.hint == "write Visual Enabled: true"
    assert checked(off.replace("Visual Enabled: false", BOTH)) == []


def test_a_fixed_frame_that_does_not_exist_is_pointed_at(checked: Checked) -> None:
    (problem,) = checked(GOOD.replace("Frame: base_link", "Frame: map"))

    assert problem.code == "setup-fixed-frame"
    assert problem.severity == "warning"
    assert (problem.line, problem.column) == (11, 18)
    assert problem.hint == "choose base_link, the root of this robot"


def test_a_fixed_frame_that_was_typed_is_in_no_line_of_the_file(
    robot: Robot, tmp_path: Path
) -> None:
    file = tmp_path / "c.rviz"
    file.write_text(GOOD)
    config = RvizConfig.load(file, Declarations())
    config.global_options.set("Fixed Frame", "mapp")
    (problem,) = check_config(robot, config)
    assert problem.code == "setup-fixed-frame" and "mapp" in problem.message
    assert (problem.file, problem.line) == (None, None)


def test_a_leading_slash_of_the_fixed_frame_does_not_matter(checked: Checked) -> None:
    assert checked(GOOD.replace("Frame: base_link", "Frame: /base_link")) == []


def test_a_volatile_description_is_pointed_at(checked: Checked) -> None:
    (problem,) = checked(GOOD.replace("Transient Local", "Volatile"))

    assert problem.code == "setup-description-volatile"
    assert problem.line == 6


def test_what_rviz_itself_saves_is_no_problem(checked: Checked) -> None:
    volatile = GOOD.replace("Transient Local", "Volatile")
    rest = "History Policy: Keep Last\n        Reliability Policy: Reliable"
    saved = volatile.replace("Depth: 1", f"Depth: 5\n        {rest}")

    assert checked(saved) == []
    assert checked(saved.replace("Reliability Policy: Reliable", "Filter size: 10"))
    assert checked(saved.replace("Depth: 5", "Depth: 1"))


def test_a_description_from_another_topic_is_pointed_at(checked: Checked) -> None:
    (problem,) = checked(GOOD.replace("/robot_description", "/robot"))

    assert problem.code == "setup-description-topic"
    assert problem.line == 7


def test_a_display_in_a_group_is_found(checked: Checked) -> None:
    listed = GOOD.replace("Transient Local", "Volatile").splitlines(keepends=True)
    inner = [f"    {line}" for line in listed[2:9]]
    group = "    - Class: rviz_common/Group\n      Name: G\n      Displays:\n"

    (problem,) = checked("".join([*listed[:2], group, *inner, *listed[9:]]))

    assert problem.line == 9


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (GOOD.replace("Enabled: true", "Enabled: false"), "switched off"),
        (GOOD.replace("/RobotModel", "/Grid"), "missing"),
    ],
)
def test_a_config_without_a_robot_model_is_reported(
    checked: Checked, text: str, said: str
) -> None:
    (problem,) = checked(text)

    assert problem.severity == "info"
    assert said in problem.message


@pytest.mark.parametrize(
    ("name", "line", "word"),
    [
        ("fixed-frame-map.rviz", 11, "map"),
        ("description-topic-volatile.rviz", 6, "Volatile"),
    ],
)
def test_the_bad_configs_of_the_collection_are_explained(
    shared: Path, robot: Robot, name: str, line: int, word: str
) -> None:
    folder = shared / "data" / "bad-models" / "launch"
    config = RvizConfig.load(folder / name, Declarations())

    (problem,) = check_config(robot, config)

    assert problem.severity == "warning"
    assert problem.line is not None
    assert abs(problem.line - line) <= 1
    assert word in problem.message


def test_a_robot_with_alpha_zero_is_invisible(checked: Checked) -> None:
    named = "Name: RobotModel\n      Alpha: {}"
    for alpha, count in (("0", 1), ("0.0", 1), ("0.6", 0)):
        found = checked(GOOD.replace("Name: RobotModel", named.format(alpha)))
        assert len([p for p in found if p.hint == "write Alpha: 1"]) == count
