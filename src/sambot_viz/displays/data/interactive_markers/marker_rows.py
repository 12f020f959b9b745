"""What is said of interactive markers: a status for each, up to a number."""

from __future__ import annotations

from sambot_viz.displays.display import Level, StatusList

MOST_ROWS = 100
"""So many markers have a status of their own."""
MARKERS = "Markers"


class MarkerRows:
    """The statuses of interactive markers, by their names.

    Args:
        status: of the display.
    """

    def __init__(self, status: StatusList) -> None:
        self._status = status
        self._rows: set[str] = set()

    def say(self, name: str, level: Level, text: str) -> None:
        """Say something of a marker, in place of what was said before."""
        if name in self._rows or len(self._rows) < MOST_ROWS:
            self._rows.add(name)
            self._status.set(name, level, text)
        elif level != "Ok":
            more = f"More markers than the {MOST_ROWS} that have a row here are wrong"
            self.say_of_all(more)

    def say_of_all(self, text: str) -> None:
        """Warn of what concerns no single marker."""
        self._status.set(MARKERS, "Warn", text)

    def unsay(self, name: str) -> None:
        """Say nothing more of a marker."""
        if name in self._rows:
            self._rows.discard(name)
            self._status.remove(name)

    def clear(self) -> None:
        """Say nothing more."""
        for name in tuple(self._rows):
            self.unsay(name)
        self._status.remove(MARKERS)
