"""From a model file to a `Robot`: no viser, no socket, no thread."""

from sambot_viz.robot.load import expand, load_robot

__all__ = ["expand", "load_robot"]
