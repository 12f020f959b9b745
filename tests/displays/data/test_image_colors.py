"""Images of sensors with a colour filter, and of Y, U and V in planes."""

from __future__ import annotations

import io
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from image_messages import Make, octets, raw
from PIL import Image

Open = Callable[..., Any]
RED = {"rggb": (0, 0), "grbg": (0, 1), "gbrg": (1, 0), "bggr": (1, 1)}
HEIGHT, WIDTH = 5, 7


def pixels(shown: Any) -> Any:
    with Image.open(io.BytesIO(shown.look()[1])) as image:
        return np.asarray(image)


def color_at(pattern: str, row: int, column: int) -> int:
    """The colour that a pixel measures: 0, 1, 2 for red, green, blue."""
    red_row, red_column = RED[pattern]
    return int(row % 2 != red_row) + int(column % 2 != red_column)


def around(row: int, column: int) -> list[tuple[int, int]]:
    rows, columns = range(row - 1, row + 2), range(column - 1, column + 2)
    return [(r, c) for r in rows for c in columns if 0 <= r < HEIGHT and 0 <= c < WIDTH]


def interpolated(mosaic: Any, pattern: str) -> Any:
    """What a pixel does not measure is the mean of its neighbours that do, rounded."""
    found = np.zeros((HEIGHT, WIDTH, 3), int)
    for row, column in np.ndindex(HEIGHT, WIDTH):
        own = color_at(pattern, row, column)
        for color in range(3):
            near = [
                int(mosaic[at])
                for at in around(row, column)
                if color_at(pattern, *at) == color
            ]
            mean = (sum(near) + len(near) // 2) // len(near)
            found[row, column, color] = mosaic[row, column] if color == own else mean
    return found


@pytest.mark.parametrize("pattern", RED)
def test_a_bayer_image_has_the_colours_around_each_pixel(
    messages: Open, pattern: str
) -> None:
    mosaic = np.random.default_rng(7).integers(0, 256, (HEIGHT, WIDTH), np.uint8)
    shown = messages("Image", raw(f"bayer_{pattern}8", mosaic, WIDTH, HEIGHT))
    assert pixels(shown).tolist() == interpolated(mosaic, pattern).tolist()


@pytest.mark.parametrize("pattern", RED)
@pytest.mark.parametrize("order", ["<", ">"])
def test_a_bayer_image_of_16_bits_is_scaled_as_one(
    messages: Open, pattern: str, order: str
) -> None:
    mosaic = np.random.default_rng(8).integers(0, 4096, (HEIGHT, WIDTH), np.uint16)
    mosaic[0, 0], mosaic[1, 1] = 0, 4095
    sent = mosaic.astype(f"{order}u2")
    shown = messages(
        "Image", raw(f"bayer_{pattern}16", sent, WIDTH, HEIGHT, big=order == ">")
    )
    expected = interpolated(mosaic, pattern) * 255.0 / 4095
    assert np.abs(pixels(shown) - expected).max() <= 1.0


def test_a_uniform_colour_of_a_bayer_image_is_that_colour(messages: Open) -> None:
    color = (200, 90, 30)
    cells = np.ndindex(HEIGHT, WIDTH)
    mosaic = np.array([color[color_at("grbg", *at)] for at in cells], np.uint8)
    shown = messages("Image", raw("bayer_grbg8", mosaic, WIDTH, HEIGHT, step=WIDTH))
    assert (pixels(shown) == color).all()


# Y of four pixels, then one pair for all of them: U 128 and V 228.
SUBSAMPLED = (75, 85, 95, 105)
PLANES = [
    raw("nv12", octets(*SUBSAMPLED, 128, 228), 2, 2, 2),
    raw("nv21", octets(*SUBSAMPLED, 228, 128), 2, 2, 2),
    raw("nv24", octets(*SUBSAMPLED, *(128, 228) * 4), 2, 2, 2),
    # With two bytes between the rows, of Y and of the pairs.
    raw("nv12", octets(75, 85, 0, 0, 95, 105, 0, 0, 128, 228, 0, 0), 2, 2, 4),
]


@pytest.mark.parametrize("make", PLANES)
def test_planes_of_y_and_uv_are_shown_in_colour(messages: Open, make: Make) -> None:
    def rgb(luma: int) -> list[int]:
        # RViz's: 1403 · 100 / 1000 and −714 · 100 / 1000, cut towards 0.
        return [luma + 140, luma - 71, luma]

    assert pixels(messages("Image", make)).tolist() == [
        [rgb(75), rgb(85)],
        [rgb(95), rgb(105)],
    ]


def test_planes_of_an_odd_size_share_their_last_pair(messages: Open) -> None:
    luma, pairs = [9] * 9, [128, 128, 128, 228] * 2
    grey, red = [9, 9, 9], [149, 0, 9]
    # Rows of 4 bytes, since those of the pairs have 4.
    data = octets(*(*luma[:3], 0) * 3, *pairs)
    shown = messages("Image", raw("nv12", data, 3, 3, 4))
    assert pixels(shown).tolist() == [[grey, grey, red]] * 3


def test_planes_that_are_cut_off_say_how_many_bytes_are_missing(messages: Open) -> None:
    shown = messages("Image", raw("nv12", octets(1, 2, 3, 4), 2, 2, 2))
    shown.look()
    text = shown.statuses["Image"][1]
    assert "has 4 bytes; 2 × 2 pixels of nv12 are 6" in text
