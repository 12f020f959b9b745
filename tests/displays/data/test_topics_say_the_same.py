"""What a display refuses, the list of topics says in the same words."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from filled_messages import DEFINITIONS, MAP_UPDATE, on_topic, pose
from image_messages import Make, file_message, octets, raw

from sambot_viz.inputs import Inputs
from sambot_viz.options import Options
from sambot_viz.topics.report import TopicReport
from sambot_viz.topics.survey import Survey

Open = Callable[..., Any]


def cloud(**fields: Any) -> Make:
    return on_topic("sensor_msgs/msg/PointCloud2", **fields)


def grid(width: int, height: int, cells: int) -> Make:
    info = {"width": width, "height": height, "resolution": 0.1, "origin": pose(0)}
    return on_topic("nav_msgs/msg/OccupancyGrid", info=info, data=[0] * cells)


def marker(kind: int) -> Make:
    fields = {"pose": pose(0), "type": kind, "scale": {"x": 1.0, "y": 1.0, "z": 1.0}}
    color = {"r": 1.0, "a": 1.0}
    return on_topic("visualization_msgs/msg/Marker", color=color, text="A", **fields)


SHORT = {"width": 2, "height": 1, "point_step": 12, "data": [0] * 25}
OLD = {"points": [{"x": 1.0}], "channels": [{"name": "a", "values": [1.0, 2.0]}]}


@pytest.mark.parametrize(
    ("kind", "make", "status"),
    [
        ("Image", raw("8UC7", octets(1)), "Image"),
        ("Image", raw("rgba16", octets(1)), "Image"),
        ("Image", raw("rgb8", octets(1, 2)), "Image"),
        ("Image", raw("rgb8", octets(1), 2**20, 2**20), "Image"),
        ("Image", file_message(b"\0\0\0\1", "h264"), "Image"),
        ("PointCloud2", cloud(), "Message"),
        ("PointCloud2", cloud(**SHORT), "Message"),
        ("PointCloud", on_topic("sensor_msgs/msg/PointCloud", **OLD), "Message"),
        ("Map", grid(0, 0, 0), "Message"),
        ("Map", grid(0, 5, 4), "Map"),
        ("Map", grid(2, 2, 3), "Map"),
        ("GridCells", on_topic("nav_msgs/msg/GridCells"), "Topic"),
    ],
)
def test_a_topic_says_what_its_display_says(
    messages: Open, tmp_path: Path, kind: str, make: Make, status: str
) -> None:
    shown = messages(kind, make)
    said = reason(tmp_path)
    assert said.startswith("not-drawn: ")
    text = said.removeprefix("not-drawn: ")
    assert text in shown.statuses[status][1]


@pytest.mark.parametrize("kind", [0, 1, 2, 3, 9])
def test_a_marker_that_is_drawn_is_not_said_to_be_empty(
    messages: Open, tmp_path: Path, kind: int
) -> None:
    shown = messages("Marker", marker(kind))
    assert shown.node_names()
    assert reason(tmp_path) == ""


def test_updates_that_a_map_draws_are_not_said_to_be_drawn_by_nothing(
    messages: Open, tmp_path: Path
) -> None:
    update = on_topic(MAP_UPDATE, "/a_updates", width=1, height=1, data=[100])
    shown = messages("Map", grid(2, 2, 4), update, definitions=DEFINITIONS)
    assert shown.statuses["Update"] == ("Ok", "Update OK")
    assert reason(tmp_path, "/a_updates") == ""


def test_what_has_nothing_in_it_is_said_by_its_display(
    messages: Open, tmp_path: Path
) -> None:
    kind = "visualization_msgs/msg/MarkerArray"
    level, text = messages("MarkerArray", on_topic(kind)).statuses["Topic"]
    assert level == "Warn"
    said = "0 markers: look at what publishes it"
    assert text.endswith(said)
    assert reason(tmp_path) == f"empty: {said}"


def reason(folder: Path, topic: str = "/a") -> str:
    with Inputs(Options(folder / "messages.mcap")) as inputs:
        assert inputs.moved_by is not None
        survey = Survey(inputs.moved_by)
        survey.finish()
        found = TopicReport(survey).account(topic).reason
    return "" if found is None else f"{found.code}: {found.text}"
