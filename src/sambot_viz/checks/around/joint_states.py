"""A launch file in which nobody publishes joint states."""

from __future__ import annotations

from collections.abc import Iterator

from sambot_viz.checks.around.launching.actions import LaunchArgument, Operation
from sambot_viz.checks.around.surroundings import Surroundings
from sambot_viz.checks.rule import listed
from sambot_viz.errors import Problem

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
