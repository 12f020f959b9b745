from __future__ import annotations

import pytest

from sambot_viz.rviz.properties.color import NAMED_COLORS, color_text, parse_color


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


def test_the_147_names_of_svg_are_known():
    assert len(NAMED_COLORS) == 147
    assert NAMED_COLORS["grey"] == NAMED_COLORS["gray"] == (128, 128, 128)
