"""Goals of actions over rosbridge, each over its own connection.

By default rosbridge_suite reads nothing more of a connection until the goal that came
over it has ended, and in older ones a goal that was rejected never ends. Neither
velocities nor STOP can wait for that.
"""

from __future__ import annotations

import json
from functools import partial
from uuid import uuid4

from sambot_viz.errors import SourceError
from sambot_viz.messages import Schema
from sambot_viz.sources import rosbridge_wire as wire
from sambot_viz.sources.action_names import feedback_topic
from sambot_viz.sources.live.conversation import Ends
from sambot_viz.sources.live.followed_goal import FollowedGoals
from sambot_viz.sources.message import Recorded, TopicChannel
from sambot_viz.sources.source import (
    ABORTED,
    GOAL_ENDS,
    SUCCEEDED,
    CancelGoal,
    Encoding,
    GoalReport,
    OnReport,
    Reply,
)
from sambot_viz.sources.websocket.side_connection import SideConnection
from sambot_viz.text import text

_ID = "sambot-viz-goal-"
_NO_TYPE = "sambot_viz/action/None"
"""No robot has it: a server that sends goals answers that, and sends nothing."""
_EXECUTES = 2


class RosbridgeActions:
    """Knows to which actions a server sends goals, and sends them.

    Args:
        ends: of the connection over which the rest goes.
        goals: that were sent over the connection.
    """

    def __init__(self, ends: Ends, goals: FollowedGoals) -> None:
        self._ends, self._goals = ends, goals
        self._asked: set[str] = set()
        self._takes: set[str] = set()

    def ask(self, action: str) -> None:
        """Ask once whether the server sends goals to an action.

        That of ROS 2 Humble does not know the operation, and a list of allowed actions
        keeps others silent.
        """
        if action not in self._asked:
            self._asked.add(action)
            self._ends.send(wire.send_goal(_new_id(), action, _NO_TYPE, b"{}"))

    def take(self, answer: wire.GoalResult) -> None:
        """Take the answer to `ask`."""
        self._takes |= {answer.action} & self._asked

    def is_about_goal(self, line: wire.StatusLine) -> bool:
        """Return whether a line of the server is about a goal, or about `ask`."""
        return str(line.id).startswith(_ID)

    def action(self, name: str, type_name: str) -> RosbridgeAction:
        """Return an action.

        Raises:
            SourceError: the server sends no goals to it.
        """
        if name not in self._takes:
            raise SourceError(
                f"rosbridge at {self._ends.address.label} sends no goals to "
                f"{text(name, 80)}; that of ROS 2 Jazzy does, where its list of "
                "allowed actions has it"
            )
        return RosbridgeAction(name, type_name, self)

    def begin(self, goal: _RosbridgeGoal) -> None:
        """Send a goal; in the thread of the connection."""
        self._goals.add(goal)
        goal.begin()

    def new_goal(
        self, action: RosbridgeAction, fields: bytes, told: OnReport
    ) -> CancelGoal:
        """Have a goal sent, and return what cancels it."""
        goal = _RosbridgeGoal(action, fields, told, self._ends, self._goals)
        self._ends.post(partial(self.begin, goal))
        return partial(self._ends.post, goal.cancel)


class RosbridgeAction:
    """Implements `OutgoingAction`.

    Args:
        name: of the action.
        type_name: of the action.
        actions: of the server.
    """

    encoding: Encoding = "json"
    frame_prefix = ""

    def __init__(self, name: str, type_name: str, actions: RosbridgeActions) -> None:
        self.name, self.type_name = name, type_name
        self._actions = actions

    def send(self, goal: bytes, told: OnReport) -> CancelGoal:
        """Send a goal once; see `OutgoingAction.send`."""
        return self._actions.new_goal(self, goal, told)


class _RosbridgeGoal:
    """A goal with its connection; used in the thread of the main one."""

    def __init__(
        self,
        action: RosbridgeAction,
        fields: bytes,
        told: OnReport,
        ends: Ends,
        goals: FollowedGoals,
    ) -> None:
        self._action, self._fields = action, fields
        self._told, self._ends, self._goals = told, ends, goals
        # rosbridge_suite has one list of the goals of all its clients.
        self._id = _new_id()
        self._is_over = self._wants_cancel = False
        topic = feedback_topic(action.name)
        schema = Schema(f"{action.type_name}_FeedbackMessage", "", "")
        self._channel = TopicChannel(topic, schema, "json")
        self._connection = SideConnection(ends.address, self._take, self._refuse)

    def begin(self) -> None:
        """Connect, send the goal, and follow it to its end."""
        name, type_name = self._action.name, self._action.type_name
        self._connection.begin()
        self._connection.send(wire.send_goal(self._id, name, type_name, self._fields))

    def cancel(self) -> None:
        """Ask the server to cancel it."""
        if not self._is_over:
            self._wants_cancel = True
            frame = wire.cancel_goal(self._id, self._action.name)
            # Over the connection of a goal rosbridge_suite may read it only at its end,
            # and takes it of any other; other servers take it of that one alone.
            self._ends.send(frame)
            self._connection.send(frame)

    def leave(self, why: str) -> None:
        """Follow it no further."""
        self._refuse(why)
        self._connection.close()

    def _take(self, frame: str | bytes) -> bool:
        """Take a frame; return whether the goal is to be followed further."""
        try:
            said = wire.parse_operation(frame)
        except wire.MalformedOperation:
            return True
        if isinstance(said, wire.GoalFeedback):
            if self._wants_cancel:
                # It may have been said before the robot had taken the goal.
                self.cancel()
                self._wants_cancel = False
            payload = memoryview(b'{"feedback":' + bytes(said.values) + b"}")
            now, topic = self._ends.clock.now_ns(), self._channel.topic
            message = Recorded(topic, self._channel, now, None, payload)
            self._report(GoalReport(_EXECUTES, feedback=message))
        elif isinstance(said, wire.GoalResult):
            self._report(_report_of(said))
        return not self._is_over

    def _refuse(self, why: str) -> None:
        self._report(GoalReport(refusal=why))

    def _report(self, report: GoalReport) -> None:
        if self._is_over:
            return
        self._is_over = report.is_last
        if self._is_over:
            self._goals.discard(self)
        self._told(report)


def _report_of(end: wire.GoalResult) -> GoalReport:
    """Return the report of what the server says of an end."""
    values = bytes(end.values)
    if not end.result and values.startswith(b'"'):
        why = text(json.loads(values), 400)
        return GoalReport(refusal=f"the robot does not take it: {why}")
    status = end.status
    if status not in GOAL_ENDS:
        status = SUCCEEDED if end.result else ABORTED
    content = b'{"status":%d,"result":%s}' % (status, values)
    return GoalReport(status, result=Reply(content, is_json=True))


def _new_id() -> str:
    return f"{_ID}{uuid4().hex}"
