"""Robots with an action of Nav2, over each transport; tests say what becomes of goals.

That of rosbridge reads nothing more of a connection over which a goal came until that
has ended, as rosbridge_suite does, and cancels goals of all its clients.
"""

from __future__ import annotations

import json
import struct
import threading
from abc import ABC, abstractmethod
from functools import cache
from typing import Any

from blank_messages import blank_message
from dds_peer import DdsPeer
from live_peers import WAIT, LivePeer
from navigator_peer import NavigatorPeer
from rosbags.typesys import Stores, get_typestore
from rosbridge_peer import RosbridgePeer, Topic
from websockets.sync.server import ServerConnection
from zenoh_peer import ZenohPeer

ACTION = "/navigate_to_pose"
KIND = "nav2_msgs/action/NavigateToPose"
INNER = f"{ACTION}/_action"
FEEDBACK = """
unique_identifier_msgs/UUID goal_id
nav2_msgs/NavigateToPose_Feedback feedback
================================================================================
MSG: unique_identifier_msgs/UUID
uint8[16] uuid
================================================================================
MSG: nav2_msgs/NavigateToPose_Feedback
builtin_interfaces/Duration estimated_time_remaining
float32 distance_remaining
"""


@cache
def _store() -> Any:
    return get_typestore(Stores.ROS2_JAZZY)


class ActionPeer(ABC):
    """A robot that takes goals by an action.

    Attributes:
        peer: the robot.
    """

    peer: LivePeer

    @abstractmethod
    def places(self) -> list[tuple[float, float]]:
        """Where the goals that have come lead, x and y [m]."""

    @abstractmethod
    def frames(self) -> list[str]:
        """Their frames."""

    @abstractmethod
    def reject(self) -> None:
        """Take no goal from now on."""

    @abstractmethod
    def hesitate(self) -> None:
        """Say nothing to goals before `go`."""

    @abstractmethod
    def go(self, metres: float) -> None:
        """Say how far the last goal is."""

    @abstractmethod
    def end(self, status: int, code: int = 0) -> None:
        """End the last goal, with Nav2's code of why."""

    @abstractmethod
    def cancelled(self) -> int:
        """How often the last goal was to be cancelled."""


class HiddenAction(ActionPeer):
    """Shows the hidden services and topics of the action.

    Args:
        peer: has the topic of its status.
        accepts: goals.
    """

    def __init__(
        self, peer: NavigatorPeer | ZenohPeer | DdsPeer, accepts: bool = True
    ) -> None:
        self.peer = self._peer = peer
        kind = f"{KIND}_FeedbackMessage"
        self._peer.offer(f"{INNER}/feedback", kind, FEEDBACK)
        self._decided = threading.Event()
        self._accept(accepts)
        self._peer.serve(f"{INNER}/cancel_goal", reply=b"\0\1\0\0" + bytes(8))
        self._peer.serve(f"{INNER}/get_result", reply=_result(0, 0))

    def places(self) -> list[tuple[float, float]]:
        return [struct.unpack_from("<2d", one, _place(one)) for one in self._goals()]

    def frames(self) -> list[str]:
        # Behind the id are the stamp, and the length of the name.
        return [_frame(one) for one in self._goals()]

    def reject(self) -> None:
        self._accept(False)

    def hesitate(self) -> None:
        def wait(service: str) -> None:
            if service.endswith("/send_goal"):
                self._decided.wait(WAIT)

        self._peer.before_answer = wait

    def go(self, metres: float) -> None:
        self._decided.set()
        self._say(2)
        head = b"\0\1\0\0" + self._id()
        self._peer.log(f"{INNER}/feedback", head + struct.pack("<iIf", 12, 0, metres))

    def end(self, status: int, code: int = 0) -> None:
        self._peer.serve(f"{INNER}/get_result", reply=_result(status, code))
        self._say(status)

    def cancelled(self) -> int:
        found = self._requests(f"{INNER}/cancel_goal")
        return sum(one[4:20] == self._id() for one in found)

    def _accept(self, accepts: bool) -> None:
        reply = b"\0\1\0\0" + bytes([accepts]) + bytes(11)
        self._peer.serve(f"{INNER}/send_goal", reply=reply)

    def _requests(self, service: str) -> list[bytes]:
        return [request for name, request in self._peer.served() if name == service]

    def _goals(self) -> list[bytes]:
        return self._requests(f"{INNER}/send_goal")

    def _id(self) -> bytes:
        return self._goals()[-1][4:20]

    def _say(self, status: int) -> None:
        kind = "action_msgs/msg/GoalStatusArray"
        found = blank_message(_store(), kind)
        one = blank_message(_store(), "action_msgs/msg/GoalStatus")
        one.goal_info.goal_id.uuid[:] = list(self._id())
        one.status = status
        found.status_list.append(one)
        self._peer.log(f"{INNER}/status", bytes(_store().serialize_cdr(found, kind)))


class FoxgloveAction(HiddenAction):
    """An action behind foxglove_bridge; see `HiddenAction`."""

    def __init__(self, *, accepts: bool = True) -> None:
        super().__init__(NavigatorPeer(statuses=()), accepts)


class ZenohAction(HiddenAction):
    """An action of a node with rmw_zenoh; see `HiddenAction`."""

    def __init__(self) -> None:
        peer = ZenohPeer()
        peer.advertise(f"{INNER}/status", True, "action_msgs/msg/GoalStatusArray")
        super().__init__(peer)


class DdsAction(HiddenAction):
    """An action of a node with DDS; see `HiddenAction`."""

    def __init__(self) -> None:
        peer = DdsPeer()
        peer.advertise(f"{INNER}/status", True, "action_msgs/msg/GoalStatusArray")
        super().__init__(peer)


class RosbridgeAction(ActionPeer):
    """Sends goals by rosbridge's own operations."""

    def __init__(self) -> None:
        self.peer = self._peer = ActingRosbridge()

    def places(self) -> list[tuple[float, float]]:
        found = [one["args"]["pose"]["pose"]["position"] for one in self._goals()]
        return [(one["x"], one["y"]) for one in found]

    def frames(self) -> list[str]:
        return [one["args"]["pose"]["header"]["frame_id"] for one in self._goals()]

    def reject(self) -> None:
        self._peer.rejects = True

    def hesitate(self) -> None:
        """It never says anything before."""

    def go(self, metres: float) -> None:
        left = {"sec": 12, "nanosec": 0}
        # Of a robot that does not know how it is turned; Python writes NaN.
        said = {"estimated_time_remaining": left, "tilt": float("nan")}
        self._peer.say("action_feedback", {**said, "distance_remaining": metres})

    def end(self, status: int, code: int = 0) -> None:
        self._peer.end({"error_code": code}, status, True)

    def cancelled(self) -> int:
        return self._peer.cancelled.count(self._goals()[-1]["id"])

    def _goals(self) -> list[dict[str, Any]]:
        return self._peer.goals()


class ActingRosbridge(RosbridgePeer):
    """A rosbridge that sends goals to an action.

    Attributes:
        rejects: the robot takes no goal.
        cancelled: ids of goals that were to be cancelled.
    """

    def __init__(self) -> None:
        self.rejects = False
        self.cancelled: list[str] = []
        self._busy: dict[ServerConnection, list[dict[str, Any]]] = {}
        super().__init__()
        self.there[f"{INNER}/status"] = Topic("action_msgs/msg/GoalStatusArray")

    def goals(self) -> list[dict[str, Any]]:
        """The goals that were sent, without what asks for the operation."""
        return [o for o in self.asked("send_action_goal") if o["action_type"] == KIND]

    def say(self, op: str, values: Any, **more: Any) -> None:
        """Say something of the last goal, over its connection."""
        with self._lock:
            client = next(reversed(self._busy))
            name = self.goals()[-1]["id"]
            said = {"op": op, "action": ACTION, "values": values, "id": name, **more}
            client.send(json.dumps(said))

    def end(self, values: Any, status: int, is_good: bool) -> None:
        """End the last goal, and read what has come over its connection meanwhile."""
        self.say("action_result", values, status=status, result=is_good)
        with self._lock:
            client, waiting = self._busy.popitem()
            for operation in waiting:
                self._take(client, operation)

    def _take(self, client: ServerConnection, operation: dict[str, Any]) -> None:
        if client in self._busy:
            self._busy[client].append(operation)
        elif operation["op"] == "send_action_goal":
            self._busy[client] = []
            if operation["action_type"] != KIND:
                why = f"Unable to import {operation['action_type']}"
                said = {"op": "action_result", "action": operation["action"]}
                said |= {"values": why, "status": 0, "result": False}
                client.send(json.dumps({**said, "id": operation["id"]}))
                del self._busy[client]
            elif self.rejects:
                self.end("Action goal was rejected", 0, False)
        elif operation["op"] == "cancel_action_goal":
            self.cancelled.append(operation["id"])
        else:
            super()._take(client, operation)


def _result(status: int, code: int) -> bytes:
    return b"\0\1\0\0" + struct.pack("<bxH", status, code)


def _frame(goal: bytes) -> str:
    (length,) = struct.unpack_from("<I", goal, 28)
    return goal[32 : 32 + length - 1].decode()


def _place(goal: bytes) -> int:
    (length,) = struct.unpack_from("<I", goal, 28)
    # Numbers of eight bytes begin at a multiple of eight behind the head.
    return 4 + -(-(28 + length) // 8) * 8
