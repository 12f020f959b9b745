"""The situations whose statuses were recorded from RViz, brought about by messages.

A situation is called as in `tests/displays/data/statuses/statuses.yaml`: what is done,
a full stop, and the display it is done to, such as "badframe.Pose".
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
from blank_messages import blank_message

START_NS = 1_700_000_000 * 10**9
NAN = float("nan")
TYPES = {
    "AccelStamped": "geometry_msgs/msg/AccelStamped",
    "CameraInfo": "sensor_msgs/msg/CameraInfo",
    "DepthCloud": "sensor_msgs/msg/Image",
    "Effort": "sensor_msgs/msg/JointState",
    "FluidPressure": "sensor_msgs/msg/FluidPressure",
    "GridCells": "nav_msgs/msg/GridCells",
    "Illuminance": "sensor_msgs/msg/Illuminance",
    "Image": "sensor_msgs/msg/Image",
    "InteractiveMarkers": "visualization_msgs/msg/InteractiveMarkerInit",
    "LaserScan": "sensor_msgs/msg/LaserScan",
    "Map": "nav_msgs/msg/OccupancyGrid",
    "Marker": "visualization_msgs/msg/Marker",
    "MarkerArray": "visualization_msgs/msg/MarkerArray",
    "Odometry": "nav_msgs/msg/Odometry",
    "Path": "nav_msgs/msg/Path",
    "PointCloud": "sensor_msgs/msg/PointCloud",
    "PointCloud2": "sensor_msgs/msg/PointCloud2",
    "PointStamped": "geometry_msgs/msg/PointStamped",
    "Polygon": "geometry_msgs/msg/PolygonStamped",
    "Pose": "geometry_msgs/msg/PoseStamped",
    "PoseArray": "geometry_msgs/msg/PoseArray",
    "PoseWithCovariance": "geometry_msgs/msg/PoseWithCovarianceStamped",
    "Range": "sensor_msgs/msg/Range",
    "RelativeHumidity": "sensor_msgs/msg/RelativeHumidity",
    "Temperature": "sensor_msgs/msg/Temperature",
    "TwistStamped": "geometry_msgs/msg/TwistStamped",
    "Wrench": "geometry_msgs/msg/WrenchStamped",
}
"""Display → the type of the messages that it is shown."""
_IN_MAP = ("Map", "Path", "PointCloud2", "Pose", "PoseArray")
(ARROW, CUBE, LINE_STRIP, LINE_LIST, POINTS, TEXT, MESH, TRIANGLES) = (
    *(0, 1, 4, 5),
    *(8, 9, 10, 11),
)
Change = Callable[[Any], None]
"""Makes of a good message one of a situation."""


def display_of(situation: str) -> str:
    """Return the display of a situation."""
    return situation.partition(".")[2].removesuffix("Origin").removesuffix("Resolution")


def message_of(store: Any, situation: str, time_ns: int) -> Any:
    """Return the message of a situation that is sent at a time [ns]; None for none."""
    what, display = situation.partition(".")[0], display_of(situation)
    if what in ("none", "emptytopic") or display not in TYPES:
        return None
    if what == "wrongtype":
        return blank_message(store, "nav_msgs/msg/Path")
    made = good_message(store, display)
    for one in headed(made):
        one.header.frame_id = frame_of(what, display)
        stamp_ns = _stamp(what, time_ns)
        one.header.stamp.sec = stamp_ns // 10**9
        one.header.stamp.nanosec = stamp_ns % 10**9
    change = CHANGES.get(situation) or CHANGES.get(what)
    if change is not None:
        change(made)
    return made


def headed(message: Any) -> list[Any]:
    """Return what has the header: a message, or the markers of an array."""
    inside = getattr(message, "markers", [message])
    return [one for one in inside if hasattr(one, "header")]


def frame_of(what: str, display: str) -> str:
    frames = {
        "badframe": "no_such_frame",
        "island": "island_b",
        "emptyframe": "",
        "slashframe": "/map",
    }
    if what in frames:
        return frames[what]
    if what in ("future", "past") and display != "Map":
        return "base_link"
    return "map" if display in _IN_MAP else "base_link"


def _stamp(what: str, time_ns: int) -> int:
    apart = {"future": 5, "past": -100}
    return 0 if what == "stamp0" else time_ns + apart.get(what, 0) * 10**9


def good_message(store: Any, display: str) -> Any:
    """Return a message without a fault for a display; its header is empty."""
    made = blank_message(store, TYPES[display])
    if display in ("Marker", "MarkerArray"):
        marker = made if display == "Marker" else _appended(store, made, "markers")
        marker.ns, marker.type = "t", CUBE
        marker.scale.x = marker.scale.y = marker.scale.z = marker.color.a = 1.0
    elif display in _FILLED:
        _FILLED[display](store, made)
    elif hasattr(made, "poses"):
        made.poses.append(blank_message(store, _item_type(store, made, "poses")))
    return made


def _item_type(store: Any, message: Any, field: str) -> str:
    fields = dict(store.fielddefs[message.__msgtype__][1])
    return str(fields[field][1][0][1])


def _appended(store: Any, message: Any, field: str) -> Any:
    made = blank_message(store, _item_type(store, message, field))
    getattr(message, field).append(made)
    return made


def _fill_scan(store: Any, scan: Any) -> None:
    del store
    scan.angle_increment, scan.range_min, scan.range_max = 0.1, 0.1, 10.0
    scan.ranges = np.ones(20, np.float32)


def _fill_map(store: Any, grid: Any) -> None:
    del store
    grid.info.resolution, grid.info.width, grid.info.height = 0.5, 3, 3
    grid.data = np.zeros(9, np.int8)


def _fill_cells(store: Any, cells: Any) -> None:
    cells.cell_width = cells.cell_height = 0.5
    _appended(store, cells, "cells")


def _fill_cloud2(store: Any, cloud: Any) -> None:
    cloud.width, cloud.height, cloud.point_step = 2, 1, 16
    for number, name in enumerate("xyz"):
        field = _appended(store, cloud, "fields")
        field.name, field.offset, field.datatype, field.count = name, 4 * number, 7, 1
    cloud.data = np.zeros(32, np.uint8)


def _fill_cloud(store: Any, cloud: Any) -> None:
    _appended(store, cloud, "points")


def _fill_polygon(store: Any, polygon: Any) -> None:
    for x in (0.0, 1.0):
        _appended(store, polygon.polygon, "points").x = x


def _fill_range(store: Any, measured: Any) -> None:
    del store
    measured.field_of_view, measured.max_range, measured.range = 1.0, 5.0, 2.0


def _fill_image(store: Any, image: Any) -> None:
    del store
    image.width, image.height, image.step, image.encoding = 2, 2, 4, "16UC1"
    image.data = np.frombuffer(np.array([900, 1000, 1100, 1200], "<u2"), np.uint8)


def _fill_camera(store: Any, camera: Any) -> None:
    del store
    camera.width, camera.height = 2, 2
    camera.p = np.array([2.0, 0, 1, 0, 0, 2, 1, 0, 0, 0, 1, 0])


def _fill_joints(store: Any, joints: Any) -> None:
    del store
    joints.name, joints.position = ["base_tip"], np.zeros(1)
    joints.effort = np.ones(1)


def _fill_interactive(store: Any, full: Any) -> None:
    marker = _appended(store, full, "markers")
    marker.header.frame_id, marker.name, marker.scale = "map", "knob", 1.0
    control = _appended(store, marker, "controls")
    control.name, control.interaction_mode, control.always_visible = "x", 3, True


_FILLED: Mapping[str, Callable[[Any, Any], None]] = {
    "CameraInfo": _fill_camera,
    "DepthCloud": _fill_image,
    "Effort": _fill_joints,
    "GridCells": _fill_cells,
    "Image": _fill_image,
    "InteractiveMarkers": _fill_interactive,
    "LaserScan": _fill_scan,
    "Map": _fill_map,
    "PointCloud": _fill_cloud,
    "PointCloud2": _fill_cloud2,
    "Polygon": _fill_polygon,
    "Range": _fill_range,
}


def _pose_of(message: Any) -> Any:
    """Return the first pose of a message."""
    if hasattr(message, "info"):
        return message.info.origin
    found = message.poses[0] if hasattr(message, "poses") else message
    while hasattr(found, "pose"):
        found = found.pose
    return found


def _turned(w: float, z: float) -> Change:
    def change(message: Any) -> None:
        _pose_of(message).orientation.w = w
        _pose_of(message).orientation.z = z

    return change


def _set(path: str, value: object) -> Change:
    """Return a change of the field at a path, such as "pose.position.x"."""
    *way, name = path.split(".")

    def change(message: Any) -> None:
        for step in way:
            message = getattr(message, step)
        setattr(message, name, value)

    return change


def _all(*changes: Change) -> Change:
    def change(message: Any) -> None:
        for one in changes:
            one(message)

    return change


def _nan_in_pose(message: Any) -> None:
    _pose_of(message).position.x = NAN


def _points(kind: int, count: int, scale: float = 1.0) -> Change:
    """Return a change to a marker of a type with a number of points."""

    def change(marker: Any) -> None:
        marker.type = kind
        point = type(marker.pose.position)
        marker.points = [point(float(n), 0.0, 0.0) for n in range(count)]
        marker.scale.x = marker.scale.y = scale

    return change


def _one_color(marker: Any) -> None:
    marker.colors = [type(marker.color)(1.0, 1.0, 1.0, 1.0)]


def _nan_point(marker: Any) -> None:
    marker.points[0].x = NAN


def _no_cells(width: int, count: int) -> Change:
    def change(grid: Any) -> None:
        grid.info.width, grid.info.height = width, 5 if not width else 3
        grid.data = np.zeros(count, np.int8)

    return change


def _first_x(nan: Any) -> None:
    nan.data[:4] = np.frombuffer(np.float32(NAN).tobytes(), np.uint8)


def _double_x(cloud: Any) -> None:
    cloud.point_step = 24
    cloud.fields[0].datatype = 8
    for number in (1, 2):
        cloud.fields[number].offset += 4
    cloud.data = np.zeros(48, np.uint8)


def _shorter(cloud: Any) -> None:
    cloud.data = cloud.data[:20]


def _no_z(cloud: Any) -> None:
    del cloud.fields[2]


def _empty_cloud(cloud: Any) -> None:
    cloud.width, cloud.data = 0, cloud.data[:0]


def _twice(array: Any) -> None:
    array.markers *= 2


def _deleted_first(array: Any) -> None:
    import copy

    first, last = (copy.deepcopy(array.markers[0]) for _ in range(2))
    first.action, last.action = 3, 2
    array.markers = [first, *array.markers, last]


CHANGES: Mapping[str, Change] = {
    "nan.GridCells": _set("cell_width", NAN),
    "nan.MapOrigin": _nan_in_pose,
    "nan.MapResolution": _set("info.resolution", NAN),
    "nan.Odometry": _nan_in_pose,
    "nan.Path": _nan_in_pose,
    "nan.PointCloud2": _first_x,
    "nan.PointStamped": _set("point.x", NAN),
    "nan.Polygon": lambda polygon: _set("x", NAN)(polygon.polygon.points[0]),
    "nan.Pose": _nan_in_pose,
    "nan.PoseArray": _nan_in_pose,
    "nan.Wrench": _set("wrench.force.x", NAN),
    "zero.GridCells": _set("cell_width", 0.0),
    "zeroquat": _turned(0.0, 0.0),
    "unnormquat": _turned(1.0, 0.5),
    "zerosize.Map": _no_cells(0, 0),
    "zerosizedata.Map": _no_cells(0, 4),
    "mismatch.Map": _no_cells(3, 8),
    "emptydata.Map": _no_cells(3, 0),
    "shortdata.PointCloud2": _shorter,
    "doublex.PointCloud2": _double_x,
    "nofieldz.PointCloud2": _no_z,
    "empty.PointCloud2": _empty_cloud,
    "empty.MarkerArray": lambda array: array.markers.clear(),
    "longscan.LaserScan": _set("time_increment", 0.2),
    "nanpose.Marker": _nan_in_pose,
    "nanscale.Marker": _set("scale.x", NAN),
    "nancolor.Marker": _set("color.r", NAN),
    "nanpoint.Marker": _all(_points(POINTS, 2), _nan_point),
    "badaction.Marker": _set("action", 7),
    "action1.Marker": _set("action", 1),
    "badtype.Marker": _set("type", 99),
    "oddlines.Marker": _points(LINE_LIST, 3),
    "strip1.Marker": _points(LINE_STRIP, 1),
    "strip0.Marker": _points(LINE_STRIP, 0),
    "tri2.Marker": _points(TRIANGLES, 2),
    "tri0.Marker": _points(TRIANGLES, 0),
    "arrow1.Marker": _points(ARROW, 1),
    "arrow3.Marker": _points(ARROW, 3),
    "scale0.Marker": _set("scale.x", 0.0),
    "alpha0.Marker": _set("color.a", 0.0),
    "meshmissing.Marker": _all(
        _set("type", MESH),
        _set("mesh_resource", "package://golden_meshes/meshes/nope.stl"),
    ),
    "meshnopkg.Marker": _all(
        _set("type", MESH), _set("mesh_resource", "package://no_such_package/a.stl")
    ),
    "meshempty.Marker": _set("type", MESH),
    "textempty.Marker": _set("type", TEXT),
    "textscale0.Marker": _all(
        _set("type", TEXT), _set("text", "a"), _set("scale.z", 0.0)
    ),
    "colorsmismatch.Marker": _all(_points(POINTS, 2), _one_color),
    "pointswidth0.Marker": _points(POINTS, 2, 0.0),
    "points0.Marker": _points(POINTS, 0),
    "cubewithpoints.Marker": _points(CUBE, 1),
    "cubewithtext.Marker": _set("text", "a"),
    "linewidth0.Marker": _points(LINE_LIST, 2, 0.0),
    "lifetime1s.Marker": _set("lifetime.sec", 1),
    "delete.Marker": _set("action", 2),
    "deleteall.Marker": _set("action", 3),
    "dup.MarkerArray": _twice,
    "deleteall_first.MarkerArray": _deleted_first,
}
"""Situation, or what is done to any display → what is changed in a good message."""
