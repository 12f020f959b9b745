"""Showing the whole robot at first, where the config says no distance."""

from __future__ import annotations

import viser

from sambot_viz.displays.picking.pick_geometry import Corners
from sambot_viz.session.robot.robot_state import RobotState
from sambot_viz.session.scene.picker import Picker
from sambot_viz.session.scene.scene import Scene
from sambot_viz.views.view import View

Size = tuple[int, int]
"""Width and height [pixels]."""


def window_of(client: viser.ClientHandle) -> Size:
    """The size of a browser's 3D view."""
    camera = client.camera
    return max(1, camera.image_width), max(1, camera.image_height)


class RobotFraming:
    """When a browser's camera is to be moved so that it shows the whole robot.

    That is when the robot comes, once its meshes are read, and in a window of another
    size; never after the user has moved the camera.

    Args:
        client: the client.
        scene: reads the meshes.
        robot: what is to be shown.
        picker: finds how large it is.
    """

    def __init__(
        self,
        client: viser.ClientHandle,
        scene: Scene,
        robot: RobotState,
        picker: Picker,
    ) -> None:
        self._scene = scene
        self._robot = robot
        self._picker = picker
        self._client = client
        self._wanted = False
        self._window: Size | None = None
        self._complete = False

    def begin(self, view: View) -> None:
        """A view of the document is shown."""
        self._wanted = not view.gives_nearness
        self._window, self._complete = None, False

    def stop(self) -> None:
        """The user, or a program, has taken another view."""
        self._wanted = False

    def box(self) -> Corners | None:
        """The box to show now; None when the camera is to stay as it is."""
        if not self._wanted or self._robot.model is None:
            return None
        window = window_of(self._client)
        all_read = self._scene.context.assets.progress is None
        if window == self._window and (self._complete or not all_read):
            return None
        found = self._picker.robot_box()
        if found is not None:
            self._window, self._complete = window, all_read
        return found
