"""The arrow from a frame to its parent."""

from __future__ import annotations

import numpy as np
import pytest

from sambot_viz.displays.scene.solids import arrow_triangles
from sambot_viz.displays.tf.tf import frame_arrow


def test_an_arrow_of_half_a_metre_has_a_head_of_ten_centimetres() -> None:
    arrow = frame_arrow((0.5, 0.0, 0.0), 1.0)
    assert arrow is not None
    assert arrow.shaft == pytest.approx((0.4, 0.01))
    assert arrow.head == pytest.approx((0.1, 0.04))
    assert arrow.direction == (-0.5, 0.0, 0.0)


def test_a_short_arrow_has_a_head_that_shrinks_with_it() -> None:
    arrow = frame_arrow((0.0, 0.05, 0.0), 1.0)
    assert arrow is not None
    assert arrow.head[0] == pytest.approx(0.005)
    assert arrow.shaft[0] == pytest.approx(0.045)


def test_frames_at_the_same_place_have_no_arrow() -> None:
    assert frame_arrow((0.0, 0.0, 0.0), 1.0) is None
    assert frame_arrow((0.0, 0.0, 0.001), 1.0) is None


def test_the_scale_changes_thickness_and_head_but_not_the_length() -> None:
    arrow = frame_arrow((0.0, 0.0, 1.0), 0.3)
    assert arrow is not None
    assert arrow.shaft[0] + arrow.head[0] == pytest.approx(1.0)
    assert arrow.shaft[1] == pytest.approx(0.003)
    assert arrow.head == pytest.approx((0.03, 0.012))


def test_a_head_longer_than_the_way_begins_behind_the_frame() -> None:
    """Marker Scale 50 and 1 m to the parent: from x = 5 the head goes to x = 0."""
    arrow = frame_arrow((1.0, 0.0, 0.0), 50.0)
    assert arrow is not None
    assert arrow.shaft[0] == pytest.approx(-4.0)
    assert arrow.head[0] == pytest.approx(5.0)
    corners = arrow_triangles((arrow,)).vertices[:, 0]
    assert corners.max() == pytest.approx(5.0 + 0.009 * 5)
    assert corners.min() == pytest.approx(0.009 * 5)


def test_a_negative_scale_lets_the_head_point_back_from_behind_the_parent() -> None:
    arrow = frame_arrow((1.0, 0.0, 0.0), -1.0)
    assert arrow is not None
    corners = arrow_triangles((arrow,)).vertices
    widest = np.abs(corners[:, 1]).max()
    base = corners[np.abs(corners[:, 1]) == widest]
    assert widest == pytest.approx(0.02)
    assert np.allclose(base[:, 0], -0.1 - 0.009 * 0.1)
