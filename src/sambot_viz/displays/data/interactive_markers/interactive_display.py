"""InteractiveMarkers: markers with handles, that a hand moves."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from sambot_viz import limits
from sambot_viz.displays.data.interactive_markers.controls import ShowOptions
from sambot_viz.displays.data.interactive_markers.initial_set import (
    FULL_TYPE,
    SERVICE,
    as_full_set,
)
from sambot_viz.displays.data.interactive_markers.interactive_markers import (
    InteractiveMarkers,
)
from sambot_viz.displays.data.interactive_markers.marker_handle import MarkerHandle
from sambot_viz.displays.data.markers.marker_rows import MarkerRows
from sambot_viz.displays.data.refused_messages import MESSAGE, MessageRefused, refusing
from sambot_viz.displays.data.topic_display import NO_SOURCE, TopicDisplay
from sambot_viz.displays.display import DisplayContext, Status
from sambot_viz.displays.picking.pick_geometry import PickGeometry
from sambot_viz.displays.picking.placed import Placed, PlacedShapes
from sambot_viz.displays.picking.selectable import Selectable
from sambot_viz.displays.picking.selected import SelectedData
from sambot_viz.displays.robot_display import Repair, WantedQos
from sambot_viz.displays.topic_messages import TopicDoubt, topics_of
from sambot_viz.geometry import Matrix
from sambot_viz.meanings import Meaning
from sambot_viz.rviz import BoolProperty, DisplayConfig, StringProperty
from sambot_viz.sources.message import Recorded
from sambot_viz.text import text
from sambot_viz.topics.service_message import ServiceMessage

NAMESPACE = "Interactive Markers Namespace"
ROS1_TOPIC = "Update Topic"
"""The key that ROS 1 has instead; its value is a topic of updates."""
CLIENT = "Interactive Marker Client"
UPDATES = "Updates"
"""Keys of statuses."""
UPDATE, FULL = "/update", "/update_full"
"""What the names of the topics end with."""
KEEP_ALIVE = 0
FEEDBACK = "/feedback"
"""Suffix of the topic on which the program receives the feedback."""
_PATIENCE = 5
"""Pause before a missing service is called again [s]."""
WHOLE_S = 1e8
"""How far back updates count where there is no full set [s]: three years."""


def namespace_of(topic: str) -> str:
    """Return the namespace of a topic of interactive markers, or of a namespace."""
    for end in (UPDATE, FULL):
        topic = topic.removesuffix(end)
    return topic.rstrip("/")


class InteractiveMarkersDisplay(TopicDisplay):
    """The interactive markers of a namespace, as its updates and full sets say."""

    kind = "rviz_default_plugins/InteractiveMarkers"
    meanings = frozenset({Meaning.INTERACTIVE_UPDATE, Meaning.INTERACTIVE_MARKERS})
    topic_path = NAMESPACE
    properties = (
        StringProperty(
            NAMESPACE,
            aliases=(ROS1_TOPIC,),
            help="What the names of the topics begin with; they end with /update, "
            "/update_full and /feedback.",
        ),
        BoolProperty(
            "Show Descriptions",
            default=True,
            help="Show the text above each marker.",
        ),
        BoolProperty(
            "Show Axes", default=False, help="Show the axes of the pose of each marker."
        ),
        BoolProperty(
            "Show Visual Aids",
            default=False,
            help="The line along the axis while a marker is dragged.",
            support="none",
            note="nothing is drawn while a marker is dragged",
        ),
        BoolProperty(
            "Enable Transparency",
            default=True,
            help="Let handles be transparent; else what can be seen is opaque.",
        ),
    )

    def __init__(self, context: DisplayContext, config: DisplayConfig, key: str):
        """Make the display; nothing is drawn before `draw`."""
        super().__init__(context, config, key)
        rows = MarkerRows(self.status, (CLIENT, UPDATES, MESSAGE))
        self._markers = InteractiveMarkers(context, rows, key, self.assets_read)
        self._drawn_in = context.fixed_frame
        self._full: tuple[str, int] | None = None
        self._last: tuple[str, int] | None = None
        self._missed = 0
        self._asked = False
        self._refused = ""
        self._pause = 0

    # Its topics

    @classmethod
    def topic_values(
        cls, topic: str, type_name: str, qos: WantedQos | None
    ) -> Mapping[str, object] | None:
        """Return the namespace of a topic."""
        found = super().topic_values(topic, type_name, qos)
        return None if found is None else {NAMESPACE: namespace_of(topic)}

    @property
    def namespace(self) -> str:
        """What the names of its topics begin with; empty when none is set."""
        return namespace_of(str(self.config.get(NAMESPACE)))

    @property
    def topic(self) -> str:
        """The name of the topic of updates; empty when none is set."""
        return f"{self.namespace}{UPDATE}" if self.namespace else ""

    @property
    def base_topic(self) -> str:
        """The name of the topic of full sets, which ROS 1 and some programs have."""
        return f"{self.namespace}{FULL}"

    def other_topics(self) -> Sequence[str]:
        """Return the topic of full sets."""
        return (self.base_topic,)

    @property
    def most_waiting(self) -> int:
        """Maximum number of waiting messages between two pictures."""
        return limits.INTERACTIVE_UPDATES.value

    @property
    def depth_s(self) -> float:
        """A marker comes once, and is only moved from then on."""
        return WHOLE_S

    # Its messages

    def messages_came(self) -> None:
        """Take full sets and updates in their order, and draw once."""
        if self.subscription is None:
            return
        came = self.subscription.drain()
        full = [i for i, one in enumerate(came) if one.topic == self.base_topic]
        # What was before the last full set is replaced by it.
        for one in came[full[-1] if full else 0 :]:
            self._take_one(one)
        self._draw()

    def _take_one(self, one: Recorded) -> None:
        assert self.subscription is not None
        try:
            with refusing(verb="taken"):
                message = self.subscription.decode(one)
                if one.topic == self.base_topic:
                    self._take_full(message)
                elif int(message.type) != KEEP_ALIVE:
                    self._take_update(message)
        except MessageRefused as refused:
            self.status.set(refused.key, "Error", refused.text, refused.code)
        else:
            self.status.remove(MESSAGE)

    def _take_full(self, message: Any) -> None:
        server, number = str(message.server_id), int(message.seq_num)
        last, is_answer = self._last, not server
        if is_answer:
            # The answer of the service does not say whose it is.
            server, self._refused = last[0] if last else "", ""
            # What has come in between is in the next answer.
            self._asked = last is None or number >= last[1]
        self._full = self._last = (server, number)
        self._missed = 0
        self._markers.replace_all(message.markers)

    def _take_update(self, message: Any) -> None:
        server, number = str(message.server_id), int(message.seq_num)
        if self._full is not None and self._full[0] in (server, ""):
            if number <= self._full[1]:
                return
        if self._last is not None and self._last[0] in (server, ""):
            missed = max(0, number - self._last[1] - 1)
        else:
            # Another program: what it has made before is in its answer.
            missed = int(self._last is not None)
        if missed:
            self._missed += missed
            self._asked = False
        self._last = (server, number)
        for marker in message.markers:
            self._markers.set(marker)
        for pose in message.poses:
            self._markers.move(pose)
        self._markers.erase(str(name) for name in message.erases)

    # What was there before

    def begin(self) -> None:
        """Ask for the markers that were there before."""
        self._asked, self._pause, self._refused = False, 0, ""
        self._ask()

    def time_passed(self) -> None:
        """Ask for the markers that were there before, if that was of no use yet."""
        self._pause = max(0, self._pause - 1)
        self._ask()
        super().time_passed()

    def _ask(self) -> None:
        """Ask the program for all its markers, when it may be there; once."""
        messages, subscription = self.context.messages, self.subscription
        if messages is None or subscription is None or self._asked or self._pause:
            return
        if messages.is_recorded(self.topic) or self.topic not in messages.types():
            return
        self._asked, self._pause = True, _PATIENCE
        service, topic = f"{self.namespace}{SERVICE}", self.base_topic
        asked = ServiceMessage(service, topic, FULL_TYPE, as_full_set, self._no_answer)
        messages.call(asked, subscription)

    def _no_answer(self, why: str) -> None:
        """Say why the service has not answered, and ask again later."""
        self._asked, self._refused = False, why

    # In a hand

    def placed(self) -> Iterator[Placed]:
        """Yield what tools that click can see: controls that are always visible."""
        yield from self._markers.placed()

    def handle_geometry(self, facing: Matrix) -> PickGeometry:
        """Return all its controls, for rays."""
        return PlacedShapes(tuple(self._markers.placed(facing)))

    @property
    def has_handles(self) -> bool:
        """Whether a program receives feedback about its markers."""
        messages = self.context.messages
        if messages is None or not self._markers.known:
            return False
        return not messages.is_recorded(self.topic)

    def handle(self, item: Selectable) -> MarkerHandle | None:
        """Return a control that a ray has met; None for anything else."""
        found = self._markers.control_of(item)
        if found is None or not self.has_handles:
            return None
        topic = f"{self.namespace}{FEEDBACK}"
        made = MarkerHandle(self.context, self._markers, found, topic, self._draw)
        return made if made.hint else None

    def selected(self, item: Selectable) -> SelectedData | None:
        """Return a marker of a control while it is shown."""
        return self._markers.selected(item)

    def redraw(self) -> None:
        """Draw what was taken again, with other properties or other frames."""
        if self.context.fixed_frame != self._drawn_in:
            self._drawn_in = self.context.fixed_frame
            self._markers.place_again()
        self._markers.look_again()
        self._draw()

    def forget(self) -> None:
        """Take all markers out of the scene."""
        self._markers.clear()
        self._full = self._last = None
        self._missed = 0
        for key in (MESSAGE, UPDATES):
            self.status.remove(key)

    def assets_read(self) -> None:
        """Draw meshes that were read in the background."""
        if self.shown:
            self._markers.files_read()
            self._draw()

    def _draw(self) -> None:
        get = self.config.get
        descriptions, axes = bool(get("Show Descriptions")), bool(get("Show Axes"))
        options = ShowOptions(descriptions, axes, bool(get("Enable Transparency")))
        self._markers.draw(options)
        if self.subscription is not None:
            self.subscription.waits = self._markers.waits

    # Statuses

    def report_topic(self) -> None:
        """Set the statuses of the namespace and of its updates."""
        found = self._client_status()
        self.status.set(CLIENT, found.level, found.text)
        if self._missed:
            many = (
                "1 update is" if self._missed == 1 else f"{self._missed:,} updates are"
            )
            said = f"{many} missing: markers may look otherwise"
            self.status.set(UPDATES, "Warn", said)
        else:
            self.status.remove(UPDATES)

    def _client_status(self) -> Status:
        if self.context.messages is None:
            return Status("Ok", "OK")
        if not self.namespace:
            return Status("Error", "Error connecting: empty namespace")
        doubt = self._doubt()
        if doubt is not None:
            return Status(doubt.level, doubt.sentence)
        if self._markers.known or (self._last and not self._markers.unknown):
            return Status("Ok", f"Connected on namespace: {self.namespace}")
        came = "No marker has come"
        if self._markers.unknown:
            name = next(iter(self._markers.unknown))
            came = f"Only poses have come, such as that of '{name}', and no marker"
        service = f"{self.namespace}{SERVICE}"
        why = "which has not answered yet"
        if self._refused:
            why = f"which does not: {text(self._refused, 300)}"
        elif self.context.messages.is_recorded(self.topic):
            why = "which a recording has not"
        return Status(
            "Warn",
            f"{came}: programs send them when they are made, and later only answer "
            f"the service {service}, {why}",
        )

    def _doubt(self) -> TopicDoubt | None:
        messages = self.context.messages
        if messages is None or not self.namespace:
            return None
        doubts = [
            messages.doubt(topic, self.meanings, WantedQos("Reliable", "Volatile"))
            for topic in (self.topic, self.base_topic)
        ]
        # Either of the two is enough.
        return doubts[0] if all(doubts) else None

    def notes(self) -> Mapping[str, str]:
        """Return why nothing comes, where no messages come at all."""
        return {} if self.context.messages else {NAMESPACE: NO_SOURCE}

    def options(self) -> Mapping[str, Sequence[str]]:
        """Return the namespaces that it could show."""
        messages = self.context.messages
        if messages is None:
            return {}
        topics = topics_of(messages.types(), self.meanings)
        return {NAMESPACE: sorted({self._as_written(topic) for topic in topics})}

    def repairs(self) -> Mapping[str, Repair]:
        """Return a button for the namespace that was meant."""
        doubt = self._doubt()
        if doubt is None or not doubt.instead:
            return {}
        meant = self._as_written(doubt.instead)
        return {CLIENT: Repair(f"Use {meant}", NAMESPACE, meant)}

    def _as_written(self, topic: str) -> str:
        """Return the namespace of a topic as the file has it."""
        namespace = namespace_of(topic)
        is_ros1 = self.config.declared[NAMESPACE].keys[-1] == ROS1_TOPIC
        return f"{namespace}{UPDATE}" if is_ros1 else namespace
