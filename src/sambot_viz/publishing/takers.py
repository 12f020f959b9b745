"""Who takes what is sent on a topic, and why nobody does."""

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
"""What a robot says unasked, and who takes a topic, is known by then [s]."""
_NAMES = 3
_BRIDGES = ("foxglove_bridge", "rosbridge")
"""What is in the names of the nodes through which we publish."""
_TAKERS = {
    "goal": "start Nav2 (its bt_navigator takes goals)",
    "pose": "start AMCL or slam_toolbox (they take poses)",
    "point": "start the program that takes points",
    "drive": "start the robot's base (its controller takes velocities)",
    "joints": "start robot_state_publisher (it takes joints)",
    "markers": "start the program that has these markers",
    "description": "start robot_state_publisher",
}
"""What is sent → who would take it."""

_IN_TOOL = "name another topic, in a page in Tool Properties"
_ELSEWHERE: dict[Kind, str] = {
    "goal": _IN_TOOL,
    "pose": _IN_TOOL,
    "point": _IN_TOOL,
    "drive": "name another topic with --cmd-vel TOPIC",
    "joints": "name another topic with --remap /joint_states:=TOPIC",
}
"""What is sent → where another topic is named for it."""
_ANOTHER = "name another topic"


def who_takes(outgoing: Outgoing, kind: Kind | None = None, elsewhere: str = "") -> str:
    """Return who gets a topic, in words.

    Args:
        outgoing: the topic.
        kind: what is sent on it; None for anything else than the tools send.
        elsewhere: where another topic is named for it; empty as a page does it.

    Raises:
        PublishError: nobody does, or its messages are of another type.
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
    """Return why a robot cannot take what is in a frame; empty when it can.

    Args:
        frames: of the robot; without any nothing is known.
        frame: in which the place is given.
        kind: what is sent.
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
