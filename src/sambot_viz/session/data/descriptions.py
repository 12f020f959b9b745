"""The robots that topics describe, for displays whose "Description Topic" names one."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import partial
from typing import Literal

from sambot_viz.displays.robot_display import Description, WantedQos
from sambot_viz.meanings import Meaning, meaning_of
from sambot_viz.session.worker import Worker
from sambot_viz.sources.qos import Qos
from sambot_viz.text import capitalized
from sambot_viz.topics import reasons
from sambot_viz.topics.reasons import TopicReason
from sambot_viz.topics.source_robot import SourceRobot

Level = Literal["Warn", "Error"]
_Joints = tuple[str, ...]
"""The topics that move the joints of a robot."""
STRING = "std_msgs/msg/String"
_OFFERED = {word: offered for offered, word in reasons.QOS_WORDS.items()}
"""RViz's word → that of ROS; System Default is not here: it adapts to publishers."""


class SourceDescriptions:
    """The descriptions in a recording, or of a live robot as they are published.

    Args:
        moved_by: the robot.
        is_given: the robot was named on the command line, and takes the place of the
            source's.
        worker: runs `changed`.
        changed: called when a topic says something else.
        reason_of: returns why nothing of a topic is seen (see `account.py`).
    """

    def __init__(
        self,
        moved_by: SourceRobot,
        is_given: bool,
        worker: Worker,
        changed: Callable[[], None],
        reason_of: Callable[[str], TopicReason | None],
    ) -> None:
        self._moved_by = moved_by
        self._is_given = is_given
        self._changed = changed
        self._reason_of = reason_of
        self._doubts: Mapping[str, TopicReason] = {}
        self._told: dict[tuple[str, WantedQos], tuple[Description, _Joints]] = {}
        self._look = partial(worker.post, self.look_again)
        moved_by.on_topics.append(self._look)
        moved_by.on_status.append(self._look)

    def topics(self) -> Sequence[str]:
        """Return the topics that describe robots."""
        return self._moved_by.topics.descriptions

    def link_frame(self, topic: str, link: str) -> str:
        """Return the frame of a link of the robot of a topic, in its name space."""
        moved_by = self._moved_by
        if not moved_by.spaces:
            return link
        if topic not in self.topics():
            # This description replaces the robot that was opened.
            topic = moved_by.topics.description or topic
        return moved_by.spaces.link_frame(topic, link)

    def joint_topics(self, topic: str) -> tuple[str, ...]:
        """Return the topics that move the joints of a further robot, as it is one."""
        return self._moved_by.topics.joints_of.get(topic, ())

    def transform_doubts(self) -> Mapping[str, TopicReason]:
        """Return the problems of topics with transforms, by their names."""
        topics, known = self._moved_by.topics, self._moved_by.source.topics()
        told = {
            name: self._reason_of(name)
            for name in (*topics.moving, *topics.static)
            if name in known
        }
        return {n: why for n, why in told.items() if why and why.severity != "info"}

    def of(self, topic: str, qos: WantedQos) -> Description:
        """Return the description on a topic, and subscribe to it."""
        told = self._of(topic, qos)
        self._told[topic, qos] = told, self.joint_topics(topic)
        return told

    def _of(self, topic: str, qos: WantedQos) -> Description:
        moved_by, source = self._moved_by, self._moved_by.source
        known = source.topics().get(topic)
        main = moved_by.topics.description
        is_gone = known is None and stands_for_opened(topic, self.topics())
        if self._is_given and (is_gone or topic == main):
            return Description(topic, is_opened=True)
        if known is None:
            if not source.status.is_connected:
                return _trouble(topic, source.status.sentence, "Warn")
            if moved_by.can("clock"):
                missing = f"start the node that publishes it (ros2 topic info {topic})"
                return not_there(topic, self.topics(), missing, "Warn")
            return not_there(topic, self.topics(), _missing_in(moved_by.name, topic))
        if known.reason is not None:
            return _trouble(topic, known.reason)
        type_name = moved_by.decoder(known).type_name
        if topic != main and meaning_of(type_name) is not Meaning.TEXT:
            return _trouble(topic, reasons.wrong_type(STRING, type_name).text)
        described = self._described(topic)
        if topic == main and moved_by.refusal:
            return _with(described, moved_by.refusal, "Error")
        is_recorded = moved_by.has_recorded(topic)
        if not is_recorded:
            refused = reasons.qos_mismatch(known.qos, wanted_qos(qos))
            if refused is not None:
                return _with(described, refused.text)
        if described.is_opened or described.text is not None:
            why = self._reason_of(topic)
            if why is None or why.severity == "info":
                return described
            return replace(_with(described, why.text), reason=why)
        if is_recorded:
            return described
        silent = reasons.unreceived(known)
        why = "no message yet: wait for its publisher, or start it again"
        return _with(described, why if silent is None else silent.text)

    def _described(self, topic: str) -> Description:
        """Return what has come of a topic that is there, and ask for the rest."""
        moved_by = self._moved_by
        if topic == moved_by.topics.description and (
            moved_by.description is not None or not moved_by.has_recorded(topic)
        ):
            is_opened = moved_by.description is not None
            return Description(topic, is_opened=is_opened)
        text = moved_by.text_of(topic)
        if text is not None or not moved_by.has_recorded(topic):
            return Description(topic, text, moved_by.label_of(topic))
        none = reasons.unreceived(moved_by.source.topics()[topic])
        why = "none of its messages can be read: record it again"
        return _trouble(topic, why if none is None else none.text)

    def close(self) -> None:
        """Unsubscribe from all topics."""
        self._moved_by.on_topics.remove(self._look)
        self._moved_by.on_status.remove(self._look)

    def look_again(self) -> None:
        """Let displays draw again when a topic that one asked for says otherwise."""
        told = {key: (self._of(*key), self.joint_topics(key[0])) for key in self._told}
        doubts, before = self.transform_doubts(), self._doubts
        if doubts != before or told != self._told:
            self._doubts = doubts
            self._told.clear()
            self._changed()


def stands_for_opened(topic: str, known: Sequence[str]) -> bool:
    """Return whether a topic that does not exist means a robot that was given.

    Args:
        topic: its name.
        known: the topics that describe robots.
    """
    return topic == "/robot_description" or not known


def wanted_qos(qos: WantedQos) -> Qos:
    """Return RViz's words as those of ROS; what adapts is empty."""
    return Qos(_OFFERED.get(qos.reliability, ""), _OFFERED.get(qos.durability, ""))


def not_there(
    topic: str, known: Sequence[str], missing: str, level: Level = "Error"
) -> Description:
    """Return the status for a missing topic, with the nearest name.

    Args:
        topic: the missing name.
        known: the topics that describe robots.
        missing: the advice when there are none.
        level: the level of the status.
    """
    if not known:
        return _trouble(topic, f"there is no topic {topic}: {missing}", level)
    text = reasons.no_such_topic(topic, known).text
    return _trouble(topic, text, level, reasons.meant_topic(topic, known))


def _missing_in(name: str, topic: str) -> str:
    return (
        f"no robot model in {name}; add --model ROBOT.urdf.xacro, or record {topic} too"
    )


def _trouble(
    topic: str, text: str, level: Level = "Error", instead: str = ""
) -> Description:
    return Description(topic, level=level, sentence=capitalized(text), instead=instead)


def _with(described: Description, text: str, level: Level = "Warn") -> Description:
    """Return a description with a doubt about its topic."""
    return replace(described, level=level, sentence=capitalized(text))
