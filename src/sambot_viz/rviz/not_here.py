"""Name the tools of a config that come with packages of RViz."""

from __future__ import annotations

from sambot_viz.errors import Problem
from sambot_viz.rviz.rviz_config import RvizConfig
from sambot_viz.text import text


def tools_not_here(config: RvizConfig) -> tuple[Problem, ...]:
    """Return the sentence for a page about tools of a config that do not exist here.

    Displays that do not exist here have a row with a note instead.
    """
    missing = [text(tool.class_id) for tool in config.tools if not tool.supported]
    if not missing:
        return ()
    return (
        Problem(
            "info",
            "config-tools",
            "tools of this config that do not exist here: "
            f"{', '.join(dict.fromkeys(missing))}: they come with packages of RViz",
            "nothing has to be done: they stay in the file, for RViz",
            config.file,
        ),
    )
