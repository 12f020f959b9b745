"""Overlays of single links and joints: axes, arrows, masses, inertias, trails.

Sizes and colours are RViz's (docs/rviz-facts.md); no Alpha changes them.
"""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
import viser

from sambot_viz.displays.display import DisplayContext
from sambot_viz.displays.robot_model.inertia_boxes import ball_diameter, inertia_box
from sambot_viz.displays.robot_model.robot_entries import BOX, WITH_AXIS, RobotEntries
from sambot_viz.displays.scene.frame_nodes import (
    Handle,
    any_gone,
    position_of,
    remove_all,
)
from sambot_viz.displays.scene.lines import Ribbon
from sambot_viz.displays.scene.solids import (
    Arrow,
    add_arrows,
    add_axes,
    arrow_triangles,
    axes_triangles,
    sphere,
)
from sambot_viz.displays.triangle_display import DrawnTriangles, Triangles
from sambot_viz.geometry import Matrix, Vector3, rotation_from_xyzw, wxyz_from_matrix
from sambot_viz.meshes.primitives import unit_box
from sambot_viz.robot.model import Robot
from sambot_viz.robot.parts import Inertial, Joint, Link

AXES_LENGTH, AXES_DIAMETER = 0.1, 0.01
SHAFT, HEAD = (0.15, 0.05), (0.05, 0.08)
"""Length and diameter of the two parts of a joint's arrow [m]."""
GREEN, RED = (0, 204, 0), (255, 0, 0)
TRAIL_COLOR, TRAIL_WIDTH = (0, 128, 128), 0.01
ELEMENT = 0.02
"""Length of a piece of a trail [m]."""
MOST_ELEMENTS = 100


@dataclass(frozen=True, slots=True)
class _Overlay:
    """Something drawn at a node."""

    path: str
    handles: tuple[Handle, ...] = ()
    shape: DrawnTriangles | None = None


@dataclass(frozen=True, slots=True)
class Wanted:
    """Overlays that the display asks for at all links."""

    mass: bool
    inertia: bool


class _Trail:
    """A ribbon through the places where a frame has been, in the fixed frame.

    Args:
        scene: where to draw.
        name: node name.
    """

    def __init__(self, scene: viser.SceneApi, name: str) -> None:
        self.ribbon = Ribbon(scene, name, TRAIL_COLOR, TRAIL_WIDTH)
        self._corners: deque[Vector3] = deque(maxlen=MOST_ELEMENTS)
        self._head: Vector3 | None = None

    def follow(self, at: Vector3) -> None:
        """Draw it to here; nothing is sent unless the frame has moved."""
        if self._head is not None and math.dist(at, self._head) < 1e-6:
            return
        if not self._corners or math.dist(at, self._corners[-1]) >= ELEMENT:
            self._corners.append(at)
        self._head = at
        points = [*self._corners]
        if points[-1] != at:
            points.append(at)
        if len(points) > 1:
            self.ribbon.draw(np.array(points, np.float32))


class LinkOverlays:
    """The overlays of one RobotModel.

    Args:
        context: what to draw with.
        key: begins the names of all nodes.
        frame_of: the frame of a link.
    """

    def __init__(
        self, context: DisplayContext, key: str, frame_of: Callable[[str], str]
    ) -> None:
        self._context = context
        self._key = key
        self._frame_of = frame_of
        self._overlays: dict[tuple[str, str], _Overlay] = {}
        self._trails: dict[str, _Trail] = {}
        self._fixed = context.fixed_frame

    def draw(self, robot: Robot, entries: RobotEntries, wanted: Wanted) -> None:
        """Add missing overlays, and remove those no longer wanted."""
        keep: set[tuple[str, str]] = set()
        for link in robot.links.values():
            own = entries.link(link.name)
            shown = own.get(BOX) or not (link.visuals or link.collisions)
            overlays: dict[str, bool] = {
                "a": own.get("Show Axes") and shown,
                "m": wanted.mass and shown,
                "i": wanted.inertia and shown,
            }
            for what, on in overlays.items():
                if on and self._at(what, link.name, link):
                    keep.add((what, link.name))
            self._draw_trail(link.name, own.get("Show Trail"), shown)
        for joint in robot.joints.values():
            own_joint = entries.joint(joint.name)
            for what, on in {
                "j": own_joint.get("Show Axes"),
                "x": own_joint.get("Show Joint Axis") and joint.type in WITH_AXIS,
            }.items():
                if on and self._at(what, joint.name, joint):
                    keep.add((what, joint.name))
        for overlay in [overlay for overlay in self._overlays if overlay not in keep]:
            remove_all(self._overlays.pop(overlay).handles)
        for name in [name for name in self._trails if name not in robot.links]:
            self._trails.pop(name).ribbon.remove()
        self._fixed = self._context.fixed_frame
        self.moved()

    def moved(self) -> None:
        """Some frames have moved: the trails follow."""
        if not self._trails:
            return
        tree, fixed = self._context.tree, self._context.fixed_frame
        for name, trail in self._trails.items():
            frame = self._frame_of(name)
            if self._context.nodes.connected(frame):
                trail.follow(position_of(tree.drawn(fixed, frame).matrix))

    def drawn(self) -> Iterator[DrawnTriangles]:
        """Yield the overlays as triangles, without the trails, which are lines."""
        for overlay in self._overlays.values():
            if overlay.shape is not None:
                yield overlay.shape

    def clear(self) -> None:
        """Take everything out of the scene."""
        for overlay in self._overlays.values():
            remove_all(overlay.handles)
        for trail in self._trails.values():
            trail.ribbon.remove()
        self._overlays.clear()
        self._trails.clear()

    def _draw_trail(self, link: str, on: bool, visible: bool) -> None:
        trail = self._trails.get(link)
        if trail is not None and (not on or self._fixed != self._context.fixed_frame):
            trail.ribbon.remove()
            del self._trails[link]
            trail = None
        if on and trail is None:
            name = f"/{self._key}t{len(self._trails)}"
            trail = self._trails[link] = _Trail(self._context.scene, name)
        if trail is not None:
            trail.ribbon.show(visible)

    def _at(self, what: str, name: str, thing: Link | Joint) -> bool:
        """Draw one overlay at its node; False when there is nothing to draw."""
        link = thing.parent if isinstance(thing, Joint) else name
        frame = self._frame_of(link)
        path = self._context.nodes.path(frame)
        if path is None or not self._context.nodes.connected(frame):
            return False
        # A link may have several joints; the child makes their names differ.
        node = f"{path}/{self._key}{what}"
        if isinstance(thing, Joint):
            child = self._context.nodes.path(self._frame_of(thing.child)) or name
            node += child.rpartition("/")[2]
        known = self._overlays.get((what, name))
        if known and known.path == node and not any_gone(known.handles):
            return bool(known.handles)
        if known is not None:
            remove_all(known.handles)
        made, overlay = self._make(what, node, thing), _Overlay(node)
        if made is not None:
            overlay = _Overlay(node, made[0], DrawnTriangles(made[1], made[2], frame))
        self._overlays[what, name] = overlay
        return made is not None

    def _make(self, what: str, node: str, thing: Link | Joint) -> _Made | None:
        scene = self._context.scene
        if isinstance(thing, Joint):
            return self._make_joint(what, node, thing)
        if what == "a":
            axes = add_axes(scene, node, AXES_LENGTH, AXES_DIAMETER)
            return (axes,), _AXES, np.eye(4)
        if thing.inertial is None:
            return None
        if what == "m":
            diameter = ball_diameter(thing.inertial.mass)
            return self._ball(node, diameter, thing.inertial) if diameter > 0 else None
        box = inertia_box(thing.inertial)
        if box is None:
            return None
        handle = scene.add_box(
            node, RED, box.size, wxyz=box.wxyz, position=box.position, **_NO_SHADOWS
        )
        w, x, y, z = box.wxyz
        T = np.eye(4)
        T[:3, :3] = np.array(rotation_from_xyzw((x, y, z, w))) * box.size
        T[:3, 3] = box.position
        return (handle,), unit_box(), T

    def _ball(self, node: str, diameter: float, inertial: Inertial) -> _Made:
        shape, T = sphere(), np.eye(4)
        T[:3, :3] *= diameter
        T[:3, 3] = inertial.origin.matrix[:3, 3]
        handle = self._context.scene.add_mesh_simple(
            node,
            shape.vertices,
            shape.faces,
            color=RED,
            flat_shading=True,
            scale=diameter,
            position=position_of(T),
            **_NO_SHADOWS,
        )
        return (handle,), shape, T

    def _make_joint(self, what: str, node: str, joint: Joint) -> _Made | None:
        scene, T_link_joint = self._context.scene, joint.origin.matrix
        if what == "j":
            axes = add_axes(scene, node, AXES_LENGTH, AXES_DIAMETER)
            axes.wxyz, axes.position = (
                wxyz_from_matrix(T_link_joint),
                position_of(T_link_joint),
            )
            return (axes,), _AXES, T_link_joint
        if not any(joint.axis):
            return None
        # RViz leaves the rotation of the joint out, which is a mistake of RViz.
        x, y, z = (float(c) for c in T_link_joint[:3, :3] @ joint.axis)
        arrow = Arrow(position_of(T_link_joint), (x, y, z), SHAFT, HEAD)
        handles = add_arrows(scene, node, [arrow], [GREEN], [GREEN])
        return handles, arrow_triangles((arrow,)), np.eye(4)


_Made = tuple[tuple[Handle, ...], Triangles, Matrix]
"""The nodes of an overlay, and the same as triangles with their pose in the link."""
_AXES = axes_triangles(AXES_LENGTH, AXES_DIAMETER)
_NO_SHADOWS: dict[str, Any] = {"cast_shadow": False, "receive_shadow": False}
