"""The Visualization Manager of a document, and what its parts share."""

from __future__ import annotations

from sambot_viz.rviz.class_name import is_ros1
from sambot_viz.rviz.config_findings import ConfigFindings
from sambot_viz.rviz.declarations import Declarations
from sambot_viz.rviz.yaml.document import Document
from sambot_viz.rviz.yaml.nodes import Map, items_of

_MANAGER = "Visualization Manager"


class VisualizationManager:
    """Where displays, views and tools are found in a document.

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
        manager = document.root.get(_MANAGER)
        self._manager = manager if isinstance(manager, Map) else Map()
        self.ros1 = any(is_ros1(name) for name in self._class_ids())

    def _class_ids(self) -> list[str]:
        """The classes of the tools and of the displays outside of groups."""
        listed = [self._manager.get("Displays"), self._manager.get("Tools")]
        found = [node for nodes in listed for _, node in items_of(nodes)]
        return [node.text("Class") or "" for node in found]

    def _attached_manager(self) -> Map:
        """The manager's map, put into the document if it is missing there."""
        root = self._document.root
        if root.get(_MANAGER) is not self._manager:
            root.put(_MANAGER, self._manager)
        return self._manager
