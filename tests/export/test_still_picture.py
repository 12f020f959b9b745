"""The picture of a robot that is drawn without a browser."""

from __future__ import annotations

import io
from pathlib import Path

import numpy as np
import pytest
from inside import session_of
from lower_limit import lower
from PIL import Image

from sambot_viz import Visualizer, load_robot
from sambot_viz.export.still_picture import SIZE, still_picture

BOX = """<robot name="box"><link name="base"><visual>
<geometry><box size="2 2 2"/></geometry>
<material name="blue"><color rgba="0 0 1 1"/></material>
</visual></link></robot>"""


def shown(text: str, tmp_path: Path) -> np.ndarray | None:
    path = tmp_path / "robot.urdf"
    path.write_text(text, "utf-8")
    with Visualizer(load_robot(path)) as viz:
        session = session_of(viz)
        file = still_picture(session.lock, session.document_view, session.scene)
    if file is None:
        return None
    assert len(file) < 50_000
    return np.asarray(Image.open(io.BytesIO(file))).astype(int)


def test_a_robot_is_drawn_in_its_colours_and_each_side_has_its_own_light(
    tmp_path: Path,
) -> None:
    picture = shown(BOX, tmp_path)
    assert picture is not None
    assert picture.shape == (SIZE[1], SIZE[0], 3)
    assert picture[0, 0].tolist() == [48, 48, 48]
    blue = picture[picture[..., 2] > 100]
    assert 0.1 < len(blue) / (SIZE[0] * SIZE[1]) < 0.7
    assert (blue[:, :2] < 60).all()
    # Three sides of a box are seen, each from another angle.
    assert np.ptp(blue[:, 2]) > 20


def test_what_is_behind_is_hidden(tmp_path: Path) -> None:
    visual = BOX[BOX.index("<visual>") : BOX.index("</link>")]
    inner = visual.replace("2 2 2", "1 1 1").replace("0 0 1 1", "1 0 0 1")
    inner = inner.replace("blue", "red")
    picture = shown(BOX.replace("</link>", f"{inner}</link>"), tmp_path)
    assert picture is not None
    assert not ((picture[..., 0] > 60) & (picture[..., 2] < 40)).any()


def test_nothing_to_see_and_too_much_give_no_picture(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert shown('<robot name="r"><link name="a"/></robot>', tmp_path) is None
    lower(monkeypatch, "NOTEBOOK_TRIANGLES", 11)
    assert shown(BOX, tmp_path) is None
