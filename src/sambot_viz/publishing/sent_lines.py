"""The last messages that were sent to a robot, as lines for people."""

from __future__ import annotations

from collections import deque
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

from sambot_viz.publishing.sent_message import SentMessage
from sambot_viz.text import text

LINES = 50
"""Maximum number of lines kept."""
_VALUES = 160
_STREAMS = ("/Twist", "/TwistStamped", "/JointState", "/InteractiveMarkerFeedback")
"""Messages that come again and again while a hand moves something."""


@dataclass(frozen=True, slots=True)
class SentLine:
    """A line of the list of sent messages: one message, or the steps of one motion.

    Attributes:
        time: time of the last message, since 1970 [s].
        who: the sender: a user or a part of the program.
        topic: the topic.
        type_name: the type of the messages.
        values: the content of the last one, in words.
        count: number of the messages.
    """

    time: float
    who: str
    topic: str
    type_name: str
    values: str
    count: int = 1


class SentLines:
    """Keeps the last lines; steps of one motion on one topic are one line."""

    def __init__(self) -> None:
        self._lines: deque[SentLine] = deque(maxlen=LINES)

    def add(self, sent: SentMessage) -> None:
        """Note a message."""
        made = SentLine(sent.time, sent.who, sent.topic, sent.type_name, _words(sent))
        if self._lines:
            last = self._lines[-1]
            key = last.who, last.topic, last.type_name
            is_next = key == (made.who, made.topic, made.type_name)
            if is_next and made.type_name.endswith(_STREAMS) and not _is_meant(sent):
                self._lines.pop()
                made = replace(made, count=last.count + 1)
        self._lines.append(made)

    @property
    def newest_first(self) -> Sequence[SentLine]:
        """The lines."""
        return [*reversed(self._lines)]


def _is_meant(sent: SentMessage) -> bool:
    """Return whether a message is a single one, not a step of a motion."""
    values = sent.values
    event = values.get("event") if isinstance(values, Mapping) else None
    return event in ("MENU_SELECT", "BUTTON_CLICK")


def _words(sent: SentMessage) -> str:
    if isinstance(sent.values, Mapping):
        if not sent.type_name and "error" in sent.values:
            # What was not sent at all.
            return text(f"error: {sent.values['error']}", _VALUES)
        parts = [f"{name} {value}" for name, value in sent.values.items()]
    else:
        parts = [f"{value:.4g}" for value in sent.values]
    where = f" [{sent.frame}]" if sent.frame else ""
    # Each part is cut by itself: a model is long.
    said = ", ".join(text(part, 60) for part in parts[:12])
    return text(f"{said}{where}", _VALUES)
