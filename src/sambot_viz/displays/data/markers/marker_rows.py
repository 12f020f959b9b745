"""The statuses of markers: one for each, up to a limit."""

from __future__ import annotations

from collections.abc import Collection

from sambot_viz import limits
from sambot_viz.displays.display import Level, StatusList

MARKERS = "Markers"


class MarkerRows:
    """The statuses of markers, by their names.

    Args:
        status: of the display.
        taken: what its other rows are called.
    """

    def __init__(self, status: StatusList, taken: Collection[str] = ()) -> None:
        self._status = status
        self._taken = {"", MARKERS, *taken}
        self._rows: dict[str, str] = {}

    def say(self, name: str, level: Level, text: str) -> None:
        """Say something of a marker, in place of what was said before."""
        row = self._rows.get(name)
        if row is None and len(self._rows) < limits.MARKER_ROWS.value:
            # A marker may be called as another row is, or have no name.
            row = f"Marker '{name}'" if name in self._taken else name
            self._rows[name] = row
        if row is not None:
            self._status.set(row, level, text)
        elif level != "Ok":
            most = limits.MARKER_ROWS.value
            more = f"More markers than the {most} that have a row here are wrong"
            self.say_of_all("Warn", more)

    def say_of_all(self, level: Level, text: str) -> None:
        """Say what concerns no single marker."""
        self._status.set(MARKERS, level, text)

    def __contains__(self, name: str) -> bool:
        """Return whether a marker has a status."""
        return name in self._rows

    def unsay(self, name: str) -> None:
        """Say nothing more of a marker."""
        row = self._rows.pop(name, None)
        if row is not None:
            self._status.remove(row)

    def unsay_all(self, namespace: str | None = None) -> None:
        """Say nothing more of any marker, or of those of a namespace."""
        for name in tuple(self._rows):
            if namespace is None or name.rpartition("/")[0] == namespace:
                self.unsay(name)

    def clear(self) -> None:
        """Say nothing more."""
        self.unsay_all()
        self._status.remove(MARKERS)
