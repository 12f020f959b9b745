"""Base of all RViz displays: properties, statuses, and nodes in the scene.

A display lists its properties once (`properties`); reading, saving, the rows of the
panel, clamping and live change all come from that list. Its values live
in the `DisplayConfig` of the document, so a save writes the values on the screen.
A robot has hundreds of links, joints and frames with their own properties, so the
panel offers a list to choose from (`EntryList`) and shows the chosen one's rows only.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence, Set
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, ClassVar, Literal

import numpy as np
import viser

from sambot_viz import limits
from sambot_viz.displays.camera_pictures import Pictures
from sambot_viz.displays.picking.handle import Handle
from sambot_viz.displays.picking.pick_geometry import PickGeometry
from sambot_viz.displays.picking.selectable import Selectable
from sambot_viz.displays.picking.selected import SelectedData
from sambot_viz.displays.picking.triangle_mesh import Part
from sambot_viz.displays.robot_display import (
    Descriptions,
    ModelReader,
    Repair,
    RobotDisplay,
    WantedQos,
)
from sambot_viz.displays.scene.frame_nodes import FrameNodes
from sambot_viz.displays.scene.session_assets import SessionAssets
from sambot_viz.displays.scene.solids import Rgb
from sambot_viz.displays.scene_size import SceneSize
from sambot_viz.displays.topic_messages import TopicMessages
from sambot_viz.frames import FrameTree, LookupRefused
from sambot_viz.frames.display_time import DisplayTime
from sambot_viz.geometry import Matrix
from sambot_viz.robot.model import Robot
from sambot_viz.rviz import FIXED_FRAME, DisplayConfig, EntryItem, Property
from sambot_viz.topics.reasons import TopicReason

HIGHLIGHT: Rgb = (255, 224, 0)
Level = Literal["Ok", "Warn", "Error"]
AHEAD = "No transform at this time yet: shown where the recording has it first"
_ORDER: dict[Level, int] = {"Ok": 0, "Warn": 1, "Error": 2}
"""Longer keys and sentences are cut here: messages may name anything."""


@dataclass(frozen=True, slots=True)
class Status:
    """One row of a status.

    Attributes:
        level: "Ok", "Warn" or "Error".
        text: a sentence.
        code: code of the reason why a topic shows nothing; "" without one.
    """

    level: Level
    text: str
    code: str = ""


class StatusList:
    """The rows of one display in order of first use.

    `version` grows with every change, so that a panel knows when to write again.
    """

    def __init__(self) -> None:
        self._rows: dict[str, Status] = {}
        self.version = 0

    @property
    def rows(self) -> dict[str, Status]:
        """Key → status; a copy."""
        return dict(self._rows)

    @property
    def level(self) -> Level:
        """The worst level of all rows; Ok without rows."""
        worst: Level = "Ok"
        for row in self._rows.values():
            if _ORDER[row.level] > _ORDER[worst]:
                worst = row.level
        return worst

    def set(self, key: str, level: Level, text: str, code: str = "") -> None:
        """Set one row."""
        key, status = (
            key[: limits.KEY.value],
            Status(level, text[: limits.STATUS_TEXT.value], code),
        )
        if self._rows.get(key) != status:
            self._rows[key] = status
            self.version += 1

    def remove(self, key: str) -> None:
        """Remove one row, if it is there."""
        if self._rows.pop(key[: limits.KEY.value], None) is not None:
            self.version += 1

    def replace(self, rows: dict[str, Status]) -> None:
        """Set all rows at once."""
        if self._rows != rows:
            self._rows = dict(rows)
            self.version += 1

    def clear(self) -> None:
        """Remove all rows, as RViz's reset does."""
        self.replace({})


@dataclass(frozen=True, slots=True)
class EntryList:
    """The entries of one kind, such as the links of a RobotModel.

    Attributes:
        title: RViz's name for all of them: "Links", "Joints", "Frames".
        singular: the name of one of them.
        names: the names of the entries.
        item: name → its item of the document, with its properties.
        set: (name, property, value) → the value it has now; others may follow.
        facts: name → read-only facts, such as "Position" → "1; 2; 3".
        rows: name → the properties that have a row, when not all of them do.
        above: name → the name of the entry above it; its own name begins with that
            and a slash.
        has_details: whether an entry has more than its box.
    """

    title: str
    singular: str
    names: Sequence[str]
    item: Callable[[str], EntryItem]
    set: Callable[[str, str, Any], Any]
    facts: Callable[[str], Mapping[str, str]]
    rows: Callable[[str], Sequence[str]] | None = None
    above: Mapping[str, str] = field(default_factory=dict[str, str])
    has_details: bool = True


def numbers(values: Sequence[float]) -> str:
    """Return several numbers as RViz shows a vector: five digits each."""
    return "; ".join(f"{float(value) + 0.0:.5g}" for value in values)


@dataclass
class DisplayContext:
    """The scene, frames, files and options that displays draw with; one per session.

    Attributes:
        scene: viser's scene (of the server, or of one client).
        tree: the frames.
        nodes: the frames as scene nodes.
        assets: the mesh files and textures.
        fixed_frame: the frame everything is drawn in.
        meant: returns the frames that a config may mean by a name.
        background: background colour, 0 to 255.
        robot: the robot that was opened, or None.
        moving: child frame → the joint type that moves it.
        models: reads other models, for a RobotModel with one of its own.
        descriptions: the robots of topics; None where no messages come.
        config_file: the .rviz file that the command line opened, or None.
        trusted_files: the models that it named before a browser could change it.
        link_colors: link of that robot → the colour that a program has given it, 0 to
            255.
        highlighted: links of that robot that a program highlights.
        messages: the messages that displays draw; None where none come.
        now: the time of messages [s since 1970]; None where no messages come.
        time: the time at which frames are drawn; None where no messages come.
        is_paced: whether a frame has a different clock, such as that of a recording
            beside a live robot, so that it does not age.
        pictures: the pictures that panels show beside the view.
        displays: returns all displays, in their order.
        apply: runs a function that draws, from any thread, and sends the drawing.
        place: sends the poses of frames that moved.
    """

    scene: viser.SceneApi
    tree: FrameTree
    nodes: FrameNodes
    assets: SessionAssets
    fixed_frame: str = "map"
    background: tuple[int, int, int] = (48, 48, 48)
    robot: Robot | None = None
    moving: Mapping[str, str] = field(default_factory=dict[str, str])
    models: ModelReader | None = None
    descriptions: Descriptions | None = None
    config_file: Path | None = None
    trusted_files: frozenset[str] = frozenset()
    link_colors: dict[str, Rgb] = field(default_factory=dict[str, Rgb])
    highlighted: set[str] = field(default_factory=set[str])
    messages: TopicMessages | None = None
    now: Callable[[], float] | None = None
    time: DisplayTime | None = None
    is_paced: Callable[[str], bool] = lambda frame: False
    pictures: Pictures = field(default_factory=Pictures)
    displays: Callable[[], Sequence[Display]] = tuple
    apply: Callable[[Callable[[], None]], None] = lambda action: action()
    place: Callable[[Set[str]], None] = lambda frames: None
    meant: Callable[[str], Sequence[str]] = lambda name: (name,)

    def color_of(self, link: str) -> Rgb | None:
        """Return the colour in place of a link's own, if a program has set one."""
        if link in self.highlighted:
            return HIGHLIGHT
        return self.link_colors.get(link)

    def frame(self, name: object) -> str:
        """Return the frame a Reference Frame property means."""
        return self.fixed_frame if name == FIXED_FRAME else self.only_meant(str(name))

    def only_meant(self, name: str) -> str:
        """Return the frame that a name means here; itself where it may be several."""
        found = self.meant(name)
        return found[0] if len(found) == 1 else name

    def above(self, frame: str) -> str:
        """The name of the node at a frame; the world ("") for the fixed frame."""
        if frame == self.fixed_frame:
            return ""
        return self.nodes.path(frame) or ""

    def pose(self, frame: str | None) -> Matrix | None:
        """Return T_fixed_frame, (4, 4); None when the frame cannot be placed.

        Args:
            frame: None for the fixed frame.
        """
        if frame is None or frame == self.fixed_frame:
            return np.eye(4)
        try:
            return self.tree.drawn(self.fixed_frame, frame).matrix
        except LookupRefused:
            return None

    def transform_status(self, frame: str, without: Level) -> Status:
        """Return what RViz says of the transform of a frame to the fixed frame.

        Args:
            frame: where something is drawn.
            without: the level where there is none.
        """
        if not self.nodes.connected(frame):
            return Status(
                without, f"No transform from [{frame}] to [{self.fixed_frame}]"
            )
        if self.tree.is_ahead(frame):
            return Status("Ok", AHEAD)
        return Status("Ok", "Transform OK")

    def unplaced(self, topic: str, refused: LookupRefused) -> TopicReason:
        """Return why a message has no place, and what brings it one.

        Args:
            topic: of the message.
            refused: tf2's answer.
        """
        messages = self.messages
        why = None if messages is None else messages.unplaced(topic, refused)
        return why or TopicReason("no-transform", refused.rviz_text)

    def lookup_problem(self, frame: str) -> str | None:
        """RViz's long text when the frame cannot be placed, None when it can."""
        if frame == self.fixed_frame:
            return None
        try:
            self.tree.lookup(self.fixed_frame, frame)
        except LookupRefused as refused:
            return refused.rviz_text
        return None


class Display:
    """Base of all displays.

    Attributes:
        kind: the ROS 2 class id, such as "rviz_default_plugins/Grid".
        is_data: whether it draws what messages bring.
        tells_time: whether frames can be drawn where they were at the stamps of its
            messages.
        differs: what RViz draws otherwise, for docs/displays.md.
        properties: the declaration of everything a user can set.
        config: this display in the document: name, enabled, values.
        status: the rows RViz shows under "Status".
        revision: grows when a user sets a value of it.
    """

    kind: ClassVar[str]
    differs: ClassVar[str] = ""
    is_data: ClassVar[bool] = False
    tells_time: ClassVar[bool] = False
    properties: ClassVar[tuple[Property, ...]]

    def __init__(self, context: DisplayContext, config: DisplayConfig, key: str):
        """Make the display; nothing is drawn before `draw`.

        Args:
            context: what to draw with.
            config: its place in the document.
            key: short text that no other display's node names begin with.
        """
        self.context = context
        self.config = config
        self.key = key
        self.status = StatusList()
        self.revision = 0
        self.shown = False

    def show(self, shown: bool) -> None:
        """Switch it on or off (its own box and those of its groups)."""
        if shown == self.shown:
            return
        self.shown = shown
        if shown:
            self.draw()
        else:
            self.clear()
            self.status.clear()

    def draw(self) -> None:
        """Bring the scene in line with properties, robot and frames."""
        raise NotImplementedError

    def clear(self) -> None:
        """Take everything out of the scene."""
        raise NotImplementedError

    @classmethod
    def topic_values(
        cls, topic: str, type_name: str, qos: WantedQos | None
    ) -> Mapping[str, object] | None:
        """Return the values with which a new display shows a topic, by path.

        Args:
            topic: its name.
            type_name: of its messages.
            qos: that suits the topic; None keeps the defaults.

        Returns:
            None when it shows nothing of such messages.
        """
        del topic, type_name, qos
        return None

    @classmethod
    def size_values(cls, size: SceneSize) -> Mapping[str, float]:
        """Return the values with which it fits a robot, by path.

        Nothing follows the robot where this is empty.
        """
        del size
        return {}

    @property
    def robot_display(self) -> RobotDisplay | None:
        """This display as one that shows a robot; None for all others."""
        return None

    def property_changed(self, path: str) -> None:
        """A property has a new value."""
        del path
        if self.shown:
            self.draw()

    def values_put_back(self) -> None:
        """Some of its values were put back by undo, those of its entries too."""
        if self.shown:
            self.draw()

    def pick_geometry(self) -> PickGeometry:
        """Return what it shows now, for rays; only called while it is shown."""
        return PickGeometry()

    def handle_geometry(self, facing: Matrix) -> PickGeometry:
        """Return what it shows with all that a hand can move, for rays.

        Args:
            facing: rotation of what faces the view, (4, 4), with x along it and z up.
        """
        del facing
        return self.pick_geometry()

    @property
    def has_handles(self) -> bool:
        """Whether it shows something that a hand can move."""
        return False

    def handle(self, item: Selectable) -> Handle | None:
        """Return the movable marker that a ray has hit; None without one."""
        del item

    def parts(
        self, of: Callable[[Selectable | None], bool]
    ) -> Iterator[tuple[Selectable | None, Part]]:
        """Yield what it shows of some items.

        Args:
            of: whether something is asked for; None is what cannot be selected.
        """
        yield from ()

    def names(self) -> Mapping[str, float]:
        """Return the frames whose names are drawn, with the size of letters [m]."""
        return {}

    def selected(self, item: Selectable) -> SelectedData | None:
        """Return the details of selected data; None if this display lacks it."""
        del item

    def entries(self) -> tuple[EntryList, ...]:
        """Return the links, joints or frames that have their own rows."""
        return ()

    def notes(self) -> Mapping[str, str]:
        """Return notes on values, by the paths of their properties."""
        return {}

    def facts(self) -> Mapping[str, Callable[[], Mapping[str, str]]]:
        """Return what makes rows that are only shown, by the paths they are below.

        It is called while a page has unfolded them, also after a motion; the names
        stay the same until the display is drawn again.
        """
        return {}

    def options(self) -> Mapping[str, Sequence[str]]:
        """Return values that may be meant, by paths of properties."""
        return {}

    def repairs(self) -> Mapping[str, Repair]:
        """Return what would make a status go away, by keys of the status."""
        return {}

    def frames_moved(self, frames: Iterable[str]) -> None:
        """Some frames have a new pose in their parents; the nodes are moved already."""
        del frames

    def assets_read(self) -> None:
        """Draw mesh files and textures that were read in the background."""

    def unseen_topics(self) -> Iterable[tuple[str, TopicReason]]:
        """Return topics that show nothing, or not all, with the reasons of its status.

        Reasons about all topics together, such as a loop of transforms, are left out.
        """
        return ()

    def time_passed(self) -> None:
        """Look at the time; called twice a second where messages come."""


def robot_displays(displays: Iterable[Display]) -> Iterator[RobotDisplay]:
    """Yield those of some displays that show a robot."""
    for display in displays:
        found = display.robot_display
        if found is not None:
            yield found
