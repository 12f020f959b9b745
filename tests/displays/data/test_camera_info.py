"""CameraInfo: the pyramid of a camera, and what gives none."""

from __future__ import annotations

from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from sambot_viz.displays.data.camera_info_display import corners_of

Make = Callable[[Any], tuple[str, str, object]]
Open = Callable[..., Any]
P = (160.0, 0, 160, 0, 0, 120, 120, 0, 0, 0, 1, 0)
"""Of a camera whose image is 2 m wide and 2 m high at a distance of 1 m."""


def info(**values: Any) -> Make:
    def make(types: Any) -> tuple[str, str, object]:
        name = "sensor_msgs/msg/CameraInfo"
        stamp = types["builtin_interfaces/msg/Time"](0, 0)
        nine = np.zeros(9)
        said = {
            "header": types["std_msgs/msg/Header"](stamp, "map"),
            "height": 240,
            "width": 320,
            "distortion_model": "",
            "d": np.zeros(0),
            "k": nine,
            "r": nine,
            "p": np.array(values.pop("p", P), np.float64),
            "binning_x": 0,
            "binning_y": 0,
            "roi": types["sensor_msgs/msg/RegionOfInterest"](0, 0, 0, 0, False),
        }
        return "/a", name, types[name](**(said | values))

    return make


def corners(p: Any = P, roi: tuple[int, int] = (0, 0), binning: int = 0) -> Any:
    region = SimpleNamespace(width=roi[0], height=roi[1])
    said: dict[str, Any] = {"width": 320, "height": 240, "roi": region}
    return corners_of(
        SimpleNamespace(p=p, binning_x=binning, binning_y=binning, **said)
    )


def test_the_corners_are_those_of_the_image() -> None:
    assert corners().tolist() == [[-1, -1, 1], [1, -1, 1], [1, 1, 1], [-1, 1, 1]]
    right_and_below = (*P[:3], 160.0, *P[4:7], 60.0, *P[8:])
    assert corners(right_and_below)[0].tolist() == [-2, -1.5, 1]


def test_a_part_of_the_image_and_binned_pixels_make_it_smaller() -> None:
    assert corners(roi=(160, 120))[2].tolist() == [0, 0, 1]
    assert corners(binning=2)[2].tolist() == [0, 0, 1]


def test_the_projection_of_ros1_has_a_capital() -> None:
    region = SimpleNamespace(width=0, height=0)
    of_ros1 = SimpleNamespace(
        P=P, width=320, height=240, roi=region, binning_x=0, binning_y=0
    )
    assert corners_of(of_ros1).tolist() == corners().tolist()


def test_a_projection_of_another_length_is_refused() -> None:
    with pytest.raises(ValueError, match="reshape"):
        corners(np.zeros(9))


def test_edges_and_sides_are_shown_as_the_boxes_say(messages: Open) -> None:
    shown = messages("CameraInfo", info())
    assert shown.statuses["Camera Info"] == ("Ok", "OK")
    assert [name[-1] for name in shown.node_names()] == ["e"]
    shown.set("Not show side polygons", False)
    assert [name[-1] for name in shown.node_names()] == ["e", "s"]
    shown.set("Show edges", False)
    assert [name[-1] for name in shown.node_names()] == ["s"]
    shown.set("Show polygons", False)
    assert shown.node_names() == []


def test_a_focal_length_of_zero_leaves_nothing(messages: Open) -> None:
    broken = info(p=(0.0, *P[1:]))
    shown = messages("CameraInfo", info(), broken)
    assert shown.statuses["Camera Info"] == ("Error", "Invalid intrinsic matrix")
    assert shown.node_names() == []


@pytest.mark.parametrize("bad", [float("nan"), 1e-300])
def test_a_projection_without_numbers_leaves_nothing(
    messages: Open, bad: float
) -> None:
    shown = messages("CameraInfo", info(), info(p=(*P[:5], bad, *P[6:])))
    text = "Message contained invalid floating point values (nans or infs)"
    assert shown.statuses["Camera Info"] == ("Error", text)
    assert shown.node_names() == []
