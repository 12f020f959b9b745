"""Displays that draw one solid for each message, and keep the newest ones."""

from __future__ import annotations

from typing import Any, ClassVar

from sambot_viz.displays.data.message_filter import MessageFilterDisplay
from sambot_viz.displays.display import DisplayContext
from sambot_viz.displays.scene.solid_nodes import Solid, SolidsNode
from sambot_viz.frames import Transform
from sambot_viz.geometry import Matrix
from sambot_viz.rviz import DisplayConfig
from sambot_viz.sources.message import Recorded


class KeptSolidsDisplay(MessageFilterDisplay):
    """Draws what each of the newest messages measures as a solid."""

    length: ClassVar[str]
    """The property that says how many messages are shown."""

    def __init__(self, context: DisplayContext, config: DisplayConfig, key: str):
        """Make the display; nothing is drawn before `draw`."""
        super().__init__(context, config, key)
        self._node = SolidsNode(context.scene, f"/{key}")
        self._kept: list[tuple[Any, Matrix]] = []

    def measured(self, message: Any) -> Any:
        """Return what is kept of a message.

        Raises:
            MessageRefused: it cannot be drawn.
        """
        raise NotImplementedError

    def solid(self, measured: Any, T_fixed_frame: Matrix) -> Solid | None:
        """Return how that is drawn; None for nothing.

        Args:
            measured: of a message.
            T_fixed_frame: (4, 4), of its frame.
        """
        raise NotImplementedError

    @property
    def needs_last_only(self) -> bool:
        """Whether one message is shown."""
        return self._most == 1

    @property
    def depth_s(self) -> float:
        """How far back messages count after a jump in a recording [s]."""
        return 1.0 if self._most == 1 else 60.0

    @property
    def _most(self) -> int:
        return int(self.config.acting(self.length))

    def process(self, message: Any, T_fixed_frame: Transform, came: Recorded) -> None:
        """Draw a message."""
        self._kept.append((self.measured(message), T_fixed_frame.matrix))
        self._show()

    def drop(self) -> None:
        """Take all out of the scene."""
        self._kept.clear()
        self._node.remove()

    def redraw(self) -> None:
        """Draw what is kept as it looks now."""
        super().redraw()
        self._show()

    def _show(self) -> None:
        del self._kept[: -self._most]
        solids = (self.solid(*one) for one in self._kept)
        self._node.draw([solid for solid in solids if solid is not None])
