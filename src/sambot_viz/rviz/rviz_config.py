"""The .rviz document with meaning: displays, options, views, tools."""

from __future__ import annotations

import os
from collections.abc import Iterable

from sambot_viz.errors import Problem
from sambot_viz.rviz.class_items import DisplayConfig, GlobalOptions, ToolConfig
from sambot_viz.rviz.declarations import TIME, Declarations, kind_of, short_name
from sambot_viz.rviz.display_list import DisplayList
from sambot_viz.rviz.item import ConfigItem
from sambot_viz.rviz.undo_log import FinishChange, note
from sambot_viz.rviz.view_list import ViewList
from sambot_viz.rviz.visualization_manager import MANAGER
from sambot_viz.rviz.yaml.yaml_document import ConfigFindings, Document
from sambot_viz.rviz.yaml.yaml_nodes import (
    Collection,
    Entry,
    List,
    Map,
    Plain,
    Scalar,
    items_of,
    plain,
)

_PANELS, _TREE, _EXPANDED = "Panels", "Property Tree Widget", "Expanded"
_DISPLAYS, _TIME = "Displays", "Time"
"""Classes of panels."""


class RvizConfig(DisplayList, ViewList):
    """A config: typed values in front, the untouched document behind.

    Everything else is kept and saved: unknown classes, keys, panels, window geometry,
    comments, the order of keys.

    Attributes:
        global_options: Fixed Frame, Background Color, Frame Rate.
        tools: the tools of the toolbar.
        time: the synchronization settings of RViz's Time panel.
        fits_robot: whether sizes are scaled to the shown robot, because the config is
            not a user's; not saved.
        fits_frames: the same for frames without a robot.
        unasked: the displays that were added for a recording or a robot without a
            config; this flag is not saved.
        offered: the topics that got such a display, also if it was removed.
        assumed_frame: the fixed frame that the program has chosen; "" for none.
    """

    def __init__(self, document: Document, declarations: Declarations):
        """Read a document; use `load` or `parse`."""
        super().__init__(document, declarations)
        self.fits_robot = self.fits_frames = False
        self.unasked: tuple[DisplayConfig, ...] = ()
        self.offered: set[str] = set()
        self.assumed_frame = ""
        _report_duplicates(document.root, self._findings)
        self.global_options = GlobalOptions(
            ConfigItem(document.root, (), self._findings),
            (MANAGER, "Global Options"),
            declarations.global_options,
            ros1=self.ros1,
        )
        self._load_displays()
        self._load_views()
        self.tools = tuple(
            ToolConfig(node, declarations.tools.get(_kind(node)), self._findings)
            for _, node in items_of(self._manager.get("Tools"))
        )
        time = self._panel(_TIME) or self._new_panel(_TIME)
        self.time = ConfigItem(time, TIME, self._findings)

    @classmethod
    def load(
        cls, path: str | os.PathLike[str], declarations: Declarations
    ) -> RvizConfig:
        """Read a file.

        Raises:
            ConfigError: the file cannot be read, or is not a .rviz document at all.
        """
        return cls(Document.load(path), declarations)

    @classmethod
    def parse(
        cls, text: str, declarations: Declarations, *, file: str | None = None
    ) -> RvizConfig:
        """Read a text.

        Args:
            text: the content of an .rviz file.
            declarations: the classes that are known.
            file: the name for messages.

        Raises:
            ConfigError: the text is not a .rviz document at all.
        """
        return cls(Document(text, file), declarations)

    def copy(self) -> RvizConfig:
        """Return the same document once more, with the edits that are not saved."""
        made = RvizConfig.parse(self.to_yaml(), self._declarations, file=self.file)
        made.fits_robot, made.fits_frames = self.fits_robot, self.fits_frames
        made.assumed_frame = self.assumed_frame
        places = [n for n, one in enumerate(self.displays) if one in self.unasked]
        made.offered = set(self.offered)
        made.unasked = tuple(made.displays[place] for place in places)
        return made

    @property
    def fits_scene(self) -> bool:
        """Whether sizes and the camera follow what is shown, where it is no user's."""
        return self.fits_robot or self.fits_frames or bool(self.unasked)

    @property
    def file(self) -> str | None:
        """The path it was read from or last saved to."""
        return self._document.file

    @property
    def panels(self) -> Plain:
        """RViz's panels as text; kept, and only `expanded` and `time` are used."""
        return plain(self._document.root.get(_PANELS))

    @property
    def expanded(self) -> tuple[str, ...] | None:
        """The paths of the unfolded rows, such as "/TF1/Frames1".

        None when the file does not say which.
        """
        panel = self._panel(_DISPLAYS)
        tree = panel.get(_TREE) if panel is not None else None
        if not isinstance(tree, Map) or tree.entry(_EXPANDED) is None:
            return None
        # RViz writes an empty list as a null.
        listed = plain(tree.get(_EXPANDED))
        return tuple(map(str, listed)) if isinstance(listed, list) else ()

    @expanded.setter
    def expanded(self, paths: Iterable[str]) -> None:
        """Write which rows are unfolded, with the panel that RViz writes it in."""
        panel = self._panel(_DISPLAYS)
        if panel is None:
            panel = self._new_panel(_DISPLAYS)
            _NewPanel(self._document.root, panel).put()
        tree = panel.get(_TREE)
        if not isinstance(tree, Map):
            tree = Map()
            tree.put("Splitter Ratio", Scalar("0.5"))
            panel.put(_TREE, tree)
        tree.put(_EXPANDED, List([Entry(None, Scalar(path)) for path in paths]))

    def _panel(self, name: str) -> Map | None:
        """Return RViz's panel of a class; None where the file has none."""
        for _, panel in items_of(self._document.root.get(_PANELS)):
            if short_name(panel.text("Class") or "") == name:
                return panel
        return None

    def _new_panel(self, name: str) -> Map:
        package = "rviz" if self.ros1 else "rviz_common"
        panel = Map()
        panel.put("Class", Scalar(f"{package}/{name}"))
        panel.put("Name", Scalar(name))
        return panel

    def set_time(self, path: str, value: object) -> None:
        """Set a property of the Time panel, which is written if the file has none.

        Raises:
            UsageError: there is no such property, or the value cannot be meant.
        """
        if self._panel(_TIME) is None:
            panel = _NewPanel(self._document.root, self.time.node)
            note(panel, _TIME)
            panel.put()
        self.time.set(path, value)

    @property
    def raw(self) -> Plain:
        """The whole document as text: dicts, lists, str, None."""
        return plain(self._document.root)

    @property
    def problems(self) -> tuple[Problem, ...]:
        """Warnings about the file, with their lines."""
        return (*self._document.problems, *self._findings.problems)

    @property
    def modified(self) -> bool:
        """Return whether a save would change the file."""
        return self._document.modified

    def to_yaml(self) -> str:
        """The text that a save writes; the file's own one where nothing changed."""
        return self._document.to_yaml()

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the file, whole or not at all.

        Raises:
            ConfigError: it cannot be written; an old file is untouched.
        """
        self._document.save(path)


class _NewPanel:
    """A panel that a file has not had, and that an undo takes out of it again.

    Args:
        root: the map of the document.
        panel: of RViz.
    """

    def __init__(self, root: Map, panel: Map) -> None:
        self._root = root
        self._entry = Entry(None, panel)
        self._is_first = root.entry(_PANELS) is None

    def put(self) -> None:
        """Write it after the other panels."""
        self._root.made(_PANELS, List).entries.append(self._entry)

    def begin_change(self, path: str) -> FinishChange:
        """Keep that it is not there."""
        del path
        return lambda: (self._remove, self.put)

    def _remove(self) -> None:
        self._root.made(_PANELS, List).entries.remove(self._entry)
        if self._is_first:
            self._root.remove(_PANELS)


def _report_duplicates(node: Collection, findings: ConfigFindings) -> None:
    seen: set[str] = set()
    joined = _first_of_second(node)
    if joined is not None:
        findings.warn_without_dash(joined)
    for entry in node.entries:
        if joined is None and entry.key is not None and entry.key in seen:
            findings.warn(
                "config-duplicate-key",
                entry.value,
                f"'{entry.key}' is given twice in one map; the later one counts",
                "remove the earlier one",
            )
        seen.add(entry.key or "")
        if isinstance(entry.value, Collection):
            _report_duplicates(entry.value, findings)


def _first_of_second(node: Collection) -> Entry | None:
    """Return the first key of the second of two items that a lost dash has made one.

    RViz sorts the keys of an item, so a new item begins where their order does.
    """
    keys = [entry.key or "" for entry in node.entries]
    if not isinstance(node, Map) or keys.count("Class") != 2:
        return None
    twice = next(at for at, key in enumerate(keys) if key in keys[:at])
    starts = (at for at in range(1, twice + 1) if keys[at] < keys[at - 1])
    return node.entries[next(starts, twice)]


def _kind(node: Map) -> str:
    return kind_of(node.text("Class") or "")
