"""The camera that viser reports of a page: what is one, and what is none."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest
import viser

from sambot_viz.session.clients.viser_camera import camera_of


def a_camera() -> SimpleNamespace:
    """4 m from the origin on the x axis, looking at the origin."""
    return SimpleNamespace(
        wxyz=(0.5, -0.5, -0.5, 0.5),
        position=(4.0, 0.0, 0.0),
        look_at=(0.0, 0.0, 0.0),
        up_direction=(0.0, 0.0, 1.0),
        fov=0.785,
        image_height=480,
    )


@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf, 1e13, None, "north"])
@pytest.mark.parametrize("name", ["wxyz", "position", "look_at", "up_direction", "fov"])
def test_what_is_not_made_of_finite_numbers_is_no_camera(name: str, bad: Any) -> None:
    reported = a_camera()
    good = getattr(reported, name)
    setattr(reported, name, (*good[:-1], bad) if isinstance(good, tuple) else bad)
    assert camera_of(cast(viser.CameraHandle, reported)) is None


@pytest.mark.parametrize(
    ("name", "values"),
    [
        ("wxyz", (0.0, 0.0, 0.0, 0.0)),
        ("wxyz", (1.0, 0.0, 0.0)),
        ("look_at", (4.0, 0.0, 0.0)),
        ("position", 3.0),
    ],
)
def test_numbers_without_a_direction_are_no_camera(name: str, values: Any) -> None:
    reported = a_camera()
    setattr(reported, name, values)
    assert camera_of(cast(viser.CameraHandle, reported)) is None
