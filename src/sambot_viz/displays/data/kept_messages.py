"""Displays that draw some of the newest messages, such as a solid for each."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any, ClassVar

from sambot_viz.displays.data.message_filter import MessageFilterDisplay
from sambot_viz.displays.display import DisplayContext
from sambot_viz.displays.picking.placed import HERE, Placed
from sambot_viz.displays.scene.solid_nodes import Solid, SolidsNode
from sambot_viz.frames import Transform
from sambot_viz.geometry import Matrix
from sambot_viz.rviz import DisplayConfig
from sambot_viz.sources.message import Recorded


class KeptMessagesDisplay(MessageFilterDisplay):
    """Draws so many of the newest messages as a property says."""

    length: ClassVar[str]
    """The property that says how many."""

    @property
    def needs_last_only(self) -> bool:
        """Whether one message is shown."""
        return self.most == 1

    @property
    def most(self) -> int:
        """So many messages are shown."""
        return int(self.config.acting(self.length))


class KeptReadingsDisplay(KeptMessagesDisplay):
    """Draws what each of the newest messages measures."""

    def __init__(self, context: DisplayContext, config: DisplayConfig, key: str):
        """Make the display; nothing is drawn before `draw`."""
        super().__init__(context, config, key)
        self._kept: list[tuple[Any, Matrix]] = []

    def measured(self, message: Any) -> Any:
        """Return what is kept of a message.

        Raises:
            MessageRefused: it cannot be drawn.
        """
        raise NotImplementedError

    def draw_kept(self, kept: Sequence[tuple[Any, Matrix]]) -> None:
        """Draw what was measured as it looks now, and nothing else.

        Args:
            kept: of each message, with T_fixed_frame, (4, 4), of its frame.
        """
        raise NotImplementedError

    def remove(self) -> None:
        """Take everything out of the scene."""
        raise NotImplementedError

    def process(self, message: Any, T_fixed_frame: Transform, came: Recorded) -> None:
        """Keep what a message measures."""
        self._kept.append((self.measured(message), T_fixed_frame.matrix))

    def show_taken(self) -> None:
        """Draw what is kept as it looks now."""
        del self._kept[: -self.most]
        self.draw_kept(self._kept)

    def drop(self) -> None:
        """Take everything out of the scene, and forget what was measured."""
        self._kept.clear()
        self.remove()


class KeptSolidsDisplay(KeptReadingsDisplay):
    """Draws what each of the newest messages measures as a solid."""

    def __init__(self, context: DisplayContext, config: DisplayConfig, key: str):
        """Make the display; nothing is drawn before `draw`."""
        super().__init__(context, config, key)
        self._node = SolidsNode(context.scene, f"/{key}")

    def solid(self, measured: Any, T_fixed_frame: Matrix) -> Solid | None:
        """Return how that is drawn; None for nothing.

        Args:
            measured: of a message.
            T_fixed_frame: (4, 4), of its frame.
        """
        raise NotImplementedError

    def draw_kept(self, kept: Sequence[tuple[Any, Matrix]]) -> None:
        """Draw the solids."""
        solids = (self.solid(*one) for one in kept)
        self._node.draw([solid for solid in solids if solid is not None])

    def placed(self) -> Iterator[Placed]:
        """Yield the solids, which cannot be selected, as in RViz."""
        yield from self._node.placed(HERE, None)

    def remove(self) -> None:
        """Take all solids out of the scene."""
        self._node.remove()
