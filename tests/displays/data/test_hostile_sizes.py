"""Messages that ask for too much, or for what they may not have, get one sentence."""

from __future__ import annotations

from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from lower_limit import lower
from patience import until
from situations import TYPES, good_message

from sambot_viz import limits
from sambot_viz.displays.data.refused_messages import MessageRefused

Make = Callable[[Any], tuple[str, str, object]]
Open = Callable[..., Any]
Change = Callable[[Any], None]
POINTS, MESH, TEXT = 8, 10, 9
INT32 = 2**31 - 1


def changed(display: str, change: Change) -> Make:
    """A good message for a display, changed."""

    def make(types: Any) -> tuple[str, str, object]:
        message = good_message(store(), display)
        inside = message.markers if hasattr(message, "markers") else [message]
        for one in inside:
            one.header.frame_id = "map"
        change(message)
        return "/a", TYPES[display], message

    return make


def store() -> Any:
    from rosbags.typesys import Stores, get_typestore

    return get_typestore(Stores.ROS2_JAZZY)


def nothing(message: Any) -> None:
    del message


def count(shown: Any) -> int:
    """How many markers are shown."""
    (namespaces,) = shown.display.entries()
    return sum(int(namespaces.facts(name)["Markers"]) for name in namespaces.names)


def points(number: int) -> Change:
    def change(marker: Any) -> None:
        marker.type = POINTS
        marker.points = [marker.pose.position] * number

    return change


def test_a_marker_with_too_many_points_is_not_drawn(messages: Open) -> None:
    shown = messages("Marker", changed("Marker", points(500_001)))
    text = "500,001 points are more than the 500,000 that are drawn"
    assert shown.statuses["t/0"] == ("Error", text)
    assert shown.node_names() == []


def test_all_markers_together_have_so_many_points(
    messages: Open, monkeypatch: pytest.MonkeyPatch
) -> None:
    lower(monkeypatch, "MARKERS_POINTS", 5)

    def three_points(number: int) -> Make:
        def change(marker: Any) -> None:
            points(3)(marker)
            marker.id = number

        return changed("Marker", change)

    shown = messages("Marker", *map(three_points, (0, 0, 1, 0)))
    assert count(shown) == 1
    text = "More than the 5 points of markers that are drawn"
    assert shown.statuses["Markers"] == ("Error", text)


def test_markers_and_namespaces_are_as_many_as_can_be_drawn(messages: Open) -> None:
    def many(array: Any) -> None:
        (first,) = array.markers
        made = type(first)
        values = {k: v for k, v in vars(first).items() if not k.startswith("__")}
        array.markers = [
            made(**{**values, "ns": f"n{number}", "type": number % 100})
            for number in range(limits.MARKERS.value + 5000)
        ]

    shown = messages("MarkerArray", changed("MarkerArray", many))
    assert len(shown.display._markers.shown) <= limits.MARKERS.value  # pyright: ignore[reportPrivateUsage]
    (namespaces,) = shown.display.entries()
    assert len(namespaces.names) == limits.NAMESPACES.value
    assert len(shown.statuses) <= limits.MARKER_ROWS.value + 5
    assert shown.statuses["Markers"][0] in ("Warn", "Error")


@pytest.mark.parametrize("field", ["ns", "text", "header.frame_id", "mesh_resource"])
def test_a_long_text_is_cut(messages: Open, field: str) -> None:
    def change(marker: Any) -> None:
        *way, name = field.split(".")
        for step in way:
            marker = getattr(marker, step)
        setattr(marker, name, "a" * 1_000_000)

    def is_text(marker: Any) -> None:
        marker.type = MESH if field == "mesh_resource" else TEXT
        marker.text = "b"
        change(marker)

    shown = messages("Marker", changed("Marker", is_text), changed("Marker", nothing))
    assert count(shown) >= 1
    assert all(len(key) <= limits.KEY.value for key in shown.statuses)
    assert all(
        len(text) <= limits.STATUS_TEXT.value for _, text in shown.statuses.values()
    )


@pytest.mark.parametrize(
    ("resource", "reason"),
    [
        ("file:///etc/passwd", "only name files of packages; write package://"),
        ("file:///etc/no_such_file", "only name files of packages; write package://"),
        ("/etc/passwd", "only name files of packages; write package://PACKAGE/…"),
        ("../../../../etc/passwd", "only name files of packages"),
        ("package://../../etc/passwd", "the package .. is not known"),
        ("package://golden_meshes/../../../etc/passwd", "golden_meshes is not known"),
        ("http://127.0.0.1:9/a.dae", "not fetched); download it and name it by"),
        ("\0", ""),
        ("file:///proc/self/mem", "only name files of packages"),
    ],
)
@pytest.mark.parametrize("trusted", [True, False])
def test_a_mesh_that_a_message_may_not_name_is_not_read(
    messages: Open, resource: str, reason: str, trusted: bool
) -> None:
    def change(marker: Any) -> None:
        marker.type, marker.mesh_resource = MESH, resource

    shown = messages("Marker", changed("Marker", change), trusted=trusted)
    until(lambda: "t/0" in shown.statuses)
    said = f"Mesh resource marker [t/0] could not load [{resource}]"
    level, text = shown.statuses["t/0"]
    assert level == "Error"
    assert text.startswith(said)
    assert reason in text
    assert bool(reason) == (len(text) > len(said))


def large_map(grid: Any) -> None:
    grid.info.width = grid.info.height = 10**6


def large_cloud(cloud: Any) -> None:
    cloud.width, cloud.height = 10**9, 4


def no_step(cloud: Any) -> None:
    large_cloud(cloud)
    cloud.point_step, cloud.data = 0, cloud.data[:0]


def large_image(image: Any) -> None:
    image.width = image.height = 100_000


@pytest.mark.parametrize(
    ("display", "change", "key", "text"),
    [
        ("Map", large_map, "Map", "width = 1000000, height = 1000000, data size = 9"),
        ("PointCloud2", large_cloud, "Message", "times point_step (16)"),
        ("PointCloud2", no_step, "Message", "No position transformer"),
        ("DepthCloud", large_image, "Camera Info", "No CameraInfo"),
    ],
)
def test_announced_sizes_are_not_believed(
    messages: Open, display: str, change: Change, key: str, text: str
) -> None:
    topic = {"Depth Map Topic": "/a"} if display == "DepthCloud" else {}
    shown = messages(display, changed(display, change), **topic)
    assert text in shown.statuses[key][1]
    assert shown.node_names() == []


@pytest.mark.parametrize(
    ("x", "width"), [(-1, 1), (2, 2), (-(2**31), 3), (0, 2**32 - 1), (INT32, 1)]
)
def test_an_update_outside_of_the_map_changes_nothing(
    messages: Open, x: int, width: int
) -> None:
    shown = messages("Map", changed("Map", nothing))
    update = SimpleNamespace(x=x, y=0, width=width, height=1, data=np.zeros(1, np.int8))
    with pytest.raises(MessageRefused, match="outside of original map area"):
        shown.display._take_update(update)


@pytest.mark.parametrize("seconds", [-(2**31), INT32])
@pytest.mark.parametrize("display", ["Marker", "Pose", "LaserScan", "PointCloud2"])
def test_stamps_at_the_ends_of_time_wait_or_are_refused(
    messages: Open, display: str, seconds: int
) -> None:
    def change(message: Any) -> None:
        message.header.stamp.sec = seconds
        message.header.stamp.nanosec = 2**32 - 1

    made = changed(display, change), changed(display, nothing)
    shown = messages(display, *made)
    # In the fixed frame all times are one.
    assert shown.node_names() != []


def test_a_negative_lifetime_is_none(messages: Open) -> None:
    def change(marker: Any) -> None:
        marker.lifetime.sec, marker.lifetime.nanosec = -(2**31), 2**32 - 1

    shown = messages("Marker", changed("Marker", change), changed("Marker", change))
    assert count(shown) == 1


def test_an_odd_name_is_no_harm(messages: Open) -> None:
    def change(marker: Any) -> None:
        marker.ns, marker.type = "a\0\n\x1b[31m<b>\u202e", 99

    made = changed("Marker", change), changed("Marker", nothing)
    shown = messages("Marker", *made)
    assert count(shown) == 1
    assert shown.statuses["a\0\n\x1b[31m<b>\u202e/0"][0] == "Error"
