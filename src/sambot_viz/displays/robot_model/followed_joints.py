"""The positions of the joints of a further robot, as messages bring them."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from sambot_viz import limits
from sambot_viz.displays.display import DisplayContext
from sambot_viz.topics.joint_states import JointStateTopics
from sambot_viz.topics.subscription import Subscription

_DEPTH_S = 1.0


class FollowedJoints:
    """Listens to the joints of a robot that is not the opened one.

    Args:
        context: has the messages, where some come.
        moved: called in the worker when joints have moved.
    """

    def __init__(self, context: DisplayContext, moved: Callable[[], None]) -> None:
        self._context = context
        self._moved = moved
        self._topics: tuple[str, ...] = ()
        self._subscription: Subscription | None = None
        self._states: JointStateTopics | None = None

    @property
    def last(self) -> Mapping[str, float]:
        """Joint → the last position that has come [rad or m]."""
        return {} if self._states is None else self._states.last

    def listen(self, topics: tuple[str, ...]) -> None:
        """Listen to these topics, and to no others."""
        messages = self._context.messages
        if topics == self._topics or messages is None:
            return
        if self._subscription is not None:
            messages.unsubscribe(self._subscription)
        self._topics, self._subscription, self._states = topics, None, None
        if topics:
            self._subscription = messages.subscribe(
                topics,
                self._take,
                depth_s=_DEPTH_S,
                size=limits.DISPLAY_WAITING.value,
                joints=True,
            )
            self._states = JointStateTopics(topics, self._subscription.decode)
            # Of a recording that stands still they wait already.
            self._take()

    def _take(self) -> None:
        if self._subscription is None or self._states is None:
            return
        has_jumped = self._subscription.is_outdated
        if has_jumped:
            self._states.clear()
        for message in self._subscription.drain():
            self._states.take(message)
        if self._states.changed() or has_jumped:
            self._moved()
