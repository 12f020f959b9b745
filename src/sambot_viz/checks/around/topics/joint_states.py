"""Report joint states without a publisher, in launch files and at bridges."""

from __future__ import annotations

from collections.abc import Iterator

from sambot_viz.checks.around.gazebo.systems import attributes, near_system
from sambot_viz.checks.around.launching.actions import LaunchArgument, Operation
from sambot_viz.checks.around.place import where
from sambot_viz.checks.around.running.bridge_entries import bare
from sambot_viz.checks.around.surroundings import Surroundings
from sambot_viz.checks.rule import listed
from sambot_viz.errors import Problem

_SENDER = "joint-state-publisher-system"
_TRUE = frozenset({"true", "1"})


def no_joint_states(around: Surroundings) -> Iterator[Problem]:
    """Report a joint state publisher that does not start, as gui is true by default."""
    robot = around.known
    joints = [j.name for j in robot.joints.values() if j.movable] if robot else []
    for launch in around.launches:
        nodes = [call for call in launch.calls if call.name == "Node"]
        started = {launch.text(node, "executable") for node in nodes}
        if "joint_state_publisher_gui" in started:
            continue
        for node in nodes:
            if launch.text(node, "executable") != "joint_state_publisher":
                continue
            match node.condition:
                case Operation("not", (LaunchArgument(name=str(argument)),)):
                    pass
                case _:
                    continue
            default = launch.values.defaults.get(argument, "")
            if default.strip().lower() not in _TRUE:
                continue
            stays = listed(joints) or "every movable joint"
            verb = "stay" if len(joints) > 1 else "stays"
            yield Problem.at(
                node.place,
                "warning",
                "launch-no-joint-states",
                f"no node publishes joint states here: {argument} is true, so "
                "joint_state_publisher does not start, and no "
                f"joint_state_publisher_gui node is listed; {stays} {verb} without a "
                "transform",
                "add the joint_state_publisher_gui node, or run with "
                f"{argument}:=False",
            )


def unsent_joint_states(around: Surroundings) -> Iterator[Problem]:
    """Report a bridge for joint states without a plugin that sends them."""
    drives = [p for p in around.plugins if p.is_drive and p.generation == "gz"]
    if not drives or any("ros2_control" in p.filename for p in around.plugins):
        return
    if any(near_system(plugin.filename) for plugin in around.plugins):
        # One of them may misspell the intended plugin.
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
