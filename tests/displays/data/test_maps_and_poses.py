"""Map, Path and the displays of poses: what they take, refuse and keep."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from inside import session_of
from lower_limit import lower
from panel_rows import panel_of

from sambot_viz.panels.displays.displays_panel import DisplaysPanel
from sambot_viz.rviz import UnknownPropertyError

Make = Callable[[Any], tuple[str, str, object]]
Open = Callable[..., Any]


def header(types: Any, frame: str = "map") -> object:
    stamp = types["builtin_interfaces/msg/Time"](0, 0)
    return types["std_msgs/msg/Header"](stamp, frame)


def pose(types: Any, x: float = 0.0, w: float = 1.0) -> Any:
    point = types["geometry_msgs/msg/Point"](x, 0.0, 0.0)
    turn = types["geometry_msgs/msg/Quaternion"](0.0, 0.0, 0.0, w)
    return types["geometry_msgs/msg/Pose"](point, turn)


def grid(
    width: int,
    height: int,
    data: list[int],
    resolution: float = 0.5,
    frame: str = "map",
) -> Make:
    def make(types: Any) -> tuple[str, str, object]:
        name = "nav_msgs/msg/OccupancyGrid"
        zero = types["builtin_interfaces/msg/Time"](0, 0)
        info = types["nav_msgs/msg/MapMetaData"](
            zero, resolution, width, height, pose(types)
        )
        cells = np.array(data, np.int8)
        return "/a", name, types[name](header(types, frame), info, cells)

    return make


def test_a_map_says_what_rviz_says(messages: Open) -> None:
    shown = messages("Map", grid(2, 2, [0, 50, 100, -1]))
    assert shown.statuses == {
        "Topic": ("Ok", "1 messages received at 0.0 hz."),
        "Update Topic": ("Ok", "OK"),
        "Message": ("Ok", "Map received"),
        "Map": ("Ok", "Map OK"),
        "Transform": ("Ok", "Transform OK"),
    }


INFO = ("Resolution", "Width", "Height", "Position", "Orientation")
NOTHING = ["0", "0", "0", "0; 0; 0", "0; 0; 0; 1"]


def test_rows_say_what_a_map_is_like_and_are_not_saved(messages: Open) -> None:
    shown = messages("Map", grid(2, 2, [0, 50, 100, -1]), grid(3, 1, [0, 0, 0], 0.25))
    session = session_of(shown.viz)
    panel = panel_of(DisplaysPanel, session)

    def rows() -> list[Any]:
        found = [row for row in panel.rows() if row.name in INFO]
        assert [row.name for row in found] == list(INFO)
        assert not any(row.set for row in found)
        return [row.value for row in found]

    assert rows() == ["0.25", "3", "1", "0; 0; 0", "0; 0; 0; 1"]
    shown.viz.player.jump(0.05)
    assert rows() == ["0.5", "2", "2", "0; 0; 0", "0; 0; 0; 1"]
    with pytest.raises(UnknownPropertyError):
        shown.display.config.set("Width", 3)
    shown.set("Topic", "/b")
    assert rows() == NOTHING
    saved = session.document.config.to_yaml()
    assert not any(f"{name}:" in saved for name in INFO)


def test_a_file_without_the_topic_of_updates_has_rvizs_own(messages: Open) -> None:
    shown = messages("Map", grid(2, 2, [0, 0, 0, 0]))
    assert shown.display.config.get("Update Topic") == "/a_updates"
    assert "Update Topic" not in session_of(shown.viz).document.config.to_yaml()


def test_the_topic_of_updates_follows_that_of_the_map(messages: Open) -> None:
    shown = messages("Map", grid(2, 2, [0, 0, 0, 0]))
    get, history = shown.display.config.get, session_of(shown.viz).history
    shown.set("Update Topic", "/mine")
    with history.acting(1):
        shown.set("Topic", "/b")
    assert (get("Topic"), get("Update Topic")) == ("/b", "/b_updates")
    assert shown.display.update_topic == "/b_updates"
    history.undo(1)
    assert (get("Topic"), get("Update Topic")) == ("/a", "/mine")
    shown.set("Topic", "")
    assert get("Update Topic") == ""
    assert "Empty topic name" in shown.statuses["Topic"][1]


@pytest.mark.parametrize(
    ("made", "key", "text"),
    [
        (grid(0, 5, [1]), "Map", "Map is zero-sized (0x5)"),
        (grid(2, 2, [1, 2, 3]), "Map", "width = 2, height = 2, data size = 3"),
        (grid(1, 1, [1], float("nan")), "Map", "invalid floating point values"),
        (grid(1, 1, [1], 0.0), "Map", "0 m wide"),
    ],
)
def test_a_map_that_cannot_be_is_refused(
    messages: Open, made: Make, key: str, text: str
) -> None:
    shown = messages("Map", made)
    assert shown.statuses[key][0] == "Error"
    assert text in shown.statuses[key][1]
    assert shown.node_names() == []


def test_a_map_in_a_frame_that_nobody_publishes_says_so(messages: Open) -> None:
    shown = messages("Map", grid(1, 1, [1], frame="nowhere"))
    level, text = shown.statuses["Transform"]
    assert level == "Error"
    assert text.startswith("For frame [nowhere]: Fixed Frame [map] does not exist. ")
    assert shown.node_names() == []


def test_an_empty_frame_of_a_map_is_map(messages: Open) -> None:
    shown = messages("Map", grid(1, 1, [1], frame=""))
    assert shown.statuses["Transform"] == ("Ok", "Transform OK")


def path_of(*xs: float) -> Make:
    def make(types: Any) -> tuple[str, str, object]:
        name = "nav_msgs/msg/Path"
        stamped = types["geometry_msgs/msg/PoseStamped"]
        poses = [stamped(header(types, ""), pose(types, x)) for x in xs]
        return "/a", name, types[name](header(types), poses)

    return make


def test_a_path_is_one_node_however_often_it_changes(messages: Open) -> None:
    shown = messages("Path", path_of(0, 1), path_of(0, 1, 2))
    assert len(shown.node_names()) == 1
    shown.set("Line Style", "Billboards")
    assert len(shown.node_names()) == 1
    shown.set("Pose Style", "Axes")
    assert len(shown.node_names()) == 2


def test_paths_stay_up_to_the_buffer_length(messages: Open) -> None:
    paths = [path_of(0, n + 1) for n in range(5)]
    shown = messages("Path", *paths, **{"Buffer Length": 3})
    assert len(shown.node_names()) == 3
    shown.set("Buffer Length", 1)
    assert len(shown.node_names()) == 1


def test_only_a_path_that_has_changed_is_drawn(
    messages: Open, monkeypatch: pytest.MonkeyPatch
) -> None:
    from sambot_viz.displays.scene.lines import LineNode

    shown = messages("Path", path_of(0, 1), path_of(0, 2), **{"Buffer Length": 2})
    assert len(shown.node_names()) == 2
    draw, drawn = LineNode.draw_chain, list[LineNode]()

    def count(node: LineNode, *args: Any, **options: Any) -> None:
        drawn.append(node)
        draw(node, *args, **options)

    monkeypatch.setattr(LineNode, "draw_chain", count)
    shown.set("Buffer Length", 3)
    assert drawn == []
    shown.set("Alpha", 0.5)
    assert len(drawn) == len(set(drawn)) == 2


def test_an_empty_path_and_one_without_numbers_show_nothing(messages: Open) -> None:
    assert messages("Path", path_of()).node_names() == []
    shown = messages("Path", path_of(0, float("nan")))
    assert shown.node_names() == []
    text = "Message contained invalid floating point values (nans or infs)"
    assert shown.statuses["Topic"] == ("Error", text)


def odometry(x: float, w: float = 1.0) -> Make:
    def make(types: Any) -> tuple[str, str, object]:
        name = "nav_msgs/msg/Odometry"
        vector = types["geometry_msgs/msg/Vector3"](0.0, 0.0, 0.0)
        twist = types["geometry_msgs/msg/Twist"](vector, vector)
        zeros = np.zeros(36)
        return (
            "/a",
            name,
            types[name](
                header(types),
                "base_link",
                types["geometry_msgs/msg/PoseWithCovariance"](pose(types, x, w), zeros),
                types["geometry_msgs/msg/TwistWithCovariance"](twist, zeros),
            ),
        )

    return make


def kept(shown: Any) -> int:
    return len(shown.display.kept)


def test_odometry_keeps_poses_that_are_apart(messages: Open) -> None:
    xs = (0.0, 0.05, 0.2, 0.25, 0.4)
    shown = messages("Odometry", *map(odometry, xs))
    assert kept(shown) == 3
    shown.set("Keep", 2)
    assert kept(shown) == 2


def test_of_all_poses_the_newest_are_drawn(
    messages: Open, monkeypatch: pytest.MonkeyPatch
) -> None:
    lower(monkeypatch, "ODOMETRY_POSES", 3)
    shown = messages("Odometry", *(odometry(float(x)) for x in range(5)), Keep=0)
    assert kept(shown) == 3
    (keep,) = (one for one in shown.display.properties if one.name == "Keep")
    assert "up to 10,000" in keep.help


def test_a_quaternion_of_another_length_is_refused(messages: Open) -> None:
    shown = messages("Odometry", odometry(0.0, 33.0))
    assert "unnormalized quaternion" in shown.statuses["Topic"][1]
    assert kept(shown) == 0


def range_of(distance: float, least: float = 0.1, most: float = 6.0) -> Make:
    def make(types: Any) -> tuple[str, str, object]:
        name = "sensor_msgs/msg/Range"
        made = types[name](header(types), 0, 1.0, least, most, distance, 0.0)
        return "/a", name, made

    return make


@pytest.mark.parametrize(
    ("made", "count"),
    [
        (range_of(5.0), 1),
        (range_of(7.0), 0),
        (range_of(float("inf")), 0),
        (range_of(float("-inf"), 2.0, 2.0), 1),
        (range_of(float("inf"), 2.0, 2.0), 0),
    ],
)
def test_a_range_is_a_cone_when_it_is_in_range(
    messages: Open, made: Make, count: int
) -> None:
    assert len(messages("Range", made).node_names()) == count
