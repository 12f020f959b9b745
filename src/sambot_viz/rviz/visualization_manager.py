"""The Visualization Manager of a document, and what its parts share."""

from __future__ import annotations

from sambot_viz.rviz.declarations import Declarations, is_ros1
from sambot_viz.rviz.yaml.yaml_document import ConfigFindings, Document
from sambot_viz.rviz.yaml.yaml_nodes import Map, items_of

MANAGER = "Visualization Manager"


class VisualizationManager:
    """The map of a document that holds displays, views and tools.

    Attributes:
        ros1: the file is one of ROS 1; new displays get ROS 1's class names.
    """

    def __init__(self, document: Document, declarations: Declarations):
        """Find the manager; nothing is read from it yet.

        Args:
            document: the file.
            declarations: the classes that are known.
        """
        self._document = document
        self._declarations = declarations
        self._findings = ConfigFindings(document.file)
        self.ros1 = any(is_ros1(name) for name in self._class_ids())

    def _class_ids(self) -> list[str]:
        """Return the classes of the tools and of the displays outside of groups."""
        listed = [self._manager.get("Displays"), self._manager.get("Tools")]
        found = [node for nodes in listed for _, node in items_of(nodes)]
        return [node.text("Class") or "" for node in found]

    @property
    def _manager(self) -> Map:
        """The manager's map; an empty one while the document has none."""
        found = self._document.root.get(MANAGER)
        return found if isinstance(found, Map) else Map()

    def _attached_manager(self) -> Map:
        """Return the manager's map, put into the document if it is missing there."""
        manager = self._manager
        self._document.root.put(MANAGER, manager)
        return manager
