"""Pictures from the command line have exactly the size that was asked for."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from sambot_viz import Visualizer
from sambot_viz.cli import main

BACKGROUND = (48, 48, 48)
pytestmark = pytest.mark.browser


def body_of(pixels: np.ndarray) -> int:
    """How many rows the robot's body covers; it is cyan, and grid and names are not."""
    body = (pixels[..., 1] > pixels[..., 0] + 40) & (pixels[..., 2] > 100)
    return int(np.ptp(np.flatnonzero(body.any(axis=1))))


def test_a_narrow_picture_is_filled_and_the_robot_10_m_away_as_in_rviz(
    tmp_path: Path,
) -> None:
    """viser lays pages below 600 pixels out for phones; the picture stays whole."""
    file = tmp_path / "narrow.png"
    words = ["-o", str(file), "--size", "200x420", "--joint", "drivewhl_l_joint=0.7"]
    assert main(["snapshot", *words]) == 0
    assert [path.name for path in tmp_path.iterdir()] == ["narrow.png"]
    with Image.open(file) as image:
        assert image.size == (200, 420)
        pixels = np.asarray(image.convert("RGB")).astype(int)
    corners = pixels[[0, 0, -1, -1], [0, -1, 0, -1]]
    assert np.abs(corners - BACKGROUND).max() <= 1
    drawn = np.abs(pixels - BACKGROUND).max(axis=-1) > 12
    assert drawn.mean() > 0.02
    assert 4 < body_of(pixels) < 420 / 10


def test_the_robot_fills_the_picture_where_it_is_to_fit(tmp_path: Path) -> None:
    file = tmp_path / "robot.png"
    assert main(["snapshot", "-o", str(file), "--size", "320x240", "--fit"]) == 0
    with Image.open(file) as image:
        pixels = np.asarray(image.convert("RGB")).astype(int)
    assert 240 / 3 < body_of(pixels) < 240 * 0.75


def test_a_program_takes_a_picture_with_its_own_nodes_in_it(
    make_viz: Callable[..., Visualizer], tmp_path: Path
) -> None:
    viz = make_viz(token="a-secret-word")
    viz.viser.scene.add_box(
        "/own", color=(255, 0, 255), dimensions=(0.2, 0.2, 0.2), position=(0, 0, 0.4)
    )
    viz.camera.look_at((0.0, 0.0, 0.4), (2.0, 0.0, 0.4))
    file = tmp_path / "own.png"
    viz.snapshot(file, size=(160, 120))
    with Image.open(file) as image:
        assert image.size == (160, 120)
        pixels = np.asarray(image.convert("RGB")).astype(int)
    red, green, blue = pixels[60, 80]
    assert min(red, blue) > green + 100
