"""The lines of a grid (spec/rviz-core.md §4.2, §10 G-01 … G-04)."""

from __future__ import annotations

import numpy as np
import pytest

from sambot_viz.displays.grid import grid_segments


def test_the_default_grid_has_22_lines_of_ten_metres() -> None:
    segments = grid_segments(10, 0, 1.0)
    assert segments.shape == (22, 2, 3)
    lengths = np.linalg.norm(segments[:, 1] - segments[:, 0], axis=1)
    assert np.allclose(lengths, 10.0)
    assert np.allclose(segments[:, :, 1], 0.0)


def test_a_grid_of_two_cells_of_two_metres_reaches_two_metres() -> None:
    points = grid_segments(2, 0, 2.0).reshape(-1, 3)
    assert points.min(axis=0) == pytest.approx([-2, 0, -2])
    assert points.max(axis=0) == pytest.approx([2, 0, 2])


def test_layers_are_centred_on_the_plane() -> None:
    points = grid_segments(3, 4, 1.5).reshape(-1, 3)
    assert points.min(axis=0) == pytest.approx([-2.25, -3, -2.25])
    assert points.max(axis=0) == pytest.approx([2.25, 3, 2.25])
    one_cell_high = grid_segments(4, 1, 1.0)
    assert set(np.unique(one_cell_high[:, 0, 1])) == {-0.5, 0.5}


def test_the_number_of_lines_follows_the_formula() -> None:
    for cells, layers in ((1, 0), (4, 2), (3, 1)):
        uprights = (cells + 1) ** 2 if layers else 0
        expected = 2 * (cells + 1) * (layers + 1) + uprights
        assert len(grid_segments(cells, layers, 0.5)) == expected
