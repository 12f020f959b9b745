"""The markers of one display: added, replaced, deleted, grown old."""

from __future__ import annotations

import heapq
from collections.abc import Callable, Iterator
from typing import Any

from sambot_viz import limits
from sambot_viz.displays.data.markers.checks import check_of, looks_the_same
from sambot_viz.displays.data.markers.marker_fields import MarkerPose
from sambot_viz.displays.data.markers.marker_nodes import Key, MarkerNodes
from sambot_viz.displays.data.markers.marker_rows import MarkerRows
from sambot_viz.displays.data.markers.namespaces import Namespaces
from sambot_viz.displays.data.markers.off_markers import OffMarker, OffMarkers
from sambot_viz.displays.data.markers.shown_markers import Shown, selected_marker
from sambot_viz.displays.display import DisplayContext, Level, StatusList
from sambot_viz.displays.picking.placed import Placed
from sambot_viz.displays.picking.selectable import Selectable
from sambot_viz.displays.picking.selected import SelectedData
from sambot_viz.frames import LookupRefused
from sambot_viz.topics.decoding import frame_and_stamp

ADD, DELETE, DELETE_ALL = 0, 2, 3
_NS = 1_000_000_000
SHORTEST_LIFE_NS = 100_000
"""A lifetime that is not longer is none [ns]."""


class Markers:
    """Shows the received markers.

    Args:
        context: the objects to draw with.
        status: shows the statuses of markers.
        namespaces: know which markers are shown.
        key: prefix of the names of nodes.
        files_found: called when mesh files are known.
    """

    def __init__(
        self,
        context: DisplayContext,
        status: StatusList,
        namespaces: Namespaces,
        key: str,
        files_found: Callable[[], None],
    ) -> None:
        self.shown: dict[Key, Shown] = {}
        # Those without a place in the fixed frame: another one may have it.
        self._apart: dict[Key, Shown] = {}
        self._off = OffMarkers()
        self._context = context
        self._key = key
        self._namespaces = namespaces
        self._nodes = MarkerNodes(context, key, files_found)
        self._changed: dict[Key, None] = {}
        self._places: dict[tuple[str, int | None], MarkerPose] = {}
        self._rows = MarkerRows(status)
        self._free: list[int] = []
        self._points = 0

    # What messages ask for

    def apply(self, marker: Any, arrived_ns: int) -> None:
        """Add, change or delete a marker; `draw` shows it.

        Args:
            marker: the message.
            arrived_ns: time of arrival [ns].
        """
        action = int(marker.action)
        key = (str(marker.ns), int(marker.id))
        if action == ADD:
            until_ns = _until(marker, arrived_ns)
            before = self.shown.get(key)
            if before is None or not self._moved(key, before, marker, until_ns):
                self._add(key, OffMarker(marker, until_ns, None))
        elif action == DELETE:
            self._off.drop(key)
            self._remove(key)
        elif action == DELETE_ALL:
            self.remove_all(key[0] or None)

    def _moved(self, key: Key, one: Shown, marker: Any, until_ns: int | None) -> bool:
        """Move a marker that looks as before, if that is all; return whether it is."""
        old, place = one.marker, None
        if one.is_fine and looks_the_same(marker, old):
            place, why = self._place(marker)
            place = None if why else place
        if place is None:
            return False
        is_there = marker.pose is old.pose and place == one.place
        one.marker, one.place = marker, place
        one.until_ns = until_ns
        if not is_there or one.frame is not None:
            self._changed[key] = None
        return True

    def _add(self, key: Key, one: OffMarker) -> None:
        marker = one.marker
        if not self._namespaces.is_on(key[0]):
            one.place, _ = self._place(marker)
            self._off.keep(key, one)
            return
        check = check_of(marker)
        if check.is_ignored:
            self._say(key, check.level, check.text)
            return
        if not check.is_drawn:
            self._remove(key)
            self._say(key, check.level, check.text)
            return
        if not self._has_room(key, marker):
            return
        place, why = one.place, ""
        if place is None:
            place, why = self._place(marker)
        self._say(key, "Error" if why else check.level, why or check.text)
        before = self.shown.get(key)
        taken = Shown(
            marker,
            frame_and_stamp(marker)[0] if marker.frame_locked else None,
            MarkerPose() if place is None else place,
            one.until_ns,
            self._slot() if before is None else before.slot,
            is_fine=not (why or check.text),
        )
        self._points += len(marker.points) - _points_of(before or self._apart.get(key))
        self._apart.pop(key, None)
        self.shown[key] = taken
        self._changed[key] = None
        if place is None:
            self._set_apart(key)

    def _set_apart(self, key: Key) -> None:
        """Show a marker no longer, until another fixed frame has a place for it."""
        one = self._apart[key] = self.shown.pop(key)
        heapq.heappush(self._free, one.slot)
        self._changed[key] = None

    def _has_room(self, key: Key, marker: Any) -> bool:
        """Return whether one more marker can be drawn; say so if not."""
        before = self.shown.get(key) or self._apart.get(key)
        points = self._points + len(marker.points) - _points_of(before)
        count = len(self.shown) + len(self._apart)
        if before is None and count >= limits.MARKERS.value:
            text = f"More than the {limits.MARKERS.value:,} markers that are drawn"
        elif points > (most := limits.MARKERS_POINTS.value):
            text = f"More than the {most:,} points of markers that are drawn"
        else:
            return True
        self._rows.say_of_all("Error", text)
        return False

    def _place(self, marker: Any) -> tuple[MarkerPose | None, str]:
        """Return where the frame of a marker is, and why that is not known."""
        frame, stamp_ns = frame_and_stamp(marker)
        if marker.frame_locked:
            return MarkerPose(), self._context.lookup_problem(frame) or ""
        known = self._places.get((frame, stamp_ns))
        if known is not None:
            return known, ""
        tree, fixed = self._context.tree, self._context.fixed_frame
        try:
            found = tree.lookup(fixed, frame, stamp_ns)
        except LookupRefused as refused:
            return None, self._context.unplaced("a marker", refused).text
        place = self._places[frame, stamp_ns] = MarkerPose(found)
        return place, ""

    def _remove(self, key: Key) -> None:
        self._say(key, "Ok", "")
        if key in self.shown:
            self._set_apart(key)
        self._points -= _points_of(self._apart.pop(key, None))

    def follow_box(self, namespace: str) -> None:
        """Show the markers of a namespace if its box is ticked, and else hide them."""
        if self._namespaces.is_on(namespace):
            for key, off in tuple(self._off.drop_all(namespace)):
                self._add(key, off)
            return
        for key, one in (*self.shown.items(), *self._apart.items()):
            if key[0] == namespace:
                place = None if key in self._apart else one.place
                self._remove(key)
                self._off.keep(key, OffMarker(one.marker, one.until_ns, place))
        self._rows.unsay_all(namespace)

    def remove_all(self, namespace: str | None = None) -> None:
        """Remove the markers of a namespace, or all of them."""
        for _ in self._off.drop_all(namespace):
            pass
        for key in (*self.shown, *self._apart):
            if namespace is None or key[0] == namespace:
                self._remove(key)
        if namespace is None:
            self._rows.unsay_all()

    def _slot(self) -> int:
        # All slots below the number of markers are taken or free.
        return heapq.heappop(self._free) if self._free else len(self.shown)

    # What time and frames do

    @property
    def some_grow_old(self) -> bool:
        """Whether some have a lifetime."""
        return any(one.until_ns is not None for one in self.shown.values())

    def expire(self, now_ns: int) -> None:
        """Remove those whose time is over."""
        self._off.expire(now_ns)
        over = [
            key
            for key, one in (*self.shown.items(), *self._apart.items())
            if one.until_ns is not None and one.until_ns <= now_ns
        ]
        for key in over:
            self._remove(key)

    def place_again(self) -> None:
        """Place all of them in another fixed frame."""
        self._off.lose_places()
        for key, one in self._apart.items():
            one.slot = self._slot()
            self.shown[key] = one
        self._apart = {}
        for key, one in tuple(self.shown.items()):
            place, why = self._place(one.marker)
            check = check_of(one.marker)
            self._say(key, "Error" if why else check.level, why or check.text)
            self._changed[key] = None
            if place is None:
                self._set_apart(key)
            else:
                one.place = place

    def follow_frames(self) -> None:
        """Look at the nodes again of those that follow a frame."""
        for key, one in self.shown.items():
            if one.frame is not None:
                self._changed[key] = None
                why = self._context.lookup_problem(one.frame)
                if why:
                    self._say(key, "Error", why)
                elif f"{key[0]}/{key[1]}" in self._rows:
                    check = check_of(one.marker)
                    self._say(key, check.level, check.text)

    # Drawing

    def draw(self) -> None:
        """Draw what has changed."""
        self._places.clear()
        if not self._changed:
            return
        changed, self._changed = self._changed, {}
        self._nodes.update(self.shown, changed)
        self._report_meshes()

    def files_read(self) -> None:
        """Draw what waits for files."""
        for key in self._nodes.meshes:
            self._changed[key] = None
        self.draw()

    def clear(self) -> None:
        """Forget all markers."""
        self.remove_all()
        self._rows.clear()
        self._changed.clear()
        self._free.clear()
        self._nodes.remove()

    def placed(self) -> Iterator[Placed]:
        """Yield the drawn markers, for rays."""
        yield from self._nodes.placed(self.shown, self.item_of)

    def item_of(self, key: Key) -> Selectable:
        """Return a marker as something that can be selected."""
        return Selectable("marker", f"{key[0]}/{key[1]}", self._key)

    def selected(self, item: Selectable) -> SelectedData | None:
        """Return a marker as its message has it; None when it is gone."""
        namespace, _, number = item.name.rpartition("/")
        if item.kind != "marker" or item.of != self._key:
            return None
        one = self.shown.get((namespace, int(number)))
        T = None if one is None else self._context.pose(one.frame)
        if one is None or T is None:
            return None
        return selected_marker(item, frame_and_stamp(one.marker)[0], one, T)

    def count_of(self, namespace: str) -> int:
        """Return how many markers of a namespace are shown."""
        return sum(key[0] == namespace for key in self.shown)

    def _report_meshes(self) -> None:
        for key, fault in self._nodes.missing_meshes():
            text = f"Mesh resource marker [{key[0]}/{key[1]}] {fault}"
            self._say(key, "Error", text)

    # Statuses

    def _say(self, key: Key, level: Level, text: str) -> None:
        row = f"{key[0]}/{key[1]}"
        if text:
            self._rows.say(row, level, text)
        else:
            self._rows.unsay(row)


def _points_of(shown: Shown | None) -> int:
    return 0 if shown is None else len(shown.marker.points)


def _until(marker: Any, arrived_ns: int) -> int | None:
    lifetime = marker.lifetime.sec * _NS + marker.lifetime.nanosec
    return arrived_ns + lifetime if lifetime > SHORTEST_LIFE_NS else None
