"""What displays of data draw is met by rays, and can be selected as in RViz."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
import pytest
from filled_messages import Make, cloud2, on_topic, pose, xyz

from sambot_viz.displays.picking.rays import RayGrid
from sambot_viz.displays.picking.selectable import Hit
from sambot_viz.tools.picking.pick_scene import PickSnapshot

Open = Callable[..., Any]
PIXEL = 0.002
DOWN = np.array((0.0, 0.0, -1.0))
UP = np.array((0.0, 1.0, 0.0))
CELLS = [xyz(1, 1), xyz(3, 1)]
MARKER = "visualization_msgs/msg/Marker"
RED = {"r": 1.0, "a": 1.0}


def hit(shown: Any, x: float, y: float) -> Hit:
    """Return what a ray from 20 m above meets of a display."""
    snapshot = PickSnapshot((shown.display.pick_geometry(),))
    return snapshot.first_hit(np.array((x, y, 20.0)), DOWN, PIXEL, UP)


def stamped(*poses: Mapping[str, Any]) -> list[Mapping[str, Any]]:
    return [{"pose": one} for one in poses]


NAV, GEO, SENSOR = "nav_msgs/msg/", "geometry_msgs/msg/", "sensor_msgs/msg/"
DRAWN: dict[str, tuple[str, Make, tuple[float, float], tuple[float, float]]] = {
    "grid cells": (
        "GridCells",
        on_topic(NAV + "GridCells", cell_width=0.5, cell_height=0.5, cells=CELLS),
        (1.2, 1.2),
        (1.3, 1.3),
    ),
    "map": (
        "Map",
        on_topic(
            NAV + "OccupancyGrid",
            info={"resolution": 0.5, "width": 4, "height": 2, "origin": pose(1, 2)},
            data=[0] * 8,
        ),
        (2.9, 2.9),
        (0.9, 2.5),
    ),
    "path": (
        "Path",
        on_topic(NAV + "Path", poses=stamped(pose(0, 0), pose(4, 0))),
        (2.0, 0.05),
        (2.0, 0.2),
    ),
    "odometry": (
        "Odometry",
        on_topic(NAV + "Odometry", pose={"pose": pose(1, 1)}),
        (1.5, 1.0),
        (1.5, 1.5),
    ),
    "poses": (
        "PoseArray",
        on_topic(GEO + "PoseArray", poses=[pose(1, 1), pose(3, 3)]),
        (3.15, 3.0),
        (2.5, 3.0),
    ),
    "polygon": (
        "Polygon",
        on_topic(
            GEO + "PolygonStamped", polygon={"points": [xyz(0), xyz(2), xyz(0, 2)]}
        ),
        (1.0, 1.0),
        (0.5, 0.5),
    ),
    "point": (
        "PointStamped",
        on_topic(GEO + "PointStamped", point=xyz(1, 2, 3)),
        (1.05, 2.0),
        (1.3, 2.0),
    ),
    "range": (
        "Range",
        on_topic(
            SENSOR + "Range", field_of_view=0.5, min_range=0.1, max_range=9.0, range=2.0
        ),
        (1.5, 0.2),
        (1.5, 0.6),
    ),
}


@pytest.mark.parametrize("name", DRAWN)
def test_what_cannot_be_selected_can_be_measured(messages: Open, name: str) -> None:
    kind, made, met, beside = DRAWN[name]
    shown = messages(kind, made)
    found = hit(shown, *met)
    assert found.item is None
    assert found.point is not None
    assert found.point[:2] == pytest.approx(met, abs=0.06)
    assert hit(shown, *beside).point is None


@pytest.mark.parametrize("style", ["Lines", "Billboards"])
@pytest.mark.parametrize("poses", ["None", "Axes", "Arrows"])
def test_a_path_is_met_in_all_its_styles(
    messages: Open, style: str, poses: str
) -> None:
    made = on_topic(NAV + "Path", poses=stamped(pose(0, 0, 1), pose(4, 0, 1)))
    look = {"Line Style": style, "Pose Style": poses, "Offset": {"X": 0, "Y": 1}}
    shown = messages("Path", made, **look)
    shown.set("Offset", (0.0, 1.0, 0.0))
    found = hit(shown, 2.0, 1.0).point
    assert found is not None
    assert found == pytest.approx((2.0, 1.0, 1.0), abs=0.05)
    assert (hit(shown, 0.0, 1.2).point is not None) == (poses == "Axes")


@pytest.mark.parametrize(
    ("style", "edge"),
    [
        ("Points", 0.0),
        ("Squares", 0.4),
        ("Flat Squares", 0.4),
        ("Spheres", 0.4),
        ("Boxes", 0.4),
        ("Tiles", 0.4),
    ],
)
def test_a_point_of_a_cloud_is_met_in_each_style(
    messages: Open, style: str, edge: float
) -> None:
    nowhere = (np.nan, 0.0, 0.0)
    made = cloud2([(0, 0, 0), nowhere, (2, 1, 0.5)], intensity=np.float32([7, 8, 9]))
    shown = messages("PointCloud2", made, Style=style, **{"Size (m)": 0.4})
    found = hit(shown, 2.0 + 0.45 * edge, 1.0)
    # The number is that of the message.
    assert found.number == 2
    assert found.item is not None
    assert hit(shown, 2.0 + 0.6 * edge + 0.2, 1.0).item is None
    (facts,) = shown.display.selected(found.item).facts(np.array([2]))
    assert facts.title == "Point 2 [PointCloud2]"
    # Topic and stamp: test_selected_data.py.
    assert facts.facts[2:] == [
        ("Frame", "map"),
        ("Position", "2; 1; 0.5 m"),
        ("3: intensity", "9"),
    ]
    assert facts.position == pytest.approx((2, 1, 0.5))
    cubes = shown.display.selected(found.item).cubes(np.array([2]))
    assert cubes.edges == pytest.approx(0.4 if edge else 0.004)


def test_fields_have_their_number_in_the_message_and_colours_are_colours(
    messages: Open,
) -> None:
    color = np.array([0x40_FF_80_01], np.uint32)
    made = cloud2([(1, 0, 0)], rgba=color, ring=np.array([5], np.uint16))
    shown = messages("PointCloud2", made)
    found = hit(shown, 1.0, 0.0)
    (facts,) = shown.display.selected(found.item).facts(np.array([0]))
    assert facts.facts[4:] == [
        ("3: rgba", (0xFF, 0x80, 0x01)),
        ("alpha", f"{0x40 / 255:.5g}"),
        ("4: ring", "5"),
    ]


def test_points_that_are_not_selectable_can_still_be_measured(messages: Open) -> None:
    shown = messages("PointCloud2", cloud2([(1, 0, 0)]), Selectable=False)
    found = hit(shown, 1.0, 0.0)
    assert (found.item, found.point) == (None, pytest.approx((1, 0, 0)))
    shown.set("Selectable", True)
    item = hit(shown, 1.0, 0.0).item
    assert item is not None
    assert shown.display.selected(item) is not None
    shown.set("Selectable", False)
    assert shown.display.selected(item) is None


def test_a_scan_has_its_points_in_the_fixed_frame(messages: Open) -> None:
    made = on_topic(
        SENSOR + "LaserScan",
        angle_increment=np.pi / 2,
        angle_max=np.pi,
        range_min=0.1,
        range_max=9.0,
        ranges=[1.0, 20.0, 3.0],
        intensities=[10.0, 11.0, 12.5],
    )
    shown = messages("LaserScan", made)
    found = hit(shown, -3.0, 0.0)
    assert found.number == 1
    assert found.item is not None
    (facts,) = shown.display.selected(found.item).facts(np.array([1]))
    assert dict(facts.facts)["3: intensity"] == "12.5"
    assert dict(facts.facts)["Frame"] == "map"


@pytest.mark.parametrize(
    ("kind", "made", "row"),
    [
        (
            "PointCloud",
            on_topic(
                SENSOR + "PointCloud",
                points=[xyz(0, 0, 0)],
                channels=[{"name": "heat", "values": [4.5]}],
            ),
            ("3: heat", "4.5"),
        ),
        (
            "Temperature",
            on_topic(SENSOR + "Temperature", temperature=21.5),
            ("3: temperature", "21.5"),
        ),
    ],
)
def test_other_points_have_their_fields(
    messages: Open, kind: str, made: Make, row: tuple[str, str]
) -> None:
    shown = messages(kind, made)
    item = hit(shown, 0.0, 0.0).item
    assert item is not None
    (facts,) = shown.display.selected(item).facts(np.array([0]))
    assert facts.facts[-1] == row


def test_points_of_an_earlier_message_are_gone(messages: Open) -> None:
    shown = messages("PointCloud2", cloud2([(1, 0, 0)]), cloud2([(1, 0, 0)]))
    shown.viz.player.pause()
    shown.viz.player.jump(0.0)
    before = hit(shown, 1.0, 0.0).item
    shown.viz.player.jump(shown.viz.player.duration)
    after = hit(shown, 1.0, 0.0).item
    assert None not in (before, after)
    assert shown.display.selected(before) is None
    assert shown.display.selected(after) is not None


@pytest.mark.parametrize("shape", ["Arrow", "Axes"])
def test_a_pose_is_selected_with_its_covariance(messages: Open, shape: str) -> None:
    covariance = [0.0] * 36
    covariance[::7] = [0.25, 0.5, 0.75, 0.01, 0.02, 0.03]
    made = on_topic(
        GEO + "PoseWithCovarianceStamped",
        pose={"pose": pose(1, 2, 3), "covariance": covariance},
    )
    shown = messages("PoseWithCovariance", made, Shape=shape)
    item = hit(shown, 1.5, 2.0).item
    assert item is not None
    assert (item.kind, item.name) == ("pose", "PoseWithCovariance")
    (facts,) = shown.display.selected(item).facts(None)
    assert facts.title == "Pose PoseWithCovariance"
    assert facts.facts == [
        ("Frame", "map"),
        ("Position", "1; 2; 3 m"),
        ("Orientation", "0; 0; 0; 1 (xyzw)"),
        ("Covariance Position", "0.25; 0.5; 0.75 m²"),
        ("Covariance Orientation", "0.01; 0.02; 0.03 rad²"),
    ]


def marker(kind: int, number: int = 7, **fields: Any) -> Make:
    given = {
        "ns": "n",
        "id": number,
        "type": kind,
        "pose": pose(2, 1),
        "scale": xyz(1, 0.5, 0.4),
        "color": RED,
    }
    frame = fields.pop("frame", "map")
    return on_topic(MARKER, frame=frame, **given | fields)


LINE = [xyz(-1), xyz(1)]
MARKERS: dict[str, tuple[Make, tuple[float, float], tuple[float, float]]] = {
    "arrow": (marker(0), (2.5, 1.1), (3.2, 1.0)),
    "cube": (marker(1), (2.4, 1.2), (2.4, 1.4)),
    "sphere": (marker(2), (2.4, 1.0), (2.4, 1.2)),
    "cylinder": (marker(3), (2.4, 1.0), (2.4, 1.2)),
    "line strip": (marker(4, points=LINE), (2.8, 1.4), (2.8, 1.7)),
    "line list": (marker(5, points=LINE), (2.8, 1.4), (2.8, 1.7)),
    "cubes": (marker(6, points=LINE), (3.4, 1.2), (2.0, 1.0)),
    "spheres": (marker(7, points=LINE), (3.4, 1.0), (2.0, 1.0)),
    "points": (marker(8, points=LINE), (3.4, 1.2), (2.0, 1.0)),
    "text": (marker(9, text="ABCDE"), (2.3, 1.1), (2.0, 1.3)),
    "triangles": (
        marker(11, points=[xyz(0), xyz(1), xyz(0, 1)], scale=xyz(1, 1, 1)),
        (2.3, 1.3),
        (2.7, 1.7),
    ),
}


@pytest.mark.parametrize("name", MARKERS)
def test_a_marker_of_each_type_is_selected(messages: Open, name: str) -> None:
    made, met, beside = MARKERS[name]
    shown = messages("Marker", made)
    item = hit(shown, *met).item
    assert item is not None
    assert (item.kind, item.name) == ("marker", "n/7")
    assert hit(shown, *beside).item is None
    (facts,) = shown.display.selected(item).facts(None)
    assert facts.title == "Marker n/7"
    assert dict(facts.facts)["Position"] == "2; 1; 0 m"
    parts = [part for _, part in shown.display.parts(lambda one: one == item)]
    low = np.min([part.box()[0] for part in parts], axis=0)
    high = np.max([part.box()[1] for part in parts], axis=0)
    assert (low[:2] <= np.array(met) + 0.01).all()
    assert (high[:2] >= np.array(met) - 0.01).all()


def test_each_marker_of_a_batch_is_one_item_and_goes_when_it_is_deleted(
    messages: Open,
) -> None:
    one, other = marker(1, 1), marker(1, 2, pose=pose(5, 5))
    gone = marker(1, 1, action=2)
    shown = messages("Marker", one, other, gone)
    shown.viz.player.pause()
    shown.viz.player.jump(0.1)
    first, second = hit(shown, 2, 1).item, hit(shown, 5, 5).item
    assert first is not None
    assert second is not None
    assert (first.name, second.name) == ("n/1", "n/2")
    shown.viz.player.jump(shown.viz.player.duration)
    assert hit(shown, 2, 1).item is None
    assert shown.display.selected(first) is None
    assert shown.display.selected(second) is not None


def test_a_marker_that_follows_its_frame_is_met_where_that_is(
    messages: Open,
) -> None:
    moved = {
        "header": {"frame_id": "map"},
        "child_frame_id": "cart",
        "transform": {"translation": xyz(3), "rotation": {"w": 1.0}},
    }
    frames = on_topic("tf2_msgs/msg/TFMessage", "/tf", transforms=[moved])
    shown = messages("Marker", frames, marker(1, frame_locked=True, frame="cart"))
    item = hit(shown, 5.4, 1.2).item
    assert item is not None
    (facts,) = shown.display.selected(item).facts(None)
    assert dict(facts.facts)["Frame"] == "cart"
    assert facts.position == pytest.approx((5, 1, 0))


def test_a_triangle_is_met_from_behind_too(messages: Open) -> None:
    made, (x, y), _ = MARKERS["triangles"]
    snapshot = PickSnapshot((messages("Marker", made).display.pick_geometry(),))
    below = snapshot.first_hit(np.array((x, y, -5.0)), -DOWN, PIXEL)
    assert below.item is not None


def test_what_is_seen_through_does_not_hide_what_can_be_selected(
    messages: Open,
) -> None:
    made = marker(1, pose=pose(0, 0, -1))
    shown = messages("Marker", made)
    cover = on_topic(
        NAV + "OccupancyGrid",
        info={"resolution": 4.0, "width": 1, "height": 1, "origin": pose(-2, -2)},
        data=[0],
    )
    behind = shown.display.pick_geometry()
    for alpha, name in ((0.5, "n/7"), (1.0, None)):
        above = messages("Map", cover, Alpha=alpha).display.pick_geometry()
        snapshot = PickSnapshot((above, behind))
        item = snapshot.first_hit(np.array((0.0, 0.0, 9.0)), DOWN, PIXEL).item
        assert (None if item is None else item.name) == name


def test_without_a_ray_nothing_is_computed_for_one(
    messages: Open, monkeypatch: pytest.MonkeyPatch
) -> None:
    shown = messages("PointCloud2", cloud2([(1, 0, 0)]), cloud2([(2, 0, 0)]))
    asked: list[str] = []
    for name in ("placed", "pick_geometry", "parts", "selected"):
        method = getattr(type(shown.display), name)

        def spy(self: Any, *values: Any, name: str = name, method: Any = method) -> Any:
            asked.append(name)
            return method(self, *values)

        monkeypatch.setattr(type(shown.display), name, spy)
    monkeypatch.setattr(RayGrid, "may_meet", lambda *_: asked.append("rays"))
    for time in (0.0, shown.viz.player.duration, 0.05):
        shown.viz.player.jump(time)
    assert asked == []
