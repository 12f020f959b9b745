"""Statuses of a RobotModel that one value of a property would make go away."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from sambot_viz.displays.display import DisplayContext, Status
from sambot_viz.displays.robot_display import Repair
from sambot_viz.displays.robot_model.robot_source import TOPIC, RobotSource
from sambot_viz.frames.frame_prefix import other_prefix
from sambot_viz.frames.hierarchy import plain_name
from sambot_viz.rviz import DisplayConfig
from sambot_viz.text import capitalized
from sambot_viz.topics.name_spaces import space_of

PREFIX = "TF Prefix"


def topic_status(source: RobotSource) -> dict[str, Status]:
    """Return the row of "Description Topic", where messages come."""
    described = source.described
    if described is None:
        return {}
    return {"Topic": Status(described.level, described.sentence)}


def meant_prefix(
    context: DisplayContext, source: RobotSource, frame_of: Callable[[str], str]
) -> str | None:
    """Return the TF Prefix with which the links are frames; None if they are.

    Args:
        context: has the frames.
        source: of the robot.
        frame_of: link → frame, with the present prefix.
    """
    if source.robot is None or source.is_kept_apart:
        return None
    space = "" if source.described is None else space_of(source.described.topic)
    links = dict.fromkeys(map(plain_name, source.robot.links))
    return other_prefix(
        links.keys(), map(frame_of, links), context.tree.frames, space.removeprefix("/")
    )


def prefix_status(config: DisplayConfig, root: str, prefix: str) -> Status:
    """Say that the frames of a robot have another prefix than its TF Prefix.

    Args:
        config: the display.
        root: the root link.
        prefix: what they have.
    """
    now = str(config.get(PREFIX))
    wanted = f"{now}/{root}" if now else root
    there = f"{prefix}/{root}" if prefix else root
    carry = f"carry the prefix {prefix}" if prefix else "carry no prefix"
    text = f"All frames of the robot {carry} ({there} instead of {wanted}): "
    return Status("Error", text + _to_do(prefix))


def repairs(prefix: str | None, source: RobotSource) -> Mapping[str, Repair]:
    """Return the values that would help, by keys of the status.

    Args:
        prefix: the TF Prefix that is meant; None for the present one.
        source: of the robot.
    """
    found: dict[str, Repair] = {}
    if source.described is not None and source.described.instead:
        instead = source.described.instead
        found["Topic"] = Repair(f"Use {instead}", TOPIC, instead)
    if prefix is not None:
        action = _to_do(prefix)
        found[PREFIX] = Repair(capitalized(action), PREFIX, prefix)
    return found


def _to_do(prefix: str) -> str:
    return f"set TF Prefix to {prefix}" if prefix else "clear TF Prefix"
