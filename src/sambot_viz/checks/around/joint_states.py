"""A launch file in which nobody publishes joint states."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from sambot_viz.checks.around.files.launch_values import keyword
from sambot_viz.checks.around.surroundings import Surroundings
from sambot_viz.checks.launch_files import call_name
from sambot_viz.checks.rule import listed
from sambot_viz.errors import Problem

_TRUE = frozenset({"true", "1"})


def no_joint_states(around: Surroundings) -> Iterator[Problem]:
    """Report a joint state publisher that does not start, as gui is true by default."""
    robot = around.known
    joints = [j.name for j in robot.joints.values() if j.movable] if robot else []
    for launch in around.launches:
        nodes = [c for c in launch.calls if call_name(c.func) == "Node"]
        started = {_text(keyword(n, "executable")) for n in nodes}
        if "joint_state_publisher_gui" in started:
            continue
        for node in nodes:
            if _text(keyword(node, "executable")) != "joint_state_publisher":
                continue
            argument = _unless(keyword(node, "condition"))
            if argument is None or not _is_true_by_default(launch.calls, argument):
                continue
            stays = listed(joints) or "every movable joint"
            verb = "stay" if len(joints) > 1 else "stays"
            yield Problem.at(
                launch.place(node),
                "warning",
                "launch-no-joint-states",
                f"no node publishes joint states here: {argument} is true, so "
                "joint_state_publisher does not start, and no "
                f"joint_state_publisher_gui node is listed; {stays} {verb} without a "
                "transform",
                "add the joint_state_publisher_gui node, or run with "
                f"{argument}:=False",
            )


def _unless(condition: ast.expr | None) -> str | None:
    """The argument in ``UnlessCondition(LaunchConfiguration("gui"))``."""
    if (
        not isinstance(condition, ast.Call)
        or call_name(condition.func) != "UnlessCondition"
    ):
        return None
    inner = condition.args[0] if condition.args else None
    if isinstance(inner, ast.Call) and call_name(inner.func) == "LaunchConfiguration":
        return _text(inner.args[0]) if inner.args else None
    return None


def _is_true_by_default(calls: list[ast.Call], argument: str) -> bool:
    for call in calls:
        if call_name(call.func) != "DeclareLaunchArgument" or not call.args:
            continue
        if _text(call.args[0]) == argument:
            default = _text(keyword(call, "default_value")) or ""
            return default.strip().lower() in _TRUE
    return False


def _text(node: ast.expr | None) -> str | None:
    if isinstance(node, ast.Constant) and isinstance(node.value, str):
        return node.value
    return None
