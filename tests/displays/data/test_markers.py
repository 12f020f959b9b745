"""Markers are added, replaced, deleted and refused as in RViz."""

from __future__ import annotations

import io
from collections.abc import Callable
from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from inside import session_of
from lower_limit import lower
from PIL import Image

from sambot_viz import limits
from sambot_viz.displays.data.markers.marker_textures import has_texture
from sambot_viz.displays.scene.batch_node import BatchNode
from sambot_viz.displays.scene.glb_node import ONE_PIXEL

Make = Callable[[Any], tuple[str, str, object]]
Open = Callable[..., Any]
CUBE, LINE_LIST, TRIANGLES = 1, 5, 11
ADD, DELETE, DELETE_ALL = 0, 2, 3


def built(
    types: Any,
    number: int,
    ns: str = "a",
    *,
    kind: int = CUBE,
    action: int = ADD,
    frame: str = "map",
    scale: float = 1.0,
    x: float = 0.0,
    lifetime: int = 0,
    points: int = 0,
    colors: int = 0,
    image: bytes = b"",
    turn: float = 1.0,
    locked: bool = False,
) -> object:
    time, point = types["builtin_interfaces/msg/Time"], types["geometry_msgs/msg/Point"]
    wxyz = types["geometry_msgs/msg/Quaternion"](0.0, 0.0, 0.0, turn)
    picture = types["sensor_msgs/msg/CompressedImage"]
    header = types["std_msgs/msg/Header"]
    return types["visualization_msgs/msg/Marker"](
        header(time(0, 0), frame),
        ns,
        number,
        kind,
        action,
        types["geometry_msgs/msg/Pose"](point(x, 0.0, 0.0), wxyz),
        types["geometry_msgs/msg/Vector3"](scale, scale, scale),
        types["std_msgs/msg/ColorRGBA"](1.0, 0.0, 0.0, 1.0),
        types["builtin_interfaces/msg/Duration"](lifetime, 0),
        locked,
        [point(float(n % 3), float(n % 2), 0.0) for n in range(points)],
        [types["std_msgs/msg/ColorRGBA"](1.0, 1.0, 0.0, 1.0)] * colors,
        "embedded://picture" if image else "",
        picture(header(time(0, 0), ""), "png", np.frombuffer(image, np.uint8)),
        [types["visualization_msgs/msg/UVCoordinate"](0.5, 0.5)] * bool(image) * points,
        "",
        "",
        types["visualization_msgs/msg/MeshFile"]("", np.zeros(0, np.uint8)),
        False,
    )


def marker(number: int, ns: str = "a", **values: Any) -> Make:
    def make(types: Any) -> tuple[str, str, object]:
        return "/a", "visualization_msgs/msg/Marker", built(types, number, ns, **values)

    return make


def array(*numbers: int) -> Make:
    def make(types: Any) -> tuple[str, str, object]:
        name = "visualization_msgs/msg/MarkerArray"
        return "/a", name, types[name]([built(types, number) for number in numbers])

    return make


def arrays(*values: dict[str, Any]) -> Make:
    """An array of markers that have a number by their place."""

    def make(types: Any) -> tuple[str, str, object]:
        name = "visualization_msgs/msg/MarkerArray"
        rows = [built(types, number, **one) for number, one in enumerate(values)]
        return "/a", name, types[name](rows)

    return make


def solids(shown: Any) -> list[tuple[Any, ...]]:
    """The copies of unit shapes in the scene, of which the display's key is no part."""
    fields = "positions", "wxyzs", "scales", "colors"
    nodes = shown._nodes.items()  # pyright: ignore[reportPrivateUsage]
    return [
        (
            name.partition(shown.display.key)[2],
            *(getattr(node, f"batched_{field}").tolist() for field in fields),
        )
        for name, node in sorted(nodes)
    ]


def names(shown: Any) -> set[tuple[str, int]]:
    """The markers that are drawn."""
    return set(shown.display._markers.shown)  # pyright: ignore[reportPrivateUsage]


def test_a_marker_is_known_by_its_namespace_and_its_number(messages: Open) -> None:
    shown = messages("Marker", marker(0), marker(0), marker(1), marker(0, "b"))
    assert names(shown) == {("a", 0), ("a", 1), ("b", 0)}
    # All boxes are one node.
    assert len(shown.node_names()) == 1


def test_deleted_markers_are_gone(messages: Open) -> None:
    shown = messages("Marker", marker(0), marker(1), marker(0, action=DELETE))
    assert names(shown) == {("a", 1)}


@pytest.mark.parametrize(("ns", "left"), [("a", {("b", 0)}), ("", set())])
def test_all_markers_of_a_namespace_or_of_all_are_deleted(
    messages: Open, ns: str, left: set[tuple[str, int]]
) -> None:
    of_all = marker(7, ns, action=DELETE_ALL)
    shown = messages("Marker", marker(0), marker(0, "b"), of_all)
    assert names(shown) == left


def test_a_marker_vanishes_after_its_lifetime(messages: Open) -> None:
    made = [marker(0, lifetime=1), *(marker(1) for _ in range(20))]
    shown = messages("Marker", *made)
    assert names(shown) == {("a", 1)}
    shown.viz.player.jump(0.5)
    assert names(shown) == {("a", 0), ("a", 1)}


def test_a_namespace_that_is_off_shows_nothing(messages: Open) -> None:
    off = {"Namespaces": {"a": False}}
    shown = messages("Marker", marker(0), marker(0, "b"), **off)
    assert names(shown) == {("b", 0)}
    (entries,) = shown.display.entries()
    assert sorted(entries.names) == ["a", "b"]


def test_a_namespace_is_shown_as_soon_as_its_box_is_ticked(messages: Open) -> None:
    gone = marker(1, action=DELETE)
    made = [marker(0), marker(1), marker(2, kind=99), marker(0, "b"), gone]
    shown = messages("Marker", *made, **{"Namespaces": {"a": False}})
    edits = session_of(shown.viz).display_edits
    assert "a/2" not in shown.display.status.rows
    edits.set_entry(shown.display, "Namespaces", "a", "Value", True)
    assert names(shown) == {("a", 0), ("b", 0)}
    assert "a/2" in shown.display.status.rows
    edits.set_entry(shown.display, "Namespaces", "a", "Value", False)
    assert names(shown) == {("b", 0)}
    assert "a/2" not in shown.display.status.rows
    edits.set_entry(shown.display, "Namespaces", "a", "Value", True)
    assert names(shown) == {("a", 0), ("b", 0)}
    all_gone = messages("Marker", *made, marker(0, action=DELETE_ALL))
    edits = session_of(all_gone.viz).display_edits
    for is_on in (False, True):
        edits.set_entry(all_gone.display, "Namespaces", "a", "Value", is_on)
        assert ("a", 0) not in names(all_gone)


def test_a_marker_grows_old_while_its_namespace_is_off(messages: Open) -> None:
    made = [marker(0, lifetime=1), *(marker(1) for _ in range(20))]
    shown = messages("Marker", *made)
    shown.viz.player.jump(0.5)
    edits = session_of(shown.viz).display_edits
    edits.set_entry(shown.display, "Namespaces", "a", "Value", False)
    assert names(shown) == set()
    shown.viz.player.jump(shown.viz.player.duration)
    edits.set_entry(shown.display, "Namespaces", "a", "Value", True)
    assert names(shown) == {("a", 1)}


@pytest.mark.parametrize(
    ("made", "text"),
    [
        (marker(0, x=float("nan")), "invalid floating point values"),
        (marker(0, kind=LINE_LIST, points=3), "multiple of 2"),
        (marker(0, kind=TRIANGLES, points=4), "multiple of 3"),
        (marker(0, kind=TRIANGLES, points=6, colors=4), "doesn't match"),
        (marker(0, kind=TRIANGLES, points=3, image=b"none"), "not an image"),
        (marker(0, scale=0.0), "0.0 in x, y or z"),
        (marker(0, frame="nowhere"), "nowhere"),
        (marker(0, kind=99), "99"),
    ],
)
def test_what_cannot_be_drawn_is_said(messages: Open, made: Make, text: str) -> None:
    shown = messages("MarkerArray", _in_array(made))
    said = " ".join(text for _, text in shown.statuses.values())
    assert text in said
    assert {level for level, _ in shown.statuses.values()} - {"Ok"}


@pytest.mark.parametrize("colors", [0, 3])
def test_triangles_have_the_picture_that_they_bring(
    messages: Open, colors: int
) -> None:
    shown = messages(
        "Marker", marker(0, kind=TRIANGLES, points=3, colors=colors, image=ONE_PIXEL)
    )
    (name,) = shown.node_names()
    node = shown.viz.viser.scene._handle_from_node_name[name]  # pyright: ignore[reportPrivateUsage]
    assert ONE_PIXEL in node.glb_data
    assert {level for level, _ in shown.statuses.values()} == {"Ok"}


def test_where_the_picture_of_triangles_is_clear_it_is_blended(
    messages: Open,
) -> None:
    for mode, blended in (("RGB", False), ("RGBA", True)):
        file = io.BytesIO()
        Image.new(mode, (2, 2)).save(file, "PNG")
        shown = messages(
            "Marker", marker(0, kind=TRIANGLES, points=3, image=file.getvalue())
        )
        (name,) = shown.node_names()
        node = shown.viz.viser.scene._handle_from_node_name[name]  # pyright: ignore[reportPrivateUsage]
        assert (b'"BLEND"' in node.glb_data) is blended


def test_triangles_with_too_few_colours_are_lit_in_one(messages: Open) -> None:
    shown = messages("Marker", marker(0, kind=TRIANGLES, points=6, colors=4))
    (name,) = shown.node_names()
    node = shown.viz.viser.scene._handle_from_node_name[name]  # pyright: ignore[reportPrivateUsage]
    assert node.color == (255, 0, 0)


def _in_array(made: Make) -> Make:
    def make(types: Any) -> tuple[str, str, object]:
        name = "visualization_msgs/msg/MarkerArray"
        return "/a", name, types[name]([made(types)[2]])

    return make


def test_two_markers_of_one_array_with_the_same_number_are_doubtful(
    messages: Open,
) -> None:
    shown = messages("MarkerArray", array(0, 1, 0))
    assert "(a, 0)" in shown.statuses["Duplicate Marker Check"][1]
    assert names(shown) == {("a", 0), ("a", 1)}


def test_a_thousand_markers_are_few_nodes(messages: Open) -> None:
    shown = messages("MarkerArray", array(*range(1000)))
    assert len(names(shown)) == 1000
    assert len(shown.node_names()) < 10


def test_markers_that_are_too_old_for_a_jump_are_said_to_be_missing(
    messages: Open,
) -> None:
    # One in a tenth of a second: the jump shows those of the last minute.
    shown = messages("Marker", marker(0), *(marker(1) for _ in range(650)))
    assert names(shown) == {("a", 1)}
    level, text = shown.statuses["Messages"]
    assert level == "Ok"
    assert "markers that were sent before are missing" in text
    shown.viz.player.jump(30.0)
    assert names(shown) == {("a", 0), ("a", 1)}
    assert "Messages" not in shown.statuses


def test_markers_that_are_too_many_bytes_for_a_jump_are_said_to_be_missing(
    messages: Open, monkeypatch: pytest.MonkeyPatch
) -> None:
    lower(monkeypatch, "MARKER_JUMP", 1000)
    shown = messages("Marker", *(marker(number) for number in range(9)))
    drawn = {number for _, number in names(shown)}
    assert drawn == set(range(9 - len(drawn), 9)) and 0 < len(drawn) < 9
    level, text = shown.statuses["Messages"]
    assert level == "Ok"
    assert "1,000 bytes: markers that were sent before are missing" in text


def test_a_lone_marker_is_shown_however_old_it_is(messages: Open) -> None:
    far = [other_topic] * 700
    shown = messages("Marker", marker(0), *far)
    assert names(shown) == {("a", 0)}
    assert "Messages" not in shown.statuses


def other_topic(types: Any) -> tuple[str, str, object]:
    name = "std_msgs/msg/String"
    return "/other", name, types[name]("")


def test_more_markers_than_can_wait_between_two_pictures_are_doubtful(
    messages: Open,
) -> None:
    shown = messages("Marker", marker(0), marker(1), frame="map")
    subscription = shown.display.subscription
    last = subscription.heard["/a"].last
    with session_of(shown.viz).lock:
        for number in range(limits.MARKER_MESSAGES.value + 1):
            subscription.take(replace(last, log_ns=last.log_ns + 1 + number))
        shown.display.messages_came()
    level, text = shown.statuses["Messages"]
    assert level == "Warn"
    assert text.startswith("More than 10,000 messages or 1,000,000 bytes")


def test_of_large_messages_between_two_pictures_the_newest_are_drawn(
    messages: Open,
) -> None:
    shown = messages("Marker", marker(0), marker(1))
    subscription = shown.display.subscription
    last = subscription.heard["/a"].last
    taken: list[bytes] = []
    with session_of(shown.viz).lock:
        for number in range(9):
            payload = bytes(last.payload) + bytes([number]) * limits.MARKER_BURST.value
            later = last.log_ns + 1 + number
            subscription.take(replace(last, log_ns=later, payload=payload))
        taken += [
            one.payload[-1:] for one in shown.display.wanted(subscription.drain())
        ]
    # As many as RViz keeps.
    assert taken == [bytes([number]) for number in range(4, 9)]


SPHERE, CYLINDER = 2, 3


@pytest.mark.parametrize(
    "last",
    [
        {"x": 2.0},
        {"x": 2.0, "frame": "odom"},
        {"kind": SPHERE},
        {"kind": 5},
        {"scale": 3.0, "kind": CYLINDER},
        {"frame": "map"},
        {"locked": True},
        {"turn": 0.0, "x": 1.0},
        {"turn": 7.0},
    ],
    ids=str,
)
def test_markers_that_come_again_are_drawn_as_those_that_come_once(
    messages: Open, last: dict[str, Any]
) -> None:
    again = [{"x": 1.0}, {**last, "ns": "a"}, {"x": 0.5}]
    come = [
        arrays({}, {}, {}),
        arrays({}, {"x": 5.0}, {"x": 0.5}),
        arrays({}, {"x": 5.0}, {"x": 0.5}),
        arrays({"x": 3.0}, {"x": 5.0, "locked": "locked" in last}, {"x": 0.5}),
    ]
    shown = messages("MarkerArray", *come, arrays(*again))
    many, said = solids(shown), shown.statuses
    once = messages("MarkerArray", arrays(*again))
    assert many == solids(once)
    topics = {key: said.pop(key, None) for key in ("Topic",)}
    assert said == {k: v for k, v in once.statuses.items() if k not in topics}


def test_what_was_wrong_with_the_pose_of_a_marker_is_forgotten(messages: Open) -> None:
    wrong = arrays({"x": 1.0, "turn": 7.0}, {})
    shown = messages("MarkerArray", arrays({}, {}), wrong)
    assert "Unnormalized" in shown.statuses["a/0"][1]
    shown = messages("MarkerArray", arrays({}, {}), wrong, arrays({"x": 2.0}, {}))
    assert "a/0" not in shown.statuses


@pytest.mark.parametrize("kind", ["Marker", "MarkerArray"])
def test_the_topic_has_another_key_in_files_of_ros_1(messages: Open, kind: str) -> None:
    values = {"Class": f"rviz/{kind}", "Topic": None, "Marker Topic": "/a"}
    made = marker(3) if kind == "Marker" else array(3)
    shown = messages(kind, made, **values)
    assert names(shown) == {("a", 3)}
    shown.set("Topic", "/b")
    text = session_of(shown.viz).document.config.to_yaml()
    assert "Marker Topic: /b" in text


def test_a_marker_of_ros_1_has_no_texture() -> None:
    assert not has_texture(SimpleNamespace(points=[1, 2, 3]))


def test_solids_that_look_the_same_are_not_drawn_again(
    messages: Open, monkeypatch: pytest.MonkeyPatch
) -> None:
    drawn: list[BatchNode] = []
    show = BatchNode.show

    def noted(node: BatchNode, *values: Any, **more: Any) -> None:
        drawn.append(node)
        show(node, *values, **more)

    shown = messages("MarkerArray", array(0, 1, 2))
    markers = shown.display._markers  # pyright: ignore[reportPrivateUsage]
    monkeypatch.setattr(BatchNode, "show", noted)
    came = [one.marker for one in markers.shown.values()]
    for one in came:
        later = replace(one.header, stamp=replace(one.header.stamp, sec=7))
        markers.apply(replace(one, header=later), 0)
    markers.draw()
    assert not drawn
    # All that change are drawn at once.
    for one in came[:2]:
        markers.apply(replace(one, scale=replace(one.scale, x=2.0)), 0)
    markers.draw()
    assert len(drawn) == 1
