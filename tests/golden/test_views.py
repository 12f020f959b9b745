"""Every type of view against a picture of RViz's 3D view.

The pictures were recorded with RViz 1, whose cylinders and spheres have more sides
than RViz 2's and whose names are drawn with another font: that is what a few pixels
in a thousand may differ by. A camera that is off by half a degree differs by ten
times as many.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pytest
from pictures import picture

if TYPE_CHECKING:
    from shared_page import SharedPage

pytestmark = pytest.mark.browser

DATA = Path(__file__).parent / "data"
VISIBLE = 32
"""A channel that differs by more is another colour to the eye (0 to 255)."""
ALLOWED = 0.004
"""Part of the pixels that may differ so."""


@pytest.mark.parametrize(
    "name",
    [
        "view_fps",
        "view_orbit_focal",
        "view_orbit_invert_z",
        "view_topdown",
        "view_wide",
        "view_xyorbit",
    ],
)
def test_the_picture_is_the_one_rviz_draws(shared_page: SharedPage, name: str) -> None:
    folder = DATA / name
    golden = picture(folder / "render.png")
    model, config = DATA / "view_robot.urdf", folder / "config.rviz"
    with shared_page.shows(model=model, config=config) as session:
        ours = shared_page.picture(session, golden.shape)
    difference = np.abs(ours - golden).max(axis=2)
    assert (difference > VISIBLE).mean() < ALLOWED
