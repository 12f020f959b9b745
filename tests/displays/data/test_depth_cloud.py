"""DepthCloud: the points of depth images, their colours, and what they wait for."""

from __future__ import annotations

import gc
import io
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from camera_messages import file, image, info
from glb_parts import document_of, numbers_of
from inside import session_of
from lower_limit import lower
from made_messages import Make
from PIL import Image

from sambot_viz.displays.data.depth_cloud.depth_sync import DepthMessage

Open = Callable[..., Any]
DEPTH, COLOR, INFO = "/cam/depth", "/cam/color", "/cam/camera_info"
MILLIMETRES = np.array([[1000, 0], [2000, 500]], "<u2")
METRES = np.array([[1.0, np.nan], [2.0, 0.5]], "<f4")
POINTS = [[-0.5, -0.25, 1.0], [-1.0, 0.5, 2.0], [0.25, 0.125, 0.5]]
"""Those of both, with these numbers of a camera."""
NUMBERS = (1.0, 2.0, 0.5, 0.5)
RGB = np.array([[[255, 0, 0], [1, 2, 3]], [[0, 255, 0], [0, 0, 255]]], np.uint8)


def depth(pixels: np.ndarray[Any, Any] = MILLIMETRES, **more: Any) -> Make:
    encoding = "32FC1" if pixels.dtype == np.float32 else "16UC1"
    return image(DEPTH, encoding, pixels, frame="map", **more)


def color(pixels: np.ndarray[Any, Any] = RGB, **more: Any) -> Make:
    return image(COLOR, "rgb8", pixels, **more)


@pytest.fixture
def shown(messages: Open) -> Open:
    def open_depths(*made: Make, colored: bool = False, **values: object) -> Any:
        topics = {"Depth Map Topic": DEPTH, "Color Image Topic": COLOR * colored}
        return messages("DepthCloud", *made, **{**topics, **values})

    return open_depths


def points(opened: Any) -> list[Any]:
    return numbers_of(opened.glb(), "POSITION").tolist()


def style(opened: Any) -> dict[str, Any]:
    return document_of(opened.glb())["meshes"][0]["extras"]


def test_an_image_of_too_many_pixels_is_not_drawn_and_says_so(
    shown: Open, monkeypatch: pytest.MonkeyPatch
) -> None:
    lower(monkeypatch, "DEPTH_POINTS", 4)
    wide = np.concatenate([MILLIMETRES, MILLIMETRES[:, :1]], axis=1)
    opened = shown(info(INFO, NUMBERS, (2, 3)), depth(wide))
    said = "It has 6 pixels: at most 4 are drawn"
    assert said in [text for _, text in opened.statuses.values()]
    assert opened.node_names() == []
    assert points(shown(info(INFO, NUMBERS, (2, 2)), depth())) == POINTS


@pytest.mark.parametrize("pixels", [MILLIMETRES, METRES])
def test_each_pixel_with_a_depth_is_a_point(
    shown: Open, pixels: np.ndarray[Any, Any]
) -> None:
    opened = shown(info(INFO, NUMBERS, (2, 2)), depth(pixels))
    assert points(opened) == POINTS
    assert set(numbers_of(opened.glb(), "COLOR_0").ravel().tolist()) == {255}
    assert opened.statuses == {
        "Topic": ("Ok", "1 messages received at 10.0 hz."),
        "Transform": ("Ok", "Transform OK"),
        "Camera Info": ("Ok", "OK"),
        "Points": ("Ok", "Showing [3] points from [1] messages"),
    }


def test_a_part_of_an_image_has_its_own_center(shown: Open) -> None:
    of_part = info(
        INFO, (2.0, 4.0, 11.0, 21.0), (80, 60), binning=2, roi=(10, 20, 2, 2)
    )
    assert points(shown(of_part, depth())) == POINTS


def test_points_have_the_colours_of_the_image_nearest_in_time(shown: Open) -> None:
    made = (
        info(INFO, NUMBERS, (2, 2)),
        color(RGB * 0, stamp=1.0),
        depth(stamp=2.0),
        color(stamp=2.1),
        color(RGB * 0 + 7, stamp=3.0),
    )
    opened = shown(*made, colored=True)
    colors = numbers_of(opened.glb(), "COLOR_0")[:, :3].tolist()
    assert colors == [[255, 0, 0], [0, 255, 0], [0, 0, 255]]
    assert opened.statuses["Color Image"] == ("Ok", "OK")


def test_a_depth_image_waits_for_a_colour_image(shown: Open) -> None:
    made = (info(INFO, NUMBERS), color(stamp=1.0), depth(stamp=2.0))
    opened = shown(*made, colored=True)
    assert opened.node_names() == []
    text = f"No image received on [{COLOR}]"
    assert opened.statuses["Color Image"] == ("Warn", text)
    opened.set("Color Image Topic", "")
    assert points(opened) == POINTS
    assert "Color Image" not in opened.statuses


def test_without_a_camera_info_the_status_names_its_topic(shown: Open) -> None:
    opened = shown(depth())
    assert opened.node_names() == []
    level, text = opened.statuses["Camera Info"]
    assert level == "Warn"
    assert text.startswith(f"No CameraInfo received on [{INFO}]. ")


@pytest.mark.parametrize(
    ("made", "key", "text"),
    [
        ([info(INFO, (0.0, 0.0, 1.0, 1.0)), depth()], "Camera Info", "not calibrated"),
        ([info(INFO, [np.nan] * 12), depth()], "Camera Info", "floating point values"),
        ([info(INFO, NUMBERS), depth(size=(9, 9))], "Image", "bytes; 9 × 9 pixels"),
        ([info(INFO, NUMBERS), depth(size=(9**9, 9))], "Image", "at most 50,000,000"),
        (
            [info(INFO, NUMBERS), depth(np.zeros((2000, 2001), "<u2"))],
            "Message",
            "4,002,000 pixels: at most 4,000,000 are drawn",
        ),
        (
            [info(INFO, NUMBERS), image(DEPTH, "rgb8", RGB, frame="map")],
            "Image",
            "An image of rgb8 has no depths",
        ),
    ],
)
def test_what_cannot_be_drawn_is_refused(
    shown: Open, made: list[Make], key: str, text: str
) -> None:
    opened = shown(*made)
    assert opened.node_names() == []
    assert opened.statuses[key][0] == "Error"
    assert text in opened.statuses[key][1]


def test_images_of_other_sizes_are_told(shown: Open) -> None:
    made = (info(INFO, NUMBERS, (4, 4)), depth(), color(RGB[:1]))
    opened = shown(*made, colored=True)
    text = "It has 2 × 1 pixels, the depth image 2 × 2: both need the same"
    assert opened.statuses["Color Image"] == ("Error", text)
    level, text = opened.statuses["Camera Info"]
    assert level == "Warn"
    assert "4 × 4 pixels, and the image has 2 × 2" in text


def test_a_broken_colour_image_is_told(shown: Open) -> None:
    made = (info(INFO, NUMBERS), depth(), file(f"{COLOR}/compressed", b"no", "jpeg"))
    values = {"Color Transport Hint": "compressed"}
    opened = shown(*made, colored=True, **values)
    assert "is not a JPEG, PNG or WebP" in opened.statuses["Color Image"][1]


def test_compressed_depths_and_colours_are_read(shown: Open) -> None:
    def png(pixels: np.ndarray[Any, Any]) -> bytes:
        stream = io.BytesIO()
        Image.fromarray(pixels).save(stream, "PNG")
        return stream.getvalue()

    packed = bytes(12) + png(MILLIMETRES.astype(np.uint16))
    opened = shown(
        info(INFO, NUMBERS),
        file(f"{DEPTH}/compressedDepth", packed, "16UC1; compressedDepth png", "map"),
        file(f"{COLOR}/compressed", png(RGB), "png"),
        colored=True,
        **{
            "Depth Map Transport Hint": "compressedDepth",
            "Color Transport Hint": "compressed",
        },
    )
    assert points(opened) == POINTS
    assert numbers_of(opened.glb(), "COLOR_0")[0, :3].tolist() == [255, 0, 0]


def test_points_grow_with_their_depth(shown: Open) -> None:
    opened = shown(info(INFO, (4.0, 4.0, 0.5, 0.5)), depth())
    assert (style(opened)["size"][0], style(opened)["byDepth"]) == (0.25, True)
    assert "0.25 m for each metre" in opened.display.notes()["Size (m)"]
    opened.set("Auto Size/Auto Size Factor", 2.0)
    assert style(opened)["size"][0] == 0.5
    opened.set("Auto Size", False)
    assert (style(opened)["size"][0], style(opened)["byDepth"]) == (0.01, False)
    opened.set("Auto Size", True)
    opened.set("Style", "Points")
    assert (style(opened)["size"][0], style(opened)["byDepth"]) == (3.0, False)


def test_covered_points_stay_for_their_time(shown: Open) -> None:
    near = np.full((2, 2), 400, "<u2")
    made = (info(INFO, NUMBERS), depth(stamp=1.0), depth(near, stamp=2.0))
    opened = shown(*made, **{"Occlusion Compensation": {"Value": True}})
    session = session_of(opened.viz)
    opened.viz.player.jump(0.15)
    assert session.data is not None
    session.data.player.advance(0.1)
    session.scene.messages_came()
    z = sorted(point[2] for point in points(opened))
    assert z == pytest.approx([0.4] * 4 + [0.5, 1.0, 2.0])
    opened.set("Occlusion Compensation/Occlusion Time-Out", 0.0)
    opened.viz.player.jump(opened.viz.player.duration)
    assert len(points(opened)) == 4


def alive() -> int:
    gc.collect()
    return sum(isinstance(one, DepthMessage) for one in gc.get_objects())


def test_images_that_others_have_followed_are_not_kept(shown: Open) -> None:
    opened = shown(info(INFO, NUMBERS), *[depth(stamp=1.0 + n) for n in range(30)])
    session = session_of(opened.viz)
    opened.viz.player.jump(0.0)
    before = alive()
    assert session.data is not None
    for _ in range(30):
        session.data.player.advance(0.1)
        session.scene.messages_came()
    assert len(points(opened)) == 3
    assert alive() <= before + 2


def test_another_fixed_frame_and_back_draws_the_same_points(shown: Open) -> None:
    opened = shown(info(INFO, NUMBERS), depth(), color(), colored=True)
    before = points(opened)
    for frame in ("nowhere", "map"):
        session_of(opened.viz).document.set_option("Fixed Frame", frame)
    assert points(opened) == before


def test_the_lists_of_topics_are_filtered(shown: Open) -> None:
    opened = shown(info(INFO, NUMBERS), depth(), color())
    options = opened.display.options()
    assert options["Depth Map Topic"] == [DEPTH]
    assert options["Color Image Topic"] == [COLOR]
    opened.set("Topic Filter", False)
    assert opened.display.options()["Depth Map Topic"] == [COLOR, DEPTH]


def test_a_wrong_topic_has_a_button_for_the_one_that_was_meant(shown: Open) -> None:
    opened = shown(info(INFO, NUMBERS), depth())
    opened.set("Depth Map Topic", "/cam/dpth")
    repair = opened.display.repairs()["Topic"]
    assert (repair.path, repair.value) == ("Depth Map Topic", DEPTH)
