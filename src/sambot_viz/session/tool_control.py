"""The tools of a session: the current one, its clicks and keys, and the selection.

A tool is current for all browsers of the session, as the robot is. Only the current
tool gets clicks, and only one that uses them: with any other, a press of the mouse
moves the camera.
"""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from functools import partial
from typing import TYPE_CHECKING, Any, Literal, TypeVar

import numpy as np
import viser

from sambot_viz.errors import UsageError
from sambot_viz.geometry import rotation_from_xyzw
from sambot_viz.tools.move_camera import MoveCameraTool
from sambot_viz.tools.picking.hit import Hit, Selectable
from sambot_viz.tools.picking.pick_scene import PickScene, PickSnapshot
from sambot_viz.tools.picking.rays import Array, RayGrid
from sambot_viz.tools.picking.selection_boxes import SelectionBoxes
from sambot_viz.tools.registry import TOOLS
from sambot_viz.tools.tool import Click, Tool

if TYPE_CHECKING:
    from sambot_viz.session import Event, Session

T = TypeVar("T")

SAMPLES = 24
"""Rays across a rectangle in each direction: what is thinner may be missed."""
INLINE = 100_000
"""Rays through this many triangles take milliseconds; more are left to a thread."""
MODIFIERS: tuple[Literal["shift", "cmd/ctrl"] | None, ...] = (None, "shift", "cmd/ctrl")


class ToolControl:
    """Switches tools, gives them clicks and rectangles, and keeps the selection.

    Implements `tools.tool.ToolContext`.

    Args:
        session: the session whose tools these are.

    Attributes:
        status: what the current tool reports; empty shows its help.
        selection: the selected links and frames, in the order of selection.
        tools: those of the document first, then the others.
        current: the tool that gets clicks.
    """

    def __init__(self, session: Session) -> None:
        self.status = ""
        self.selection: dict[Selectable, None] = {}
        self._session = session
        self._pick_scene = PickScene(session.context, lambda: session.displays)
        self._boxes = SelectionBoxes(session.audience.scene)
        self._config: object = None
        self._rays = ThreadPoolExecutor(1, "sambot-viz-rays")
        self.tools: tuple[Tool, ...] = ()
        self.current: Tool = MoveCameraTool(self, None)
        self._take_config()
        session.listeners.append(self._hear)

    # The tools

    @property
    def default(self) -> Tool:
        """The first tool of the file that is known here, as in RViz."""
        for item in self._session.config.tools:
            for tool in self.tools:
                if tool.kind == item.kind:
                    return tool
        return self.tool(MoveCameraTool.kind)

    def tool(self, kind: str) -> Tool:
        """The tool of a class id.

        Raises:
            UsageError: an unknown tool.
        """
        for tool in self.tools:
            if tool.kind == kind:
                return tool
        raise UsageError(f"there is no tool '{kind}'; there are {', '.join(TOOLS)}")

    def choose(self, kind: str) -> None:
        """Make a tool current, whichever was before.

        Raises:
            UsageError: an unknown tool.
        """
        with self._session.change("tools"):
            self._switch(self.tool(kind))

    def press(self, kind: str) -> None:
        """The key of a tool was pressed: choose the tool, or leave it again.

        In RViz the keys of other tools do nothing while Select is current; here they
        choose their tool.

        Raises:
            UsageError: an unknown tool.
        """
        if self.current.kind == kind:
            self.finish()
        else:
            self.choose(kind)

    def escape(self) -> None:
        """Esc: stop what the current tool does, and go back to the default tool."""
        with self._session.change("tools"):
            self.current.cancel()
            self._switch(self.default)

    def focus(self, client_id: int) -> None:
        """F: look at the selection, or at what is in the middle of the picture."""
        with self._session.lock:
            boxes = [self._pick_scene.box_of(item) for item in self.selection]
            camera = self._session.views.camera_of(client_id)
        known = [box for box in boxes if box is not None]
        if known:
            low = np.min([box[0] for box in known], axis=0)
            high = np.max([box[1] for box in known], axis=0)
            self.look_at((low + high) / 2, client_id)
            return

        def then(hit: Hit) -> None:
            if hit.point is not None:
                self.look_at(hit.point, client_id)

        self._follow(lambda s: s.first_hit(camera.position, camera.forward), then)

    def close(self) -> None:
        """Follow no more rays."""
        self._rays.shutdown(wait=False, cancel_futures=True)

    def set_property(self, kind: str, path: str, value: Any) -> None:
        """Set a property of a tool that the document lists.

        Raises:
            UsageError: an unknown tool, or the document does not list it.
        """
        with self._session.change("tools"):
            tool = self.tool(kind)
            if tool.config is None:
                raise UsageError(f"the config has no tool '{kind}'")
            tool.config.set(path, value)
            tool.property_changed()

    # What tools may use (tools.tool.ToolContext)

    @property
    def scene(self) -> viser.SceneApi:
        """Where to draw."""
        return self._session.audience.scene

    def select(self, items: set[Selectable], modifier: str | None) -> None:
        """Replace the selection, add to it (Shift) or remove from it (Ctrl)."""
        with self._session.change("tools"):
            if modifier == "shift":
                kept = {**self.selection, **dict.fromkeys(items)}
            elif modifier == "cmd/ctrl":
                kept = {item: None for item in self.selection if item not in items}
            else:
                kept = dict.fromkeys(sorted(items, key=lambda i: (i.kind, i.name)))
            self.selection = kept
            self._draw_boxes()

    def look_at(self, point: Array, client_id: int) -> None:
        """Turn a browser's camera to a point of the fixed frame, (3,) [m]."""
        self._session.views.look_at(point, client_id)

    def finish(self) -> None:
        """Go back to the default tool."""
        self.choose(self.default.kind)

    def show_status(self, status: str) -> None:
        """Show a sentence below the toolbar; an empty one shows the tool's help."""
        with self._session.change("tools"):
            self.status = status

    # Inside

    def _take_config(self) -> None:
        """The tools of the document, then the others, each with its settings."""
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
        """Have viser send what the current tool uses, and nothing else."""
        scene = self.scene
        scene.remove_click_callback()  # pyright: ignore[reportUnknownMemberType]
        scene.remove_rect_select_callback()  # pyright: ignore[reportUnknownMemberType]
        tool = self.current
        for modifier in MODIFIERS if tool.rectangles else (None,):
            if tool.clicks:
                scene.on_click(modifier=modifier)(self._on_click(tool))
            if tool.rectangles:
                scene.on_rect_select(modifier=modifier)(self._on_rectangle(tool))

    def _follow(
        self, rays: Callable[[PickSnapshot], T], then: Callable[[T], None]
    ) -> None:
        """Follow rays through what is drawn now, then act; one click after the other.

        Millions of triangles take most of a second. A thread of its own does that, so
        that neither browsers nor the session wait.
        """
        snapshot = self._pick_scene.snapshot()
        if snapshot.triangles <= INLINE:
            then(rays(snapshot))
            return

        def followed(future: Future[T]) -> None:
            # An exception of the rays is raised, and reported, in the worker.
            self._session.worker.post(lambda: then(future.result()))

        self._rays.submit(rays, snapshot).add_done_callback(followed)

    def _on_click(self, tool: Tool) -> Callable[[viser.SceneClickEvent], Any]:
        worker = self._session.worker

        async def clicked(event: viser.SceneClickEvent) -> None:
            click = _click(event)
            if click is not None:
                worker.post(partial(self._click, tool, click))

        return clicked

    def _click(self, tool: Tool, click: Click) -> None:
        def then(hit: Hit) -> None:
            with self._session.change("tools"):
                # The tool may have changed meanwhile.
                if self.current is tool:
                    tool.click(click, hit)

        self._follow(lambda s: s.first_hit(click.origin, click.direction), then)

    def _on_rectangle(self, tool: Tool) -> Callable[[viser.SceneRectSelectEvent], Any]:
        worker = self._session.worker

        async def drawn(event: viser.SceneRectSelectEvent) -> None:
            rays = _rays(event)
            if rays is not None:
                worker.post(partial(self._rectangle, tool, rays, event.modifier))

        return drawn

    def _rectangle(self, tool: Tool, rays: RayGrid, modifier: str | None) -> None:
        def then(items: set[Selectable]) -> None:
            with self._session.change("tools"):
                if self.current is tool:
                    tool.rectangle(items, modifier)

        self._follow(lambda s: s.items_met(rays), then)

    def _hear(self, event: Event) -> None:
        if event == "config":
            self._take_config()
        if event in ("joints", "frames", "robot", "config", "status"):
            self._draw_boxes()

    def _draw_boxes(self) -> None:
        boxes = {item: self._pick_scene.box_of(item) for item in self.selection}
        self._boxes.draw({i: box for i, box in boxes.items() if box is not None})


def _click(event: viser.SceneClickEvent) -> Click | None:
    """A click as a browser reports it; None when its numbers are not a ray."""
    origin, direction = _numbers(event.ray_origin), _numbers(event.ray_direction)
    if origin.shape != (3,) or direction.shape != (3,):
        return None
    length = float(np.linalg.norm(direction))
    if not (np.isfinite(origin).all() and np.isfinite(length) and length > 0.0):
        return None
    return Click(event.client_id, origin, direction / length, event.modifier)


def _rays(event: viser.SceneRectSelectEvent) -> RayGrid | None:
    """Rays through a rectangle of the picture, given from 0 to 1 of its size.

    Returns:
        The rays; None when the browser's numbers are not a rectangle or a camera.
    """
    camera = event.client.camera
    corners = _numbers((event.screen_min, event.screen_max))
    lens = _numbers((camera.fov, camera.aspect))
    wxyz, position = _numbers(camera.wxyz), _numbers(camera.position)
    shapes = [values.shape for values in (corners, wxyz, position)]
    if shapes != [(2, 2), (4,), (3,)]:
        return None
    if not all(np.isfinite(v).all() for v in (corners, lens, wxyz, position)):
        return None
    corners = np.minimum(np.maximum(np.sort(corners, axis=0), 0.0), 1.0)
    (left, top), (right, bottom) = corners.tolist()
    half = float(np.tan(lens[0] / 2))
    steps = np.arange(SAMPLES) / (SAMPLES - 1)
    columns = (2 * (left + (right - left) * steps) - 1) * half * float(lens[1])
    rows = (2 * (top + (bottom - top) * steps) - 1) * half
    if not (half > 0.0 and lens[1] > 0.0 and wxyz.any()):
        return None
    w, x, y, z = wxyz.tolist()
    R = np.array(rotation_from_xyzw((x, y, z, w)))
    return RayGrid(position, R, columns, rows)


def _numbers(values: object) -> Array:
    """What a browser sent as an array; an empty one for what is not numbers."""
    try:
        return np.asarray(values, np.float64)
    except (TypeError, ValueError):
        return np.zeros(0)
