"""What every RViz tool is: what the mouse does on the picture while it is current."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, Literal, Protocol

import numpy as np
import viser

from sambot_viz.rviz import Property, ToolConfig
from sambot_viz.tools.picking.raycast import Array
from sambot_viz.views.camera import Vector, add, times

Key = Literal["I", "M", "S", "C", "N"]


@dataclass(frozen=True, slots=True)
class Thing:
    """What can be selected: a link of the robot, or a TF frame."""

    kind: Literal["link", "frame"]
    name: str


@dataclass(frozen=True, slots=True)
class Ray:
    """A click: the ray through the pixel, in the fixed frame.

    Attributes:
        client_id: the browser.
        origin: where the camera stands [m].
        direction: of length 1.
        modifier: held keys as viser names them ("shift", "cmd/ctrl"), or None.
    """

    client_id: int
    origin: Vector
    direction: Vector
    modifier: str | None = None

    def at(self, distance: float) -> Vector:
        """The point at a distance along the ray [m]."""
        return add(self.origin, times(self.direction, distance))


@dataclass(frozen=True, slots=True)
class Rays:
    """A rectangle: rays through many of its pixels.

    Attributes:
        origins: (N, 3) [m].
        directions: (N, 3), of length 1.
        modifier: held keys as viser names them, or None.
    """

    origins: Array
    directions: Array
    modifier: str | None = None


@dataclass(frozen=True, slots=True)
class Hit:
    """What a ray meets first.

    Attributes:
        point: where, in the fixed frame [m].
        thing: the link or frame; None for the grid.
    """

    point: Vector
    thing: Thing | None


class ToolContext(Protocol):
    """What a tool works with; the session's, see `tool_control`."""

    @property
    def scene(self) -> viser.SceneApi:
        """Where to draw."""
        ...

    def pick(self, ray: Ray) -> Hit | None:
        """What a click means; None for the background."""
        ...

    def things_met(self, rays: Rays) -> set[Thing]:
        """What the rays meet first."""
        ...

    def select(self, things: set[Thing], modifier: str | None) -> None:
        """Replace the selection, or add to it (Shift), or take away (Ctrl)."""
        ...

    def look_at(self, point: Vector, client_id: int) -> None:
        """Turn a browser's camera to a point of the fixed frame [m]."""
        ...

    def finish(self) -> None:
        """Go back to the default tool."""
        ...

    def say(self, status: str) -> None:
        """Show a sentence beside the toolbar."""
        ...


class Tool:
    """Base of all tools.

    Attributes:
        kind: the ROS 2 class id.
        label: what stands on its button.
        key: the key that chooses it.
        help: what to do with it; shown while it is current.
        clicks: whether it wants clicks. Only then does the page send them: a drag
            stays a camera drag.
        rectangles: whether dragging with the left button draws a rectangle.
        properties: what a user can set.
    """

    kind: ClassVar[str]
    label: ClassVar[str]
    key: ClassVar[Key]
    help: ClassVar[str]
    clicks: ClassVar[bool] = False
    rectangles: ClassVar[bool] = False
    properties: ClassVar[tuple[Property, ...]] = ()

    def __init__(self, desk: ToolContext, config: ToolConfig | None) -> None:
        """Make the tool.

        Args:
            desk: what to work with.
            config: its place in the document; None when the file does not list it.
        """
        self.desk = desk
        self.config = config

    def click(self, ray: Ray) -> None:
        """Somebody clicked into the picture."""
        del ray

    def rectangle(self, rays: Rays) -> None:
        """Somebody drew a rectangle."""
        del rays

    def cancel(self) -> None:
        """Somebody pressed Esc."""

    def property_changed(self) -> None:
        """One of its properties has a new value."""


def as_vector(values: object) -> Vector:
    """Three numbers as a vector."""
    x, y, z = (float(v) for v in np.asarray(values, np.float64))
    return (x, y, z)
