"""Marker and MarkerArray: shapes, lines and texts that programs draw."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any, ClassVar

from sambot_viz import limits
from sambot_viz.displays.data.kept import HeldMessages
from sambot_viz.displays.data.markers.markers import Markers
from sambot_viz.displays.data.markers.namespaces import NAMESPACES, Namespaces
from sambot_viz.displays.data.message_filter import (
    KEPT_DEPTH_S,
    TRANSFORM,
    MessageFilterDisplay,
    is_final,
)
from sambot_viz.displays.data.refused_messages import MessageRefused
from sambot_viz.displays.data.topic_display import topic_property
from sambot_viz.displays.display import DisplayContext, EntryList
from sambot_viz.displays.picking.placed import Placed
from sambot_viz.displays.picking.selectable import Selectable
from sambot_viz.displays.picking.selected import SelectedData
from sambot_viz.frames import LookupRefused, Transform
from sambot_viz.meanings import Meaning
from sambot_viz.rviz import DisplayConfig, GroupProperty, Property
from sambot_viz.sources.message import Recorded
from sambot_viz.topics.decoding import frame_and_stamp

DUPLICATES, MESSAGES = "Duplicate Marker Check", "Messages"
FEWEST = 5
"""Messages that are read between two pictures whatever their size; RViz keeps as many.
With the limit a slow computer still shows the newest ones."""
ROS1_TOPIC = "Marker Topic"
"""What files of ROS 1 call the topic."""
_NAMESPACES = GroupProperty(
    NAMESPACES,
    help="The namespaces of markers, each with a box to show or hide them.",
    children=(),
    open_keys=True,
)


class MarkerDisplay(MessageFilterDisplay[None]):
    """The markers of a topic, and of another one with arrays of markers."""

    kind = "rviz_default_plugins/Marker"
    differs = (
        "Dark colours of solids are up to 6 of 255 off, as they have 8 bits in linear "
        "light."
    )
    meanings = frozenset({Meaning.MARKER})
    properties: ClassVar[tuple[Property, ...]] = (
        topic_property(ros1=ROS1_TOPIC),
        _NAMESPACES,
    )

    def __init__(self, context: DisplayContext, config: DisplayConfig, key: str):
        """Make the display; nothing is drawn before `draw`."""
        super().__init__(context, config, key)
        # The markers keep their own state.
        self.held = HeldMessages(most_drawn=1)
        self._is_after_jump = True
        self._has_left_out = False
        self._given_way = 0
        self._namespaces = Namespaces(config)
        self._markers = Markers(
            context, self.status, self._namespaces, key, self._files_found
        )

    @property
    def needs_last_only(self) -> bool:
        """Whether only the newest message is drawn: each one changes the markers."""
        return False

    @property
    def waits(self) -> bool:
        """Whether there is something to do without a message: markers grow old."""
        return super().waits or self._markers.some_grow_old

    @property
    def most_waiting(self) -> int:
        """How many messages wait between two pictures, or after a jump."""
        return limits.MARKER_MESSAGES.value

    @property
    def minds_older(self) -> bool:
        """Whether older messages than those that count may still hold."""
        return True

    def other_topics(self) -> Sequence[str]:
        """Return the topic of arrays beside the one of single markers."""
        return (f"{self.topic}_array",)

    def wanted(self, came: Sequence[Recorded]) -> Sequence[Recorded]:
        """Leave out what later messages make good for nothing."""
        kept: list[Recorded] = []
        seen: set[bytes] = set()
        row = limits.MARKER_JUMP if self._is_after_jump else limits.MARKER_BURST
        size, most = 0, row.value
        for one in reversed(came):
            payload = bytes(one.payload)
            size += len(payload)
            if size > most and len(kept) >= (1 if self._is_after_jump else FEWEST):
                self._has_left_out = True
                break
            if payload not in seen:
                seen.add(payload)
                kept.append(one)
        return kept[::-1]

    def place(self, message: Any) -> Transform:
        """Return where the frame of a marker is; those of arrays have one each.

        Of what will never have a place the marker's own status says so.
        """
        if hasattr(message, "markers"):
            return Transform.identity()
        try:
            return super().place(message)
        except LookupRefused as refused:
            if is_final(refused):
                return Transform.identity()
            raise

    def say_placed(self) -> None:
        """Say nothing of the places that the statuses of markers are about."""
        self.status.remove(TRANSFORM)

    def process(self, message: Any, T_fixed_frame: Transform, came: Recorded) -> None:
        """Add, change or delete markers, as a message requests."""
        markers = getattr(message, "markers", None)
        if markers is not None:
            self._look_for_duplicates(markers)
            for marker in markers:
                self._markers.apply(marker, came.log_ns)
        elif hasattr(message, "action"):
            self._markers.apply(message, self._arrived(message, came))
        else:
            raise MessageRefused("It has no markers")

    def _arrived(self, message: Any, came: Recorded) -> int:
        """Return when a marker came [ns]; one of the future waited for its time."""
        messages, (_, stamp_ns) = self.context.messages, frame_and_stamp(message)
        if messages is None or stamp_ns is None:
            return came.log_ns
        waited = came.log_ns < stamp_ns <= messages.now_ns(self.topic)
        return stamp_ns if waited else came.log_ns

    def messages_came(self) -> None:
        """Apply what has come; markers vanish also when nothing has."""
        subscription = self.subscription
        if subscription is None:
            return
        self._has_left_out = subscription.given_way > self._given_way
        self._given_way = subscription.given_way
        super().messages_came()
        self.show_taken()
        if self._is_after_jump and (subscription.has_older or self._has_left_out):
            self.status.set(MESSAGES, "Ok", _older())
        elif self._has_left_out:
            self.status.set(MESSAGES, "Warn", _too_many())
        self._is_after_jump = False

    def time_passed(self) -> None:
        """Let markers vanish after their lifetime."""
        super().time_passed()
        if self.shown:
            self.show_taken()

    def show_taken(self) -> None:
        """Draw the markers that are other ones, without those that are too old."""
        messages = self.context.messages
        if messages is not None:
            self._markers.expire(messages.now_ns(self.topic))
        self._markers.draw()

    def redraw(self) -> None:
        """Place the markers again in another fixed frame, or below other nodes."""
        if self.context.fixed_frame != self._drawn_in:
            self._drawn_in = self.context.fixed_frame
            self._markers.place_again()
            self.place_held()
        self._markers.follow_frames()
        self._markers.files_read()

    def placed(self) -> Iterator[Placed]:
        """Yield the markers for rays."""
        yield from self._markers.placed()

    def selected(self, item: Selectable) -> SelectedData | None:
        """Return a marker while it is shown."""
        return self._markers.selected(item)

    def drop(self) -> None:
        """Take all markers out of the scene."""
        self._markers.clear()
        self._is_after_jump = True
        for key in (DUPLICATES, MESSAGES):
            self.status.remove(key)

    def assets_read(self) -> None:
        """Draw meshes that were read in the background."""
        self._files_found()

    def _files_found(self) -> None:
        if self.shown:
            self._markers.files_read()

    def _look_for_duplicates(self, markers: Sequence[Any]) -> None:
        seen: set[tuple[str, int]] = set()
        for marker in markers:
            if marker.action != 0:
                continue
            key = (marker.ns, marker.id)
            if key in seen:
                text = (
                    "Multiple Markers in the same MarkerArray message had the same ns "
                    f"and id: ({key[0]}, {key[1]})"
                )
                self.status.set(DUPLICATES, "Error", text)
                return
            seen.add(key)
        self.status.remove(DUPLICATES)

    # Namespaces

    def entries(self) -> tuple[EntryList, ...]:
        """Return the namespaces."""
        return (self._namespaces.entries(self._ticked, self._facts),)

    def values_put_back(self) -> None:
        """Hide or show what belongs to a namespace whose box was undone."""
        for name in self._namespaces.names:
            self._ticked(name)
        super().values_put_back()

    def _facts(self, namespace: str) -> Mapping[str, str]:
        return {"Markers": str(self._markers.count_of(namespace))}

    def _ticked(self, namespace: str) -> None:
        """Hide or show the markers of a namespace; RViz waits for others to show."""
        if self.shown:
            self._markers.follow_box(namespace)
            self.show_taken()


def _older() -> str:
    messages, size = limits.MARKER_MESSAGES.value, limits.MARKER_JUMP.value
    return (
        f"Of what was before a jump the last {KEPT_DEPTH_S:.0f} s are shown, up to "
        f"{messages:,} messages and {size:,} bytes: markers that were sent before are "
        "missing; to see them, play from an earlier time"
    )


def _too_many() -> str:
    messages, size = limits.MARKER_MESSAGES.value, limits.MARKER_BURST.value
    return (
        f"More than {messages:,} messages or {size:,} bytes came between two pictures: "
        "markers of the oldest ones may be missing"
    )


class MarkerArrayDisplay(MarkerDisplay):
    """The markers of a topic with arrays of them; none waits for its transform."""

    kind = "rviz_default_plugins/MarkerArray"
    meanings = frozenset({Meaning.MARKERS})
    tells_time = False
    properties = (
        topic_property(
            is_filtered=False, default="visualization_marker_array", ros1=ROS1_TOPIC
        ),
        _NAMESPACES,
    )

    def other_topics(self) -> Sequence[str]:
        """Return nothing: arrays are what its topic has."""
        return ()

    @property
    def most_held(self) -> int:
        """Return 0: no array waits for a transform."""
        return 0
