"""How far two frames are from each other."""

from __future__ import annotations

import math

import pytest

from sambot_viz.frames import FrameTree, LookupRefused, Transform
from sambot_viz.frames.distance import distance_between


def test_the_offset_is_along_the_axes_of_the_first_frame() -> None:
    tree = FrameTree()
    quarter = (0.0, 0.0, math.pi / 2)
    tree.set_static("base", "left", Transform.from_xyz_rpy((0, 0.2, 0.1), quarter))
    tree.set_static("base", "right", Transform.from_xyz_rpy((0.3, -0.2, 0.1)))
    found = distance_between(tree, "left", "right")
    assert found.length == pytest.approx(0.5)
    assert found.offset == pytest.approx((-0.4, -0.3, 0.0))
    back = distance_between(tree, "right", "left")
    assert back.length == pytest.approx(0.5)
    assert back.offset == pytest.approx((-0.3, 0.4, 0.0))


def test_frames_without_a_connection_are_refused() -> None:
    tree = FrameTree()
    tree.set_static("base", "left", Transform.from_xyz_rpy((0, 0.2, 0.1)))
    with pytest.raises(LookupRefused, match="nowhere"):
        distance_between(tree, "left", "nowhere")
