"""Services of nodes over DDS: a topic with requests, and one with the answers.

Cyclone DDS writes before each whose call it is. Fast DDS says that beside the message,
where cyclonedds does not look: so one call at a time waits for the next answer.
"""

from __future__ import annotations

import asyncio
import struct
from collections import deque
from collections.abc import Callable

from sambot_viz.errors import SourceError
from sambot_viz.sources.dds import names
from sambot_viz.sources.dds.ends import SETTLED
from sambot_viz.sources.dds.participant import DdsParticipant
from sambot_viz.sources.dds.raw import unfilled
from sambot_viz.sources.live.service_calls import LONGEST_ANSWER
from sambot_viz.sources.qos import Qos
from sambot_viz.sources.ros_endpoint import RosEndpoint
from sambot_viz.sources.ros_graph import mangled
from sambot_viz.text import text

_HEAD = 4
"""The bytes of CDR before the fields."""
_LOOK = 0.02
"""Between two looks whether a service is found [s]."""

OnAnswer = Callable[[int, bytes], object]


class DdsServices:
    """Calls services, each over two topics that stay once it was called.

    Args:
        participant: that calls.
        answered: called with the number of a call and its answer.
    """

    def __init__(self, participant: DdsParticipant, answered: OnAnswer) -> None:
        self._participant = participant
        self._answered = answered
        self._callers: dict[str, _Caller] = {}

    def call(
        self, number: int, service: RosEndpoint, vendor: bytes, content: bytes
    ) -> None:
        """Call a service.

        Args:
            number: of the call.
            service: that is there.
            vendor: with what the id of its participant begins.
            content: the request as CDR.

        Raises:
            SourceError: its middleware is not known.
        """
        if vendor not in (names.CYCLONE, names.EPROSIMA):
            raise SourceError(
                f"{text(service.name, 80)} is of a middleware whose services are not "
                "known here: only those of rmw_fastrtps_cpp and rmw_cyclonedds_cpp are"
            )
        caller = self._callers.get(service.name)
        if caller is None:
            caller = self._callers[service.name] = _Caller(
                self._participant, service, vendor == names.CYCLONE, self._answered
            )
        caller.call(number, content)


class _Caller:
    """Calls one service."""

    def __init__(
        self,
        participant: DdsParticipant,
        service: RosEndpoint,
        has_header: bool,
        answered: OnAnswer,
    ) -> None:
        self._participant = participant
        self._has_header = has_header
        self._answered = answered
        self._waiting: deque[tuple[int, bytes, float]] = deque()
        self._asked: deque[tuple[int, float]] = deque()
        self._is_settled = False
        kind, qos = mangled(service.type_name), Qos("reliable", "volatile")
        self._reader = participant.subscribe(
            names.reply_topic(service.name),
            f"{kind}Response_",
            qos,
            self._take,
            lambda size: None,
        )
        self._writer = participant.publisher(
            names.request_topic(service.name), f"{kind}Request_", service.type_hash
        )
        self._loop = asyncio.get_running_loop()
        self._id = self._writer.id[8:]

    def call(self, number: int, content: bytes) -> None:
        """Send a request, as soon as the service has found this."""
        is_first = not self._waiting
        self._waiting.append((number, content, self._loop.time() + LONGEST_ANSWER))
        if is_first:
            self._send_waiting()

    def _send_waiting(self) -> None:
        """Send what may be sent now, and look again for the rest."""
        now = self._loop.time()
        for queue in (self._waiting, self._asked):
            # What has waited for so long was given up.
            while queue and queue[0][-1] < now:
                queue.popleft()
        if self._participant.is_closed or not self._waiting:
            return
        if not self._is_settled:
            self._is_settled = self._reader.is_matched
            self._loop.call_later(
                SETTLED if self._is_settled else _LOOK, self._send_waiting
            )
            return
        while self._waiting and (self._has_header or not self._asked):
            number, content, due = self._waiting.popleft()
            self._asked.append((number, due))
            if self._has_header:
                header = self._id + struct.pack("<q", number)
                content = content[:_HEAD] + header + content[_HEAD:]
            self._writer.put(content)
        if self._waiting:
            self._loop.call_later(_LOOK, self._send_waiting)

    def _take(self, content: bytes, handle: int, stamp: int) -> None:
        del handle, stamp
        content = unfilled(content)
        if self._has_header:
            end = _HEAD + len(self._id) + 8
            if content[_HEAD : end - 8] != self._id or len(content) < end:
                return
            (number,) = struct.unpack("<q", content[end - 8 : end])
            self._answered(number, content[:_HEAD] + content[end:])
        elif self._asked:
            number, _ = self._asked.popleft()
            self._answered(number, content)
