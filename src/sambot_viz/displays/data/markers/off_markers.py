"""The markers of namespaces that are off: they are shown when their box is ticked."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from sambot_viz import limits
from sambot_viz.displays.data.markers.marker_fields import MarkerPose
from sambot_viz.displays.data.markers.marker_nodes import Key

"""Maximum number of markers kept, and of their points together."""


@dataclass(slots=True, eq=False)
class OffMarker:
    """A marker that is not shown.

    Attributes:
        marker: the message.
        until_ns: when it vanishes [ns]; None when it stays.
        place: where its frame was; None when that is to be looked up.
    """

    marker: Any
    until_ns: int | None
    place: MarkerPose | None


class OffMarkers:
    """Keeps markers, as long as there is room; RViz waits for them to come again."""

    def __init__(self) -> None:
        self._kept: dict[Key, OffMarker] = {}
        self._points = 0

    def keep(self, key: Key, one: OffMarker) -> None:
        """Keep a marker in place of the one with the same key."""
        self.drop(key)
        points = self._points + len(one.marker.points)
        most, most_points = limits.MARKERS.value, limits.MARKERS_POINTS.value
        if len(self._kept) < most and points <= most_points:
            self._kept[key] = one
            self._points = points

    def drop(self, key: Key) -> OffMarker | None:
        """Keep a marker no longer; return it."""
        one = self._kept.pop(key, None)
        if one is not None:
            self._points -= len(one.marker.points)
        return one

    def drop_all(self, namespace: str | None) -> Iterator[tuple[Key, OffMarker]]:
        """Yield the markers of a namespace, or all, which are then no longer kept."""
        for key in tuple(self._kept):
            if namespace is None or key[0] == namespace:
                one = self.drop(key)
                if one is not None:
                    yield key, one

    def expire(self, now_ns: int) -> None:
        """Forget those whose time is over."""
        for key, one in tuple(self._kept.items()):
            if one.until_ns is not None and one.until_ns <= now_ns:
                self.drop(key)

    def lose_places(self) -> None:
        """Have all places looked up in another fixed frame."""
        for one in self._kept.values():
            one.place = None
