"""From a model file to a `Robot`: no viser, no socket, no thread.

The loading is imported when it is first used: the page has to be there before it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from sambot_viz.robot.load import expand, load_robot

__all__ = ["expand", "load_robot"]


def __getattr__(name: str) -> Any:
    if name not in __all__:
        raise AttributeError(f"module 'sambot_viz.robot' has no attribute '{name}'")
    from sambot_viz.robot import load

    return getattr(load, name)
