"""Camera: what the page gets of a picture, of its camera, and of other displays."""

from __future__ import annotations

import io
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from camera_messages import cube, file, image, info, pose, unpacked
from inside import session_of
from made_messages import Make
from PIL import Image

from sambot_viz.displays.display import Display, EntryList

Open = Callable[..., Any]
INFO = "/camera_info"
GREY = np.full((2, 4), 90, np.uint8)
NUMBERS = (10.0, 20.0, 2.0, 1.0)
FORWARD = (-0.5, 0.5, -0.5, 0.5)
"""Turns a camera, which looks along its z axis with y downwards, to x of the map."""


def picture(pixels: np.ndarray[Any, Any] = GREY, **more: Any) -> Make:
    return image("/a", "mono8", pixels, **more)


def placed(*xyz: float) -> Make:
    return pose("camera", xyz, FORWARD)


def view(shown: Any) -> Any:
    return shown.look()[0]["view"]


def test_the_page_gets_the_camera_with_its_picture(messages: Open) -> None:
    shown = messages("Camera", placed(1, 2, 3), info(INFO, NUMBERS, (4, 2)), picture())
    found = view(shown)
    assert found["position"] == [1, 2, 3]
    assert abs(np.dot(found["wxyz"], [0.5, -0.5, 0.5, -0.5])) == pytest.approx(1)
    assert (found["focus"], found["center"]) == ([10, 20], [2, 1])
    assert (found["size"], found["roi"]) == ([4, 2], [0, 0, 0, 0])
    assert (found["zoom"], found["far"]) == (1, 100)
    assert (found["behind"], found["over"], found["hidden"]) == (True, 0.5, [])
    assert shown.statuses == {
        "Topic": ("Ok", "1 messages received at 10.0 hz."),
        "Transform": ("Ok", "Transform OK"),
        "Camera Info": ("Ok", "OK"),
    }


def test_the_second_camera_of_a_pair_is_moved_aside(messages: Open) -> None:
    # Tx is -fx times 0.5 m to the right, Ty is fy times 0.25 m to the bottom.
    p = (10.0, 0.0, 2.0, -5.0, 0.0, 20.0, 1.0, 5.0, 0.0, 0.0, 1.0, 0.0)
    shown = messages("Camera", placed(0, 0, 0), info(INFO, p), picture())
    assert view(shown)["position"] == pytest.approx([0, -0.5, -0.25])


def test_settings_reach_the_page(messages: Open) -> None:
    shown = messages("Camera", placed(0, 0, 0), info(INFO, NUMBERS), picture())
    shown.set("Overlay Alpha", 0.25)
    shown.set("Zoom Factor", 2.0)
    shown.set("Far Plane Distance", 7.0)
    found = view(shown)
    assert (found["over"], found["zoom"], found["far"]) == (0.25, 2, 7)
    shown.set("Image Rendering", "background")
    assert (view(shown)["behind"], view(shown)["over"]) == (True, 0)
    shown.set("Image Rendering", "overlay")
    assert (view(shown)["behind"], view(shown)["over"]) == (False, 0.25)


def test_without_sizes_those_of_the_image_count(messages: Open) -> None:
    shown = messages("Camera", placed(0, 0, 0), info(INFO, NUMBERS), picture())
    assert view(shown)["size"] == [4, 2]
    assert shown.statuses["Camera Info"] == ("Ok", "OK")


def test_a_camera_info_that_comes_later_is_taken(messages: Open) -> None:
    shown = messages("Camera", placed(0, 0, 0), picture(), info(INFO, NUMBERS))
    shown.viz.player.jump(0.15)
    assert view(shown) is None
    level, text = shown.statuses["Camera Info"]
    assert level == "Warn"
    assert text == f"No CameraInfo received on [{INFO}]"
    session = session_of(shown.viz)
    assert session.data is not None
    session.data.player.advance(0.1)
    session.scene.messages_came()
    assert view(shown) is not None


def test_a_topic_without_a_camera_info_is_named(messages: Open) -> None:
    shown = messages("Camera", placed(0, 0, 0), picture(), Topic={"Value": "/a"})
    level, text = shown.statuses["Camera Info"]
    assert level == "Warn"
    assert text.startswith("No CameraInfo received on [/camera_info]. ")
    # The image is shown all the same.
    about, content = shown.look()
    assert about["view"] is None
    assert content


@pytest.mark.parametrize(
    ("p", "text"),
    [
        ([0.0] * 12, "The focal lengths in P are 0 and 0 pixels"),
        ([float("nan")] * 12, "invalid floating point values"),
        ([float("inf")] * 12, "invalid floating point values"),
        ([1e-300] * 12, "not calibrated"),
    ],
)
def test_a_camera_without_numbers_draws_no_scene(
    messages: Open, p: list[float], text: str
) -> None:
    shown = messages("Camera", placed(0, 0, 0), info(INFO, p), picture())
    about, content = shown.look()
    assert (about["view"], about["width"]) == (None, 4)
    assert content
    assert shown.statuses["Camera Info"][0] == "Error"
    assert text in shown.statuses["Camera Info"][1]


def test_absurd_numbers_stay_finite(messages: Open) -> None:
    p = (1e-8, 0.0, 1e300, 1e305, 0.0, 1e300, -1e300, 1e305, 0.0, 0.0, 1.0, 0.0)
    shown = messages("Camera", placed(0, 0, 0), info(INFO, p), picture())
    assert np.isfinite(view(shown)["position"]).all()


def test_another_size_than_the_camera_says_is_doubtful(messages: Open) -> None:
    shown = messages("Camera", placed(0, 0, 0), info(INFO, NUMBERS, (8, 8)), picture())
    level, text = shown.statuses["Camera Info"]
    assert level == "Warn"
    assert "8 × 8 pixels, and the image has 4 × 2" in text
    assert view(shown)["size"] == [8, 8]


@pytest.mark.parametrize(
    ("made", "text"),
    [
        (picture(size=(9, 9)), "bytes; 9 × 9 pixels"),
        (picture(size=(2**31, 2**31)), "at most 50,000,000"),
        (image("/a", "8UC7", GREY), "Unsupported image encoding [8UC7]"),
    ],
)
def test_a_picture_that_cannot_be_shown_says_why(
    messages: Open, made: Make, text: str
) -> None:
    shown = messages("Camera", placed(0, 0, 0), info(INFO, NUMBERS), made)
    about, content = shown.look()
    assert (about["type"], about["view"], content) == ("", None, b"")
    assert text in shown.statuses["Image"][1]


def test_ros_1_names_the_topic_of_whole_pictures(messages: Open) -> None:
    stream = io.BytesIO()
    Image.fromarray(GREY).save(stream, "PNG")
    made = file("/a/compressed", stream.getvalue(), "png")
    ros1 = {"Class": "rviz/Camera", "Topic": None, "Image Topic": "/a"}
    values = {**ros1, "Transport Hint": "compressed"}
    shown = messages("Camera", placed(0, 0, 0), info(INFO, NUMBERS), made, **values)
    assert view(shown)["size"] == [4, 2]


def test_a_picture_waits_for_the_place_of_its_camera(messages: Open) -> None:
    shown = messages("Camera", info(INFO, NUMBERS), picture(frame="nowhere"))
    assert shown.look()[0]["type"] == ""
    assert shown.statuses["Image"] == ("Warn", "No Image received")
    assert "Points" not in shown.statuses


def test_nothing_is_made_before_somebody_looks(messages: Open) -> None:
    shown = messages("Camera", placed(0, 0, 0), info(INFO, NUMBERS), picture())
    assert "Image" not in shown.statuses
    session, key = session_of(shown.viz), shown.display.key
    pictures = session.scene.context.pictures
    assert unpacked(pictures.frames([key])[key][1])[0]["type"] == ""


def test_what_cannot_be_shown_says_so_whether_or_not_somebody_looks(
    messages: Open,
) -> None:
    made = image("/a", "8UC7", GREY)
    shown = messages("Camera", placed(0, 0, 0), info(INFO, NUMBERS), made)
    before = shown.statuses["Image"]
    assert before[0] == "Error"
    assert before[1].startswith("Unsupported image encoding [8UC7]. ")
    shown.look()
    shown.look_away()
    assert shown.statuses["Image"] == before


def test_what_is_the_same_is_not_sent_again(messages: Open) -> None:
    shown = messages("Camera", placed(0, 0, 0), info(INFO, NUMBERS), picture())
    shown.look()
    session, key = session_of(shown.viz), shown.display.key
    before = session.scene.context.pictures.frames([key])
    with session.lock:
        shown.display.draw()
        shown.display.time_passed()
    assert session.scene.context.pictures.frames([key]) == before


# Visibility


def boxes(display: Display) -> EntryList:
    (found,) = display.entries()
    return found


@pytest.fixture
def among(messages: Open) -> Any:
    """A Camera beside a marker in a group; only its own display is in the file."""
    made = (placed(0, 0, 0), info(INFO, NUMBERS), picture(), cube("/m", (3, 0, 0), 1.0))
    shown = messages("Camera", *made)
    edits = session_of(shown.viz).display_edits
    group = edits.add_display("rviz_common/Group", name="All")
    marker = edits.add_display("rviz_default_plugins/Marker", name="Cube")
    session_of(shown.viz).display_edits.move_display(marker, 0, group)
    display = session_of(shown.viz).scene.display_of(marker)
    assert display is not None
    edits.set_property(display, "Topic", "/m")
    return shown


def test_each_other_display_has_a_box(among: Any) -> None:
    found = boxes(among.display)
    assert (found.title, found.names) == ("Visibility", ["All", "All/Cube"])
    assert found.above == {"All/Cube": "All"}
    assert all(found.item(name).get("Value") for name in found.names)


@pytest.mark.parametrize("name", ["All", "All/Cube"])
def test_a_display_whose_box_is_off_is_hidden_in_the_picture(
    among: Any, name: str
) -> None:
    edits, scene = session_of(among.viz).display_edits, session_of(among.viz).scene
    (marker,) = (one for one in scene.displays if one.kind.endswith("/Marker"))
    edits.set_entry(among.display, "Visibility", name, "Value", False)
    assert view(among)["hidden"] == [marker.key]
    edits.set_enabled(marker, False)
    with session_of(among.viz).lock:
        among.display.time_passed()
    assert view(among)["hidden"] == []


def test_the_box_of_all_hides_all(among: Any) -> None:
    among.set("Visibility", False)
    assert len(view(among)["hidden"]) == 1


def test_boxes_are_kept_in_the_file_as_rviz_writes_them(among: Any) -> None:
    session = session_of(among.viz)
    edits, visitor = session.display_edits, 7
    for name in ("All/Cube", "All"):
        with session.history.acting(visitor):
            edits.set_entry(among.display, "Visibility", name, "Value", False)
    assert len(view(among)["hidden"]) == 1
    kept = among.display.config.dynamic("Visibility")
    assert kept == {"Value": "true", "All": {"Value": "false", "Cube": "false"}}
    for _ in range(2):
        session.history.undo(visitor)
    assert view(among)["hidden"] == []


def test_a_display_with_another_name_keeps_its_box(among: Any) -> None:
    session = session_of(among.viz)
    (marker,) = (one for one in session.scene.displays if one.kind.endswith("/Marker"))
    session.display_edits.set_entry(
        among.display, "Visibility", "All/Cube", "Value", False
    )
    session.display_edits.rename_display(marker.config, "Box")
    with session.lock:
        among.display.time_passed()
    assert view(among)["hidden"] == [marker.key]
    kept = among.display.config.dynamic("Visibility")
    assert kept["All"]["Box"] == "false"


def test_boxes_of_the_file_hold(messages: Open) -> None:
    values = {"Visibility": {"Value": True, "Camera": True, "Grid": False}}
    made = (placed(0, 0, 0), info(INFO, NUMBERS), picture())
    shown = messages("Camera", *made, **values)
    edits = session_of(shown.viz).display_edits
    edits.add_display("rviz_default_plugins/Grid", name="Grid")
    assert len(view(shown)["hidden"]) == 1
