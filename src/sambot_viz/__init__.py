"""A web visualiser for URDF and xacro robots: no ROS, no X server.

The public names; each is loaded when it is first used, so that ``import sambot_viz``
costs nothing and `check` needs neither viser nor a mesh library.
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

from sambot_viz._version import __version__

if TYPE_CHECKING:
    from sambot_viz.checks import check
    from sambot_viz.errors import (
        ConfigError,
        FrameError,
        JointError,
        Problem,
        RobotError,
        SambotVizError,
        ServerError,
        UsageError,
    )
    from sambot_viz.frames import Transform
    from sambot_viz.open_config import load_config
    from sambot_viz.robot import load_robot
    from sambot_viz.robot.joint import Joint
    from sambot_viz.robot.model import Link, Robot
    from sambot_viz.rviz import RvizConfig
    from sambot_viz.visualizer import Visualizer

_HOMES = {
    "ConfigError": "errors",
    "FrameError": "errors",
    "Joint": "robot.joint",
    "JointError": "errors",
    "Link": "robot.model",
    "Problem": "errors",
    "Robot": "robot.model",
    "RobotError": "errors",
    "RvizConfig": "rviz",
    "SambotVizError": "errors",
    "ServerError": "errors",
    "Transform": "frames",
    "UsageError": "errors",
    "Visualizer": "visualizer",
    "check": "checks",
    "load_config": "open_config",
    "load_robot": "robot",
}

__all__ = [
    "ConfigError",
    "FrameError",
    "Joint",
    "JointError",
    "Link",
    "Problem",
    "Robot",
    "RobotError",
    "RvizConfig",
    "SambotVizError",
    "ServerError",
    "Transform",
    "UsageError",
    "Visualizer",
    "__version__",
    "check",
    "load_config",
    "load_robot",
]


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"module 'sambot_viz' has no attribute '{name}'")
    module = importlib.import_module(f"sambot_viz.{_HOMES[name]}")
    return getattr(module, name)


def __dir__() -> list[str]:
    return list(__all__)
