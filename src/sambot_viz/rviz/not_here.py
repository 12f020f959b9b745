"""Name the tools of a config that exist in RViz and not in this program."""

from __future__ import annotations

from sambot_viz.errors import Problem
from sambot_viz.rviz.rviz_config import RvizConfig
from sambot_viz.text import text

_SENDING = {
    "SetInitialPose": "2D Pose Estimate",
    "SetGoal": "2D Goal Pose",
    "PublishPoint": "Publish Point",
    "GoalTool": "Nav2 Goal",
}
"""The last part of the class of a tool that publishes → its name in RViz's toolbar."""


def tools_not_here(config: RvizConfig) -> tuple[Problem, ...]:
    """Return what a page says of the tools of a config that it does not have.

    Displays that do not exist here have a row, which says so.
    """
    missing = [tool.class_id for tool in config.tools if not tool.supported]
    names = [name.rpartition("/")[2] for name in missing]
    sending = [_SENDING[name] for name in names if name in _SENDING]
    others = [
        text(full)
        for full, name in zip(missing, names, strict=True)
        if name not in _SENDING
    ]
    said: list[str] = []
    if sending:
        said.append(
            f"{_words(sending)}: they send messages to a robot, and this program sends "
            "none"
        )
    if others:
        said.append(f"{_words(others)}: they come with packages of RViz")
    if not said:
        return ()
    return (
        Problem(
            "info",
            "config-tools",
            f"tools of this config that do not exist here: {'; '.join(said)}",
            "nothing has to be done: they stay in the file, for RViz",
            config.file,
        ),
    )


def _words(names: list[str]) -> str:
    return ", ".join(dict.fromkeys(names))
