"""Adapt the config that comes with the program to a robot without a config.

It was made for the tutorial's robot: each frame has its axes and its name, and the
robot is transparent. Other robots show frames too, but are opaque, and sizes are scaled
to them.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from sambot_viz import bundled
from sambot_viz.displays.grid import GridDisplay
from sambot_viz.displays.registry import DISPLAYS
from sambot_viz.displays.robot_model.robot_model import RobotModelDisplay
from sambot_viz.displays.scene_size import SceneSize, frame_spacing
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
MOST_NAMES = 30
"""The names and arrows of more frames would cover each other."""
_ALPHA = 0.6
"""Of the robot, in the file."""
_IN_FILE = {
    (GridDisplay.kind, "Cell Size"): 1.0,
    (TfDisplay.kind, "Marker Scale"): 0.3,
}
"""Values of the file that follow the size of the robot; of others, RViz's default."""


def is_own_config(document: RvizConfig) -> bool:
    """Return whether a document is that of the program, and not a user's."""
    return bundled.is_bundled(document.file)


def take_root(document: RvizConfig, robot: Robot) -> None:
    """Take the root of a robot as the fixed frame, if it has none of that name."""
    if document.global_options.get("Fixed Frame") not in robot.links:
        document.global_options.set("Fixed Frame", plain_name(robot.root))


def fit_robot(document: RvizConfig, robot: Robot) -> None:
    """Show a robot opaque and let sizes follow it, unless it is the tutorial's.

    Many frames have no names. A robot without a visual shape has no size; its frames
    keep theirs.
    """
    document.fits_robot = robot.name != TUTORIAL and any(
        link.visuals for link in robot.links.values()
    )
    for display in document.displays:
        if display.kind == RobotModelDisplay.kind:
            if document.fits_robot and display.get("Alpha") == _ALPHA:
                display.set("Alpha", 1.0)
        elif display.kind == TfDisplay.kind and len(robot.links) > MOST_NAMES:
            display.set("Show Names", False)
            display.set("Show Arrows", False)


def fit_own_config(document: RvizConfig, robot: Robot | None) -> None:
    """Let the config that comes with the program fit a robot; others stay."""
    if robot is not None and is_own_config(document):
        take_root(document, robot)
        fit_robot(document, robot)


class SizeOfRobot:
    """Scales displays to the robot, unless a user has chosen a size.

    Displays of the config and of a source's data are scaled once the meshes are read;
    added ones from the start. A user's own config is left alone.

    Args:
        document: the shown document.
        scene: reads the meshes.
        robot: the robot to fit.
        picker: measures it.
        edits: sets the sizes.
        history: leaves these edits out.
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
        self._fitted: tuple[RvizConfig, Robot, int] | None = None
        self._given = dict(_IN_FILE)
        connect([robot.changed, scene.statuses], self._fit)
        edits.sizes_of = self._sizes_of

    def _fit(self) -> None:
        config, robot = self._document.config, self._robot.model
        if robot is None or not config.fits_scene:
            return
        shown = (config, robot, len(config.unasked))
        if shown == self._fitted or self._scene.context.assets.progress is not None:
            return
        size = self._size()
        if size is None:
            return
        if self._fitted is None or self._fitted[0] is not config:
            self._given = dict(_IN_FILE)
        self._fitted = shown
        self._set(size)

    def _size(self) -> SceneSize | None:
        """Return the size of the robot, or else how far frames are from each other.

        None where there is neither, and in a user's config.
        """
        if self._robot.model is None or not is_own_config(self._document.config):
            return None
        tree, box = self._scene.context.tree, self._picker.link_box()
        if box is None:
            # Axes follow how far frames are apart over the whole recording, so that
            # they are seen at each time of it.
            is_alone = self._document.config.fits_frames
            apart = self._scene.whole_run().spacing if is_alone else 0.0
            return SceneSize(2 * apart, apart) if apart else None
        length = float(np.max(box[1] - box[0]))
        return SceneSize(length, frame_spacing(tree, length))

    def _sizes_of(self, kind: str) -> Mapping[str, float]:
        """Return the sizes of a display that is added, by path."""
        size = self._size()
        return {} if size is None else DISPLAYS[kind].size_values(size)

    def _set(self, size: SceneSize) -> None:
        config, given = self._document.config, dict(self._given)
        with self._history.unrecorded():
            for display in self._scene.displays:
                unasked = display.config in config.unasked
                of_frames = config.fits_frames and display.config.kind == TfDisplay.kind
                if not (config.fits_robot or of_frames or unasked):
                    continue
                kind, declared = display.config.kind, display.config.declared
                for path, value in display.size_values(size).items():
                    default = declared[path].property.default
                    olds = [given.get((kind, path), default)]
                    if unasked:
                        # It may have come after others of its kind.
                        olds.append(default)
                    self._given[kind, path] = value
                    if display.config.get(path) in olds:
                        self._edits.set_property(display, path, value)
