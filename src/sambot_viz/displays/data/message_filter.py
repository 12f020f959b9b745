"""Displays whose messages wait until their transform is known (RViz's filter)."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Sequence
from typing import Any

from sambot_viz.displays.data.message_numbers import at_sensor
from sambot_viz.displays.data.refusals import MESSAGE, MessageRefused, refusing
from sambot_viz.displays.data.topic_display import (
    MOST_WAITING,
    TOPIC,
    TopicDisplay,
)
from sambot_viz.displays.display import DisplayContext
from sambot_viz.frames import LookupRefused, Transform
from sambot_viz.rviz import DisplayConfig
from sambot_viz.sources.message import Recorded
from sambot_viz.topics.decoding import frame_and_stamp

TRANSFORM = "Transform"
"""Key of a status."""
LONGEST_WAIT_NS = 1_000_000_000
"""What has waited so long while nothing is shown is said to wait [ns]."""
KEPT_DEPTH_S = 60.0
"""After a jump in a recording, older messages are not looked for where several are
shown [s]."""


def is_final(refused: LookupRefused) -> bool:
    """Return whether the place of a frame will not be known later either."""
    return refused.reason == "extrapolation-past" or not refused.source


class _Held:
    """A message that waits for its transform; it is decoded when it is its turn.

    Attributes:
        recorded: as it came.
        refused: why it had no place when that was looked for last.
    """

    def __init__(self, recorded: Recorded, decode: Callable[[Recorded], Any]) -> None:
        self.recorded = recorded
        self.refused: LookupRefused | None = None
        self._decode = decode
        self._message: Any = None

    @property
    def message(self) -> Any:
        """The message with its fields; raises DecodeError."""
        if self._message is None:
            self._message = self._decode(self.recorded)
        return self._message

    def forget(self) -> None:
        """Keep the bytes alone."""
        self._message = None


class MessageFilterDisplay(TopicDisplay):
    """Draws each message in the place where its frame was at its stamp.

    A message is held until that is known; of more than "Filter size" the oldest is
    dropped, and the status says why it had no place. What was drawn stays where it is,
    whatever its frame does later, until the fixed frame is another one.
    """

    def __init__(self, context: DisplayContext, config: DisplayConfig, key: str):
        """Make the display; nothing is drawn before `draw`."""
        super().__init__(context, config, key)
        self._held: deque[_Held] = deque()
        self._drawn: deque[_Held] = deque(maxlen=MOST_WAITING)
        self._drawn_in = context.fixed_frame

    # For the displays that derive from it

    @property
    def needs_last_only(self) -> bool:
        """Whether only the newest message that has a place is drawn."""
        return True

    @property
    def depth_s(self) -> float:
        """How far back messages count after a jump in a recording [s]."""
        return super().depth_s if self.needs_last_only else KEPT_DEPTH_S

    @property
    def waits(self) -> bool:
        """Whether there is something to do also when no message comes."""
        return bool(self._held)

    @property
    def most_held(self) -> int:
        """So many messages are held at most."""
        return int(self.config.get(f"{TOPIC}/Filter size"))

    def wanted(self, came: Sequence[Recorded]) -> Sequence[Recorded]:
        """Return those of some messages that are worth a look, the oldest first."""
        return came

    def process(self, message: Any, T_fixed_frame: Transform, came: Recorded) -> None:
        """Take a message; `show_taken` draws what several have brought.

        Args:
            message: with its fields.
            T_fixed_frame: where the frame of its header was at its stamp.
            came: the message as it came; its `log_ns` is when.

        Raises:
            MessageRefused: it cannot be drawn, and why.
        """
        raise NotImplementedError

    def show_taken(self) -> None:
        """Draw what was taken as it looks now; what is the same is not sent again."""
        raise NotImplementedError

    def drop(self) -> None:
        """Take everything out of the scene."""
        raise NotImplementedError

    def place(self, message: Any) -> Transform:
        """Return where the frame of a message was at its stamp, T_fixed_frame.

        Raises:
            LookupRefused: it is not known, or not yet.
        """
        frame, stamp_ns = frame_and_stamp(message)
        found = self.context.tree.lookup(self.context.fixed_frame, frame, stamp_ns)
        return at_sensor(found, message)

    # As a display of a topic

    def forget(self) -> None:
        """Drop what is drawn and what waits."""
        self._held.clear()
        self._drawn.clear()
        self._drawn_in = self.context.fixed_frame
        self.refusal = ""
        self.drop()
        for key in (TRANSFORM, MESSAGE):
            self.status.remove(key)

    def redraw(self) -> None:
        """Draw again; in another fixed frame what is drawn gets other places."""
        if self.context.fixed_frame != self._drawn_in:
            again = [*self._drawn, *self._held]
            self.forget()
            self._held.extend(again)
            self._try()
        else:
            self.show_taken()

    def messages_came(self) -> None:
        """Draw what has a place, and hold the rest."""
        if self.subscription is None:
            return
        decode = self.subscription.decode
        came = self.wanted(self.subscription.drain())
        self._held.extend(_Held(one, decode) for one in came)
        self._try()

    def time_passed(self) -> None:
        """Say how many messages have come, and why none is shown."""
        super().time_passed()
        if self.shown:
            self._report_waiting()

    def _try(self) -> None:
        last_only, is_new, is_fine = self.needs_last_only, False, True
        for one in reversed(self._held) if last_only else tuple(self._held):
            one.refused = None
            try:
                is_done = self._is_done(one)
            except MessageRefused as refused:
                self._refuse(refused)
                # Of what is newer than all that is drawn the statuses go on to say so.
                is_fine = not last_only
                continue
            if is_done:
                if last_only:
                    self._drawn.clear()
                self._drawn.append(one)
                is_new = True
                if is_fine:
                    self._say_fine()
                if last_only:
                    break
        if is_new:
            self.show_taken()
        self._leave_waiting(last_only)
        if self.subscription is not None:
            self.subscription.waits = self.waits
        self._report_waiting()

    def _leave_waiting(self, last_only: bool) -> None:
        """Keep what waits; what is older than the newest that is drawn does not."""
        kept: list[_Held] = []
        for one in reversed(self._held):
            if one.refused is not None:
                kept.append(one)
            elif last_only:
                break
        size = self.most_held if kept else 0
        for dropped in kept[size:]:
            if dropped.refused is not None:
                self.status.set(TRANSFORM, "Error", dropped.refused.rviz_text)
        self._held = deque(reversed(kept[:size]))

    def _is_done(self, one: _Held) -> bool:
        """Take a message if it has a place; return whether that was done.

        Raises:
            MessageRefused: it cannot be drawn.
        """
        try:
            with refusing():
                T_fixed_frame = self.place(one.message)
                self.say_placed()
                self.process(one.message, T_fixed_frame, one.recorded)
        except LookupRefused as refused:
            if is_final(refused):
                self.status.set(TRANSFORM, "Error", refused.rviz_text)
            else:
                one.refused = refused
            return False
        finally:
            one.forget()
        return True

    def say_placed(self) -> None:
        """Say that a message has a place."""
        self.status.set(TRANSFORM, "Ok", "Transform OK")

    def _refuse(self, refused: MessageRefused) -> None:
        if refused.key == TOPIC:
            self.refusal = refused.text
            self.report_topic()
        else:
            self.status.set(refused.key, "Error", refused.text)

    def _say_fine(self) -> None:
        """Say nothing any longer of what was wrong with messages before."""
        if self.refusal:
            self.refusal = ""
            self.report_topic()
        if MESSAGE in self.status.rows:
            self.status.set(MESSAGE, "Ok", "OK")

    def _report_waiting(self) -> None:
        """Say why nothing is shown; RViz says nothing for as long as there is room."""
        messages = self.context.messages
        if self._drawn or not self._held or messages is None:
            return
        said = self.status.rows.get(TRANSFORM)
        if said is not None and said.level == "Error":
            return
        oldest = self._held[0]
        waited = messages.now_ns(oldest.recorded.topic) - oldest.recorded.log_ns
        # That the fixed frame does not exist is no matter of a second, and while a
        # recording is paused no time passes.
        frames = self.context.tree.frames
        is_nowhere = bool(frames) and self.context.fixed_frame not in frames
        if oldest.refused is not None and (is_nowhere or waited > LONGEST_WAIT_NS):
            self.status.set(TRANSFORM, "Warn", oldest.refused.rviz_text)
