"""Displays whose messages wait until their transform is known (RViz's filter)."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, ClassVar, Generic

from sambot_viz import limits
from sambot_viz.displays.data.kept import Held, HeldMessages, T, Taken
from sambot_viz.displays.data.message_numbers import at_sensor
from sambot_viz.displays.data.refused_messages import MESSAGE, MessageRefused, refusing
from sambot_viz.displays.data.topic_display import (
    TOPIC,
    TopicDisplay,
)
from sambot_viz.displays.display import DisplayContext, Level
from sambot_viz.frames import LookupRefused, Transform
from sambot_viz.rviz import DisplayConfig
from sambot_viz.sources.message import Recorded
from sambot_viz.topics.contents import content_reason
from sambot_viz.topics.decoding import frame_and_stamp

TRANSFORM = "Transform"
"""Key of a status."""
LONGEST_WAIT_NS = 1_000_000_000
"""Waiting time after which the status reports it, while nothing is shown [ns]."""
KEPT_DEPTH_S = 60.0
"""After a jump in a recording, older messages are not looked for where several are
shown [s]."""


def is_final(refused: LookupRefused) -> bool:
    """Return whether the place of a frame will not be known later either."""
    return refused.reason == "extrapolation-past" or not refused.source


class MessageFilterDisplay(TopicDisplay, Generic[T]):
    """Draws each message in the place where its frame was at its stamp.

    A message waits until that place is known; above "Filter size" the oldest is
    dropped, and the status says why it had no place. Drawn messages stay in their
    places, whatever their frames do later, until the fixed frame changes.

    A display extracts the content of a message in `read`, and draws the kept content in
    `draw_kept`; one that keeps messages in another way overrides `process`,
    `show_taken` and `drop`.

    Attributes:
        held: the messages, as they came.
        kept: the content of the shown messages, the newest last.
    """

    tells_time = True
    length: ClassVar[str] = ""
    """The property that says how many messages are shown; the newest alone without."""

    def __init__(self, context: DisplayContext, config: DisplayConfig, key: str):
        """Make the display; nothing is drawn before `draw`."""
        super().__init__(context, config, key)
        self.held = HeldMessages(limits.DISPLAY_WAITING.value)
        self.kept: list[Taken[T]] = []
        self._drawn_in = context.fixed_frame

    # For the displays that derive from it

    def read(self, message: Any) -> T:
        """Return the content of a message, as it is drawn.

        Raises:
            MessageRefused: it cannot be drawn.
        """
        raise NotImplementedError

    def draw_kept(self, kept: Sequence[Taken[T]]) -> None:
        """Draw what was read as it looks now, and nothing else.

        Args:
            kept: of the messages that are shown, the newest last; at least one.
        """
        raise NotImplementedError

    @property
    def most(self) -> int:
        """Number of messages shown."""
        return int(self.config.acting(self.length)) if self.length else 1

    @property
    def needs_last_only(self) -> bool:
        """Whether only the newest message that has a place is drawn."""
        return self.most == 1

    @property
    def depth_s(self) -> float:
        """How far back messages count after a jump in a recording [s]."""
        return super().depth_s if self.needs_last_only else KEPT_DEPTH_S

    @property
    def waits(self) -> bool:
        """Whether there is something to do also when no message comes."""
        return bool(self.held.waiting)

    @property
    def most_held(self) -> int:
        """Maximum number of messages held."""
        return int(self.config.get(f"{TOPIC}/Filter size"))

    def wanted(self, came: Sequence[Recorded]) -> Sequence[Recorded]:
        """Return those of some messages that are worth a look, the oldest first."""
        return came

    def process(self, message: Any, T_fixed_frame: Transform, came: Recorded) -> None:
        """Keep the content of a message; `show_taken` draws several together.

        Args:
            message: the decoded message.
            T_fixed_frame: pose of the frame of its header at its stamp.
            came: the message as it came, at the time `log_ns`.

        Raises:
            MessageRefused: it cannot be drawn; with the reason.
        """
        self.kept.append(Taken(self.read(message), T_fixed_frame.matrix))

    def show_taken(self) -> None:
        """Draw the kept content with the present settings; unchanged nodes are kept."""
        del self.kept[: -self.most]
        if self.kept:
            self.draw_kept(self.kept)

    def drop(self) -> None:
        """Take everything out of the scene, and forget what was read."""
        self.kept.clear()
        self.remove()

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
        """Drop the drawn and the waiting messages."""
        self.held.clear()
        self._drawn_in = self.context.fixed_frame
        self.refusal, self.nothing = "", None
        self.drop()
        for key in (TRANSFORM, MESSAGE):
            self.status.remove(key)

    def redraw(self) -> None:
        """Draw again; after a change of the fixed frame compute all places again."""
        if self.context.fixed_frame != self._drawn_in:
            again = [*self.held.drawn, *self.held.waiting]
            self.forget()
            self.held.waiting.extend(again)
            self.place_held()
        else:
            self.show_taken()

    def messages_came(self) -> None:
        """Draw what has a place, and hold the rest."""
        if self.subscription is None:
            return
        decode = self.subscription.decode
        came = self.wanted(self.subscription.drain())
        self.held.waiting.extend(Held(one, decode) for one in came)
        self.place_held()

    def time_passed(self) -> None:
        """Say how many messages have come, and why none is shown."""
        super().time_passed()
        if self.shown:
            self._report_waiting()

    def place_held(self) -> None:
        """Draw what has a place now."""
        held = self.held
        last_only, is_new, is_fine = self.needs_last_only, False, True
        for one in reversed(held.waiting) if last_only else tuple(held.waiting):
            one.refused = None
            try:
                is_done = self._is_done(one)
            except MessageRefused as refused:
                self._refuse(refused)
                # Messages newer than all drawn ones keep that status.
                is_fine = not last_only
                continue
            if is_done:
                if last_only:
                    held.drawn.clear()
                held.drawn.append(one)
                is_new = True
                if is_fine:
                    self._say_fine()
                if last_only:
                    break
        if is_new:
            self.show_taken()
        for dropped in held.leave(self.most_held, last_only=last_only):
            self._say_unplaced(dropped, "Error")
        if self.subscription is not None:
            self.subscription.waits = self.waits
        self._report_waiting()

    def _is_done(self, one: Held) -> bool:
        """Take a message if it has a place; return whether that was done.

        Raises:
            MessageRefused: it cannot be drawn.
        """
        try:
            with refusing():
                T_fixed_frame = self.place(one.message)
                self.say_placed()
                self.process(one.message, T_fixed_frame, one.recorded)
                self.tell_time(one.message)
                self.nothing = content_reason(one.message)
        except LookupRefused as refused:
            one.refused = refused
            if is_final(refused):
                self._say_unplaced(one, "Error")
                one.refused = None
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
            self.status.set(refused.key, "Error", refused.text, refused.code)

    def _say_fine(self) -> None:
        """Say nothing any longer of what was wrong with messages before."""
        if self.refusal:
            self.refusal = ""
            self.report_topic()
        if MESSAGE in self.status.rows:
            self.status.set(MESSAGE, "Ok", "OK")

    def _say_unplaced(self, one: Held, level: Level) -> None:
        """Say why a message has no place, and what brings it one."""
        if one.refused is not None:
            why = self.context.unplaced(one.recorded.topic, one.refused)
            self.status.set(TRANSFORM, level, why.text, why.code)

    def _report_waiting(self) -> None:
        """Say why nothing is shown; RViz says nothing for as long as there is room."""
        messages = self.context.messages
        if self.held.drawn or not self.held.waiting or messages is None:
            return
        said = self.status.rows.get(TRANSFORM)
        oldest = self.held.waiting[0]
        if oldest.refused is None or (said is not None and said.level == "Error"):
            return
        topic = oldest.recorded.topic
        waited = messages.now_ns(topic) - oldest.recorded.log_ns
        # That the fixed frame does not exist is no matter of a second, and what a
        # recording had up to now is here.
        frames = self.context.tree.frames
        is_nowhere = bool(frames) and self.context.fixed_frame not in frames
        is_sure = is_nowhere or waited > LONGEST_WAIT_NS
        if not is_sure and messages.is_recorded(topic):
            is_sure = messages.unplaced(topic, oldest.refused) is not None
        if is_sure:
            self._say_unplaced(oldest, "Warn")
