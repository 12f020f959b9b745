"""Displays that draw what the newest message says, in the place of its frame."""

from __future__ import annotations

from typing import Any, Generic, TypeVar

from sambot_viz.displays.data.message_filter import MessageFilterDisplay
from sambot_viz.displays.display import DisplayContext
from sambot_viz.displays.scene.nodes import position_of
from sambot_viz.frames import Transform
from sambot_viz.geometry import (
    Matrix,
    Vector3,
    Wxyz,
    matrix_from_wxyz,
    wxyz_from_matrix,
)
from sambot_viz.rviz import DisplayConfig
from sambot_viz.sources.message import Recorded
from sambot_viz.topics.decoding import frame_and_stamp

T = TypeVar("T")


class NewestMessageDisplay(MessageFilterDisplay, Generic[T]):
    """Draws what it reads from the newest message.

    Attributes:
        frame: of that message.
    """

    def __init__(self, context: DisplayContext, config: DisplayConfig, key: str):
        """Make the display; nothing is drawn before `draw`."""
        super().__init__(context, config, key)
        self._taken: tuple[T, Wxyz, Vector3] | None = None
        self.frame = ""

    def read(self, message: Any) -> T:
        """Return what is drawn of a message.

        Raises:
            MessageRefused: it cannot be drawn.
        """
        raise NotImplementedError

    def draw_read(self, read: T, wxyz: Wxyz, position: Vector3) -> None:
        """Draw what was read as it looks now.

        Args:
            read: from the newest message.
            wxyz: rotation of its frame in the fixed frame.
            position: of its frame there [m].
        """
        raise NotImplementedError

    def remove(self) -> None:
        """Take everything out of the scene."""
        raise NotImplementedError

    def process(self, message: Any, T_fixed_frame: Transform, came: Recorded) -> None:
        """Take a message in the place of the one before."""
        matrix = T_fixed_frame.matrix
        place = wxyz_from_matrix(matrix), position_of(matrix)
        self._taken = (self.read(message), *place)
        self.frame = frame_and_stamp(message)[0]

    @property
    def taken(self) -> tuple[T, Matrix] | None:
        """What was read of the newest message, and T_fixed_frame, (4, 4)."""
        if self._taken is None:
            return None
        read, wxyz, position = self._taken
        return read, matrix_from_wxyz(wxyz, position)

    def show_taken(self) -> None:
        """Draw the newest message, if there is one."""
        if self._taken is not None:
            self.draw_read(*self._taken)

    def drop(self) -> None:
        """Take everything out of the scene, and forget the message."""
        self._taken = None
        self.remove()
