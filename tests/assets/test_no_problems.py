"""What the program brings along gives no reason to complain."""

from __future__ import annotations

import pytest
from patience import patience

from sambot_viz import Visualizer, bundled
from sambot_viz.checks import check
from sambot_viz.checks.config_against_robot import check_config
from sambot_viz.inputs import load_config
from sambot_viz.robot.model import load_robot

MODELS = {"mbot.rviz": "mbot.urdf.xacro", "urdf_config.rviz": "sam_bot.urdf.xacro"}

REMARKS = {"sam_bot_collision.urdf.xacro": ["inertia-on-root"]}
"""The tutorial's step with inertias has one on its root, which KDL remarks upon."""


@pytest.mark.parametrize("name", bundled.model_names())
def test_a_bundled_model_gives_no_remark_but_the_one_that_is_true(name: str) -> None:
    problems = check(bundled.model_path(name))
    assert [problem.code for problem in problems] == REMARKS.get(name, [])


@pytest.mark.parametrize("name", bundled.config_names())
def test_a_bundled_config_fits_its_robot(name: str) -> None:
    config = load_config(bundled.config_path(name))
    robot = load_robot(bundled.model_path(MODELS[name]))
    assert config.problems == ()
    assert check_config(robot, config) == []


@pytest.mark.parametrize("config", [None, *MODELS])
def test_the_page_starts_without_a_problem_and_without_a_changed_setting(
    config: str | None,
) -> None:
    model = None if config is None else bundled.model_path(MODELS[config])
    path = None if config is None else bundled.config_path(config)
    with Visualizer(model, path) as viz:
        viz.server.sessions.wait_for_meshes(patience(20))
        (session,) = viz.server.sessions.all()
        assert session.problems.shown.value.listed == ()
        assert session.problems.shown.value.note == ""
        assert {display.status.level for display in session.scene.displays} == {"Ok"}
        assert session.scene.global_status().level == "Ok"
        assert not session.history.modified.value
