"""What is said of tools of a config that this program does not have."""

from __future__ import annotations

from pathlib import Path

import pytest

from sambot_viz.inputs import load_config
from sambot_viz.rviz.not_here import tools_not_here

_CONFIG = "Visualization Manager:\n  Displays: []\n  Tools:\n{}"


def said(folder: Path, *tools: str) -> list[str]:
    path = folder / "own.rviz"
    path.write_text(_CONFIG.format("".join(f"    - Class: {t}\n" for t in tools)))
    return [problem.message for problem in tools_not_here(load_config(path))]


@pytest.mark.parametrize("package", ["rviz_default_plugins", "rviz"])
def test_tools_that_publish_are_named_once_as_in_the_toolbar_of_rviz(
    tmp_path: Path, package: str
) -> None:
    tools = ("Interact", "SetInitialPose", "SetGoal", "PublishPoint", "SetGoal")
    (message,) = said(tmp_path, *(f"{package}/{tool}" for tool in tools))

    assert message == (
        "tools of this config that do not exist here: 2D Pose Estimate, 2D Goal Pose, "
        "Publish Point: they send messages to a robot, and this program sends none"
    )


def test_tools_of_other_packages_are_named_by_their_class(tmp_path: Path) -> None:
    (message,) = said(tmp_path, "lab_tools/Paint", "nav2_rviz_plugins/GoalTool")

    assert "Nav2 Goal: they send messages" in message
    assert message.endswith("lab_tools/Paint: they come with packages of RViz")


def test_of_tools_that_are_here_nothing_is_said(tmp_path: Path) -> None:
    here = ("Interact", "MoveCamera", "Select", "FocusCamera", "Measure")
    assert said(tmp_path, *(f"rviz_default_plugins/{tool}" for tool in here)) == []
    assert said(tmp_path) == []
