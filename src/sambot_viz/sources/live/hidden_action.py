"""Goals of an action by its hidden services and topics, where a server shows those."""

from __future__ import annotations

import threading
from contextlib import suppress
from functools import cache, partial
from typing import Any
from uuid import uuid4

from sambot_viz.errors import DecodeError, SourceError
from sambot_viz.messages import MessageTypes, Schema
from sambot_viz.sources.action_names import (
    cancel_service,
    feedback_topic,
    result_service,
    send_service,
    status_topic,
)
from sambot_viz.sources.live.followed_goal import FollowedGoals
from sambot_viz.sources.message import Recorded
from sambot_viz.sources.source import (
    GOAL_ENDS,
    CancelGoal,
    Encoding,
    GoalReport,
    OnReport,
    Reply,
    Source,
)

_HEAD = 4
"""The bytes of CDR before the fields."""
_ANSWER = Schema(
    "sambot_viz/SendGoal_Response",
    "ros2msg",
    "bool accepted\nbuiltin_interfaces/Time stamp",
)


@cache
def _types() -> MessageTypes:
    return MessageTypes()


class HiddenAction:
    """Implements `OutgoingAction` by what any source can do.

    Args:
        name: of the action.
        type_name: of the action.
        source: shows the services and topics of the action, in CDR.
        goals: of the connection.
    """

    encoding: Encoding = "cdr"
    frame_prefix = ""

    def __init__(
        self, name: str, type_name: str, source: Source, goals: FollowedGoals
    ) -> None:
        self.name, self.type_name = name, type_name
        self._source, self._goals = source, goals

    def send(self, goal: bytes, told: OnReport) -> CancelGoal:
        """Send a goal once; see `OutgoingAction.send`."""
        made = _HiddenGoal(self.name, self._source, told, self._goals)
        self._goals.add(made)
        made.send(goal)
        return made.cancel


class _HiddenGoal:
    """A goal by its id, which is made here; its services and topics say it again."""

    def __init__(
        self,
        action: str,
        source: Source,
        told: OnReport,
        goals: FollowedGoals,
    ) -> None:
        self._action, self._source = action, source
        self._told, self._goals = told, goals
        self._id = uuid4().bytes
        self._status = 0
        self._is_over = self._wants_cancel = False
        # Answers and messages come in two threads.
        self._lock = threading.Lock()

    def send(self, goal: bytes) -> None:
        """Send it.

        Raises:
            SourceError: the connection has ended.
        """
        # The id has 16 bytes, so the fields after it are aligned as without it.
        request = goal[:_HEAD] + self._id + goal[_HEAD:]
        for topic in self._topics:
            self._source.subscribe(topic, self._take)
        service = send_service(self._action)
        try:
            self._source.call(service, lambda encoding: request, self._answered)
        except SourceError:
            self._is_over = True
            self._leave()
            raise

    def cancel(self) -> None:
        """Ask the robot to cancel it."""
        self._wants_cancel = True
        fields = {"goal_info": {"goal_id": self._uuid}}
        text = "action_msgs/GoalInfo goal_info"
        with suppress(SourceError):
            write = partial(_written, "CancelGoal_Request", text, fields)
            service = cancel_service(self._action)
            self._source.call(service, write, lambda reply: None)

    def leave(self, why: str) -> None:
        """Follow it no further."""
        self._report(GoalReport(refusal=why))

    @property
    def _uuid(self) -> dict[str, Any]:
        return {"uuid": [*self._id]}

    @property
    def _topics(self) -> tuple[str, str]:
        return status_topic(self._action), feedback_topic(self._action)

    def _answered(self, reply: Reply) -> None:
        """Take what the service says to the goal."""
        if reply.refusal:
            self._report(GoalReport(refusal=reply.refusal))
            return
        try:
            is_taken = _types().decoder(_ANSWER, "cdr").decode(reply.content).accepted
        except DecodeError as error:
            self._report(GoalReport(refusal=f"its answer makes no sense: {error}"))
            return
        if not is_taken:
            self._report(GoalReport(refusal="the robot rejects it"))
        elif self._wants_cancel:
            # It may have been asked before it had the goal.
            self.cancel()

    def _take(self, message: Recorded) -> None:
        """Take a message of one of its topics."""
        status, feedback = self._topics
        if message.topic == feedback:
            if message.payload[_HEAD : _HEAD + len(self._id)] == self._id:
                self._report(GoalReport(self._status, feedback=message))
        elif message.topic == status:
            self._take_status(message)

    def _take_status(self, message: Recorded) -> None:
        channel = message.channel
        decoder = _types().decoder(channel.schema, channel.message_encoding)
        try:
            every = decoder.decode(message.payload).status_list
            told = {bytes(one.goal_info.goal_id.uuid): int(one.status) for one in every}
        except (DecodeError, AttributeError):
            return
        status = told.get(self._id, self._status)
        if status == self._status:
            return
        self._status = status
        if status in GOAL_ENDS:
            self._ask_result()
        else:
            self._report(GoalReport(status))

    def _ask_result(self) -> None:
        """Ask how it has ended, and say so, with the answer or without."""
        status = self._status

        def answered(reply: Reply) -> None:
            self._report(GoalReport(status, result=None if reply.refusal else reply))

        text, fields = "unique_identifier_msgs/UUID goal_id", {"goal_id": self._uuid}
        write = partial(_written, "GetResult_Request", text, fields)
        try:
            self._source.call(result_service(self._action), write, answered)
        except SourceError:
            self._report(GoalReport(status))

    def _report(self, report: GoalReport) -> None:
        with self._lock:
            if self._is_over:
                return
            self._is_over = report.is_last
        if report.is_last:
            self._leave()
        self._told(report)

    def _leave(self) -> None:
        for topic in self._topics:
            self._source.unsubscribe(topic, self._take)
        self._goals.discard(self)


def _written(name: str, text: str, fields: dict[str, Any], encoding: Encoding) -> bytes:
    """Return a request as CDR, which is what the bridges of hidden services take."""
    del encoding
    return _types().shape(f"sambot_viz/{name}", text).as_cdr(fields)
