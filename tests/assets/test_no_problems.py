"""What the program brings along gives no reason to complain."""

from __future__ import annotations

import pytest

from sambot_viz import bundled
from sambot_viz.checks import check
from sambot_viz.checks.config_against_robot import check_config
from sambot_viz.open_config import load_config
from sambot_viz.robot import load_robot

MODELS = {"mbot.rviz": "mbot.urdf.xacro", "urdf_config.rviz": "sam_bot.urdf.xacro"}


@pytest.mark.parametrize("name", bundled.model_names())
def test_a_bundled_model_has_no_errors_and_no_warnings(name: str) -> None:
    problems = check(bundled.model_path(name))
    assert [p for p in problems if p.severity != "info"] == []


@pytest.mark.parametrize("name", bundled.config_names())
def test_a_bundled_config_fits_its_robot(name: str) -> None:
    config = load_config(bundled.config_path(name))
    robot = load_robot(bundled.model_path(MODELS[name]))
    assert config.problems == ()
    assert check_config(robot, config) == []
