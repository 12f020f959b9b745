"""What stops a robot when the connection to it is lost, as far as it says so."""

from __future__ import annotations

from collections.abc import Callable, Collection, Sequence
from functools import partial

from sambot_viz.publishing.parameters import Value, get_parameters
from sambot_viz.sources.source import Receivers
from sambot_viz.text import text
from sambot_viz.topics.source_robot import SourceRobot

_TIMEOUTS = {
    "velocity_smoother": "velocity_timeout",
    "collision_monitor": "source_timeout",
}
"""Node of Nav2 that stops a robot when no velocities come → the parameter with its
timeout [s]."""
_NAMED = 2


class Protection:
    """Finds what stops a robot, and asks it after how long.

    Args:
        robot: a live one.
        told: called when an answer has come; in any thread, must only post.
    """

    def __init__(self, robot: SourceRobot, told: Callable[[], object]) -> None:
        self._robot, self._told = robot, told
        # Of each node that was asked; written in the thread of the source.
        self._after: dict[str, float | None] = {}

    def words(self, receivers: Receivers | None) -> str:
        """Return the node that stops the robot by itself.

        Args:
            receivers: the receivers of its velocities; None if unknown.
        """
        topics = self._robot.source.topics().values()
        named = [one.publishers for one in topics]
        nodes = {n for names in named if isinstance(names, tuple) for n in names}
        if receivers is not None and receivers.names:
            nodes.update(receivers.names)
        found = sorted(n for n in nodes if any(one in n for one in _TIMEOUTS))
        if not found:
            known = any(one is not None for one in named)
            seen = "nothing seen that stops it" if known else "its nodes are not known"
            return f"the robot may keep its last speed: {seen}"
        self._ask(found[:_NAMED])
        names = " and ".join(map(self._named, found[:_NAMED]))
        return f"{names} of the robot can stop it when it hears nothing"

    def _named(self, node: str) -> str:
        """Return a node with after how long it acts, where it has said so."""
        after = self._after.get(node)
        name = text(node, 60)
        if after is None:
            return name
        return f"{name} (after {after:g} s)" if after > 0.0 else f"{name} (off now)"

    def _ask(self, nodes: Collection[str]) -> None:
        """Ask nodes for their times, each once."""
        for node in nodes:
            if node not in self._after:
                self._after[node] = None
                name = next(_TIMEOUTS[one] for one in _TIMEOUTS if one in node)
                take, types = partial(self._take, node), self._robot.decoding.types
                get_parameters(self._robot.source, node, [name], types, take)

    def _take(self, node: str, values: Sequence[Value | None], why: str) -> None:
        # A node that does not say it is named without a time.
        del why
        if isinstance(values[0], int | float):
            self._after[node] = float(values[0])
            self._told()
