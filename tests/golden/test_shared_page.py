"""The page in which all scenes are shown forgets each of them."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pytest

if TYPE_CHECKING:
    from shared_page import SharedPage

pytestmark = pytest.mark.browser

SCENES = Path(__file__).parent / "messages"
NAMES = ("marker_text", "cloud_styles_top", "map_orbit", "marker_triangles", "effort")
"""Letters, points, textures, triangles, and a robot with its joints."""


def test_a_scene_looks_the_same_before_and_after_others(
    shared_page: SharedPage,
) -> None:
    def picture(name: str) -> bytes:
        return shared_page.end_of_recording(SCENES / name, (480, 640)).tobytes()

    first = {name: picture(name) for name in NAMES}
    assert len(set(first.values())) == len(NAMES)
    for name in reversed(NAMES):
        assert picture(name) == first[name], name


def test_nothing_of_a_scene_is_left_for_the_next_one(shared_page: SharedPage) -> None:
    from sambot_viz.inputs import declarations
    from sambot_viz.rviz import RvizConfig

    shared_page.end_of_recording(SCENES / NAMES[0], (480, 640))
    nothing = RvizConfig.parse(
        "Visualization Manager:\n  Displays: []\n", declarations()
    )
    with shared_page.shows(config=nothing) as session:
        picture = shared_page.picture(session, (48, 64))
    assert np.ptp(picture, axis=(0, 1)).tolist() == [0, 0, 0]
