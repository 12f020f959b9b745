"""Find the receivers of messages on a topic, or why there are none."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

from sambot_viz.errors import PublishError
from sambot_viz.frames import LookupRefused
from sambot_viz.frames.hierarchy import plain_name
from sambot_viz.publishing.outbound import MAP, Kind
from sambot_viz.sources.source import Outgoing, Source
from sambot_viz.text import text


class KnownFrames(Protocol):
    """Frames that can be looked up: a tree, or its history."""

    @property
    def frames(self) -> Sequence[str]:
        """Return their names."""
        ...

    def lookup(self, target: str, source: str) -> object:
        """Return the pose of a frame in another one.

        Raises:
            LookupRefused: there is none.
        """
        ...


FOUND_WITHIN = 2.0
"""Time until a robot's announcements and the readers of a topic are known [s]."""
_NAMES = 3
_BRIDGES = ("foxglove_bridge", "rosbridge")
"""Part of the names of the nodes through which we publish."""
_TAKERS = {
    "goal": "start Nav2 (its bt_navigator takes goals)",
    "pose": "start AMCL or slam_toolbox (they take poses)",
    "point": "start the program that takes points",
    "drive": "start the robot's base (its controller takes velocities)",
    "joints": "start robot_state_publisher (it takes joints)",
    "markers": "start the program that has these markers",
    "description": "start robot_state_publisher",
}
"""Kind of message → its usual receiver."""

_IN_TOOL = "name another topic, in a page in Tool Properties"
_ELSEWHERE: dict[Kind, str] = {
    "goal": _IN_TOOL,
    "pose": _IN_TOOL,
    "point": _IN_TOOL,
    "drive": "name another topic with --cmd-vel TOPIC",
    "joints": "name another topic with --remap /joint_states:=TOPIC",
}
"""Kind of message → the advice on how to set another topic."""
_ANOTHER = "name another topic"


def who_takes(outgoing: Outgoing, kind: Kind | None = None, elsewhere: str = "") -> str:
    """Return the receivers of a topic, in words.

    Args:
        outgoing: the topic.
        kind: the kind of message; None for messages that no tool sends.
        elsewhere: how to set another topic; empty for the way of the page.

    Raises:
        PublishError: there is none, or its messages are of another type.
    """
    receivers, topic = outgoing.receivers, text(outgoing.topic, 80)
    named = _ELSEWHERE.get(kind, _ANOTHER) if kind else _ANOTHER
    elsewhere = elsewhere or named
    if receivers.type_name not in ("", outgoing.type_name):
        raise PublishError(
            f"{topic} of this robot has messages of {text(receivers.type_name, 80)}, "
            f"and what is sent is a {outgoing.type_name}: {elsewhere}"
        )
    if receivers.names is None:
        return f"{topic}; the bridge does not say who gets it"
    taker = _TAKERS[kind] if kind else "start the program that takes it"
    if not receivers.names:
        raise PublishError(f"nobody has subscribed to {topic}: {taker}, or {elsewhere}")
    names = ", ".join(text(name, 80) for name in receivers.names[:_NAMES])
    more = len(receivers.names) - _NAMES
    return f"{topic}, which {names}{f' and {more} more' if more > 0 else ''} takes"


def other_publishers(source: Source, topic: str) -> Sequence[str]:
    """Return who publishes a topic beside the bridge, which does it for us.

    Args:
        source: the robot.
        topic: its name.
    """
    known = source.topics().get(topic)
    names = () if known is None else known.publishers
    if not isinstance(names, tuple):
        return ()
    return [one for one in names if not any(bridge in one for bridge in _BRIDGES)]


def frame_fault(frames: KnownFrames, frame: str, kind: Kind) -> str:
    """Return why a robot cannot use a message in a frame; empty if it can.

    Args:
        frames: the frames of the robot; without any the frame is not checked.
        frame: the frame of the message.
        kind: the kind of message.
    """
    known = frames.frames
    if not known or kind in ("point", "markers"):
        return ""
    place = MAP if MAP in known else known[0]
    if kind == "pose" and MAP in known and plain_name(frame) != MAP:
        return f"AMCL takes poses in {MAP} only: the frame is {text(frame, 80)}"
    try:
        frames.lookup(place, frame)
    except LookupRefused as refused:
        return str(refused)
    return ""
