"""The tools of a session: the current one, its clicks and keys, and the selection.

A tool is current for all browsers of the session, as the robot is. Only the current
tool gets clicks, and only one that wants them: with any other, a press of the mouse
is the camera's.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
import viser
import viser.transforms

from sambot_viz.session.worker import Worker
from sambot_viz.tools.move_camera import MoveCameraTool
from sambot_viz.tools.picking.pick_scene import PickScene
from sambot_viz.tools.picking.raycast import Array
from sambot_viz.tools.picking.selection_marks import SelectionMarks
from sambot_viz.tools.registry import TOOLS
from sambot_viz.tools.select import SelectTool
from sambot_viz.tools.tool import Hit, Ray, Rays, Thing, Tool, as_vector
from sambot_viz.views.camera import Vector

if TYPE_CHECKING:
    from sambot_viz.session import Event, Session

SAMPLES = 24
"""Rays across a rectangle in each direction: what is thinner may be missed."""
MODIFIERS: tuple[Literal["shift", "cmd/ctrl"] | None, ...] = (None, "shift", "cmd/ctrl")


class ToolControl:
    """See the module.

    Args:
        session: whose tools these are.
    """

    def __init__(self, session: Session) -> None:
        self.status = ""
        self.selection: dict[Thing, None] = {}
        self._session = session
        self._scenery = PickScene(session.context, lambda: session.displays)
        self._marks = SelectionMarks(session.audience.scene)
        self._config: object = None
        self.tools: tuple[Tool, ...] = ()
        self.current: Tool = MoveCameraTool(self, None)
        self._take_config()
        session.listeners.append(self._hear)

    # The tools

    @property
    def default(self) -> Tool:
        """The first tool of the file that is known here (§2.1)."""
        for item in self._session.config.tools:
            for tool in self.tools:
                if tool.kind == item.kind:
                    return tool
        return self._tool(MoveCameraTool.kind)

    def choose(self, kind: str) -> None:
        """Make a tool current.

        Raises:
            KeyError: no such tool.
        """
        with self._session.change("tools"):
            self._switch(self._tool(kind))

    def press(self, kind: str) -> None:
        """The key of a tool was pressed: choose it, or leave it again (§2.2)."""
        if self.current.kind == kind:
            self.finish()
        elif not isinstance(self.current, SelectTool):
            # Select keeps all keys for itself, as in RViz.
            self.choose(kind)

    def escape(self) -> None:
        """Esc: stop what the current tool does, and go back to the default tool."""
        with self._session.change("tools"):
            self.current.cancel()
            self._switch(self.default)

    def focus(self, client_id: int) -> None:
        """F: look at what is selected, else at what is in the middle of the picture."""
        boxes = [self._scenery.box_of(thing) for thing in self.selection]
        known = [box for box in boxes if box is not None]
        if known:
            low = np.min([box[0] for box in known], axis=0)
            high = np.max([box[1] for box in known], axis=0)
            self.look_at(as_vector((low + high) / 2), client_id)
            return
        camera = self._session.views.camera_of(client_id)
        hit = self.pick(Ray(client_id, camera.position, camera.forward))
        if hit is not None:
            self.look_at(hit.point, client_id)

    def set_property(self, tool: Tool, path: str, value: Any) -> None:
        """Set a property of a tool, in the document too."""
        if tool.config is not None:
            with self._session.change("tools"):
                tool.config.set(path, value)
                tool.property_changed()

    # What tools work with (tools.tool.ToolContext)

    @property
    def scene(self) -> viser.SceneApi:
        """Where to draw."""
        return self._session.audience.scene

    def pick(self, ray: Ray) -> Hit | None:
        """What a click means; None for the background."""
        with self._session.lock:
            return self._scenery.first_hit(
                np.array(ray.origin), np.array(ray.direction)
            )

    def things_met(self, rays: Rays) -> set[Thing]:
        """What the rays meet first."""
        with self._session.lock:
            return self._scenery.things_met(rays)

    def select(self, things: set[Thing], modifier: str | None) -> None:
        """Replace the selection, or add to it (Shift), or take away (Ctrl)."""
        with self._session.change("tools"):
            if modifier == "shift":
                kept = {**self.selection, **dict.fromkeys(things)}
            elif modifier == "cmd/ctrl":
                kept = {t: None for t in self.selection if t not in things}
            else:
                kept = dict.fromkeys(sorted(things, key=lambda t: (t.kind, t.name)))
            self.selection = kept
            self._draw_marks()

    def look_at(self, point: Vector, client_id: int) -> None:
        """Turn a browser's camera to a point of the fixed frame [m]."""
        self._session.views.look_at(point, client_id)

    def finish(self) -> None:
        """Go back to the default tool."""
        self.choose(self.default.kind)

    def say(self, status: str) -> None:
        """Show a sentence beside the toolbar."""
        with self._session.change("tools"):
            self.status = status

    # Inside

    def _tool(self, kind: str) -> Tool:
        return {tool.kind: tool for tool in self.tools}[kind]

    def _take_config(self) -> None:
        """The tools of the document, then the others, each at its document's place."""
        config = self._session.config
        if self._config is config:
            return
        self._config = config
        items = {item.kind: item for item in config.tools if item.kind in TOOLS}
        kinds = [*items, *(kind for kind in TOOLS if kind not in items)]
        self.current.cancel()
        self.tools = tuple(TOOLS[kind](self, items.get(kind)) for kind in kinds)
        self.current = self.default
        self._listen()

    def _switch(self, tool: Tool) -> None:
        if tool is not self.current:
            self.current = tool
            self.status = ""
            self._listen()

    def _listen(self) -> None:
        """Have viser send what the current tool wants, and nothing else."""
        scene = self.scene
        scene.remove_click_callback()  # pyright: ignore[reportUnknownMemberType]
        scene.remove_rect_select_callback()  # pyright: ignore[reportUnknownMemberType]
        tool, worker = self.current, self._session.worker
        for modifier in MODIFIERS if tool.rectangles else (None,):
            if tool.clicks:
                scene.on_click(modifier=modifier)(_clicked(tool, worker))
            if tool.rectangles:
                scene.on_rect_select(modifier=modifier)(_boxed(tool, worker))

    def _hear(self, event: Event) -> None:
        if event == "config":
            self._take_config()
        if event in ("joints", "frames", "robot", "config", "status"):
            self._draw_marks()

    def _draw_marks(self) -> None:
        if not self.selection:
            self._marks.draw({})
            return
        boxes = {thing: self._scenery.box_of(thing) for thing in self.selection}
        self._marks.draw({t: box for t, box in boxes.items() if box is not None})


def _clicked(tool: Tool, worker: Worker) -> Callable[[viser.SceneClickEvent], Any]:
    async def clicked(event: viser.SceneClickEvent) -> None:
        direction = as_vector(event.ray_direction)
        origin = as_vector(event.ray_origin)
        if np.all(np.isfinite([*origin, *direction])) and any(direction):
            ray = Ray(event.client_id, origin, direction, event.modifier)
            worker.post(partial(tool.click, ray))

    return clicked


def _boxed(tool: Tool, worker: Worker) -> Callable[[viser.SceneRectSelectEvent], Any]:
    async def boxed(event: viser.SceneRectSelectEvent) -> None:
        corners = np.array([event.screen_min, event.screen_max], np.float64)
        if np.all(np.isfinite(corners)):
            camera, modifier = event.client.camera, event.modifier
            worker.post(lambda: tool.rectangle(_rays(camera, corners, modifier)))

    return boxed


def _rays(camera: viser.CameraHandle, corners: Array, modifier: str | None) -> Rays:
    """Rays through a rectangle of the picture, given from 0 to 1 of its size."""
    (left, top), (right, bottom) = np.minimum(np.maximum(corners, 0.0), 1.0)
    across = np.linspace(float(left), float(right), SAMPLES)
    down = np.linspace(float(top), float(bottom), SAMPLES)
    half = float(np.tan(camera.fov / 2))
    in_camera = np.ones((SAMPLES * SAMPLES, 3))
    in_camera[:, 0] = np.tile((2 * across - 1) * half * camera.aspect, SAMPLES)
    in_camera[:, 1] = np.repeat((2 * down - 1) * half, SAMPLES)
    R = viser.transforms.SO3(camera.wxyz).as_matrix()
    directions = np.einsum("ij,nj->ni", R, in_camera)
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    origins = np.broadcast_to(np.asarray(camera.position, np.float64), directions.shape)
    return Rays(np.array(origins), directions, modifier)
