"""The current view and the saved ones."""

from __future__ import annotations

from typing import NamedTuple

from sambot_viz.errors import UsageError
from sambot_viz.rviz.class_items import ViewConfig, new_map
from sambot_viz.rviz.declarations import (
    is_ros1,
    kind_of,
    row_text,
    short_name,
    written_in_ros1,
)
from sambot_viz.rviz.visualization_manager import VisualizationManager
from sambot_viz.rviz.yaml.yaml_nodes import Entry, List, Map, copied_map, items_of, same

CURRENT = "Current View"
ORBIT = "rviz_default_plugins/Orbit"


class RemovedView(NamedTuple):
    """A saved view that is not in the document.

    Attributes:
        view: the view.
        entry: its entry in the document.
        following: the saved view that came next; None at the end.
    """

    view: ViewConfig
    entry: Entry
    following: ViewConfig | None


class ViewList(VisualizationManager):
    """The views of a config."""

    def _load_views(self) -> None:
        views = self._manager.get("Views")
        current = views.get("Current") if isinstance(views, Map) else None
        saved = views.get("Saved") if isinstance(views, Map) else None
        given = isinstance(current, Map) and current.text("Class") is not None
        self._view = self._read_view(
            current if isinstance(current, Map) and given else None
        )
        self._saved_views = [self._read_view(node) for _, node in items_of(saved)]

    def _read_view(self, node: Map | None) -> ViewConfig:
        found = node
        if found is None:
            # RViz starts with an Orbit view.
            found = new_map(ORBIT, CURRENT)
            found.put_text("Value", row_text(ORBIT))
        kind = kind_of(found.text("Class") or "")
        return ViewConfig(
            found,
            self._declarations.views.get(kind),
            self._findings,
            self._attach_current if node is None else None,
        )

    def _views_map(self) -> Map:
        return self._attached_manager().made("Views", Map)

    def _attach_current(self, node: Map) -> None:
        self._views_map().put("Current", node)

    def _saved_list(self) -> List:
        return self._views_map().made("Saved", List)

    @property
    def view(self) -> ViewConfig:
        """The current view."""
        return self._view

    @property
    def saved_views(self) -> tuple[ViewConfig, ...]:
        """The saved views, in order."""
        return tuple(self._saved_views)

    def detached_view(self, view: ViewConfig | None = None) -> ViewConfig:
        """A copy of a view, the current one by default, that is not in the document."""
        node = copied_map((view or self._view).node)
        node.put_text("Name", CURRENT)
        return self._made(node)

    def new_view(self, kind: str, like: ViewConfig) -> ViewConfig:
        """Return a view of another class, not in the document.

        Keys that both classes have keep their values; the caller sets the new place of
        the camera.

        Args:
            kind: ROS 2 class id.
            like: the view that it is to replace.
        """
        class_id = written_in_ros1(kind) if is_ros1(like.class_id) else kind
        node = new_map(class_id, CURRENT)
        node.put_text("Value", row_text(class_id))
        view = self._made(node)
        view.fill()
        for path in view.properties:
            if path in like.properties and like.is_given(path):
                view.set(path, like.get(path))
        return view

    def store_view(self, view: ViewConfig) -> None:
        """Copy the values of another view to the current one; keep equal nodes."""
        if view.supported and view.class_id == self._view.class_id:
            for path, value in view.properties.items():
                self._view.set(path, value)
        elif not same(view.node, self._view.node):
            self._view = self.detached_view(view)
            self._views_map().put("Current", self._view.node)

    def save_view(
        self, view: ViewConfig | None = None, name: str | None = None
    ) -> ViewConfig:
        """Add a copy of a view to the end of the saved ones.

        Args:
            view: the view; the current one when not given.
            name: its label; the class's short name when not given, as in RViz.
        """
        copy = self.detached_view(view)
        copy.rename(short_name(copy.kind) if name is None else name)
        self.put_back_view(RemovedView(copy, Entry(None, copy.node), None))
        return copy

    def remove_view(self, saved: ViewConfig) -> RemovedView:
        """Remove a saved view.

        Returns:
            What `put_back_view` takes.

        Raises:
            UsageError: it is not one of them.
        """
        if saved not in self._saved_views:
            raise UsageError(f"{saved.label} is not one of the saved views")
        index = self._saved_views.index(saved)
        following = self._saved_views[index + 1 : index + 2]
        self._saved_views.remove(saved)
        entries = self._saved_list().entries
        at = next(i for i, entry in enumerate(entries) if entry.value is saved.node)
        return RemovedView(saved, entries.pop(at), next(iter(following), None))

    def put_back_view(self, removed: RemovedView) -> None:
        """Put a saved view back where it was, or at the end."""
        entries, following = self._saved_list().entries, removed.following
        at, index = len(entries), len(self._saved_views)
        if following in self._saved_views:
            index = self._saved_views.index(following)
            at = next(i for i, e in enumerate(entries) if e.value is following.node)
        entries.insert(at, removed.entry)
        self._saved_views.insert(index, removed.view)

    def _made(self, node: Map) -> ViewConfig:
        kind = kind_of(node.text("Class") or "")
        return ViewConfig(node, self._declarations.views.get(kind), self._findings)
