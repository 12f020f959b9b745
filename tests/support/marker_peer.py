"""A robot on the network whose program has interactive markers, as its server does."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from typing import Any

from interactive_messages import update
from navigator_peer import NavigatorPeer
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

UPDATES, FEEDBACK = "/ns/update", "/ns/feedback"
SERVICE = "/ns/get_interactive_markers"
_RESPONSE = "visualization_msgs/msg/GetInteractiveMarkersResponse"
_FEEDBACK = "visualization_msgs/msg/InteractiveMarkerFeedback"


@cache
def _store() -> Any:
    store = get_typestore(Stores.ROS2_JAZZY)
    text = "uint64 sequence_number\nvisualization_msgs/InteractiveMarker[] markers"
    store.register(get_types_from_msg(text, _RESPONSE))
    return store


class MarkerPeer(NavigatorPeer):
    """Answers the service with its markers, and takes what is done with them.

    Args:
        markers: what makes each, of the types of messages.
        number: of the last update before.
        is_heard: whether it has subscribed to what is done.
    """

    def __init__(
        self,
        *markers: Callable[[Any], Any],
        number: int = 7,
        is_heard: bool = True,
        frames: dict[str, str] | None = None,
    ) -> None:
        way = {"odom": "map", "base_link": "odom"} if frames is None else frames
        super().__init__(frames=way, node="")
        self.offer(UPDATES, "visualization_msgs/msg/InteractiveMarkerUpdate")
        self.answer(*markers, number=number)
        if is_heard:
            self.listen_as(FEEDBACK, "/program")

    def answer(self, *markers: Callable[[Any], Any], number: int = 7) -> None:
        """Answer the service with other markers from now on."""
        store = _store()
        made = [one(store.types) for one in markers]
        answer = store.types[_RESPONSE](sequence_number=number, markers=made)
        self.serve(SERVICE, reply=bytes(store.serialize_cdr(answer, _RESPONSE)))

    def update(self, *markers: Callable[[Any], Any], **options: Any) -> None:
        """Publish an update (see `interactive_messages.update`)."""
        _, kind, message = update(*markers, **options)(_store().types)
        self.log(UPDATES, bytes(_store().serialize_cdr(message, kind)))

    def feedback(self) -> list[Any]:
        """What was done with its markers."""
        read = _store().deserialize_cdr
        came = [one for one in self.came() if one.topic == FEEDBACK]
        return [read(one.content, _FEEDBACK) for one in came]

    def events(self) -> list[int]:
        """The numbers of what was done."""
        return [int(one.event_type) for one in self.feedback()]
