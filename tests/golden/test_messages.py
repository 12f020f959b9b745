"""Displays of messages beside the pictures of the real RViz (recorded by the project).

Four measures for every case:

- probes: the pixels whose colour a formula of RViz says, and that are in a flat place
  of its picture, have that colour within 3 of 255 in ours;
- patches: of the pixels in the middle of a flat patch of RViz's picture, the part that
  has the same colour within 8 of 255 in ours;
- colours: of the pixels that differ from the background in RViz's picture, the part
  that has a pixel of about that colour in ours within one pixel (thin lines and dots
  are smoothed differently);
- outline: of the pixels that differ from the background in one picture, the part that
  has such a pixel of the other within one pixel.
"""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt
import pytest
from pictures import (
    SAME,
    Image,
    Mask,
    counting,
    drawn,
    flat,
    near_part,
    picture,
)

if TYPE_CHECKING:
    from shared_page import SharedPage

pytestmark = pytest.mark.browser

DATA = Path(__file__).parent / "messages"
COLLECTION = Path(__file__).resolve().parents[2].parent / "shared/data/golden-data"
PACKAGES = (COLLECTION / "golden_meshes",) if COLLECTION.is_dir() else ()
NEEDS_SHARED = "needs the collection ../shared, which is not beside this checkout"
IN_PLACE = ("marker_mesh", "marker_mesh_tint", "tf_moved")
"""Cases that are drawn where the collection has them."""
PROBED, ABOUT, MOST_COLORS = 3, 40, 0.9
BACKGROUND = 48


@dataclass(frozen=True)
class Limits:
    """The least a case may reach, and why it is not 1."""

    outline: float = 0.99
    reason: str = ""


CASES = {folder.name: Limits() for folder in sorted(DATA.iterdir())}
CASES |= {name: Limits() for name in IN_PLACE}
CASES["marker_text"] = Limits(
    outline=0.97, reason="the letters of RViz 1 are 3.7 % smaller than RViz 2's"
)


def probes(folder: Path) -> list[dict[str, Any]]:
    path = folder / "values.json"
    if not path.exists():
        return []
    return [p for p in json.loads(path.read_text())["probes"] if p["flat_3x3"]]


def outline(ours: Image, golden: Image, counts: Mask) -> float:
    return near_part(*(drawn(one, BACKGROUND) & counts for one in (ours, golden)))


def test_lines_in_the_plane_of_a_costmap_are_in_front_of_it(
    shared_page: SharedPage,
) -> None:
    """The outline of a footprint is green, and the costmap is blended over the rest."""
    folder = DATA / "nav2_scene_top"
    golden = picture(folder / "render.png")
    ours = shared_page.end_of_recording(folder, golden.shape, PACKAGES)

    def green(image: Image) -> int:
        red, green, blue = (image[..., channel] for channel in range(3))
        return int(((green > 180) & (red < 90) & (blue < 90)).sum())

    # The two smooth thin lines differently; behind the costmap it is a seventh.
    assert green(ours) > 0.6 * green(golden)


def colors(ours: Image, golden: Image, counts: Mask) -> float:
    wanted = drawn(golden, BACKGROUND) & counts
    height, width = wanted.shape
    padded = np.pad(ours, ((1, 1), (1, 1), (0, 0)), "edge")
    found = np.zeros_like(wanted)
    for y in range(3):
        for x in range(3):
            near = padded[y : y + height, x : x + width]
            found |= np.abs(near - golden).max(axis=-1) <= ABOUT
    return float((found & wanted).sum() / max(1, wanted.sum()))


def patches(ours: Image, golden: Image, counts: Mask) -> float:
    wanted = flat(golden) & drawn(golden, BACKGROUND) & counts
    same = np.abs(ours - golden).max(axis=-1) <= SAME
    # Lines of one pixel have no flat patch.
    return float(same[wanted].mean()) if wanted.any() else 1.0


@pytest.mark.parametrize("name", list(CASES))
def test_the_picture_is_rvizs(shared_page: SharedPage, name: str) -> None:
    limits = CASES[name]
    folder = (COLLECTION if name in IN_PLACE else DATA) / name
    if not folder.is_dir():
        pytest.skip(NEEDS_SHARED)
    golden = picture(folder / "render.png")
    ours = shared_page.end_of_recording(folder, golden.shape, PACKAGES)
    counts = counting(folder, golden)
    # A line along the border belongs to the picture or does not, by a rounding.
    counts[[0, -1]] = counts[:, [0, -1]] = False
    assert outline(ours, golden, counts) >= limits.outline, limits.reason
    assert colors(ours, golden, counts) >= MOST_COLORS
    assert patches(ours, golden, counts) >= 0.99
    wrong = [
        (probe["name"], ours[y, x].tolist(), probe["render_rgb"])
        for probe in probes(folder)
        for x, y in [probe["xy"]]
        if np.abs(ours[y, x] - np.array(probe["render_rgb"])).max() > PROBED
    ]
    assert not wrong


def box(found: Image, area: tuple[slice, slice]) -> npt.NDArray[np.float64]:
    """Left, top, right and bottom of what is coloured in a part of a picture."""
    bright = found[area].max(axis=-1)
    rows, columns = np.nonzero(bright > (bright.max() + BACKGROUND) / 2)
    top, left = area[0].start, area[1].start
    right, bottom = left + columns.max() + 1, top + rows.max() + 1
    return np.array((left + columns.min(), top + rows.min(), right, bottom), float)


def color(part: Image) -> npt.NDArray[np.float64]:
    """The colour of letters, away from their edges and from lines below them."""
    bright = part.max(axis=-1)
    inside = bright > BACKGROUND + 0.8 * (np.percentile(bright, 99) - BACKGROUND)
    return np.asarray(np.median(part[inside], axis=0), float)


TEXTS = {
    "Robot_1": (slice(90, 160), slice(200, 440)),
    "two lines": (slice(200, 290), slice(120, 300)),
    "Ag": (slice(245, 360), slice(340, 560)),
}


def test_texts_have_the_boxes_and_colours_of_rviz(shared_page: SharedPage) -> None:
    """RViz 2's letters are 0.889 of the height of a line, the recording's 0.857."""
    folder = DATA / "marker_text"
    golden = picture(folder / "render.png")
    found = shared_page.end_of_recording(folder, golden.shape)
    for text, area in TEXTS.items():
        us, them = box(found, area), box(golden, area)
        assert (us[:2] + us[2:]) / 2 == pytest.approx((them[:2] + them[2:]) / 2, abs=2)
        larger = 0.889 / 0.857
        width, height = them[2:] - them[:2]
        # One line is as far below the other in both.
        height *= 1.0 if text == "two lines" else larger
        assert us[2:] - us[:2] == pytest.approx((width * larger, height), abs=2)
    # Half of (0, 255, 255) over the background; the recording's letters are blurred.
    assert color(found[TEXTS["Ag"]]) == pytest.approx((24, 151.5, 151.5), abs=3)
    assert color(golden[TEXTS["Ag"]]) == pytest.approx((24, 151.5, 151.5), abs=12)
