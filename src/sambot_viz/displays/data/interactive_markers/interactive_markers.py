"""The interactive markers of one display: set, moved, erased, and drawn."""

from __future__ import annotations

import heapq
from collections.abc import Callable, Iterable, Iterator, Sequence
from functools import partial
from itertools import chain
from typing import Any

from sambot_viz import limits
from sambot_viz.displays.data.interactive_markers.control_nodes import (
    ControlNodes,
    InteractiveMarkerNodes,
)
from sambot_viz.displays.data.interactive_markers.controls import (
    TITLES,
    Control,
    ShowOptions,
)
from sambot_viz.displays.data.interactive_markers.known_marker import (
    ControlPart,
    KnownMarker,
)
from sambot_viz.displays.data.markers.checks import check_of
from sambot_viz.displays.data.markers.marker_nodes import Key
from sambot_viz.displays.data.markers.marker_rows import MarkerRows
from sambot_viz.displays.data.markers.shown_markers import Shown, selected_marker
from sambot_viz.displays.data.refused_messages import MessageRefused, refusing
from sambot_viz.displays.display import DisplayContext
from sambot_viz.displays.picking.placed import Placed
from sambot_viz.displays.picking.selectable import Selectable
from sambot_viz.displays.picking.selected import SelectedData
from sambot_viz.displays.scene.frame_nodes import short_id
from sambot_viz.frames import LookupRefused
from sambot_viz.geometry import Matrix

EMPTY = "Marker empty."


class InteractiveMarkers:
    """Shows the received interactive markers.

    Args:
        context: the objects to draw with.
        rows: show the statuses of markers.
        key: prefix of the names of nodes.
        files_found: called when mesh files are known.

    Attributes:
        known: name → marker.
        unknown: names of markers of which only a pose has come.
    """

    def __init__(
        self,
        context: DisplayContext,
        rows: MarkerRows,
        key: str,
        files_found: Callable[[], None],
    ) -> None:
        self.known: dict[str, KnownMarker] = {}
        self.unknown: dict[str, None] = {}
        self._context = context
        self._rows = rows
        self._key = key
        self._options = ShowOptions()
        self._dirty: dict[str, None] = {}
        self._waiting: dict[str, None] = {}
        self._shown: dict[Key, Shown] = {}
        self._changed: dict[Key, None] = {}
        self._nodes = ControlNodes(context, key, files_found)
        self._free: list[int] = []
        self._made = 0

    @property
    def waits(self) -> bool:
        """Whether some wait for the transform of their frame."""
        return bool(self._waiting)

    # What messages ask for

    def replace_all(self, messages: Sequence[Any]) -> None:
        """Take the full set of markers, and erase all others."""
        names = {str(message.name) for message in messages}
        self.erase([name for name in self.known if name not in names])
        self.unknown.clear()
        for message in messages:
            self.set(message)

    def set(self, message: Any) -> None:
        """Add an interactive marker, or replace the one of its name."""
        name = str(message.name)
        before = self.known.get(name)
        if before is not None and before.is_held:
            before.later = {"set": partial(self.set, message)}
            return
        if not len(message.controls):
            self.erase([name])
            self._rows.say(name, "Ok", EMPTY)
            return
        most = limits.INTERACTIVE_MARKERS.value
        if before is None and len(self.known) >= most:
            self._rows.say_of_all(
                "Warn", f"More than the {most:,} markers that are shown"
            )
            return
        try:
            with refusing():
                nodes = self._new_nodes() if before is None else before.nodes
                known = KnownMarker(message, nodes)
        except MessageRefused as refused:
            self._refuse(name, before, refused.text)
            return
        if before is not None:
            known.shown = before.shown
        self.known[name] = known
        self.unknown.pop(name, None)
        self._dirty[name] = None

    def move(self, message: Any) -> None:
        """Take another pose of an interactive marker."""
        name = str(message.name)
        known = self.known.get(name)
        if known is None:
            if len(self.unknown) < limits.INTERACTIVE_MARKERS.value:
                self.unknown[name] = None
            return
        if known.is_held:
            known.later["move"] = partial(self.move, message)
            return
        try:
            with refusing():
                known.move(message)
        except MessageRefused:
            self._refuse(name, known, "Pose message contains invalid floats!")
            return
        self._dirty[name] = None

    def moved(self, name: str) -> None:
        """A hand has moved an interactive marker."""
        self._dirty[name] = None

    def release(self, known: KnownMarker) -> None:
        """A hand has left an interactive marker: do what was asked for meanwhile."""
        known.is_held = False
        later, known.later = known.later, {}
        for one in later.values():
            one()

    def _refuse(self, name: str, known: KnownMarker | None, text: str) -> None:
        """Say why a message was not taken, until the next one of the marker."""
        self._rows.say(name, "Error", text)
        if known is not None:
            known.refused = text

    def erase(self, names: Iterable[str]) -> None:
        """Forget some interactive markers."""
        for name in names:
            self._rows.unsay(name)
            self._dirty.pop(name, None)
            self._waiting.pop(name, None)
            self.unknown.pop(name, None)
            known = self.known.pop(name, None)
            if known is not None:
                self._hide(name, known)

    def clear(self) -> None:
        """Forget all of them."""
        self.erase(tuple(self.known))
        self.unknown.clear()
        self._nodes.remove()
        self._changed.clear()
        self._free.clear()
        self._made = 0
        self._rows.clear()

    def _new_nodes(self) -> InteractiveMarkerNodes:
        self._made += 1
        name = f"{self._key}i{short_id(self._made)}"
        return InteractiveMarkerNodes(self._context.scene, name)

    # Drawing

    def placed(self, facing: Matrix | None = None) -> Iterator[Placed]:
        """Yield the visible markers, for rays.

        Args:
            facing: rotation of markers that face the view, (4, 4); None for the markers
                that are visible with every tool.
        """
        known = (one for one in self.known.values() if one.drawn is not None)
        poses = (one.group_poses(self._context, facing) for one in known)
        self._nodes.poses = dict(chain.from_iterable(one.items() for one in poses))
        yield from self._nodes.placed(self._shown, self.item_of)

    def control_of(self, item: Selectable) -> tuple[str, KnownMarker, Control] | None:
        """Return the owner of a marker of a control; None for other markers."""
        name, _, number = item.name.rpartition("/")
        known = self.known.get(name)
        if known is None or item.kind != "marker" or item.of != self._key:
            return None
        control = known.control_of(int(number))
        return None if control is None else (name, known, control)

    def item_of(self, key: Key) -> Selectable:
        """Return a marker of a control as something that can be selected."""
        return Selectable("marker", f"{key[0]}/{key[1]}", self._key)

    def selected(self, item: Selectable) -> SelectedData | None:
        """Return a marker of a control as its message has it; None when it is gone."""
        name, _, number = item.name.rpartition("/")
        if item.kind != "marker" or item.of != self._key:
            return None
        known, one = self.known.get(name), self._shown.get((name, int(number)))
        if known is None or one is None:
            return None
        T = known.group_poses(self._context, None).get(one.frame or "")
        return None if T is None else selected_marker(item, known.frame, one, T)

    def draw(self, options: ShowOptions) -> None:
        """Draw what has changed, and what had no place."""
        if options != self._options:
            if options.transparency != self._options.transparency:
                self.place_again()
            self._options = options
            self.look_again()
        todo = {**self._dirty, **self._waiting}
        self._dirty.clear()
        self._waiting.clear()
        for name in todo:
            self._draw_one(name, self.known[name])
        changed, self._changed = self._changed, {}
        if changed:
            self._nodes.update(self._shown, changed)
            self._report_meshes()

    def look_again(self) -> None:
        """Look at the frames and nodes of all of them at the next `draw`."""
        self._dirty.update(dict.fromkeys(self.known))

    def place_again(self) -> None:
        """Place all of them again at the next `draw`, in another fixed frame."""
        for known in self.known.values():
            known.place_again()
        self.look_again()

    def files_read(self) -> None:
        """Draw what waits for files at the next `draw`."""
        self._changed.update(dict.fromkeys(self._nodes.meshes))

    def _draw_one(self, name: str, known: KnownMarker) -> None:
        options, context = self._options, self._context
        try:
            above, wxyz, position = known.place(context)
            parts = known.parts(context, transparency=options.transparency)
        except LookupRefused as refused:
            why = self._context.unplaced("a marker", refused)
            self._rows.say(name, "Error", why.text)
            self._waiting[name] = None
            self._hide(name, known)
            return
        axes = known.scale if options.axes else None
        groups = dict.fromkeys(part.group for part in parts)
        if known.nodes.draw(above, wxyz, position, groups, axes):
            known.drawn = None
        drawn = (parts, options.descriptions)
        if known.drawn != drawn:
            known.drawn = drawn
            known.wrong = self._show(name, known, parts)
        wrong = known.refused or known.wrong
        fine = f"Locked to frame {known.frame}"
        fine = fine if known.is_locked else "Position is fixed."
        self._rows.say(name, "Error" if wrong else "Ok", wrong or fine)

    def _show(self, name: str, known: KnownMarker, parts: Sequence[ControlPart]) -> str:
        """Show the markers of controls; return the fault of one of them."""
        wrong, before = "", dict.fromkeys(known.shown)
        known.shown = []
        for number, part in enumerate(parts):
            if part.group is TITLES and not self._options.descriptions:
                continue
            check = check_of(part.marker)
            if not check.is_drawn:
                wrong = wrong or f"Control '{part.control}': {check.text}"
                continue
            key = (name, number)
            most = limits.CONTROL_MARKERS.value
            if key not in self._shown and len(self._shown) >= most:
                wrong = f"More than the {most:,} markers of controls that are shown"
                break
            old = self._shown.get(key)
            slot = self._slot() if old is None else old.slot
            path = known.nodes.path(part.group)
            self._shown[key] = Shown(part.marker, path, part.place, None, slot)
            self._changed[key] = None
            known.shown.append(number)
            before.pop(number, None)
        self._drop(name, before)
        return wrong

    def _hide(self, name: str, known: KnownMarker) -> None:
        self._drop(name, known.shown)
        known.shown, known.drawn = [], None
        known.nodes.remove()

    def _drop(self, name: str, numbers: Iterable[int]) -> None:
        for number in numbers:
            gone = self._shown.pop((name, number))
            heapq.heappush(self._free, gone.slot)
            self._changed[name, number] = None

    def _slot(self) -> int:
        # All slots below the number of markers are taken or free.
        return heapq.heappop(self._free) if self._free else len(self._shown)

    def _report_meshes(self) -> None:
        for (name, _), fault in self._nodes.missing_meshes():
            self._rows.say(name, "Error", f"Mesh resource marker [{name}] {fault}")
