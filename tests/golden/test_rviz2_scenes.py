"""Displays of messages beside the reference pictures of RViz 2's own tests.

The pictures are read where they are. RViz 2's tests light a scene from the side, and
we light it from the camera, so hues are compared and not their brightness.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt
import pytest
from pictures import Image, dilated, drawn, end_of_recording, picture

if TYPE_CHECKING:
    from sambot_viz.export.chromium import Chromium

pytestmark = pytest.mark.browser

SCENES = Path(__file__).resolve().parents[2].parent / "shared/data/rviz2"
BACKGROUND = 48
SHOWN = (
    "accels_are_displayed",
    "camera_info_displayed",
    "wrenches_are_displayed",
)
BRIGHT = 90
"""From here on a pixel has a hue, whatever is mixed in at an edge."""


def hues(image: Image) -> npt.NDArray[np.float64]:
    return image / image.max(axis=-1, keepdims=True).clip(1)


@pytest.mark.parametrize("name", SHOWN)
def test_the_scene_is_rviz2s(chromium: Chromium, name: str) -> None:
    folder = SCENES / name
    if not folder.exists():
        pytest.skip(f"no {folder}")
    golden = picture(folder / "reference.png")
    ours = end_of_recording(chromium, folder, golden.shape)
    theirs, found = drawn(golden, BACKGROUND), drawn(ours, BACKGROUND)
    assert not (found & ~dilated(dilated(theirs))).any()
    assert not (theirs & ~dilated(dilated(found))).any()
    bright = (np.minimum(ours.max(axis=-1), golden.max(axis=-1)) > BRIGHT) & found
    off = np.abs(hues(ours) - hues(golden)).max(axis=-1)[bright]
    assert not off.size or np.median(off) < 0.02
    assert (off < 0.2).sum() >= 0.99 * off.size
