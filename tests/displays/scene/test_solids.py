"""The colours of batches reach the page in the space in which viser takes them."""

from __future__ import annotations

import pytest

from sambot_viz.displays.scene.solids import (
    UPSIDE_DOWN,
    Arrow,
    add_arrows,
    arrow_wxyz,
    linear,
)
from sambot_viz.geometry import wxyz_product, wxyz_rotated
from sambot_viz.options import Options
from sambot_viz.server.listener import listen


def encoded(value: float) -> float:
    """Linear, 0 to 1, to an 8-bit sRGB channel."""
    if value <= 0.0031308:
        return 255 * 12.92 * value
    return 255 * (1.055 * value ** (1 / 2.4) - 0.055)


def test_linear_undoes_the_encoding_of_the_page() -> None:
    for channel in (0, 5, 25, 76, 153, 204, 255):
        assert encoded(linear(channel)) == pytest.approx(channel, abs=0.01)


def test_arrows_are_shown_in_their_colours_to_four_steps() -> None:
    with listen(Options()) as listener:
        server = listener.viser
        arrow = Arrow((0, 0, 0), (1, 0, 0), (0.4, 0.01), (0.1, 0.04))
        shafts, heads = add_arrows(
            server.scene, "/a", [arrow], [(204, 204, 76)], [(255, 25, 153)]
        )
        for node, color in ((shafts, (204, 204, 76)), (heads, (255, 25, 153))):
            shown = [encoded(c / 255) for c in node.batched_colors[0]]
            assert shown == pytest.approx(color, abs=4)


@pytest.mark.parametrize("way", [(1.0, 2.0, 3.0), (0.0, 0.0, -2.0), (-0.3, 0.4, 0.0)])
def test_arrows_are_turned_the_shortest_way_from_minus_z(
    way: tuple[float, float, float],
) -> None:
    """The sides of shaft and head then face where those of RViz's arrows face."""
    turn = arrow_wxyz(way)
    length = sum(c * c for c in way) ** 0.5
    assert wxyz_rotated(turn, (0, 0, length)) == pytest.approx(way, abs=1e-12)
    from_minus_z = wxyz_product(turn, UPSIDE_DOWN)
    assert from_minus_z[3] == pytest.approx(0.0, abs=1e-12)
