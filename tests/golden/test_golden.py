"""Our pictures beside those of the real RViz (recorded by the project).

Three measures for every case, each with a limit and the reason for it:

- silhouette: of what differs from the background in either picture, the part that
  does in both (intersection over union);
- patches: of the pixels in the middle of a flat patch of RViz's picture, the part
  that has the same colour within 8 of 255 in ours;
- lines: of the pixels that differ from the background in one picture, the part that
  has such a pixel of the other within one pixel. Grid lines are one pixel wide, and
  the two renderers smooth them differently, so this is what says where they are.

The recordings are RViz 1's; we draw RViz 2's coarser round shapes, with 16 sides
instead of 40: a silhouette then lacks up to 2 % of the
radius, and facets are seen where RViz 1 has a smooth shade.

``SAMBOT_VIZ_ALL_GOLDEN=1`` adds all other recordings of the collection.
"""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt
import pytest
import yaml
from pictures import SAME, Image, Mask, counting, drawn, flat, near_part, picture

if TYPE_CHECKING:
    from shared_page import SharedPage

pytestmark = pytest.mark.browser

DATA = Path(__file__).parent / "data"
COLLECTION = Path(__file__).resolve().parents[2].parent / "shared/data/golden"


@dataclass(frozen=True)
class Limits:
    """The least a case may reach, and why it is not 1."""

    silhouette: float
    patches: float
    lines: float
    reason: str


LINES = "one-pixel lines are smoothed differently; their places are what counts"
ROUND = "16 sides where the recording has 40"
CASES = {
    "grid_default": Limits(0.91, 0.99, 0.999, LINES),
    "grid_normal_2": Limits(0.93, 0.99, 0.999, LINES),
    "grid_billboards": Limits(0.88, 0.99, 0.999, LINES),
    "robot_alpha_1": Limits(0.99, 0.99, 0.998, ROUND),
    "robot_alpha_06_grid": Limits(0.98, 0.99, 0.998, f"{ROUND}; {LINES}"),
    "link_alpha_axes": Limits(0.98, 0.99, 0.998, ROUND),
    "collision_only": Limits(0.99, 0.99, 0.998, ROUND),
    "materials": Limits(0.99, 0.99, 0.998, ROUND),
    "multi_visual": Limits(0.985, 0.99, 0.998, ROUND),
    "primitives": Limits(0.965, 0.99, 0.995, f"{ROUND}, and the sphere is large"),
    "fixed_frame_missing": Limits(0.98, 0.99, 0.998, LINES),
    "tf_scale_03_no_names": Limits(0.93, 0.99, 0.998, f"{ROUND}; arrows are thin"),
    "axes_display": Limits(0.93, 0.99, 0.998, f"{LINES}; {ROUND}"),
}
ELSEWHERE = Limits(0.85, 0.0, 0.85, "what has no limits of its own: a coarse net")
NOT_OURS = {
    "mesh_missing": "a mesh that is missing is marked by a box of orange lines here",
    "seed_no_joint_states": "without joint states, wheels have poses here",
    "tf_names_only_empty_scene": "RViz draws nothing, an accident",
    "tf_names_only": "RViz 1's letters are smaller and hang lower",
    "tf_scale_03": "RViz 1's letters are smaller and hang lower",
    "tf_scale_03_no_axes": "RViz 1's letters are smaller and hang lower",
    "tf_scale_1": "RViz 1's letters are smaller and hang lower",
}


def names() -> list[str]:
    """The cases to compare."""
    if os.environ.get("SAMBOT_VIZ_ALL_GOLDEN") != "1":
        return list(CASES)
    folders = sorted(p.name for p in (COLLECTION / "images").iterdir() if p.is_dir())
    return [*CASES, *(n for n in folders if n not in CASES and not _left_out(n))]


def _left_out(name: str) -> bool:
    # Views have a file of tests of their own.
    return name in NOT_OURS or name.startswith("view_") or name == "tf_label_one"


def recorded(name: str) -> tuple[Path, dict[str, Any], Image, Mask]:
    """A case: its folder, what it says, RViz's picture, and which pixels count."""
    folder = DATA / name
    folder = folder if folder.is_dir() else COLLECTION / "images" / name
    case = yaml.safe_load((folder / "case.yaml").read_text())
    golden = picture(folder / "render.png")
    return folder, case, golden, counting(folder, golden)


def drawn_by_us(shared_page: SharedPage, folder: Path, case: dict[str, Any]) -> Image:
    """Our picture, of the size of the recording, through the config's own view."""
    size = case["camera"]["image_height"], case["camera"]["image_width"]
    shown = shared_page.shows(
        model=folder / "robot.urdf",
        config=folder / "config.rviz",
        package_path=[COLLECTION / "golden_meshes"] if COLLECTION.is_dir() else [],
    )
    with shown as session:
        assert session.robot.joints is not None
        free = session.robot.joints.free
        positions = case["joint_positions"].items()
        session.robot.set_positions({n: v for n, v in positions if n in free})
        return shared_page.picture(session, size)


def measures(ours: Image, golden: Image, counts: Mask, background: Image) -> Limits:
    """What a pair of pictures reaches."""
    a, b = drawn(ours, background) & counts, drawn(golden, background) & counts
    patches = flat(golden) & b
    same = np.abs(ours - golden).max(axis=-1) <= SAME
    return Limits(
        float((a & b).sum() / max(1, (a | b).sum())),
        float((same & patches).sum() / max(1, patches.sum())) if patches.any() else 1.0,
        near_part(a, b),
        "",
    )


@pytest.mark.parametrize("name", names())
def test_the_picture_is_rvizs(shared_page: SharedPage, name: str) -> None:
    folder, case, golden, counts = recorded(name)
    ours = drawn_by_us(shared_page, folder, case)
    assert ours.shape == golden.shape
    background = np.array(case["background_rgb"], np.int16)
    reached = measures(ours, golden, counts, background)
    limits = CASES.get(name, ELSEWHERE)
    assert reached.silhouette >= limits.silhouette, limits.reason
    assert reached.patches >= limits.patches, limits.reason
    assert reached.lines >= limits.lines, limits.reason


def box(image: Image) -> npt.NDArray[np.float64]:
    """Left, top, right and bottom of what is white: a name."""
    rows, columns = np.nonzero(image.min(axis=-1) > 150)
    sides = (columns.min(), rows.min(), columns.max() + 1, rows.max() + 1)
    return np.array(sides, float)


def test_a_name_has_the_box_of_rviz_2(shared_page: SharedPage) -> None:
    """RViz 2's letters are 0.0889 of the scale high, those of the recording 0.0857.

    Both are centred on the frame, in the font that comes with the page; RViz 2's
    baseline is 0.0667 of the scale below it, and its tall letters are 0.0630 high.
    """
    folder, case, golden, _ = recorded("tf_label_one")
    ours = drawn_by_us(shared_page, folder, case)
    us, them = box(ours), box(golden)
    meter = 600 / 2 / np.tan(np.pi / 8) / 1.5
    assert (us[0] + us[2]) / 2 == pytest.approx((them[0] + them[2]) / 2, abs=1)
    width = (them[2] - them[0]) * 0.0889 / 0.0857
    assert us[2] - us[0] == pytest.approx(width, abs=2)
    # The tops of the tall letters of the recording are 0.0607 of the scale high.
    assert them[1] == pytest.approx(300 + (0.0857 - 0.0607) * meter, abs=2)
    assert us[1] == pytest.approx(300 + (0.0667 - 0.0630) * meter, abs=2)
