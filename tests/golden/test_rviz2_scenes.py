"""Displays beside the pictures of RViz 2's own visual tests, read in the collection.

Its tests look with a camera that has no light of its own: what is lit has the colours
that the collection has computed for a light along the camera. Three measures:

- outline: of the pixels at the border of what is drawn, in either picture, the part
  that has such a pixel of the other within two pixels;
- far: how many pixels of what is drawn are farther than two pixels from what the other
  picture has, as a part of all;
- patches: of the pixels in the middle of a flat patch, the part that has the same
  colour within 8 of 255.
"""

from __future__ import annotations

import json
import os
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from pictures import (
    SAME,
    Image,
    Mask,
    dilated,
    drawn,
    flat,
    near_part,
    outlined,
    picture,
)

if TYPE_CHECKING:
    from shared_page import SharedPage

pytestmark = pytest.mark.browser

SCENES = Path(__file__).resolve().parents[2].parent / "shared/data/rviz2"
NEEDS_SHARED = "needs the collection ../shared, which is not beside this checkout"
PACKAGES = (SCENES / "packages",)
PIXELS = 2
LISTED: list[dict[str, Any]] = (
    json.loads((SCENES / "scenes.json").read_text()) if SCENES.is_dir() else []
)
NOT_DRAWN = {
    "test_image_display_with_published_image": "the panel: tests/browser/test_images",
}
OTHER_LIGHT = {"test_marker_with_multiple_marker_types": np.s_[:180, 240:520]}
"""Rows and columns where light and shade of a mesh make the outlines of the test."""
LIKE_ANOTHER = {
    "accels_are_displayed",
    "illuminance_display_high_illuminance",
    "map_display_costmap_scheme",
    "odometry_covariance_orientation",
    "pointcloud2_containing_one_big_point",
    "pointcloud_containing_one_big_point",
    "pose_display_with_axes",
    "relative_humidity_display_low_relative_humidity",
    "temperature_display_high_temperature",
    "test_with_three_points",
}
"""Scenes of what others show, too: ``SAMBOT_VIZ_ALL_GOLDEN=1`` adds them."""
LEFT_OUT = set() if os.environ.get("SAMBOT_VIZ_ALL_GOLDEN") == "1" else LIKE_ANOTHER
NAMES = [one["name"] for one in LISTED if one["name"] not in {*NOT_DRAWN, *LEFT_OUT}]


def predicted(folder: Path, golden: Image) -> tuple[Image, Mask]:
    """The colours under a light along the camera, and where they are known."""
    from PIL import Image as Pillow

    path = folder / "predicted_headlight.png"
    if not path.exists():
        return golden, np.ones(golden.shape[:2], bool)
    with Pillow.open(path) as opened:
        rgba = np.asarray(opened.convert("RGBA"), np.int16)
    return rgba[..., :3], rgba[..., 3] > 0


@pytest.mark.skipif(not SCENES.is_dir(), reason=NEEDS_SHARED)
@pytest.mark.parametrize("name", NAMES)
def test_the_picture_is_that_of_rviz_2(shared_page: SharedPage, name: str) -> None:
    folder = SCENES / name
    golden = picture(folder / "reference.png")
    ours = shared_page.end_of_recording(folder, golden.shape, PACKAGES)
    scene = next(one for one in LISTED if one["name"] == name)
    background = np.array(scene["background"], np.int16)
    both = [drawn(one[1:-1, 1:-1], background) for one in (ours, golden)]
    far = sum((a & ~dilated(b, PIXELS)).sum() for a, b in (both, both[::-1]))
    assert far <= 0.0005 * sum(mask.sum() for mask in both)
    edges = [outlined(mask) for mask in both]
    if name in OTHER_LIGHT:
        for edge in edges:
            edge[OTHER_LIGHT[name]] = False
    assert not any(edge.any() for edge in edges) or near_part(*edges, PIXELS) >= 0.97
    colors, known = predicted(folder, golden)
    patches = flat(colors) & known & drawn(golden, background)
    same = np.abs(ours - colors).max(axis=-1) <= SAME
    assert same[patches].sum() >= 0.995 * patches.sum()
