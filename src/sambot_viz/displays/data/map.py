"""Map: an occupancy grid, such as a map or a costmap, and its updates."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np
import numpy.typing as npt

from sambot_viz import limits
from sambot_viz.displays.data.map_properties import (
    HEIGHT,
    MAP_PROPERTIES,
    ORIENTATION,
    POSITION,
    RESOLUTION,
    UPDATE_TOPIC,
    WIDTH,
)
from sambot_viz.displays.data.message_filter import TRANSFORM
from sambot_viz.displays.data.message_numbers import point_of, require_finite, wxyz_of
from sambot_viz.displays.data.refused_messages import MESSAGE, MessageRefused, refusing
from sambot_viz.displays.data.topic_display import TOPIC, TopicDisplay
from sambot_viz.displays.display import DisplayContext
from sambot_viz.displays.picking.placed import Placed
from sambot_viz.displays.robot_display import WantedQos
from sambot_viz.displays.scene.frame_nodes import position_of
from sambot_viz.displays.scene.maps import MapNode, palette
from sambot_viz.frames import LookupRefused
from sambot_viz.geometry import Matrix, rotation_from_xyzw, wxyz_from_matrix
from sambot_viz.meanings import Meaning, meaning_of
from sambot_viz.rviz import DisplayConfig
from sambot_viz.sources.message import Recorded
from sambot_viz.topics.contents.grids import map_fault
from sambot_viz.topics.decoding import frame_and_stamp

MAP, UPDATE = "Map", "Update"
"""Keys of statuses."""
_NONE_YET = "No map received"
Cells = npt.NDArray[np.uint8]


def unsigned(data: npt.NDArray[np.int8], rows: int, columns: int) -> Cells:
    """Return the values of cells as the bytes that palettes are for; a copy."""
    values = np.frombuffer(data.tobytes(), np.uint8)
    return np.array(np.reshape(values, (rows, columns)))


_UPDATES = "_updates"


def updates_of(topic: str) -> str:
    """Return the topic that RViz takes for the updates of a map's; "" without one."""
    return f"{topic}{_UPDATES}" if topic else ""


class MapDisplay(TopicDisplay):
    """The cells of nav_msgs/OccupancyGrid, with those of map_msgs/OccupancyGridUpdate.

    The map hangs below the node of its frame, so it follows the transforms.
    """

    kind = "rviz_default_plugins/Map"
    meanings = frozenset({Meaning.GRID})
    properties = MAP_PROPERTIES

    def __init__(self, context: DisplayContext, config: DisplayConfig, key: str):
        """Make the display; nothing is drawn before `draw`."""
        super().__init__(context, config, key)
        self._node: MapNode | None = None
        self._hung_at = ""
        self._cells: Cells | None = None
        self._resolution = 0.0
        self._T_frame_map: Matrix = np.eye(4)
        self._frame = ""
        self._stamp_ns: int | None = None
        config.assume(UPDATE_TOPIC, updates_of(self.topic))

    @classmethod
    def topic_values(
        cls, topic: str, type_name: str, qos: WantedQos | None
    ) -> Mapping[str, object] | None:
        """Return the values of a new display that draws a topic and its updates."""
        if meaning_of(type_name) is Meaning.GRID_UPDATE:
            # The map that it changes has the same name, as a rule.
            return {TOPIC: topic.removesuffix(_UPDATES), UPDATE_TOPIC: topic}
        found = super().topic_values(topic, type_name, qos)
        return None if found is None else {**found, UPDATE_TOPIC: updates_of(topic)}

    @property
    def update_topic(self) -> str:
        """The topic of updates: the property's, or RViz's own choice."""
        return str(self.config.get(UPDATE_TOPIC)) or updates_of(self.topic)

    def other_topics(self) -> tuple[str, ...]:
        """Return the topic of updates."""
        return (self.update_topic,)

    @property
    def base_topic(self) -> str:
        """Updates count since the last map."""
        return self.topic

    @property
    def most_waiting(self) -> int:
        """Maximum number of waiting messages between two pictures."""
        return limits.MAP_UPDATES.value

    def messages_came(self) -> None:
        """Take maps and updates in their order, and draw once."""
        if self.subscription is None:
            return
        came = self.subscription.drain()
        maps = [index for index, one in enumerate(came) if one.topic == self.topic]
        # What was before the last map is overwritten by it.
        for one in came[maps[-1] if maps else 0 :]:
            self._take_one(one)
        self.redraw()

    def forget(self) -> None:
        """Take the map out of the scene."""
        self._remove()
        self._cells = None
        for path in (RESOLUTION, WIDTH, HEIGHT, POSITION, ORIENTATION):
            self.config.assume(path, self.config.declared[path].property.default)
        for key in (MAP, MESSAGE, TRANSFORM, UPDATE):
            self.status.remove(key)

    def redraw(self) -> None:
        """Draw the map as it looks now, below the node of its frame."""
        if self._cells is None:
            if self.context.messages is not None and self.topic:
                if MESSAGE not in self.status.rows:
                    self.status.set(MESSAGE, "Warn", _NONE_YET, "no-message")
            return
        place = self._place()
        if place is None:
            self._say_unplaced()
            self._remove()
            return
        self.status.set(TRANSFORM, "Ok", "Transform OK")
        above, T = place
        if self._node is None or above != self._hung_at or self._node.is_gone:
            self._remove()
            self._node = MapNode(self.context.scene, f"{above}/{self.key}")
            self._hung_at = above
        get = self.config.get
        scheme, threshold = str(get("Color Scheme")), int(get("Binary threshold"))
        self._node.draw(
            self._cells,
            palette(scheme, bool(get("Binary representation")), threshold),
            self._resolution,
            alpha=float(get("Alpha")),
            is_behind=bool(get("Draw Behind")),
            wxyz=wxyz_from_matrix(T),
            position=position_of(T),
        )

    def property_changed(self, path: str) -> None:
        """A property has a new value; the topic of updates follows the map's."""
        if path == TOPIC:
            self.config.set(UPDATE_TOPIC, updates_of(self.topic))
        super().property_changed(path)

    def report_topic(self) -> None:
        """Set the statuses of both topics."""
        super().report_topic()
        if self.context.messages is not None and self.topic:
            self.status.set(UPDATE_TOPIC, "Ok", "OK")

    def placed(self) -> Iterator[Placed]:
        """Yield the map, which cannot be selected, as in RViz."""
        place = self._place() if self._cells is not None else None
        if place is None or self._node is None:
            return
        above = None if place[0] == "" else self._frame
        T_fixed_above = self.context.pose(above)
        if T_fixed_above is not None and float(self.config.get("Alpha")) > 0.0:
            yield from self._node.placed(T_fixed_above)

    def _place(self) -> tuple[str, Matrix] | None:
        """Return the node to hang below and the pose there; None without a place."""
        context = self.context
        if self.config.get("Use Timestamp"):
            try:
                fixed = context.fixed_frame
                found = context.tree.lookup(fixed, self._frame, self._stamp_ns)
                return "", found.matrix @ self._T_frame_map
            except LookupRefused:
                # RViz falls back on the latest transform, too.
                pass
        if self._frame == context.fixed_frame:
            return "", self._T_frame_map
        if not context.nodes.connected(self._frame):
            return None
        return context.above(self._frame), self._T_frame_map

    def _say_unplaced(self) -> None:
        """Say why the map has no place, and what brings it one."""
        try:
            self.context.tree.lookup(self.context.fixed_frame, self._frame)
        except LookupRefused as refused:
            why = self.context.unplaced(self.topic, refused)
            self.status.set(TRANSFORM, "Error", why.text, why.code)

    def _take_one(self, one: Recorded) -> None:
        assert self.subscription is not None
        is_map = one.topic == self.topic
        key = MAP if is_map else UPDATE
        try:
            with refusing(key):
                message = self.subscription.decode(one)
                if is_map:
                    self._take_map(message)
                else:
                    self._take_update(message)
        except MessageRefused as refused:
            self.status.set(key, "Error", refused.text, refused.code)

    def _take_map(self, message: Any) -> None:
        info, data = message.info, np.asarray(message.data, np.int8)
        width, height = int(info.width), int(info.height)
        fault = map_fault(message)
        if not len(data):
            if self._cells is None:
                self.status.set(MESSAGE, "Warn", f"{_NONE_YET}. {fault}")
            return
        require_finite([float(info.resolution)])
        x, y, z = point_of(info.origin.position)
        w, qx, qy, qz = wxyz_of(info.origin.orientation)
        if fault:
            raise MessageRefused(fault)
        resolution = float(info.resolution)
        frame, self._stamp_ns = frame_and_stamp(message)
        self._frame = frame or "map"
        T = np.eye(4)
        T[:3, :3] = rotation_from_xyzw((qx, qy, qz, w))
        T[:3, 3] = x, y, z
        self._T_frame_map = T
        self._cells = unsigned(data, height, width)
        self._resolution = resolution
        for path, value in (
            (RESOLUTION, resolution),
            (WIDTH, width),
            (HEIGHT, height),
            (POSITION, (x, y, z)),
            (ORIENTATION, (qx, qy, qz, w)),
        ):
            self.config.assume(path, value)
        self.status.set(MESSAGE, "Ok", "Map received")
        self.status.set(MAP, "Ok", "Map OK")

    def _take_update(self, message: Any) -> None:
        if self._cells is None:
            return
        rows, columns = self._cells.shape
        x, y = int(message.x), int(message.y)
        width, height = int(message.width), int(message.height)
        data = np.asarray(message.data, np.int8)
        is_inside = 0 <= x <= columns - width and 0 <= y <= rows - height
        if not is_inside or len(data) != width * height:
            raise MessageRefused("update area outside of original map area")
        self._cells[y : y + height, x : x + width] = unsigned(data, height, width)
        self.status.set(UPDATE, "Ok", "Update OK")

    def _remove(self) -> None:
        if self._node is not None:
            self._node.remove()
            self._node = None
