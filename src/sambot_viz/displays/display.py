"""Base of all RViz displays: properties, statuses, and nodes in the scene.

A display lists its properties once (`properties`); reading, saving, the rows of the
panel, clamping and live change all come from that list. Its values live
in the `DisplayConfig` of the document, so what is on the screen is what a save writes.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import ClassVar

import numpy as np
import viser

from sambot_viz.displays.entries import EntryList
from sambot_viz.displays.picking.pick_geometry import (
    Corners,
    PickGeometry,
    Selectable,
)
from sambot_viz.displays.robot_display import ModelReader, RobotDisplay
from sambot_viz.displays.scene.frame_nodes import FrameNodes
from sambot_viz.displays.scene.session_assets import SessionAssets
from sambot_viz.displays.status import StatusList
from sambot_viz.frames import FrameTree, LookupRefused
from sambot_viz.geometry import Matrix
from sambot_viz.robot.model import Robot
from sambot_viz.rviz import FIXED_FRAME, DisplayConfig, Property


@dataclass
class DisplayContext:
    """The scene, frames, files and options that displays draw with; one per session.

    Attributes:
        scene: where to draw (of the server, or of one client).
        tree: the frames.
        nodes: the frames as scene nodes.
        assets: the mesh files and textures.
        fixed_frame: the frame everything is drawn in.
        background: colour behind the scene, 0 to 255.
        robot: the robot that was opened, or None.
        moving: child frame → the joint type that moves it.
        models: reads other models, for a RobotModel from a file.
        config_file: the .rviz file that the command line opened, or None.
        trusted_files: the models that it named before a browser could change it.
        apply: runs a function that draws, from any thread, and sends what it draws.
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
    config_file: Path | None = None
    trusted_files: frozenset[str] = frozenset()
    apply: Callable[[Callable[[], None]], None] = lambda action: action()

    def frame(self, name: object) -> str:
        """Return the frame a Reference Frame property means."""
        return self.fixed_frame if name == FIXED_FRAME else str(name)

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
        if not self.tree.can_lookup(self.fixed_frame, frame):
            return None
        return self.tree.lookup(self.fixed_frame, frame).matrix

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
        help: one sentence for the list of displays.
        properties: the declaration of everything a user can set.
        config: this display in the document: name, enabled, values.
        status: the rows RViz shows under "Status".
        revision: grows when a user sets a value of it.
    """

    kind: ClassVar[str]
    help: ClassVar[str]
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

    def boxes(
        self, of: Callable[[Selectable | None], bool]
    ) -> Iterator[tuple[Selectable | None, Corners]]:
        """Yield boxes around what it shows of some items, in the fixed frame.

        Args:
            of: whether something is asked for; None is what cannot be selected.
        """
        yield from ()

    def entries(self) -> tuple[EntryList, ...]:
        """Return the links, joints or frames that have rows of their own."""
        return ()

    def frames_moved(self, frames: Iterable[str]) -> None:
        """Some frames have a new pose in their parents; the nodes are moved already."""
        del frames


def robot_displays(displays: Iterable[Display]) -> Iterator[RobotDisplay]:
    """Yield those of some displays that show a robot."""
    for display in displays:
        found = display.robot_display
        if found is not None:
            yield found
