"""A robot on the network that takes goals as Nav2 does, and says what they become."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache
from typing import Any

import foxglove
from blank_messages import blank_message
from foxglove.websocket import Client
from live_peers import FoxglovePeer
from rosbags.typesys import Stores, get_typestore

STATUS = "/navigate_to_pose/_action/status"
GOAL = "/goal_pose"
WAY = {"odom": "map", "base_link": "odom"}


@cache
def _store() -> Any:
    return get_typestore(Stores.ROS2_JAZZY)


class NavigatorPeer(FoxglovePeer):
    """Takes goals; of each it says some numbers of GoalStatus, one after the other.

    Args:
        statuses: of each goal.
        frames: child → parent, static.
        refusal: what the bridge says of a goal instead.
        is_hidden: hidden topics are not shown.
    """

    def __init__(
        self,
        statuses: Sequence[int] = (1, 2, 4),
        *,
        frames: dict[str, str] = WAY,
        refusal: str = "",
        is_hidden: bool = False,
        node: str = "/bt_navigator",
    ) -> None:
        self.statuses, self.refusal = statuses, refusal
        self._goals = 0
        super().__init__()
        if frames:
            self.offer("/tf_static", "tf2_msgs/msg/TFMessage")
            self._latched["/tf_static"] = [transforms(frames)]
        if not is_hidden:
            self.offer(STATUS, "action_msgs/msg/GoalStatusArray")
            # Somebody has sent it somewhere before.
            self._latched[STATUS] = [_said(0, 4)]
        self.offer("/rosout", "std_msgs/msg/String")
        if node:
            self.listen_as(GOAL, node)

    def on_message_data(
        self, client: Client, client_channel_id: int, data: bytes
    ) -> None:
        super().on_message_data(client, client_channel_id, data)
        if self.refusal:
            self.complain(self.refusal)
        if self.refusal or not self.came()[-1].type_name.endswith("/PoseStamped"):
            return
        self._goals += 1
        if STATUS in self._channels:
            for status in self.statuses:
                self.tell(status)

    def tell(self, status: int) -> None:
        """Say a number of GoalStatus of the last goal; who comes late gets the last."""
        said = _said(self._goals, status)
        self._latched[STATUS] = [said]
        self._channels[STATUS].log(said)

    def offer(self, topic: str, kind: str, definition: str = "") -> None:
        """Begin to publish a topic, of a type of ROS or with its definition."""
        text = definition or _store().generate_msgdef(kind, ros_version=2)[0]
        schema = foxglove.Schema(name=kind, encoding="ros2msg", data=text.encode())
        self._channels[topic] = foxglove.Channel(
            topic, schema=schema, message_encoding="cdr", context=self.context
        )


def _said(goal: int, status: int) -> bytes:
    """What becomes of a goal, behind all that were done before."""
    found = blank_message(_store(), "action_msgs/msg/GoalStatusArray")
    for number in range(goal + 1):
        one = blank_message(_store(), "action_msgs/msg/GoalStatus")
        one.goal_info.goal_id.uuid[:] = number + 1
        one.status = status if number == goal else 4
        found.status_list.append(one)
    return bytes(_store().serialize_cdr(found, "action_msgs/msg/GoalStatusArray"))


def transforms(frames: dict[str, str], seconds: int = 0) -> bytes:
    """A TFMessage without translations, as CDR: child → parent, at a time [s]."""
    found = blank_message(_store(), "tf2_msgs/msg/TFMessage")
    for child, parent in frames.items():
        one = blank_message(_store(), "geometry_msgs/msg/TransformStamped")
        one.header.frame_id, one.child_frame_id = parent, child
        one.header.stamp.sec = seconds
        one.transform.rotation.w = 1.0
        found.transforms.append(one)
    return bytes(_store().serialize_cdr(found, "tf2_msgs/msg/TFMessage"))
