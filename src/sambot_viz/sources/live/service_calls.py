"""Calls of services over one connection, until they are answered."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

from sambot_viz import limits
from sambot_viz.errors import SourceError
from sambot_viz.sources.source import OnReply, Reply
from sambot_viz.text import text

LONGEST_ANSWER = 8.0
"""A service that has not answered by then is given up [s]."""


@dataclass(slots=True)
class _Call:
    service: str
    answered: OnReply
    # Its time begins at the next tick.
    due: float = 0.0


class CallSender(Protocol):
    """What sends a call to a peer."""

    def __call__(self, number: int, service: str, request: bytes) -> object:
        """Send it.

        Raises:
            SourceError: the peer has no such service.
        """
        ...


class ServiceCalls:
    """Calls that wait for their answers; used in the thread of the connection.

    Args:
        send: sends a call.
        encoding: how answers are written.
    """

    def __init__(self, send: CallSender, encoding: str) -> None:
        self._send = send
        self._encoding = encoding
        self._calls: dict[int, _Call] = {}
        self._count = 0

    def call(self, service: str, request: bytes, answered: OnReply) -> None:
        """Call a service; `answered` is called once, whatever happens."""
        if len(self._calls) >= limits.CALLS.value:
            return _refuse(answered, f"too many calls wait for answers: {service}")
        self._count += 1
        self._calls[self._count] = _Call(service, answered)
        try:
            self._send(self._count, service, request)
        except SourceError as error:
            self.fail(self._count, str(error))

    def take(self, number: int, content: bytes) -> bool:
        """Take an answer; return whether it was asked for."""
        found = self._calls.pop(number, None)
        if found is not None:
            found.answered(Reply(content, self._encoding == "json"))
        return found is not None

    def fail(self, number: int, why: str) -> bool:
        """Take the words in which a call was refused; as `take`."""
        found = self._calls.pop(number, None)
        if found is not None:
            _refuse(found.answered, why)
        return found is not None

    def tick(self, now: float) -> None:
        """Give up what waits for too long; `now` is monotonic [s]."""
        for number, call in list(self._calls.items()):
            if call.due == 0.0:
                call.due = now + LONGEST_ANSWER
            elif call.due < now:
                self.fail(number, f"{text(call.service, 120)} does not answer")

    def end(self) -> None:
        """The connection has ended: nothing is answered any longer."""
        for number in list(self._calls):
            self.fail(number, "the connection was lost")


def _refuse(answered: OnReply, why: str) -> None:
    answered(Reply(b"", refusal=why))
