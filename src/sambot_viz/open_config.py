"""Reading a .rviz file with the properties of every display and view we know."""

from __future__ import annotations

from functools import cache
from pathlib import Path

from sambot_viz.displays.registry import DISPLAYS
from sambot_viz.rviz import Declarations, RvizConfig
from sambot_viz.tools.registry import TOOLS
from sambot_viz.views.registry import VIEWS


@cache
def declarations() -> Declarations:
    """What displays, views and tools declare, for the .rviz document."""
    return Declarations(
        displays={kind: display.properties for kind, display in DISPLAYS.items()},
        views={kind: view.properties for kind, view in VIEWS.items()},
        tools={kind: tool.properties for kind, tool in TOOLS.items()},
    )


def load_config(path: Path | str) -> RvizConfig:
    """Read a .rviz file, of ROS 2 or ROS 1.

    Args:
        path: the file.

    Returns:
        The document; what is doubtful in it is in `.problems`, what we do not show
        is kept for saving.

    Raises:
        ConfigError: the file cannot be read, or is not a .rviz document.
    """
    return RvizConfig.load(Path(path), declarations())
