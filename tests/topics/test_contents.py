"""Why nothing of a message can be drawn: the cause, and a remedy."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from sambot_viz.topics.contents import content_reason
from sambot_viz.topics.contents.pictures import PIXEL_BYTES


def message(kind: str, **fields: Any) -> SimpleNamespace:
    return SimpleNamespace(__msgtype__=kind, **fields)


def said(made: SimpleNamespace) -> tuple[str, str]:
    reason = content_reason(made)
    return ("", "") if reason is None else (reason.code, reason.text)


# Nothing in it


def scan(*ranges: float) -> SimpleNamespace:
    kind = "sensor_msgs/msg/LaserScan"
    return message(kind, ranges=np.array(ranges), range_min=0.1, range_max=30.0)


def marker(kind: int, action: int = 0, points: int = 0) -> SimpleNamespace:
    name = "visualization_msgs/msg/Marker"
    return message(name, type=kind, action=action, points=[0] * points)


NOTHING = [
    (scan(), "0 ranges"),
    (scan(np.nan, 40.0), "all 2 ranges are out of range"),
    (scan(1.0, np.nan), ""),
    (message("geometry_msgs/msg/PoseArray", poses=[]), "0 poses"),
    (message("nav_msgs/msg/Path", poses=[]), "0 poses"),
    (message("nav2_msgs/msg/ParticleCloud", particles=[]), "0 particles"),
    (message("visualization_msgs/msg/MarkerArray", markers=[]), "0 markers"),
    (message("visualization_msgs/msg/MarkerArray", markers=[1]), ""),
    (
        message("geometry_msgs/msg/PolygonStamped", polygon=SimpleNamespace(points=[])),
        "0 points",
    ),
    # A cube, a ball and a text are drawn without points, lines are not.
    *((marker(kind), "") for kind in (0, 1, 2, 3, 9, 10)),
    *((marker(kind), "0 points") for kind in (4, 5, 6, 7, 8, 11)),
    (marker(4, points=2), ""),
    (marker(4, action=2), ""),
    # What has such a field, and nothing draws it, is not said to be empty.
    (message("trajectory_msgs/msg/JointTrajectory", points=[]), ""),
    (
        message("visualization_msgs/msg/InteractiveMarkerUpdate", markers=[], poses=[]),
        "",
    ),
    (message("std_msgs/msg/String", data=""), ""),
]


@pytest.mark.parametrize(("made", "what"), NOTHING)
def test_a_message_with_nothing_in_it_says_what_is_missing(
    made: SimpleNamespace, what: str
) -> None:
    text = f"{what}: look at what publishes it"
    assert said(made) == (("empty", text) if what else ("", ""))


@pytest.mark.parametrize("kind", ["nav_msgs/msg/Path", "sensor_msgs/msg/Image"])
def test_a_type_with_other_fields_is_left_to_its_display(kind: str) -> None:
    assert content_reason(message(kind)) is None


# Point clouds


def cloud(
    names: str = "xyz", kind: int = 7, size: int = 24, **fields: int
) -> SimpleNamespace:
    listed = [
        SimpleNamespace(name=name, offset=4 * at, datatype=kind, count=1)
        for at, name in enumerate(names)
    ]
    shape = {"width": 2, "height": 1, "point_step": 12, "row_step": 24} | fields
    kind_name = "sensor_msgs/msg/PointCloud2"
    return message(kind_name, fields=listed, data=bytes(size), **shape)


@pytest.mark.parametrize(
    ("made", "second"),
    [
        (cloud(kind=8), "Its x and y and z are FLOAT64: publish the coordinates as"),
        (cloud(kind=0), "are of datatype 0: publish"),
        (cloud("ab"), "It has no field x or y or z (its fields: a, b): publish"),
        (cloud("xy"), "It has no field z (its fields: x, y)"),
        (cloud(""), "It has no fields: look at what publishes it"),
        (cloud("abxyz"), "The field y begins at byte 12 of points of 12 bytes"),
    ],
)
def test_a_cloud_without_coordinates_says_why_and_what_to_publish(
    made: SimpleNamespace, second: str
) -> None:
    code, text = said(made)
    assert code == "not-drawn"
    first = "No position transformer available for cloud. "
    assert text.startswith(first)
    assert second in text


@pytest.mark.parametrize(
    ("made", "second"),
    [
        (cloud(size=64, height=2, row_step=32), "Each row has 8 bytes more than its"),
        # Without the padding of the last row.
        (cloud(size=56, height=2, row_step=32), "publish rows without them (row_step"),
        (cloud(size=48), "The data are 4 points: publish their number as width"),
        (cloud(size=25), "They should be 24: point_step is"),
    ],
)
def test_a_cloud_of_another_size_says_where_the_bytes_are(
    made: SimpleNamespace, second: str
) -> None:
    code, text = said(made)
    assert code == "not-drawn"
    assert "does not match width (2) times height" in text
    assert second in text.partition("Dropping message. ")[2]


def test_a_cloud_that_can_be_drawn_may_have_no_points() -> None:
    assert said(cloud()) == ("", "")
    assert said(cloud(width=0, size=0)) == (
        "empty",
        "0 points: look at what publishes it",
    )


# Maps


def grid(width: int, height: int, cells: int, size: float = 0.1) -> SimpleNamespace:
    info = SimpleNamespace(width=width, height=height, resolution=size)
    kind = "nav_msgs/msg/OccupancyGrid"
    return message(kind, info=info, data=np.zeros(cells, np.int8))


@pytest.mark.parametrize(
    ("made", "text"),
    [
        (grid(0, 0, 0), "What came has 0 × 0 cells and no data: what publishes it"),
        (grid(0, 5, 4), "Map is zero-sized (0x5). It has 4 values: publish"),
        (grid(2, 2, 3), "Data size doesn't match width*height: width = 2, height = 2"),
        (grid(2, 2, 4, 0.0), "Its cells are 0 m wide: set info.resolution"),
    ],
)
def test_a_map_that_is_none_says_what_came(made: SimpleNamespace, text: str) -> None:
    assert said(made)[1].startswith(text)


def test_a_map_can_be_drawn() -> None:
    assert said(grid(2, 2, 4)) == ("", "")


# Images


def image(encoding: str, size: int = 2**10) -> SimpleNamespace:
    shape = {"width": 2, "height": 2, "step": 0, "data": bytes(size)}
    return message("sensor_msgs/msg/Image", encoding=encoding, **shape)


def file(of: str, data: bytes) -> SimpleNamespace:
    return message("sensor_msgs/msg/CompressedImage", format=of, data=data)


@pytest.mark.parametrize(
    ("encoding", "instead"),
    [
        ("RGB8", "Its name is written 'rgb8'"),
        ("rgba16", "Publish 8 bits for each colour ('rgba8')"),
        ("64FC4", "Publish one number for each pixel (16UC1 or 32FC1), or colours"),
        ("8UC7", "Publish one number for each pixel"),
        ("yuv422_yuyv", "Did you mean 'yuv422_yuy2'?"),
        ("jpeg", "Publish one that is shown, such as rgb8, bgr8, mono8, 16UC1 or"),
        ("", "Publish one that is shown, such as rgb8, bgr8, mono8, 16UC1 or"),
    ],
)
def test_an_encoding_that_is_not_shown_names_one_that_is(
    encoding: str, instead: str
) -> None:
    text = said(image(encoding))[1]
    first = f"Unsupported image encoding [{encoding}]. "
    assert text.startswith(first + instead)


@pytest.mark.parametrize("encoding", PIXEL_BYTES)
def test_an_image_that_is_too_short_says_how_many_bytes_it_needs(encoding: str) -> None:
    assert said(image(encoding)) == ("", "")
    text = said(image(encoding, 0))[1]
    assert f"The image has 0 bytes; 2 × 2 pixels of {encoding} are " in text


@pytest.mark.parametrize(
    ("of", "data", "remedy"),
    [
        ("h264", b"\0\0\0\1g", "Video is not read"),
        ("jpeg", b"\0\0\0\1g", "Video is not read"),
        ("hevc", b"abc", "Video is not read"),
        ("16UC1; compressedDepth rvl", bytes(20), "sent as PNG (the parameter"),
        ("tiff", b"II*\0", "let it be sent as jpeg or png"),
        ("jpeg", b"", "it has no bytes"),
    ],
)
def test_a_file_that_is_no_picture_says_what_to_send(
    of: str, data: bytes, remedy: str
) -> None:
    code, text = said(file(of, data))
    assert code == "not-drawn"
    assert f"The image of the format '{of}' is not a JPEG, PNG or WebP" in text
    assert remedy in text


@pytest.mark.parametrize(
    ("of", "data"),
    [
        ("jpeg", b"\xff\xd8\xff\xe0"),
        ("png", b"\x89PNG\r\n\x1a\n"),
        ("webp", b"RIFF\0\0\0\0WEBPVP8 "),
        # What the bytes are counts.
        ("", b"\xff\xd8\xff\xe0"),
        ("16UC1; compressedDepth png", bytes(12) + b"\x89PNG\r\n\x1a\n"),
    ],
)
def test_a_file_that_is_a_picture_is_shown(of: str, data: bytes) -> None:
    assert content_reason(file(of, data)) is None
