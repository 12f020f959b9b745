"""Arrays are drawn the same however they were read, and not element by element."""

from __future__ import annotations

import sys
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from blank_messages import blank_message

from sambot_viz.displays.data.markers.checks import check_of
from sambot_viz.displays.data.markers.marker_fields import rgba_of
from sambot_viz.displays.data.message_numbers import points_of, poses_of
from sambot_viz.geometry import unit_wxyz
from sambot_viz.matrices import unit_wxyzs
from sambot_viz.messages import MessageTypes, Rows, Schema
from sambot_viz.topics.decoding import numbers_of

Open = Callable[..., Any]
STRIP = 4


@pytest.fixture(scope="module")
def store() -> Any:
    from rosbags.typesys import Stores, get_typestore

    return get_typestore(Stores.ROS2_JAZZY)


def header(types: Any, frame: str = "map") -> Any:
    stamp = types["builtin_interfaces/msg/Time"](0, 0)
    return types["std_msgs/msg/Header"](stamp, frame)


def pose(types: Any, number: int) -> Any:
    return types["geometry_msgs/msg/Pose"](
        types["geometry_msgs/msg/Point"](float(number), number**0.5, 0.25),
        types["geometry_msgs/msg/Quaternion"](0.0, 0.0, float(number % 7), 1.0),
    )


def path(store: Any, count: int, *frames: str) -> Any:
    types = store.types
    stamped = types["geometry_msgs/msg/PoseStamped"]
    poses = [
        stamped(header(types, frames[n % len(frames)]), pose(types, n))
        for n in range(count)
    ]
    return types["nav_msgs/msg/Path"](header(types), poses)


def pose_array(store: Any, count: int) -> Any:
    types = store.types
    poses = [pose(types, n) for n in range(count)]
    return types["geometry_msgs/msg/PoseArray"](header(types), poses)


def strip(store: Any, count: int) -> Any:
    color = store.types["std_msgs/msg/ColorRGBA"]
    marker = blank_message(store, "visualization_msgs/msg/Marker")
    marker.type, marker.scale.x = STRIP, 0.1
    marker.points = [pose(store.types, n).position for n in range(count)]
    marker.colors = [color(n / count, 0.5, 0.0, 1.0) for n in range(count)]
    return marker


def decoded(store: Any, message: Any) -> Any:
    name = message.__msgtype__
    text = store.generate_msgdef(name, ros_version=2)[0]
    decoder = MessageTypes().decoder(Schema(name, "ros2msg", text), "cdr")
    return decoder.decode(store.serialize_cdr(message, name))


def calls_of(action: Callable[[], object]) -> int:
    """How many functions are called, those of C included."""
    count = 0

    def note(frame: object, event: str, argument: object) -> None:
        nonlocal count
        count += event in ("call", "c_call")

    sys.setprofile(note)
    try:
        action()
    finally:
        sys.setprofile(None)
    return count


@pytest.mark.parametrize("style", ["Lines", "Billboards"])
def test_a_path_is_the_same_line_when_its_poses_have_other_frames(
    messages: Open, store: Any, style: str
) -> None:
    seen: list[bytes] = []
    for frames in (("map",), ("map", "elsewhere")):
        message = path(store, 20, *frames)
        made = decoded(store, message)
        assert isinstance(made.poses, Rows) == (len(frames) == 1)
        opened = messages(
            "Path",
            lambda _, one=message: ("/a", "nav_msgs/msg/Path", one),
            **{"Line Style": style},
        )
        seen.append(opened.glb())
    assert seen[0] == seen[1]


def test_numbers_of_rows_are_those_of_objects(store: Any) -> None:
    rows = decoded(store, path(store, 20, "map")).poses
    assert isinstance(rows, Rows)
    for paths in (["pose.position.x"], ["pose.orientation.w", "header.stamp.sec"]):
        one_by_one = numbers_of(list(rows), *paths)
        assert numbers_of(rows, *paths).tolist() == one_by_one.tolist()
        assert one_by_one.shape == (20, len(paths))
    assert numbers_of([], "x", "y", "z").shape == (0, 3)


@pytest.mark.parametrize(
    ("make", "read"),
    [
        (lambda t, n: path(t, n, "map"), lambda m: poses_of(m.poses, "pose.")),
        (pose_array, lambda m: poses_of(m.poses)),
        (strip, lambda m: points_of(m.points)),
        (strip, lambda m: rgba_of(m.colors)),
        (strip, check_of),
    ],
)
def test_ten_times_the_elements_take_no_more_calls(
    store: Any, make: Callable[[Any, int], Any], read: Callable[[Any], object]
) -> None:
    few, many = (decoded(store, make(store, count)) for count in (30, 300))
    read(few)
    assert calls_of(lambda: read(few)) == calls_of(lambda: read(many))


def test_many_quaternions_get_the_length_that_each_gets() -> None:
    given = np.random.default_rng(1).normal(size=(50, 4))
    given[3], given[4], given[5] = 0.0, 1e-320, 1e200
    found = unit_wxyzs(given)
    np.testing.assert_allclose(found, [unit_wxyz(row) for row in given.tolist()])
