"""Joint states of Gazebo that a bridge is to carry, and that nobody sends."""

from __future__ import annotations

from collections.abc import Iterator

from sambot_viz.checks.around.place import where
from sambot_viz.checks.around.running.bridge_entries import bare
from sambot_viz.checks.around.surroundings import Surroundings
from sambot_viz.checks.around.systems import attributes, near_system
from sambot_viz.errors import Problem

_SENDER = "joint-state-publisher-system"


def unsent_joint_states(around: Surroundings) -> Iterator[Problem]:
    """Report a bridge for joint states, and no plugin that sends them there."""
    drives = [p for p in around.plugins if p.is_drive and p.generation == "gz"]
    if not drives or any("ros2_control" in p.filename for p in around.plugins):
        return
    if any(near_system(plugin.filename) for plugin in around.plugins):
        # One of them may be meant to.
        return
    carried = (e for e in around.bridged if e.kind == "Model")
    entry = next((e for e in carried if e.reaches_ros), None)
    if entry is None or entry.scoped:
        return
    topic = f"<topic>{bare(entry.gz.value)}</topic>"
    senders = [p for p in around.plugins if _SENDER in p.filename]
    if not senders:
        place = entry.gz.place
        yield Problem.at(
            place,
            "warning",
            "bridge-topic",
            f"the bridge carries {entry.gz.value}, but no plugin beside "
            f"{drives[0].filename} ({where(drives[0].element.place, place)}) sends the "
            "states of the joints: the wheels have no transform in ROS",
            f"add <plugin {attributes('joint-state-publisher')}>{topic}</plugin> "
            "beside that of the drive",
        )
    elif not any(sender.element.find("topic") for sender in senders):
        place = senders[0].element.place
        yield Problem.at(
            place,
            "warning",
            "bridge-topic",
            f"{senders[0].filename} has no <topic> and sends to one that Gazebo makes "
            f"up, but the bridge carries {entry.gz.value} "
            f"({where(entry.gz.place, place)})",
            f"add {topic} to the plugin",
        )
