"""A web visualiser for URDF, SDF and xacro robots: no ROS, no X server.

The public names; each is loaded when it is first used, so that ``import sambot_viz``
costs nothing and `check` needs neither viser nor a mesh library.
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

from sambot_viz._version import __version__ as __version__

# Type checkers need the names as imports, the program as a table; a test compares them.
if TYPE_CHECKING:
    from sambot_viz.checks import check as check
    from sambot_viz.errors import ConfigError as ConfigError
    from sambot_viz.errors import FrameError as FrameError
    from sambot_viz.errors import JointError as JointError
    from sambot_viz.errors import LessonError as LessonError
    from sambot_viz.errors import Problem as Problem
    from sambot_viz.errors import RobotError as RobotError
    from sambot_viz.errors import SambotVizError as SambotVizError
    from sambot_viz.errors import ServerError as ServerError
    from sambot_viz.errors import UsageError as UsageError
    from sambot_viz.frames import Transform as Transform
    from sambot_viz.inputs import load_config as load_config
    from sambot_viz.lessons import Grade as Grade
    from sambot_viz.lessons import grade as grade
    from sambot_viz.robot.model import Robot as Robot
    from sambot_viz.robot.model import load_robot as load_robot
    from sambot_viz.robot.parts import Joint as Joint
    from sambot_viz.robot.parts import Link as Link
    from sambot_viz.rviz import RvizConfig as RvizConfig
    from sambot_viz.visualizer import Visualizer as Visualizer

_MODULES = {
    "checks": "check",
    "errors": "ConfigError FrameError JointError LessonError Problem RobotError "
    "SambotVizError ServerError UsageError",
    "frames": "Transform",
    "inputs": "load_config",
    "lessons": "Grade grade",
    "robot.model": "Robot load_robot",
    "robot.parts": "Joint Link",
    "rviz": "RvizConfig",
    "visualizer": "Visualizer",
}
_HOMES = {name: home for home, names in _MODULES.items() for name in names.split()}

_NAMES = sorted([*_HOMES, "__version__"])

__all__ = [*_NAMES]  # noqa: PLE0604  # pyright: ignore[reportUnsupportedDunderAll]


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"module 'sambot_viz' has no attribute '{name}'")
    module = importlib.import_module(f"sambot_viz.{_HOMES[name]}")
    return getattr(module, name)


def __dir__() -> list[str]:
    return _NAMES
