"""The config that comes with the program, for a robot that has none of its own.

It was made for the tutorial's robot: each frame has its axes and its name, and the
robot can be seen through. For others it is plain: the robot is opaque, on a grid of its
size, and its frames are off, until they are ticked.
"""

from __future__ import annotations

import math

import numpy as np

from sambot_viz import bundled
from sambot_viz.displays.grid import GridDisplay
from sambot_viz.displays.robot_model.robot_model import RobotModelDisplay
from sambot_viz.displays.tf.tf import TfDisplay
from sambot_viz.frames.hierarchy import plain_name
from sambot_viz.robot.model import Robot
from sambot_viz.rviz import RvizConfig
from sambot_viz.session.document.display_edits import DisplayEdits
from sambot_viz.session.document.document import ShownDocument
from sambot_viz.session.robot.robot_state import RobotState
from sambot_viz.session.scene.picker import Picker
from sambot_viz.session.scene.scene import Scene
from sambot_viz.session.signals import connect
from sambot_viz.session.undo import History

TUTORIAL = "sam_bot"
"""The name of the tutorial's robot, which those who change a copy of it keep."""
CELLS = 2.0
"""So many cells of the grid, about, are as long as the robot: ten show five of it."""
_ALPHA = 0.6
"""Of the robot, in the file."""
_ROUND = (1.0, 2.0, 5.0, 10.0)
_SIZES = {
    GridDisplay.kind: ("Cell Size", 1.0),
    TfDisplay.kind: ("Marker Scale", 0.3),
}
"""What follows the size of the robot, and its value in the file."""


def take_root(document: RvizConfig, robot: Robot) -> None:
    """Take the root of a robot as the fixed frame, if it has none of that name."""
    if document.global_options.get("Fixed Frame") not in robot.links:
        document.global_options.set("Fixed Frame", plain_name(robot.root))


def make_plain(document: RvizConfig, robot: Robot) -> None:
    """Show only what a robot looks like, unless it is the tutorial's.

    A robot without a visual shape is seen by its frames, which stay.
    """
    seen = any(link.visuals for link in robot.links.values())
    if robot.name == TUTORIAL or not seen:
        return
    document.fits_robot = True
    for display in document.displays:
        if display.kind == RobotModelDisplay.kind:
            if display.get("Alpha") == _ALPHA:
                display.set("Alpha", 1.0)
        elif display.kind == TfDisplay.kind:
            display.set_enabled(False)


def fit_own_config(document: RvizConfig, robot: Robot | None) -> None:
    """Let the config that comes with the program fit a robot; others stay."""
    if robot is not None and bundled.is_bundled(document.file):
        take_root(document, robot)
        make_plain(document, robot)


class SizeOfRobot:
    """Gives the grid and the frames the size of the robot, where nobody has.

    That is once its meshes are read, in a config that no file says.

    Args:
        document: what is shown.
        scene: reads the meshes.
        robot: what is to be fitted.
        picker: finds how large it is.
        edits: set the sizes.
        history: records nothing of that.
    """

    def __init__(
        self,
        document: ShownDocument,
        scene: Scene,
        robot: RobotState,
        picker: Picker,
        edits: DisplayEdits,
        history: History,
    ) -> None:
        self._document = document
        self._scene = scene
        self._robot = robot
        self._picker = picker
        self._edits = edits
        self._history = history
        self._fitted: tuple[RvizConfig, Robot] | None = None
        self._given = dict(_SIZES.values())
        connect([robot.changed, scene.statuses], self._fit)

    def _fit(self) -> None:
        config, robot = self._document.config, self._robot.model
        if not config.fits_robot or robot is None or (config, robot) == self._fitted:
            return
        box = None
        if self._scene.context.assets.progress is None:
            box = self._picker.robot_box()
        if box is None or not bundled.is_bundled(config.file):
            return
        if self._fitted is None or self._fitted[0] is not config:
            self._given = dict(_SIZES.values())
        self._fitted = (config, robot)
        self._set(round_size(float(np.max(box[1] - box[0])) / CELLS))

    def _set(self, size: float) -> None:
        with self._history.unrecorded():
            for display in self._scene.displays:
                path, _ = _SIZES.get(display.config.kind, ("", 0.0))
                if path and display.config.get(path) == self._given[path]:
                    self._edits.set_property(display, path, size)
        self._given = dict.fromkeys(self._given, size)


def round_size(size: float) -> float:
    """Return the nearest of 1, 2 and 5 times a power of ten, by their ratio.

    Args:
        size: [m]; what is smaller than 0.1 mm is taken for that.
    """
    size = max(size, 1e-4)
    power = 10.0 ** math.floor(math.log10(size))
    nearest = min(_ROUND, key=lambda times: abs(math.log(size / (times * power))))
    return float(f"{nearest * power:.1g}")
