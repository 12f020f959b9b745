"""TF: axes, names and arrows of the frames."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field

import numpy as np

from sambot_viz.displays.display import DisplayContext, EntryList, Status
from sambot_viz.displays.picking.selectable import Selectable
from sambot_viz.displays.robot_display import WantedQos
from sambot_viz.displays.scene.frame_nodes import (
    NodeCache,
    position_of,
)
from sambot_viz.displays.scene.solids import (
    AXIS_COLORS,
    Arrow,
    add_arrows,
    add_axes,
    arrow_triangles,
    axes_triangles,
)
from sambot_viz.displays.scene_size import SceneSize, round_size
from sambot_viz.displays.tf.ageing import FRESH, GONE, FrameAges, FrameLook
from sambot_viz.displays.tf.frame_rows import (
    ALL_ENABLED,
    TF_PROPERTIES,
    FrameEntries,
    frame_list,
)
from sambot_viz.displays.triangle_display import DrawnTriangles, TriangleDisplay
from sambot_viz.geometry import Vector3
from sambot_viz.meanings import Meaning, meaning_of
from sambot_viz.rviz import DisplayConfig, RegexProperty
from sambot_viz.text import capitalized, text
from sambot_viz.topics.reasons import OF_PARENTS, TopicReason

AXES_LENGTH, AXES_DIAMETER = 0.2, 0.02
SHAFT_COLOR, HEAD_COLOR = (204, 204, 76), (255, 25, 153)
HEAD_LENGTH, HEAD_DIAMETER, SHAFT_DIAMETER = 0.1, 0.04, 0.01
SHORTEST_ARROW = 0.001
"""Frames nearer than this have no arrow [m]."""
SHORTEST_AXES = 250
"""Axes are no shorter than this part of the robot."""
EM_HEIGHT = 0.0889
"""Height of the em square of names, in a character cell of 0.1 m."""


@dataclass
class _FrameOverlays:
    """The nodes of one frame."""

    axes: NodeCache = field(default_factory=NodeCache)
    name: NodeCache = field(default_factory=NodeCache)

    def remove(self) -> None:
        """Take them out of the scene."""
        self.axes.remove()
        self.name.remove()


class TfDisplay(TriangleDisplay):
    """The frames: axes, names, and arrows from child to parent."""

    kind = "rviz_default_plugins/TF"
    properties = TF_PROPERTIES

    def __init__(self, context: DisplayContext, config: DisplayConfig, key: str):
        """Make the display; nothing is drawn before `draw`."""
        super().__init__(context, config, key)
        self._entries = FrameEntries(config)
        self._overlays: dict[str, _FrameOverlays] = {}
        self._arrows: dict[str, NodeCache] = {}
        self._ages = FrameAges(context)

    @classmethod
    def topic_values(
        cls, topic: str, type_name: str, qos: WantedQos | None
    ) -> Mapping[str, object] | None:
        """Return no values: one display shows the transforms of all topics."""
        del topic, qos
        return {} if meaning_of(type_name) is Meaning.TRANSFORMS else None

    @classmethod
    def size_values(cls, size: SceneSize) -> Mapping[str, float]:
        """Return a tenth of the robot for axes, or less where frames are closer."""
        axes = min(size.length / 10, size.spacing)
        axes = max(axes, size.length / SHORTEST_AXES)
        return {"Marker Scale": round_size(axes / AXES_LENGTH)}

    def time_passed(self) -> None:
        """Let frames that messages bring no more fade, and vanish."""
        timeout = float(self.config.get("Frame Timeout"))
        if self.shown and self._ages.look(self.context.tree.frames, timeout):
            self.draw()

    def draw(self) -> None:
        """Add missing nodes, and update others."""
        tree, nodes = self.context.tree, self.context.nodes
        passes = self._filter()
        frames = {
            frame: None
            for frame in tree.frames
            if nodes.connected(frame) and self._entries.is_on(frame) and passes(frame)
            if self._look(frame) != GONE
        }
        for frame in [f for f in self._overlays if f not in frames]:
            self._overlays.pop(frame).remove()
        for frame in frames:
            self._draw_overlays(frame)
        parents = {tree.parent(f) for f in frames}
        for parent in [p for p in self._arrows if p not in parents]:
            self._arrows.pop(parent).remove()
        for parent in parents:
            if parent is not None:
                self._draw_arrows(parent)
        self._report()

    def _letters(self) -> float:
        """Return the size of the letters of names [m]."""
        return EM_HEIGHT * abs(float(self.config.get("Marker Scale")))

    def _look(self, frame: str) -> FrameLook:
        return self._ages.looks.get(frame, FRESH)

    def _filter(self) -> Callable[[str], bool]:
        """Return a check whether the two filters let a frame through."""
        whitelist = RegexProperty.compiled(self.config.get("Filter (whitelist)"))
        blacklist = RegexProperty.compiled(self.config.get("Filter (blacklist)"))

        def passes(frame: str) -> bool:
            if whitelist is not None and not whitelist.matches(frame):
                return False
            return blacklist is None or not blacklist.matches(frame)

        return passes

    def _draw_overlays(self, frame: str) -> None:
        path = self.context.nodes.path(frame)
        if path is None:
            return
        overlays = self._overlays.setdefault(frame, _FrameOverlays())
        scene, look = self.context.scene, self._look(frame)
        if bool(self.config.get("Show Axes")):
            colors = [look.of(color) for color in AXIS_COLORS]
            axes = f"{path}/{self.key}a", AXES_LENGTH, AXES_DIAMETER, colors, look.alpha
            scale = float(self.config.get("Marker Scale"))
            (node,) = overlays.axes.show(
                (path, look), lambda: [add_axes(scene, *axes, scale)]
            )
            # viser takes long to find out that a value is the same.
            if node.scale != scale:
                node.scale = scale
        else:
            overlays.axes.remove()
        if bool(self.config.get("Show Names")):
            height = self._letters()
            (label,) = overlays.name.show(
                path,
                lambda: [
                    scene.add_label(
                        f"{path}/{self.key}n",
                        text(frame),
                        font_size_mode="scene",
                        font_scene_height=height,
                        depth_test=True,
                        anchor="top-center",
                    )
                ],
            )
            if label.font_scene_height != height:
                label.font_scene_height = height
        else:
            overlays.name.remove()

    def _draw_arrows(self, parent: str) -> None:
        """The arrows of all children of a frame, as two nodes below it."""
        path = self.context.nodes.path(parent)
        at = self._arrows_at(parent)
        if path is None or not at:
            self._arrows.pop(parent, NodeCache()).remove()
            return
        name = f"{path}/{self.key}"
        arrows = tuple(at.values())
        looks = tuple(self._look(child) for child in at)
        self._arrows.setdefault(parent, NodeCache()).show(
            (name, arrows, looks),
            lambda: add_arrows(
                self.context.scene,
                name,
                arrows,
                [look.of(SHAFT_COLOR) for look in looks],
                [look.of(HEAD_COLOR) for look in looks],
                [look.alpha for look in looks],
            ),
        )

    def _arrows_at(self, parent: str) -> dict[str, Arrow]:
        """Return the arrows of all children of a frame, in its coordinates."""
        if not bool(self.config.get("Show Arrows")):
            return {}
        tree, scale = self.context.tree, float(self.config.get("Marker Scale"))
        arrows = {
            child: frame_arrow(position_of(tree.hop(child).transform.matrix), scale)
            for child in tree.children(parent)
            if child in self._overlays
        }
        return {child: arrow for child, arrow in arrows.items() if arrow is not None}

    def drawn(self) -> Iterator[DrawnTriangles]:
        """Yield axes, which select their frame, and arrows, which select nothing."""
        scale = float(self.config.get("Marker Scale"))
        axes, T = axes_triangles(AXES_LENGTH, AXES_DIAMETER), np.eye(4)
        T[:3, :3] *= scale
        for frame, overlays in self._overlays.items():
            if overlays.axes.handles:
                yield DrawnTriangles(axes, T, frame, Selectable("frame", frame))
        for parent in self._arrows:
            arrows = tuple(self._arrows_at(parent).values())
            if arrows:
                yield DrawnTriangles(arrow_triangles(arrows), np.eye(4), parent)

    def names(self) -> Mapping[str, float]:
        """Return the frames that have names below them."""
        named = (f for f, overlays in self._overlays.items() if overlays.name.handles)
        return dict.fromkeys(named, self._letters())

    def property_changed(self, path: str) -> None:
        """A property has a new value."""
        if path == ALL_ENABLED:
            self._entries.set_all(bool(self.config.get(ALL_ENABLED)))
        super().property_changed(path)

    def values_put_back(self) -> None:
        """Read the frames again, and draw them."""
        self._entries = FrameEntries(self.config)
        super().values_put_back()

    def entries(self) -> tuple[EntryList, ...]:
        """Return the frames."""
        return (frame_list(self.context, self._entries),)

    def frames_moved(self, frames: Iterable[str]) -> None:
        """An arrow only changes when its frame has moved away from its parent."""
        if not self.shown:
            return
        for frame in frames:
            if self.context.moving.get(frame) not in ("revolute", "continuous"):
                parent = self.context.tree.parent(frame)
                if parent in self._arrows:
                    self._draw_arrows(parent)

    def _report(self) -> None:
        frames, said = self.context.tree.frames, self.context.transform_status
        rows = {frame: said(frame, "Warn") for frame in frames}
        descriptions = self.context.descriptions
        if descriptions is not None:
            doubts = descriptions.transform_doubts().items()
            told = {
                topic: Status("Warn", capitalized(why.text), why.code)
                for topic, why in doubts
            }
            rows = {**told, **rows}
        self.status.replace(rows)

    def unseen_topics(self) -> Iterator[tuple[str, TopicReason]]:
        """Yield topics of transforms with their faults, except those of parents."""
        for topic, row in self.status.rows.items():
            if row.code and row.code not in OF_PARENTS:
                yield topic, TopicReason(row.code, row.text)

    def clear(self) -> None:
        """Take all overlays out of the scene."""
        for overlays in self._overlays.values():
            overlays.remove()
        for arrows in self._arrows.values():
            arrows.remove()
        self._overlays.clear()
        self._arrows.clear()


def frame_arrow(at: Vector3, scale: float) -> Arrow | None:
    """Return the arrow from a frame to its parent, in the parent's coordinates.

    Args:
        at: origin of the frame in its parent [m].
        scale: the property "Marker Scale".

    Returns:
        None when the frames are too close for an arrow. A head that is longer than the
        way begins behind the frame, so that its tip is at the parent.
    """
    distance = math.hypot(*at)
    if distance <= SHORTEST_ARROW:
        return None
    head = HEAD_LENGTH * scale
    if distance < head:
        head *= distance
    towards_parent = (-at[0], -at[1], -at[2])
    return Arrow(
        start=at,
        direction=towards_parent,
        shaft=(distance - head, SHAFT_DIAMETER * scale),
        head=(head, HEAD_DIAMETER * scale),
    )
