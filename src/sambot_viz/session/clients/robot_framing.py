"""Showing the whole robot and all data at first, where the config says no distance."""

from __future__ import annotations

import math

import numpy as np
import viser

from sambot_viz.displays.picking.triangle_mesh import Corners
from sambot_viz.robot.model import Robot
from sambot_viz.session.document.document import ShownDocument
from sambot_viz.session.document.document_view import first_box
from sambot_viz.session.robot.robot_state import RobotState
from sambot_viz.session.scene.picker import Picker
from sambot_viz.session.scene.scene import Scene
from sambot_viz.views.view import View

Size = tuple[int, int]
"""Width and height [pixels]."""
_MUCH_LARGER = 2.0
"""A model that has grown by more than this is shown whole again."""


def window_of(client: viser.ClientHandle) -> Size:
    """The size of a browser's 3D view."""
    camera = client.camera
    return max(1, camera.image_width), max(1, camera.image_height)


class RobotFraming:
    """Decides when to move a browser's camera so that it shows robot and data whole.

    That is when the robot comes, once its meshes are read, when more of its links have
    a place, when one more display has drawn data, when a changed model gets its first
    shape or grows much larger, and when the window is resized; never after the user
    has moved the camera.

    Args:
        client: the client.
        document: knows whether data are shown that no config names.
        scene: reads the meshes.
        robot: the robot to show.
        picker: measures it.
    """

    def __init__(
        self,
        client: viser.ClientHandle,
        document: ShownDocument,
        scene: Scene,
        robot: RobotState,
        picker: Picker,
    ) -> None:
        self._document = document
        self._scene = scene
        self._robot = robot
        self._picker = picker
        self._client = client
        self._wanted = False
        self._window: Size | None = None
        # How many links had no place when the robot was shown, and in which state of
        # the tree they were counted; infinite until its meshes are read.
        self._missing, self._version = math.inf, -1
        self._data_drawn = 0
        # The robot that was looked at last, and its longest side when it was shown [m].
        self._seen: Robot | None = None
        self._length = 0.0

    @property
    def wanted(self) -> bool:
        """Whether to show the robot whole: the user has not chosen another view."""
        return self._wanted

    @property
    def waiting(self) -> bool:
        """Whether no robot was shown yet, and the user has not chosen another view."""
        return self._wanted and self._window is None

    def begin(self, view: View) -> None:
        """A view of the document is shown."""
        self._wanted = not view.gives_nearness
        self._window = None

    def stop(self) -> None:
        """The user, or a program, has taken another view."""
        self._wanted = False

    def box(self) -> Corners | None:
        """The box to show now; None when the camera is to stay as it is."""
        robot = self._robot.model
        if not self._wanted or robot is None:
            return None
        window = window_of(self._client)
        if window != self._window:
            self._missing, self._version, self._data_drawn = math.inf, -1, 0
        all_read = self._scene.context.assets.progress is None
        missing = self._without_place(robot) if all_read else math.inf
        unasked = self._document.config.unasked
        drawn = self._picker.data_drawn if unasked else 0
        is_more = (
            missing < self._missing
            or drawn > self._data_drawn
            or (all_read and self._is_much_larger())
        )
        if window == self._window and not is_more:
            if all_read:
                self._missing = missing
            return None
        found = first_box(self._document, self._scene, self._picker)
        if found is not None:
            self._window, self._missing = window, missing
            self._data_drawn = max(drawn, self._data_drawn)
            self._seen, self._length = self._scene.context.robot, self._longest_side()
        return found

    def _is_much_larger(self) -> bool:
        """Whether another robot is drawn now, larger than the picture was made for.

        A source that describes its robot again does not make it a new one.
        """
        context = self._scene.context
        drawn = context.robot
        if drawn is self._seen or context.descriptions is not None:
            return False
        self._seen = drawn
        return self._longest_side() > _MUCH_LARGER * self._length

    def _longest_side(self) -> float:
        """Return the longest side of the box around all links; 0 without a shape."""
        box = self._picker.link_box()
        return 0.0 if box is None else float(np.max(box[1] - box[0]))

    def _without_place(self, robot: Robot) -> float:
        """How many links have no place, if that may be less than before."""
        version = self._scene.context.tree.version
        if not self._missing or version == self._version:
            return self._missing
        self._version = version
        return sum(self._scene.fault_of(link) is not None for link in robot.links)
