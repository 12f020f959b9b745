"""RViz's Time panel: at which display's times frames are drawn."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from sambot_viz.frames.display_time import SyncMode
from sambot_viz.panels.panel import Panel
from sambot_viz.panels.rows.row import Data, Json, Row
from sambot_viz.session.data.session_sources import SessionSources
from sambot_viz.session.document.document import ShownDocument
from sambot_viz.session.scene.scene import Scene
from sambot_viz.session.signals import Signal

BEHIND = "time/behind"
_LABELS = {mode.name.capitalize(): int(mode) for mode in SyncMode}


class TimePanel(Panel):
    """Shows and sets what the latest time means.

    Args:
        document: has the setting.
        scene: has the displays.
        sources: have the messages.
    """

    name = "time"
    period = 1.0

    def __init__(
        self, document: ShownDocument, scene: Scene, sources: SessionSources
    ) -> None:
        self.remade_by = (document.time, document.displays, sources.replaced)
        self._document = document
        self._scene = scene
        self._sources = sources

    @property
    def moved_by(self) -> Sequence[Signal[Any]]:
        """What displays draw may be of another time."""
        is_on = self._document.synchronization[0] != SyncMode.OFF
        return (self._scene.data,) if is_on else ()

    def rows(self) -> Sequence[Row]:
        """Return the mode, and the display whose messages count."""
        mode, source = self._document.synchronization
        names = [one.config.name for one in self._scene.displays if one.tells_time]
        known = dict.fromkeys([*names, source] if source else names)
        return [
            Row(
                "time/mode",
                "",
                "enum",
                "Synchronization",
                value=SyncMode(mode).name.capitalize(),
                options=tuple(_LABELS),
                help="Off draws frames where they are now; Exact where they were at "
                "the stamp of the source's last message; Approximate as long ago as "
                "its messages take to come.",
                set=self._set_mode,
            ),
            Row(
                "time/source",
                "",
                "enum",
                "Source",
                value=source,
                options=tuple(known),
                help="The display whose messages say when frames are drawn.",
                set=lambda name: self._document.synchronize(mode, name),
            ),
        ]

    def data(self) -> Sequence[Data]:
        """Return how long ago that is which is drawn [s]."""
        return [Data(BEHIND, self._behind())]

    def values(self) -> dict[str, Json]:
        """Return how long ago that is which is drawn [s]."""
        return {BEHIND: self._behind()}

    def _behind(self) -> float:
        data = self._sources.data
        return 0.0 if data is None else round(data.time.behind_s, 2)

    def _set_mode(self, label: str) -> None:
        _, source = self._document.synchronization
        first = (one.config.name for one in self._scene.displays if one.tells_time)
        self._document.synchronize(_LABELS[label], source or next(first, ""))
