"""Image: what pictures become on the way to the page, and when they are made."""

from __future__ import annotations

import io
import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from camera_messages import unpacked
from image_messages import Make, file_message, octets, raw
from inside import session_of
from PIL import Image

from sambot_viz import Visualizer
from sambot_viz.displays.camera_pictures import CameraPicture, ClientPictures, Pictures

CASES = Path(__file__).parents[2] / "golden" / "images"
Open = Callable[..., Any]


def pixels(shown: Any) -> list[Any]:
    with Image.open(io.BytesIO(shown.look()[1])) as image:
        return np.asarray(image).tolist()


@pytest.mark.parametrize(
    "name", ["image_16uc1_normalized", "image_mono8", "image_rgb8"]
)
def test_the_pixels_are_rvizs(name: str) -> None:
    folder = CASES / name
    source, config = f"bag:{folder / 'messages.mcap'}", folder / "config.rviz"
    with Visualizer(source=source, config=config, port=0) as viz:
        viz.player.jump(viz.player.duration)
        session = session_of(viz)
        key = session.scene.displays[1].key
        with session.lock:
            session.scene.context.pictures.want(key)
        found = session.scene.context.pictures.frames([key])
    with Image.open(io.BytesIO(unpacked(found[key][1])[1])) as image:
        ours = np.asarray(image.convert("RGB"))
    for probe in json.loads((folder / "values.json").read_text())["probes"]:
        column, row = probe["image_pixel"]
        assert ours[row, column].tolist() == probe["render_rgb"]


RED_BLUE = [[[255, 0, 0], [0, 0, 255]]]


@pytest.mark.parametrize(
    ("make", "expected"),
    [
        (raw("rgb8", octets(255, 0, 0, 0, 0, 255)), RED_BLUE),
        (raw("bgr8", octets(0, 0, 255, 255, 0, 0)), RED_BLUE),
        (raw("rgba8", octets(255, 0, 0, 0, 0, 0, 255, 0)), RED_BLUE),
        (raw("bgra8", octets(0, 0, 255, 7, 255, 0, 0, 7)), RED_BLUE),
        (raw("8UC1", octets(3, 4)), [[3, 4]]),
        (raw("bayer_rggb8", octets(3, 4)), [[[3, 4, 0]] * 2]),
        (raw("yuyv", octets(100, 128, 200, 128)), [[[100] * 3, [200] * 3]]),
        (raw("uyvy", octets(128, 100, 128, 200)), [[[100] * 3, [200] * 3]]),
        (raw("yuyv", octets(100, 128, 100, 228)), [[[240, 29, 100]] * 2]),
        (raw("mono8", octets(1, 2, 9, 3, 4, 9), 2, 2, 3), [[1, 2], [3, 4]]),
        (raw("16UC1", np.array([100, 300], "<u2")), [[0, 255]]),
        (raw("mono16", np.array([100, 300], ">u2"), big=True), [[0, 255]]),
        # The limits are cut to whole metres: 0 and 4.
        (raw("32FC1", np.array([0.6, 4.7], "<f4")), [[38, 255]]),
        (raw("32FC1", np.array([np.nan, 2], "<f4")), [[0, 0]]),
        (raw("32FC1", np.array([np.nan, np.nan], "<f4")), [[0, 0]]),
    ],
)
def test_an_encoding_is_shown_as_rviz_does(
    messages: Open, make: Make, expected: object
) -> None:
    shown = messages("Image", make)
    assert pixels(shown) == expected
    assert "Image" not in shown.statuses


@pytest.mark.parametrize(
    ("make", "text"),
    [
        (raw("8UC7", octets(1)), "Unsupported image encoding [8UC7]"),
        (raw("rgb8", octets(1, 2)), "has 2 bytes; 2 × 1 pixels of rgb8 are 6"),
        (raw("rgb8", octets(), 0, 0), "0 × 0 pixels"),
        (raw("rgb8", octets(1), 100_000, 100_000), "at most 50,000,000"),
        (raw("mono8", octets(1), 2**32 - 1, 2**32 - 1), "at most 50,000,000"),
        (file_message(b"nonsense"), "format 'jpeg' is not a JPEG, PNG or WebP"),
        (file_message(b"", "16UC1; compressedDepth png"), "is not a JPEG, PNG or WebP"),
    ],
)
def test_a_picture_that_cannot_be_shown_says_why(
    messages: Open, make: Make, text: str
) -> None:
    shown = messages("Image", make)
    about, content = shown.look()
    level, said = shown.statuses["Image"]
    assert (level, about["type"], content) == ("Error", "", b"")
    assert text in said


def file_of(mode: str, kind: str) -> bytes:
    stream = io.BytesIO()
    Image.new(mode, (4, 3), 500 if mode == "I;16" else 90).save(stream, kind)
    return stream.getvalue()


@pytest.mark.parametrize("kind", ["JPEG", "PNG", "WEBP"])
def test_a_compressed_picture_travels_as_it_came(messages: Open, kind: str) -> None:
    data = file_of("RGB", kind)
    shown = messages("Image", file_message(data))
    about, content = shown.look()
    assert (about["width"], about["height"]) == (4, 3)
    assert about["type"] == f"image/{kind.lower()}"
    assert content == data


@pytest.mark.parametrize(
    ("hint", "topic"), [("raw", "/a"), ("compressed", "/a/compressed"), (None, "/a")]
)
def test_ros_1_names_the_topic_of_whole_pictures(
    messages: Open, hint: str | None, topic: str
) -> None:
    def pixel(types: Any) -> tuple[str, str, object]:
        _, kind, message = raw("mono8", octets(7, 8))(types)
        return topic, kind, message

    values = {"Class": "rviz/Image", "Topic": None, "Image Topic": "/a"}
    shown = messages("Image", pixel, **values, **{"Transport Hint": hint})
    assert shown.statuses["Topic"][1].startswith("1 messages received")


def test_a_compressed_depth_is_scaled(messages: Open) -> None:
    data = bytes(12) + file_of("I;16", "PNG")
    shown = messages("Image", file_message(data, "16UC1; compressedDepth png"))
    shown.set("Normalize Range", False)
    shown.set("Max Value", 1000.0)
    assert pixels(shown) == [[127] * 4] * 3


def test_the_range_is_the_median_of_the_last_pictures(messages: Open) -> None:
    makes = [raw("16UC1", np.array([0, most], "<u2")) for most in (100, 200, 400)]
    shown = messages("Image", *makes)
    shown.viz.player.jump(0.0)
    assert pixels(shown) == [[0, 255]]
    shown.set("Normalize Range", False)
    shown.set("Max Value", 200.0)
    assert pixels(shown) == [[0, 127]]


def test_no_picture_is_made_before_somebody_looks(messages: Open) -> None:
    shown = messages("Image", raw("mono8", octets(1, 2)))
    pictures = session_of(shown.viz).scene.context.pictures
    key = shown.display.key
    assert "Image" not in shown.statuses
    assert unpacked(pictures.frames([key])[key][1])[0]["type"] == ""


@pytest.mark.parametrize(
    "make",
    [
        raw("8UC7", octets(1)),
        raw("rgb8", octets(1, 2)),
        file_message(b"nonsense"),
        # Only those who look find out that it ends early.
        file_message(b"\xff\xd8\xff"),
    ],
)
def test_what_cannot_be_shown_says_so_also_when_nobody_looks_any_longer(
    messages: Open, make: Make
) -> None:
    shown = messages("Image", make)
    shown.look()
    seen = shown.statuses["Image"]
    assert seen[0] == "Error"
    shown.look_away()
    assert shown.statuses["Image"] == seen


def test_what_cannot_be_shown_says_so_before_somebody_looks(messages: Open) -> None:
    bad, good = raw("8UC7", octets(1)), raw("mono8", octets(1, 2))
    shown = messages("Image", bad, bad, good)
    shown.viz.player.jump(0.0)
    assert shown.statuses["Image"][1].startswith("Unsupported image encoding [8UC7]")
    # One that is good again takes the error away.
    shown.viz.player.jump(shown.viz.player.duration)
    assert "Image" not in shown.statuses


def test_without_a_picture_the_status_says_so(messages: Open) -> None:
    shown = messages("Image", raw("mono8", octets(1, 2)), Topic={"Value": "/b"})
    assert shown.statuses["Image"] == ("Warn", "No Image received")


def test_another_fixed_frame_does_not_make_the_picture_again(messages: Open) -> None:
    shown = messages("Image", raw("mono8", octets(1, 2)))
    shown.look()
    session, key = session_of(shown.viz), shown.display.key
    before = session.scene.context.pictures.frames([key])
    with session.lock:
        shown.display.draw()
    assert session.scene.context.pictures.frames([key]) == before


def test_a_display_that_is_off_has_no_picture(messages: Open) -> None:
    shown = messages("Image", raw("mono8", octets(1, 2)))
    shown.look()
    session, display = session_of(shown.viz), shown.display
    with session.lock:
        display.show(False)
    assert display.key not in session.scene.context.pictures


# What a page gets


def of_grey(value: int) -> CameraPicture:
    return CameraPicture("image/png", 1, 1, bytes([value]))


@pytest.fixture
def two() -> Pictures:
    pictures = Pictures()
    for key in ("a", "b"):
        pictures.begin(key, lambda: None)
    return pictures


def all_sent(client: ClientPictures, version: int) -> tuple[int, list[int]]:
    sent = list[int]()
    while client.version != version:
        version, frame = client.since(version)
        assert frame is not None
        sent.append(unpacked(frame)[1][0])
    return version, sent


def test_a_page_gets_only_the_newest_of_what_it_shows(two: Pictures) -> None:
    client = ClientPictures(two)
    client.show("a", True)
    for value in (1, 2, 3):
        two.put("a", of_grey(value))
        two.put("b", of_grey(9))
    version, sent = all_sent(client, 0)
    assert sent == [3]
    client.show("b", True)
    version, sent = all_sent(client, version)
    assert sent == [9]
    client.show("b", False)
    two.put("b", of_grey(8))
    assert client.since(version) == (version, None)


def test_a_fast_camera_does_not_keep_another_one_away(two: Pictures) -> None:
    client = ClientPictures(two)
    client.show("a", True)
    client.show("b", True)
    two.put("b", of_grey(1))
    version, sent = 0, list[int]()
    for value in (7, 8, 9):
        two.put("a", of_grey(value))
        version, frame = client.since(version)
        assert frame is not None
        sent.append(unpacked(frame)[1][0])
    assert sent == [1, 8, 9]


def test_a_display_is_woken_by_the_first_page_that_looks(two: Pictures) -> None:
    woken = list[str]()
    two.begin("c", lambda: woken.append("c"))
    first, second = ClientPictures(two), ClientPictures(two)
    for client in (first, second):
        client.show("c", True)
        client.show("c", True)
    assert woken == ["c"]
    first.close()
    assert two.is_wanted("c")
    second.close()
    assert not two.is_wanted("c")
