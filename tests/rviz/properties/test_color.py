from __future__ import annotations

import zlib

import pytest
from PIL import ImageColor

from sambot_viz.rviz.properties.color import color_text, parse_color


@pytest.mark.parametrize(
    ("text", "color"),
    [
        ("160; 160; 164", (160, 160, 164)),
        ("1;2;3", (1, 2, 3)),
        (" 10 ; 20;30 ; 40", (10, 20, 30)),
        ("-1;2000;3", (0, 255, 3)),
        ("White", (255, 255, 255)),
        ("light blue", (173, 216, 230)),
        ("#f00", (255, 0, 0)),
        ("#102030", (16, 32, 48)),
        ("#80102030", (16, 32, 48)),
        ("#102030405060", (16, 48, 80)),
    ],
)
def test_colours_are_read_as_rviz_reads_them(text: str, color: tuple[int, int, int]):
    assert parse_color(text) == color


@pytest.mark.parametrize(
    "text", ["", "1,2,3", "1 2 3", "0.5; 0.5; 0.5", "chubby!", "#12", "#12345", "#xyz"]
)
def test_what_rviz_cannot_read_is_no_colour(text: str):
    assert parse_color(text) is None


def test_a_colour_is_written_with_semicolons():
    assert color_text((48, 48, 48)) == "48; 48; 48"


@pytest.mark.parametrize(
    ("name", "color"),
    [
        ("aliceblue", (240, 248, 255)),
        ("gray", (128, 128, 128)),
        ("grey", (128, 128, 128)),
        ("green", (0, 128, 0)),
        ("lightgoldenrodyellow", (250, 250, 210)),
        ("yellowgreen", (154, 205, 50)),
    ],
)
def test_names_are_those_of_svg(name: str, color: tuple[int, int, int]):
    assert parse_color(name) == color


def test_the_147_names_of_svg_are_known_with_their_values():
    known = {name: parse_color(name) for name in ImageColor.colormap}
    assert known.pop("rebeccapurple", None) is None, "a name of CSS 4, not of Qt"
    assert len(known) == 147
    # Of the table in the standard.
    assert zlib.crc32(repr(sorted(known.items())).encode()) == 403863970
