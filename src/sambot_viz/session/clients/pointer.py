"""Show a presenter's selection to all clients for some seconds."""

from __future__ import annotations

from sambot_viz.displays.picking.selectable import Selection
from sambot_viz.session.robot.robot_state import RobotState
from sambot_viz.session.scene.picker import Picker
from sambot_viz.session.scene.scene import Scene
from sambot_viz.session.signals import Change, Listening
from sambot_viz.session.worker import Worker
from sambot_viz.tools.picking.selection_boxes import SelectionBoxes

SHOWN_FOR = 4.0
"""How long it is shown [s]."""
COLOR = (255, 200, 0)
THICKNESS = 5.0
"""Of the lines [pixels]: wide enough to be seen from the last row of a class."""


class Pointer:
    """Draws boxes around a selection, for all clients alike.

    They are nodes of the shared scene: the message is packed once, and clients that
    join see the boxes too. Removing them leaves nothing for clients that join later.

    Args:
        scene: the scene that they are drawn in.
        picker: computes the boxes.
        robot: the boxes move with it.
        change: sends the drawing.
        worker: removes them again.
    """

    def __init__(
        self,
        scene: Scene,
        picker: Picker,
        robot: RobotState,
        change: Change,
        worker: Worker,
    ) -> None:
        self._picker, self._change, self._worker = picker, change, worker
        self._boxes = SelectionBoxes(scene.context.scene, "pointed", COLOR, THICKNESS)
        self._items: Selection = {}
        self._until = 0.0
        self._waiting = False
        self._motion = (robot.positions, robot.changed, scene.frames)
        self._moving = Listening(self._draw)

    def show(self, items: Selection) -> None:
        """Show a selection for some seconds, beginning now."""
        self._items, self._until = dict(items), self._worker.clock.now() + SHOWN_FOR
        self._draw()
        self._moving.to(*self._motion)
        if not self._waiting:
            self._waiting = True
            self._worker.post_later(SHOWN_FOR, self._late)

    def hide(self) -> None:
        """Show nothing."""
        self._items = {}
        self._moving.to()
        self._draw()

    def _draw(self) -> None:
        with self._change():
            self._boxes.draw(self._picker.boxes_of(self._items))

    def _late(self) -> None:
        left = self._until - self._worker.clock.now()
        self._waiting = left > 0.0
        if self._waiting:
            self._worker.post_later(left, self._late)
        else:
            self.hide()
