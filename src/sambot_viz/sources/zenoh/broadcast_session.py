"""What a broadcast and its followers say over a session of zenoh."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, ClassVar, Protocol

from sambot_viz.sources.zenoh.readings import (
    OnSample,
    at_once,
    in_a_thread,
    waiting_room,
)
from sambot_viz.sources.zenoh.session import ZenohDeclaration, ZenohSession


class FramePublisher(Protocol):
    """Publishes on one key; what a line cannot take is dropped."""

    def put(self, payload: bytes, *, attachment: bytes) -> object:
        """Publish bytes, with some that say what they are."""
        ...


class BroadcastSession(ZenohSession):
    """A session with publishers, and questions that are answered with bytes."""

    # Memory that zenoh shares between programs of a machine takes 17 MB in each.
    settings: ClassVar = {"transport/shared_memory/enabled": False}

    def frames(self, key: str) -> FramePublisher:
        """Begin to publish on a key."""
        return self._session.declare_publisher(key)

    def take_frames(
        self, key: str, most: int, take: OnSample, on_large: Callable[[int], Any]
    ) -> None:
        """Take what is published on a key from now on.

        Args:
            key: as of `frames`.
            most: so many wait until they are taken; the oldest give way.
            take: gets them.
            on_large: gets the size of those that are too large [bytes].
        """
        subscriber = self._session.declare_subscriber(key, waiting_room(most))
        self._readings.add(subscriber, take, on_large)

    def on_question(
        self, key: str, asked: Callable[[Callable[[bytes], object]], object]
    ) -> ZenohDeclaration:
        """Take questions from now on.

        Args:
            key: that is asked for.
            asked: called with what answers the question, which takes its time.
        """

        def take(query: Any) -> None:
            def answer(content: bytes) -> None:
                with query:
                    query.reply(key, content)

            self._post(lambda: asked(answer))

        return self._session.declare_queryable(key, at_once(take), complete=True)

    def ask(
        self,
        key: str,
        timeout: float,
        answered: Callable[[bytes], object],
        ended: Callable[[], object],
    ) -> None:
        """Ask who answers questions of a key.

        Args:
            key: as of `on_question`.
            timeout: how long an answer is waited for [s].
            answered: called with it.
            ended: called when no more comes.
        """

        def take(reply: Any) -> None:
            if reply.ok is not None:
                content = bytes(reply.ok.payload)
                self._post(lambda: answered(content))

        handler = in_a_thread(lambda: self._post(ended), take)
        self._session.get(key, handler, timeout=timeout)
