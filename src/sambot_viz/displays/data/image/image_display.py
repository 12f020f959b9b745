"""Image: the pictures of a camera, in a panel beside the view."""

from __future__ import annotations

from contextlib import suppress
from typing import Any

from sambot_viz import limits
from sambot_viz.displays.camera_pictures import NO_PICTURE
from sambot_viz.displays.data.image.encodings import (
    IMAGE,
    Bytes,
    Values,
    require_shown,
)
from sambot_viz.displays.data.image.image_files import picture_of
from sambot_viz.displays.data.image.ranges import Ranges, scaled
from sambot_viz.displays.data.image.transports import (
    ROS1_HINT,
    ROS1_TOPIC,
    hint_property,
    sent_topic,
)
from sambot_viz.displays.data.refused_messages import MessageRefused, refusing
from sambot_viz.displays.data.topic_display import TopicDisplay, topic_property
from sambot_viz.displays.display import DisplayContext
from sambot_viz.errors import DecodeError
from sambot_viz.meanings import Meaning
from sambot_viz.rviz import (
    BoolProperty,
    DisplayConfig,
    FloatProperty,
    IntProperty,
)
from sambot_viz.sources.message import Recorded

NONE_YET = "No Image received"
NORMALIZE = "Normalize Range"


class ImageDisplay(TopicDisplay):
    """The newest picture of sensor_msgs/Image or CompressedImage.

    Its pixels are unpacked while some page shows it.
    """

    kind = "rviz_default_plugins/Image"
    differs = (
        "It is no part of the 3D view, so `snapshot` and exported pages do not have "
        "it; nor has RViz's File > Save Image, unless it saves the whole window."
    )
    meanings = frozenset({Meaning.IMAGE, Meaning.IMAGE_FILE})
    tells_time = True
    properties = (
        topic_property(is_filtered=False, ros1=ROS1_TOPIC),
        hint_property(),
        BoolProperty(
            NORMALIZE,
            default=True,
            help="Show 16-bit and float values from the least to the greatest one.",
        ),
        FloatProperty(
            "Min Value",
            default=0.0,
            help="The whole number that is black.",
            hidden_unless=(NORMALIZE, False),
        ),
        FloatProperty(
            "Max Value",
            default=1.0,
            help="The whole number that is white.",
            hidden_unless=(NORMALIZE, False),
        ),
        IntProperty(
            "Median window",
            default=5,
            minimum=1,
            maximum=limits.IMAGE_MEDIAN.value,
            help="Number of pictures over which the range is the median.",
            hidden_unless=(NORMALIZE, True),
        ),
    )

    def __init__(self, context: DisplayContext, config: DisplayConfig, key: str):
        """Make the display; nothing is decoded before a page shows it."""
        super().__init__(context, config, key)
        self._newest: Recorded | None = None
        self._ranges = Ranges()
        self._measured: Recorded | None = None
        self._made: tuple[object, ...] | None = None
        self._judged: Recorded | None = None

    @property
    def topic(self) -> str:
        """The name of the topic; ROS 1 names that of whole pictures for all kinds."""
        return sent_topic(super().topic, self.config.properties.get(ROS1_HINT))

    @property
    def most_waiting(self) -> int:
        """Return 1: only the newest picture is shown."""
        return 1

    def draw(self) -> None:
        """Listen to the topic, and show what has come."""
        self.context.pictures.begin(self.key, self._wake)
        super().draw()

    def clear(self) -> None:
        """Listen no longer."""
        super().clear()
        self.context.pictures.end(self.key)

    def messages_came(self) -> None:
        """Show the newest picture, if a page shows the panel."""
        if self.subscription is None:
            return
        if came := self.subscription.drain():
            self._newest = came[-1]
            time = self.context.time
            if time is not None and time.is_told_by(self.config.name):
                with suppress(DecodeError):
                    self.tell_time(self.subscription.decode(came[-1]))
        self.redraw()

    def forget(self) -> None:
        """Show no picture."""
        self._newest = self._measured = self._made = self._judged = None
        self._ranges.clear()
        self.status.remove(IMAGE)
        if self.key in self.context.pictures:
            self.context.pictures.put(self.key, NO_PICTURE)

    def redraw(self) -> None:
        """Make the picture again when a setting is another one."""
        pictures = self.context.pictures
        if self._newest is None:
            if self.context.messages is not None and self.topic:
                self.status.set(IMAGE, "Warn", NONE_YET, "no-message")
            return
        if not pictures.is_wanted(self.key):
            self._judge(self._newest)
            return
        self._judged = self._newest
        names = (NORMALIZE, "Min Value", "Max Value", "Median window")
        made = (self._newest, *(self.config.get(name) for name in names))
        if self._made is not None and all(map(_same, made, self._made)):
            return
        self._made = made
        try:
            # Files of pictures break in more ways than those of a message.
            with refusing(IMAGE, "shown", OSError, SyntaxError):
                self._show(self._newest)
        except MessageRefused as refused:
            self._refuse(refused)
        else:
            self.status.remove(IMAGE)

    def _judge(self, newest: Recorded) -> None:
        """Report of a picture that no page shows whether it could be shown.

        The first picture answers for the following ones; after one that cannot be shown
        each is inspected. No pixel is unpacked.
        """
        status = self.status.rows.get(IMAGE)
        is_bad = status is not None and status.level == "Error"
        if self.subscription is None or newest is self._judged:
            return
        if self._judged is not None and not is_bad:
            return
        self._judged = newest
        try:
            with refusing(IMAGE, "shown"):
                require_shown(self.subscription.decode(newest))
        except MessageRefused as refused:
            self._refuse(refused)
        else:
            self.status.remove(IMAGE)

    def _wake(self) -> None:
        self.redraw()

    def _refuse(self, refused: MessageRefused) -> None:
        self.status.set(IMAGE, "Error", refused.text, refused.code)
        self.context.pictures.put(self.key, NO_PICTURE)

    def _show(self, came: Recorded) -> None:
        if self.subscription is None:
            return
        picture = picture_of(self.subscription.decode(came), self._grey)
        self.context.pictures.put(self.key, picture)

    def _grey(self, values: Values) -> Bytes:
        get: Any = self.config.get
        if not get(NORMALIZE):
            return scaled(values, (get("Min Value"), get("Max Value")))
        if self._measured is not self._newest:
            self._measured = self._newest
            self._ranges.add(values)
        return scaled(values, self._ranges.median(int(get("Median window"))))


def _same(one: object, other: object) -> bool:
    # Of messages only the identity counts: to compare them means all their bytes.
    return one is other if isinstance(one, Recorded) else one == other
