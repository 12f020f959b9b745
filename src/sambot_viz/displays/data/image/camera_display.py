"""Camera: the pictures of a camera with the scene over them, in a panel."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from sambot_viz import limits
from sambot_viz.displays.camera_pictures import NO_PICTURE, CameraPicture
from sambot_viz.displays.data.image.camera_info import (
    CAMERA_INFO,
    CameraNumbers,
    no_info,
    numbers_of,
    size_doubt,
)
from sambot_viz.displays.data.image.encodings import (
    IMAGE,
    Bytes,
    Values,
    require_shown,
)
from sambot_viz.displays.data.image.image_display import NONE_YET
from sambot_viz.displays.data.image.image_files import picture_of
from sambot_viz.displays.data.image.ranges import Ranges, scaled
from sambot_viz.displays.data.image.transports import (
    ROS1_HINT,
    ROS1_TOPIC,
    hint_property,
    info_topic,
    sent_topic,
)
from sambot_viz.displays.data.image.visibility import VISIBILITY, Visibility
from sambot_viz.displays.data.kept import Taken
from sambot_viz.displays.data.message_filter import MessageFilterDisplay
from sambot_viz.displays.data.refused_messages import MessageRefused, refusing
from sambot_viz.displays.data.topic_display import topic_property
from sambot_viz.displays.display import DisplayContext, EntryList
from sambot_viz.displays.scene.frame_nodes import placed
from sambot_viz.frames import Transform
from sambot_viz.geometry import Matrix, wxyz_from_matrix
from sambot_viz.meanings import Meaning
from sambot_viz.rviz import (
    BoolProperty,
    DisplayConfig,
    EnumProperty,
    FloatProperty,
)
from sambot_viz.sources.message import Recorded

_BACK, _OVER = "background", "overlay"
_BOTH = f"{_BACK} and {_OVER}"
RENDERING = "Image Rendering"
MEDIAN = 5
"""Number of pictures over which the range of 16-bit and float values is the median."""


class CameraDisplay(MessageFilterDisplay[Any]):
    """The newest picture of a camera, and what the page needs to draw the scene in it.

    The picture is made while some page shows it.
    """

    kind = "rviz_default_plugins/Camera"
    meanings = frozenset({Meaning.IMAGE, Meaning.IMAGE_FILE})
    properties = (
        BoolProperty(
            VISIBILITY,
            default=True,
            open_keys=True,
            help="The displays that are drawn in the picture. Names of frames are not, "
            "where one of the displays that have some is left out.",
        ),
        topic_property(is_filtered=False, ros1=ROS1_TOPIC),
        hint_property(),
        EnumProperty(
            RENDERING,
            default=_BOTH,
            options=(_BACK, _OVER, _BOTH),
            help="Whether the image is behind the scene, over it, or both.",
        ),
        FloatProperty(
            "Overlay Alpha",
            default=0.5,
            minimum=0.0,
            maximum=1.0,
            help="How opaque the image over the scene is.",
            hidden_unless=(RENDERING, (_OVER, _BOTH)),
        ),
        FloatProperty(
            "Zoom Factor",
            default=1.0,
            minimum=1e-5,
            maximum=1e5,
            help="How many times as large everything is.",
        ),
        FloatProperty(
            "Far Plane Distance",
            default=100.0,
            minimum=1e-5,
            maximum=1e5,
            unit="m",
            help="What is farther away is not drawn.",
        ),
    )

    def __init__(self, context: DisplayContext, config: DisplayConfig, key: str):
        """Make the display; nothing is decoded before a page shows it."""
        super().__init__(context, config, key)
        self._visibility = Visibility(self)
        self._ranges = Ranges()
        self._info: Recorded | None = None
        self._made: CameraPicture | None = None
        self._put: CameraPicture | None = None

    # Its topics

    @property
    def topic(self) -> str:
        """The name of the topic; ROS 1 names that of whole pictures for all kinds."""
        return sent_topic(super().topic, self.config.properties.get(ROS1_HINT))

    def other_topics(self) -> Sequence[str]:
        """Return the topic of the camera infos."""
        return (info_topic(self.topic),)

    @property
    def most_held(self) -> int:
        """Maximum number of pictures held."""
        return limits.IMAGES_WAITING.value

    @property
    def most_waiting(self) -> int:
        """Maximum number of waiting messages between two pictures, of both topics."""
        return 2 * limits.DISPLAY_WAITING.value

    def begin(self) -> None:
        """Wait for a camera info of another time or topic."""
        self._info = None
        self._ranges.clear()
        for key in (CAMERA_INFO, IMAGE):
            self.status.remove(key)

    # What comes

    def wanted(self, came: Sequence[Recorded]) -> Sequence[Recorded]:
        """Return the pictures; of the camera infos the newest counts."""
        infos = [one for one in came if one.topic != self.topic]
        if infos:
            self._info = infos[-1]
        return [one for one in came if one.topic == self.topic]

    def messages_came(self) -> None:
        """Show the newest picture that has a place, if a page shows the panel."""
        before = self._info
        super().messages_came()
        if self._info is not before:
            self.show_taken()

    def process(self, message: Any, T_fixed_frame: Transform, came: Recorded) -> None:
        """Take a picture; it is made when it is shown."""
        self._made, self.kept = None, [Taken(message, T_fixed_frame.matrix)]

    def drop(self) -> None:
        """Show no picture."""
        super().drop()
        self._made = None
        self._show(NO_PICTURE)

    def draw(self) -> None:
        """Listen to the topics, and show what has come."""
        self.context.pictures.begin(self.key, self.show_taken)
        super().draw()

    def clear(self) -> None:
        """Listen no longer."""
        super().clear()
        self.context.pictures.end(self.key)
        self._put = None

    def time_passed(self) -> None:
        """Look whether other displays are to be drawn: some were added or renamed."""
        super().time_passed()
        if self.shown and self.kept:
            self.show_taken()

    # What is shown

    def show_taken(self) -> None:
        """Show the picture with the present settings, and send it only if changed."""
        if not self.kept:
            if self.context.messages is not None and self.topic:
                self.status.set(IMAGE, "Warn", NONE_YET, "no-message")
            return
        message, T_fixed_camera = self.kept[-1].read, self.kept[-1].T_fixed_frame
        camera = self._camera()
        if not self.context.pictures.is_wanted(self.key):
            # A picture that could not be made is not made again to say so.
            if self._made != NO_PICTURE:
                self._made = None
                self._is_refused(lambda: require_shown(message))
            return
        if self._made is None:
            self._made = self._picture(message)
        view = None
        if camera is not None and self._made != NO_PICTURE:
            view = self._view(camera, self._made, T_fixed_camera)
        self._show(replace(self._made, view=view))

    def _picture(self, message: Any) -> CameraPicture:
        """Return the picture of a message, or say why there is none."""
        made = list[CameraPicture]()
        if self._is_refused(lambda: made.append(picture_of(message, self._grey))):
            return NO_PICTURE
        return made[0]

    def _is_refused(self, look: Callable[[], object]) -> bool:
        """Inspect a picture, and report its faults in the status."""
        try:
            # Files of pictures break in more ways than those of a message.
            with refusing(IMAGE, "shown", OSError, SyntaxError):
                look()
        except MessageRefused as refused:
            self.status.set(IMAGE, "Error", refused.text, refused.code)
            return True
        self.status.remove(IMAGE)
        return False

    def _show(self, picture: CameraPicture) -> None:
        if picture != self._put and self.key in self.context.pictures:
            self._put = picture
            self.context.pictures.put(self.key, picture)

    def _grey(self, values: Values) -> Bytes:
        self._ranges.add(values)
        return scaled(values, self._ranges.median(MEDIAN))

    def _camera(self) -> CameraNumbers | None:
        """Return the numbers of the camera, or say why there are none."""
        messages, topic = self.context.messages, info_topic(self.topic)
        if self._info is None or self.subscription is None or not self.kept:
            self.status.set(CAMERA_INFO, "Warn", no_info(topic, messages))
            return None
        try:
            with refusing(CAMERA_INFO, "read"):
                camera = numbers_of(self.subscription.decode(self._info))
        except MessageRefused as refused:
            self.status.set(CAMERA_INFO, "Error", refused.text, refused.code)
            return None
        image, doubt = self.kept[-1].read, None
        if hasattr(image, "width"):
            doubt = size_doubt(camera, (int(image.width), int(image.height)))
        self.status.set(CAMERA_INFO, "Warn" if doubt else "Ok", doubt or "OK")
        return camera

    def _view(
        self, camera: CameraNumbers, picture: CameraPicture, T_fixed_camera: Matrix
    ) -> Mapping[str, object]:
        """Return how the page draws the scene in a picture."""
        (fx, fy), (tx, ty) = camera.focus, camera.shift
        R: Matrix = T_fixed_camera[:3, :3]
        with np.errstate(over="ignore", invalid="ignore"):
            at = T_fixed_camera[:3, 3] - R[:, 0] * (tx / fx) + R[:, 1] * (ty / fy)
        wxyz, position = placed(wxyz_from_matrix(T_fixed_camera), at.tolist())
        get, rendering = self.config.get, self.config.acting(RENDERING)
        return {
            "position": position,
            "wxyz": wxyz,
            "focus": camera.focus,
            "center": camera.center,
            "size": (camera.width or picture.width, camera.height or picture.height),
            "roi": camera.roi,
            "zoom": float(get("Zoom Factor")),
            "far": float(get("Far Plane Distance")),
            "behind": rendering != _OVER,
            "over": 0.0 if rendering == _BACK else float(get("Overlay Alpha")),
            "hidden": list(self._visibility.hidden()),
        }

    # The displays in it

    def entries(self) -> tuple[EntryList, ...]:
        """Return the boxes of the displays."""
        return (self._visibility.entries(),)
