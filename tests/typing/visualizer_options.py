# pyright: strict, reportUnnecessaryTypeIgnoreComment=true
"""What a type checker reports about the arguments of `Visualizer`.

pyright checks this file (`bash tests/run`); nothing runs it. An `ignore` that pyright
does not need is an error here, so each line shows that a mistake is found.
"""

from __future__ import annotations

from pathlib import Path

from sambot_viz import Robot, Visualizer


def right(robot: Robot) -> None:
    """Arguments that are accepted."""
    Visualizer()
    Visualizer("arm.urdf", "arm.rviz", port=0)
    Visualizer(model=Path("arm.urdf"), joint_positions={"elbow": 1.0}, watch=True)
    Visualizer(robot, session="private", static_transforms=["0 0 0 0 0 0 a b"])
    Visualizer(robot.to_yourdfpy())


def wrong() -> None:
    """Misspelled names and wrong types."""
    Visualizer(modle="arm.urdf")  # pyright: ignore[reportCallIssue]
    Visualizer(port="8080")  # pyright: ignore[reportArgumentType]
    Visualizer(session="privat")  # pyright: ignore[reportArgumentType]
    Visualizer(model=5)  # pyright: ignore[reportArgumentType]
    Visualizer(joint_positions={"elbow": "1"})  # pyright: ignore[reportArgumentType]
    Visualizer(start_pose=None)  # pyright: ignore[reportCallIssue]
    Visualizer("arm.urdf", None, {})  # pyright: ignore[reportCallIssue]
