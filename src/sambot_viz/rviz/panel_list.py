"""What RViz's panels keep in a config: which rows of the displays are unfolded."""

from __future__ import annotations

from collections.abc import Iterable

from sambot_viz.rviz.class_name import short_name
from sambot_viz.rviz.visualization_manager import VisualizationManager
from sambot_viz.rviz.yaml.nodes import Entry, List, Map, Scalar, items_of, plain

_PANELS, _TREE, _EXPANDED = "Panels", "Property Tree Widget", "Expanded"
_PANEL_CLASS = "Displays"


class PanelList(VisualizationManager):
    """The panels of a config; only the unfolded rows of the displays are used."""

    @property
    def expanded(self) -> tuple[str, ...] | None:
        """The paths of the unfolded rows, such as "/TF1/Frames1".

        None when the file does not say which.
        """
        panel = self._displays_panel()
        tree = panel.get(_TREE) if panel is not None else None
        if not isinstance(tree, Map) or tree.entry(_EXPANDED) is None:
            return None
        # RViz writes an empty list as a null.
        listed = plain(tree.get(_EXPANDED))
        return tuple(map(str, listed)) if isinstance(listed, list) else ()

    @expanded.setter
    def expanded(self, paths: Iterable[str]) -> None:
        """Write which rows are unfolded, with the panel that RViz writes it in."""
        panel = self._displays_panel()
        if panel is None:
            panel = Map()
            panel.put("Class", Scalar(f"{self._panel_package()}/{_PANEL_CLASS}"))
            panel.put("Name", Scalar(_PANEL_CLASS))
            panels = self._document.root.get(_PANELS)
            if not isinstance(panels, List):
                panels = List()
                self._document.root.put(_PANELS, panels)
            panels.entries.append(Entry(None, panel))
        tree = panel.get(_TREE)
        if not isinstance(tree, Map):
            tree = Map()
            tree.put("Splitter Ratio", Scalar("0.5"))
            panel.put(_TREE, tree)
        tree.put(_EXPANDED, List([Entry(None, Scalar(path)) for path in paths]))

    def _displays_panel(self) -> Map | None:
        for _, panel in items_of(self._document.root.get(_PANELS)):
            if short_name(panel.text("Class") or "") == _PANEL_CLASS:
                return panel
        return None

    def _panel_package(self) -> str:
        return "rviz" if self.ros1 else "rviz_common"
