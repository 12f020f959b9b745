"""Nodes of markers: batches of solids, and one node for each of the others."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterable, Iterator, Mapping
from dataclasses import dataclass

from sambot_viz.displays.data.display_node import Drawable
from sambot_viz.displays.data.markers.checks import (
    LINES,
    LISTS,
    MESH,
    SOLIDS,
    TEXT,
)
from sambot_viz.displays.data.markers.marker_meshes import MeshFinder, MeshNodes
from sambot_viz.displays.data.markers.marker_solids import solids_of
from sambot_viz.displays.data.markers.marker_triangles import TrianglesNode
from sambot_viz.displays.data.markers.shown_markers import (
    Shown,
    draw_lines,
    draw_list,
    draw_text,
)
from sambot_viz.displays.display import DisplayContext
from sambot_viz.displays.picking.placed import Placed
from sambot_viz.displays.picking.selectable import Selectable
from sambot_viz.displays.scene.frame_nodes import short_id
from sambot_viz.displays.scene.points import PointNode
from sambot_viz.displays.scene.ribbons import RibbonNode
from sambot_viz.displays.scene.solid_nodes import Solid, SolidsNode
from sambot_viz.displays.scene.text_node import TextNode
from sambot_viz.geometry import Matrix
from sambot_viz.meshes.glb import OPAQUE_FROM

Key = tuple[str, int]
"""Namespace and id."""
BATCH = 500
"""Solids in one batch: all of them are sent when one changes."""
ALONE = 100
"""Maximum number of translucent solids with separate nodes, which browsers sort."""


@dataclass(slots=True, eq=False)
class _Batch:
    """Solids that are drawn together."""

    node: SolidsNode
    members: dict[Key, tuple[Solid, ...]]


class MarkerNodes:
    """The nodes of the markers of one display.

    Args:
        context: what to draw with.
        key: what the names of nodes begin with.
        files_found: called when mesh files are known.
    """

    def __init__(
        self, context: DisplayContext, key: str, files_found: Callable[[], None]
    ) -> None:
        self._context = context
        self._key = key
        self._files_found = files_found
        self._finders: dict[str, MeshFinder] = {}
        self._batches: dict[Hashable, _Batch] = {}
        self._batch_of: dict[Key, Hashable] = {}
        self._single: dict[Key, tuple[Hashable, Drawable]] = {}

    @property
    def meshes(self) -> Mapping[Key, MeshNodes]:
        """What draws mesh files."""
        singles = self._single.items()
        return {k: node for k, (_, node) in singles if isinstance(node, MeshNodes)}

    def missing_meshes(self) -> Iterator[tuple[Key, str]]:
        """Yield the markers whose mesh files cannot be drawn, and why."""
        for key, nodes in self.meshes.items():
            if nodes.fault is not None:
                yield key, nodes.fault

    def update(self, shown: Mapping[Key, Shown], changed: Iterable[Key]) -> None:
        """Draw changed markers, and remove those that are no longer shown.

        Args:
            shown: all markers to show.
            changed: those that differ from the last call.
        """
        dirty: dict[Hashable, None] = {}
        touched: dict[Hashable, None] = {}
        todo: list[tuple[Key, Shown, str]] = []
        for key in changed:
            one = shown.get(key)
            above = None if one is None else self._above(one)
            if one is None or above is None:
                self._forget(key, dirty)
            elif int(one.marker.type) in SOLIDS:
                self._drop_single(key)
                touched[self._into_batch(key, one, above, dirty)] = None
            else:
                self._leave_batch(key, dirty)
                kind = int(one.marker.type), above, one.slot
                if key in self._single and self._single[key][0] != kind:
                    self._drop_single(key)
                todo.append((key, one, above))
        # An unchanged marker is drawn again if its parent node was removed.
        again = (group for group in touched if self._batches[group].node.is_gone)
        for group in dirty | dict.fromkeys(again):
            self._draw_batch(group)
        # Names of nodes are free again when all that is gone has been removed.
        for key, one, above in todo:
            self._draw_single(key, one, above)

    def placed(
        self, shown: Mapping[Key, Shown], item_of: Callable[[Key], Selectable | None]
    ) -> Iterator[Placed]:
        """Yield all markers for rays.

        Args:
            shown: the markers.
            item_of: what each is to a selection; None for nothing.
        """
        poses: dict[str | None, Matrix | None] = {}

        def above(key: Key) -> Matrix | None:
            frame = shown[key].frame
            if frame not in poses:
                poses[frame] = self._pose_above(frame)
            return poses[frame]

        for batch in self._batches.values():
            T_fixed_above = above(next(iter(batch.members)))
            if T_fixed_above is not None:
                members = batch.members.items()
                items = [item_of(key) for key, solids in members for _ in solids]
                yield from batch.node.placed(T_fixed_above, items)
        for key, (_, node) in self._single.items():
            T_fixed_above = above(key)
            if T_fixed_above is not None:
                yield from node.placed(T_fixed_above, item_of(key))

    def _pose_above(self, frame: str | None) -> Matrix | None:
        """Return the pose of the node above, T_fixed_above; None where it has none."""
        return self._context.pose(frame)

    def remove(self) -> None:
        """Take everything out of the scene."""
        for batch in self._batches.values():
            batch.node.remove()
        for _, node in self._single.values():
            node.remove()
        self._batches.clear()
        self._batch_of.clear()
        self._single.clear()
        self._finders.clear()

    def _above(self, one: Shown) -> str | None:
        """Return the node that a marker hangs below; None when it has no place."""
        if one.frame is None or one.frame == self._context.fixed_frame:
            return ""
        return self._context.nodes.path(one.frame)

    def _forget(self, key: Key, dirty: dict[Hashable, None]) -> None:
        self._leave_batch(key, dirty)
        self._drop_single(key)

    # Solids

    def _into_batch(
        self, key: Key, one: Shown, above: str, dirty: dict[Hashable, None]
    ) -> Hashable:
        """Put a marker into its batch, which is returned."""
        solids = solids_of(one.marker, one.place)
        # All parts of a marker have its alpha.
        blended = bool(solids) and solids[0].alpha < OPAQUE_FROM
        number = one.slot // BATCH
        if blended and one.slot < ALONE:
            number = one.slot
        kind = "c" if not blended else "t" if one.slot < ALONE else "u"
        group = (above, kind, number)
        if self._batch_of.get(key, group) != group:
            self._leave_batch(key, dirty)
        batch = self._batches.get(group)
        if batch is None:
            name = f"{above}/{self._key}{kind}{short_id(number)}"
            batch = _Batch(SolidsNode(self._context.scene, name), {})
            self._batches[group] = batch
        self._batch_of[key] = group
        if batch.members.get(key) != solids:
            batch.members[key] = solids
            dirty[group] = None
        return group

    def _leave_batch(self, key: Key, dirty: dict[Hashable, None]) -> None:
        group = self._batch_of.pop(key, None)
        if group is not None:
            del self._batches[group].members[key]
            dirty[group] = None

    def _draw_batch(self, group: Hashable) -> None:
        batch = self._batches[group]
        members = batch.members.values()
        if members:
            batch.node.draw([solid for solids in members for solid in solids])
        else:
            batch.node.remove()
            del self._batches[group]

    # The others

    def _drop_single(self, key: Key) -> None:
        found = self._single.pop(key, None)
        if found is not None:
            found[1].remove()

    def _draw_single(self, key: Key, one: Shown, above: str) -> None:
        scene, kind = self._context.scene, int(one.marker.type)
        _, node = self._single.get(key, (None, None))
        name = f"{above}/{self._key}m{short_id(one.slot)}"
        if kind in LISTS:
            node = node if isinstance(node, PointNode) else PointNode(scene, name)
            draw_list(node, one)
        elif kind in LINES:
            node = node if isinstance(node, RibbonNode) else RibbonNode(scene, name)
            draw_lines(node, one)
        elif kind == TEXT:
            node = node if isinstance(node, TextNode) else TextNode(scene, name)
            draw_text(node, one)
        elif kind == MESH:
            if not isinstance(node, MeshNodes):
                node = MeshNodes(self._context, name)
            node.finder = self._finder(str(one.marker.mesh_resource))
            node.draw(one.marker, *one.place.of(one.marker.pose))
        else:
            if not isinstance(node, TrianglesNode):
                node = TrianglesNode(scene, name)
            node.draw(one.marker, *one.place.of(one.marker.pose))
        self._single[key] = ((kind, above, one.slot), node)

    def _finder(self, resource: str) -> MeshFinder:
        found = self._finders.get(resource)
        if found is None:
            found = MeshFinder(self._context, resource, self._files_found)
            self._finders[resource] = found
        return found
