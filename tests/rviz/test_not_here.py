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


def test_tools_of_other_packages_are_named_once_by_their_class(
    tmp_path: Path,
) -> None:
    tools = ("lab_tools/Paint", "rviz_default_plugins/Select", "lab_tools/Paint")
    (message,) = said(tmp_path, *tools)

    assert message == (
        "tools of this config that do not exist here: lab_tools/Paint: they come with "
        "packages of RViz"
    )


@pytest.mark.parametrize("package", ["rviz_default_plugins", "rviz"])
def test_of_tools_that_are_here_nothing_is_said(tmp_path: Path, package: str) -> None:
    here = ("Interact", "MoveCamera", "Select", "FocusCamera", "Measure")
    sending = ("SetInitialPose", "SetGoal", "PublishPoint")
    own = (f"{package}/{tool}" for tool in (*here, *sending))
    assert said(tmp_path, *own, "nav2_rviz_plugins/GoalTool") == []
    assert said(tmp_path) == []
