"""Displays, views and tools: items of the document that have a class."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from sambot_viz.errors import nearest
from sambot_viz.rviz.declarations import NO_CLASS, is_ros1, kind_of, short_name
from sambot_viz.rviz.item import ConfigItem, EntryItem
from sambot_viz.rviz.properties.numbers import read_bool
from sambot_viz.rviz.properties.property import KeptProperty, Property
from sambot_viz.rviz.properties.texts import (
    QOS_PROPERTIES,
    PolicyProperty,
    TopicProperty,
    checked_text,
)
from sambot_viz.rviz.yaml.yaml_document import ConfigFindings
from sambot_viz.rviz.yaml.yaml_nodes import Entry, Map, Scalar

_LIKENESS = 0.8
_OF_ROS1 = (
    KeptProperty(
        "Queue Size",
        note="of ROS 1; the queue is as long as the display needs",
    ),
    KeptProperty("Unreliable", note="of ROS 1; messages are taken as they come"),
)
"""What ROS 1 has beside the name of a topic, where ROS 2 has its quality of service."""


class ClassItem(ConfigItem):
    """An item with a class.

    Attributes:
        supported: its class is declared; otherwise it is kept as it is.
    """

    _own_keys = frozenset({"Class", "Name", "Value"})

    def __init__(
        self,
        node: Map,
        declared: Sequence[Property] | None,
        findings: ConfigFindings,
        attach: Callable[[Map], None] | None = None,
    ):
        """Read one item.

        Args:
            node: its map.
            declared: the properties of its class; None for an unknown class.
            findings: collects warnings.
            attach: puts the map into the document when a value is set.
        """
        self.supported = declared is not None
        ros1 = is_ros1(node.text("Class") or "")
        properties = tuple(declared or ())
        if ros1 and any(isinstance(one, TopicProperty) for one in properties):
            names = {one.name for one in properties}
            properties += tuple(one for one in _OF_ROS1 if one.name not in names)
        super().__init__(node, properties, findings, ros1=ros1, attach=attach)
        if self.supported and not ros1:
            self._report_keys()
        elif not ros1:
            self._report_policies()

    def _report_keys(self) -> None:
        """Report keys that are like those of properties which are not given."""
        declared = [one.keys for one in self._declared.values()]
        for path in self.unknown_keys:
            *above, key = path.split("/")
            owner = self.node_at(above)
            free = [
                name
                for *parents, name in declared
                if parents == above and isinstance(owner, Map) and not owner.get(name)
            ]
            right = meant_key(key, free)
            if right is not None and isinstance(owner, Map):
                self._findings.warn_key(
                    next(entry for entry in owner.entries if entry.key == key),
                    f"{short_name(self.kind)} has no property '{path}', but '{right}', "
                    "whose default is used",
                    right,
                )

    def _report_policies(self) -> None:
        """Report the quality of service of a class that is not declared."""
        for entry in self._node.entries:
            for prop in QOS_PROPERTIES if isinstance(entry.value, Map) else ():
                if isinstance(prop, PolicyProperty) and isinstance(entry.value, Map):
                    prop.read(entry.value.get(prop.name), self._report)

    @property
    def class_id(self) -> str:
        """The class as the file writes it."""
        return self._node.text("Class") or NO_CLASS

    @property
    def kind(self) -> str:
        """The ROS 2 id of the class."""
        return kind_of(self.class_id)

    @property
    def name(self) -> str:
        """Its label; need not be unique."""
        return self._node.text("Name") or ""

    @property
    def label(self) -> str:
        """The label used in messages."""
        return f"'{self.name}' ({self.kind})"

    def rename(self, name: str) -> None:
        """Give it another label.

        Raises:
            PropertyError: the name is not a text.
        """
        self.map_at(()).put_text("Name", checked_text("Name", name))


class DisplayConfig(ClassItem):
    """One display of the document, or a group of them.

    Attributes:
        parent: the group it is in; None at the top.
        members: the displays of a group; `RvizConfig` changes the list.
    """

    _own_keys = frozenset({"Class", "Name", "Enabled", "Value", "Displays"})

    def __init__(
        self,
        node: Map,
        declared: Sequence[Property] | None,
        findings: ConfigFindings,
        parent: DisplayConfig | None = None,
    ):
        """Read one display.

        Args:
            node: its map.
            declared: the properties of its class; None for an unknown class.
            findings: collects warnings.
            parent: its group; None at the top level.
        """
        super().__init__(node, declared, findings)
        self.parent = parent
        self.members: list[DisplayConfig] = []
        self._enabled = self._read_enabled()

    def _read_enabled(self) -> bool:
        """Off, then "Value", then "Enabled"."""
        enabled = False
        for key in ("Value", "Enabled"):
            node = self._node.get(key)
            if isinstance(node, Scalar):
                enabled = read_bool(node, self._report, key)
        return enabled

    @property
    def displays(self) -> tuple[DisplayConfig, ...]:
        """The members of a group, in order."""
        return tuple(self.members)

    @property
    def enabled(self) -> bool:
        """Its own box."""
        return self._enabled

    @property
    def active(self) -> bool:
        """Return whether its own box and those of all its groups are ticked."""
        return self._enabled and (self.parent is None or self.parent.active)

    def set_enabled(self, enabled: bool) -> None:
        """Tick or untick its box."""
        if enabled == self._enabled:
            return
        self._enabled = enabled
        text = "true" if enabled else "false"
        if self._node.text("Enabled") is not None or self._node.get("Value") is None:
            self._node.put_text("Enabled", text)
        if self._node.text("Value") is not None:
            self._node.put_text("Value", text)


class GlobalOptions(EntryItem):
    """Fixed Frame, Background Color, Frame Rate."""

    @property
    def label(self) -> str:
        """The label used in messages."""
        return "Global Options"


class ViewConfig(ClassItem):
    """The current view, or a saved one."""


class ToolConfig(ClassItem):
    """One tool of the toolbar."""


def meant_key(key: str, free: Sequence[str]) -> str | None:
    """Return the property that an unknown key probably means.

    Args:
        key: the key.
        free: the properties that are missing in the file.

    Returns:
        A property of almost the same name, or the only one that contains its words.
    """
    near = nearest(key, free, _LIKENESS)
    words = set(key.split())
    longer = [name for name in free if words < set(name.split())]
    return near or (longer[0] if len(longer) == 1 else None)


def new_map(class_id: str, name: str, enabled: bool | None = None) -> Map:
    """Return the map of a new item, with its keys in RViz's order."""
    texts = {"Class": class_id, "Name": name}
    if enabled is not None:
        texts["Enabled"] = texts["Value"] = "true" if enabled else "false"
    return Map([Entry(key, Scalar(texts[key])) for key in sorted(texts)])
