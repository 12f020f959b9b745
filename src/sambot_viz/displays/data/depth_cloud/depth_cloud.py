"""DepthCloud: the pixels of a depth image as points, with the colours of another."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any, ClassVar

import numpy as np

from sambot_viz import limits
from sambot_viz.displays.data.cloud.cloud import Cloud
from sambot_viz.displays.data.cloud.cloud_display import CloudDisplay
from sambot_viz.displays.data.cloud.cloud_properties import CLOUD_PROPERTIES
from sambot_viz.displays.data.depth_cloud.depth_points import (
    Occluded,
    cloud_of_depth,
    focus_of,
    metres_of,
)
from sambot_viz.displays.data.depth_cloud.depth_properties import (
    AUTO_SIZE,
    COLOR_HINT,
    COLOR_TOPIC,
    DEPTH_HINT,
    DEPTH_PROPERTIES,
    DEPTH_TOPIC,
    FACTOR,
    OCCLUSION,
    QUEUE_SIZE,
    TIME_OUT,
)
from sambot_viz.displays.data.depth_cloud.depth_sync import DepthMessage, DepthSync
from sambot_viz.displays.data.image.camera_info import (
    CAMERA_INFO,
    CameraNumbers,
    no_info,
    numbers_of,
    size_doubt,
)
from sambot_viz.displays.data.image.encodings import Bytes
from sambot_viz.displays.data.image.image_files import read_colors, read_depths
from sambot_viz.displays.data.image.transports import info_topic, sent_topic
from sambot_viz.displays.data.refused_messages import MESSAGE, MessageRefused, refusing
from sambot_viz.displays.display import DisplayContext
from sambot_viz.displays.robot_display import WantedQos
from sambot_viz.displays.scene.points import PointStyle
from sambot_viz.displays.topic_messages import topics_of
from sambot_viz.frames import Transform
from sambot_viz.geometry import Matrix
from sambot_viz.meanings import Meaning
from sambot_viz.rviz import DisplayConfig, Property
from sambot_viz.sources.message import Recorded

COLOR_IMAGE = "Color Image"
"""Key of a status."""
_NAMES = {DEPTH_TOPIC: ("depth",), COLOR_TOPIC: ("color", "rgb", "bgr", "gray", "mono")}
"""Words that a topic's name contains to be in a filtered list."""
_WHITE: Bytes = np.full(3, 255, np.uint8)
_NS = 1_000_000_000


class DepthCloudDisplay(CloudDisplay):
    """The points of depth images, each with the camera info and colours of its time."""

    kind = "rviz_default_plugins/DepthCloud"
    meanings = frozenset({Meaning.IMAGE, Meaning.IMAGE_FILE})
    topic_path = DEPTH_TOPIC
    properties: ClassVar[tuple[Property, ...]] = (*DEPTH_PROPERTIES, *CLOUD_PROPERTIES)

    def __init__(self, context: DisplayContext, config: DisplayConfig, key: str):
        """Make the display; nothing is drawn before `draw`."""
        super().__init__(context, config, key)
        self._sync = DepthSync(1, False)
        self._came: DepthMessage | None = None
        self._focus = 0.0
        self._occluded = Occluded()

    # Its topics

    @property
    def topic(self) -> str:
        """The topic of the depth images, as they are sent."""
        return self._sent(DEPTH_TOPIC, DEPTH_HINT)

    @property
    def color_topic(self) -> str:
        """The topic of the colour images, as they are sent; empty for none."""
        return self._sent(COLOR_TOPIC, COLOR_HINT)

    def _sent(self, path: str, hint: str) -> str:
        return sent_topic(str(self.config.get(path)), self.config.get(hint))

    def other_topics(self) -> Sequence[str]:
        """Return the topics of the camera infos and of the colour images."""
        color = self.color_topic
        return (info_topic(self.topic), *([color] if color else []))

    @property
    def wanted_qos(self) -> WantedQos:
        """The quality of service that it asks for; this display spells it its way."""
        reliability = str(self.config.get("Reliability Policy"))
        return WantedQos(reliability.replace("effort", "Effort"), "Volatile")

    @property
    def most_held(self) -> int:
        """Maximum number of messages held."""
        return int(self.config.acting(QUEUE_SIZE))

    @property
    def most_waiting(self) -> int:
        """Maximum number of waiting messages, of the three topics together."""
        return 3 * limits.DISPLAY_WAITING.value

    def options(self) -> Mapping[str, Sequence[str]]:
        """Return the topics, and what the points have fields for."""
        options = dict(super().options())
        messages = self.context.messages
        if messages is None:
            return options
        found = topics_of(messages.types(), self.meanings)
        for path, words in _NAMES.items():
            options[path] = found
            if self.config.get("Topic Filter"):
                lower = ((topic, topic.lower()) for topic in found)
                options[path] = [
                    topic for topic, name in lower if any(w in name for w in words)
                ]
        return options

    # What comes

    def wanted(self, came: Sequence[Recorded]) -> Sequence[Recorded]:
        """Return the depth images that have what belongs to them."""
        for one in came:
            key = COLOR_IMAGE if one.topic == self.color_topic else MESSAGE
            try:
                with refusing(key, "read"):
                    self._sort(one)
            except MessageRefused as refused:
                self.status.set(refused.key, "Error", refused.text, refused.code)
        ready = self._sync.ready()
        self._report_lacking()
        return ready

    def _sort(self, one: Recorded) -> None:
        assert self.subscription is not None
        if one.topic == self.topic:
            self._sync.take_depth(one, self.subscription.decode)
        elif one.topic == self.color_topic:
            self._sync.take_color(one, self.subscription.decode)
        else:
            self._sync.info = one

    def _report_lacking(self) -> None:
        """Say what the depth images lack, if they lack something."""
        messages, info = self.context.messages, info_topic(self.topic)
        if messages is None or not self.topic:
            return
        if self._sync.info is None:
            self.status.set(CAMERA_INFO, "Warn", no_info(info, messages))
        if self._sync.waits_for_color and COLOR_IMAGE not in self.status.rows:
            text = f"No image received on [{self.color_topic}]"
            self.status.set(COLOR_IMAGE, "Warn", text)

    def drop(self) -> None:
        """Take all points out of the scene."""
        super().drop()
        self._occluded = Occluded()

    def draw(self) -> None:
        """Listen to the topics, and draw what has come."""
        super().draw()
        self._report_lacking()

    def begin(self) -> None:
        """Wait for images and camera infos of another time or topic."""
        self._sync = DepthSync(self.most_held, bool(self.color_topic))
        for key in (CAMERA_INFO, COLOR_IMAGE):
            self.status.remove(key)

    def property_changed(self, path: str) -> None:
        """A property has a new value."""
        if path == QUEUE_SIZE:
            # The new queue is filled as it is after a jump.
            self._stop()
        elif path == OCCLUSION:
            self._occluded = Occluded()
        super().property_changed(path)

    def process(self, message: Any, T_fixed_frame: Transform, came: Recorded) -> None:
        """Take the points of a depth image."""
        assert isinstance(came, DepthMessage)
        self._came = came
        super().process(message, T_fixed_frame, came)

    def cloud_of(self, message: Any, T_fixed_frame: Transform) -> tuple[Cloud, Matrix]:
        """Return the points of a depth image, and the pose of its frame."""
        assert self._came is not None
        with refusing(MESSAGE, "read", OSError, SyntaxError):
            depths = metres_of(read_depths(message))
        most = limits.DEPTH_POINTS.value
        if depths.size > most:
            text = f"It has {depths.size:,} pixels: at most {most:,} are drawn"
            raise MessageRefused(text)
        camera = self._camera(self._came.info, depths.shape)
        colors = self._colors(self._came.color, depths.shape)
        self._focus = focus_of(camera)[0]
        cloud = cloud_of_depth(depths, camera, colors)
        if self.config.get(OCCLUSION):
            longest = float(self.config.get(TIME_OUT))
            now, limit = self._came.log_ns, round(min(longest, 1e6) * _NS)
            covered = self._occluded.behind(depths, colors, now, limit)
            cloud = _joined(cloud, cloud_of_depth(covered[0], camera, covered[1]))
        return cloud, T_fixed_frame.matrix

    def _camera(self, info: Recorded, shape: tuple[int, ...]) -> CameraNumbers:
        assert self.subscription is not None
        with refusing(CAMERA_INFO, "read"):
            camera = numbers_of(self.subscription.decode(info))
        doubt = size_doubt(camera, (shape[1], shape[0]))
        self.status.set(CAMERA_INFO, "Warn" if doubt else "Ok", doubt or "OK")
        return camera

    def _colors(self, image: Recorded | None, shape: tuple[int, ...]) -> Bytes:
        if image is None or self.subscription is None:
            self.status.remove(COLOR_IMAGE)
            return _WHITE
        try:
            with refusing(COLOR_IMAGE, "read", OSError, SyntaxError):
                colors = read_colors(self.subscription.decode(image))
        except MessageRefused as refused:
            raise MessageRefused(refused.text, COLOR_IMAGE) from refused
        if colors.shape[:2] != shape:
            (height, width), (rows, columns) = colors.shape[:2], shape
            text = f"It has {width} × {height} pixels, the depth image {columns} ×"
            raise MessageRefused(f"{text} {rows}: both need the same", COLOR_IMAGE)
        self.status.set(COLOR_IMAGE, "Ok", "OK")
        return colors

    # How it looks

    def style(self) -> PointStyle:
        """Return how all points look: as large as their pixels, or as was set."""
        style = super().style()
        if not self._grows:
            return style
        factor = float(self.config.get(FACTOR))
        edge = factor / abs(self._focus)
        return replace(style, size=(edge, edge, edge), is_by_depth=True)

    def notes(self) -> Mapping[str, str]:
        """Return how large points are, where that is not what was set."""
        notes = dict(super().notes())
        if self._grows:
            edge = self.style().size[0]
            notes["Size (m)"] = f"{AUTO_SIZE}: {edge:.3g} m for each metre of depth"
        return notes

    @property
    def _grows(self) -> bool:
        is_flat = self.config.acting("Style") == "Points"
        return bool(self.config.get(AUTO_SIZE)) and not is_flat and self._focus != 0.0


def _joined(one: Cloud, other: Cloud) -> Cloud:
    fields = {
        name: np.concatenate([values, other.fields[name]])
        for name, values in one.fields.items()
    }
    return Cloud(np.concatenate([one.points, other.points]), fields)
