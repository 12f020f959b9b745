"""The current view and the saved ones."""

from __future__ import annotations

from sambot_viz.errors import UsageError
from sambot_viz.rviz.class_items import ViewConfig, new_map
from sambot_viz.rviz.class_name import (
    is_ros1,
    kind_of,
    row_text,
    short_name,
    written_in_ros1,
)
from sambot_viz.rviz.visualization_manager import VisualizationManager
from sambot_viz.rviz.yaml.nodes import Entry, List, Map, copied_map, items_of

CURRENT = "Current View"
ORBIT = "rviz_default_plugins/Orbit"


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
        manager = self._attached_manager()
        views = manager.get("Views")
        if isinstance(views, Map):
            return views
        made = Map()
        manager.put("Views", made)
        return made

    def _attach_current(self, node: Map) -> None:
        self._views_map().put("Current", node)

    def _saved_list(self) -> List:
        views = self._views_map()
        saved = views.get("Saved")
        if isinstance(saved, List):
            return saved
        made = List()
        views.put("Saved", made)
        return made

    @property
    def view(self) -> ViewConfig:
        """The current view."""
        return self._view

    @property
    def saved_views(self) -> tuple[ViewConfig, ...]:
        """The saved views, in order."""
        return tuple(self._saved_views)

    def set_view_class(self, kind: str) -> ViewConfig:
        """Make the current view one of another class.

        Keys that both classes have keep their values; the caller sets the new place of
        the camera.

        Args:
            kind: ROS 2 class id.

        Returns:
            The new current view.
        """
        old = self._view
        ros1 = is_ros1(old.class_id)
        node = new_map(written_in_ros1(kind) if ros1 else kind, CURRENT)
        node.put_text("Value", row_text(node.text("Class") or ""))
        view = ViewConfig(node, self._declarations.views.get(kind), self._findings)
        view.fill()
        for path in view.properties:
            if path in old.properties and old.is_given(path):
                view.set(path, old.get(path))
        self._put_current(view)
        return view

    def save_view(self, name: str | None = None) -> ViewConfig:
        """Copy the current view to the end of the saved ones.

        Args:
            name: its label; the class's short name when not given, as in RViz.
        """
        kind = self._view.kind
        node = copied_map(self._view.node)
        node.put_text("Name", short_name(kind) if name is None else name)
        self._saved_list().entries.append(Entry(None, node))
        view = ViewConfig(node, self._declarations.views.get(kind), self._findings)
        self._saved_views.append(view)
        return view

    def use_view(self, saved: ViewConfig) -> ViewConfig:
        """Copy a saved view into the current one."""
        node = copied_map(saved.node)
        node.put_text("Name", CURRENT)
        view = ViewConfig(
            node, self._declarations.views.get(saved.kind), self._findings
        )
        self._put_current(view)
        return view

    def remove_view(self, saved: ViewConfig) -> None:
        """Remove a saved view.

        Raises:
            UsageError: it is not one of them.
        """
        if saved not in self._saved_views:
            raise UsageError(f"{saved.label} is not one of the saved views")
        self._saved_views.remove(saved)
        listed = self._saved_list()
        listed.entries[:] = [e for e in listed.entries if e.value is not saved.node]

    def _put_current(self, view: ViewConfig) -> None:
        self._views_map().put("Current", view.node)
        self._view = view
