"""The camera of one browser: which reports of a page are taken over."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest
import viser

from sambot_viz.session.clients.camera import ClientCamera


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
def test_a_camera_that_is_not_made_of_finite_numbers_changes_nothing(
    name: str, bad: Any
) -> None:
    reported = a_camera()
    browser = ClientCamera(cast(viser.ClientHandle, SimpleNamespace(camera=reported)))
    before = browser.camera
    reported.position = (7.0, 1.0, 2.0)
    good = getattr(reported, name)
    setattr(reported, name, (*good[:-1], bad) if isinstance(good, tuple) else bad)
    assert not browser.take()
    assert browser.camera is before


@pytest.mark.parametrize(
    ("name", "values"),
    [
        ("wxyz", (0.0, 0.0, 0.0, 0.0)),
        ("wxyz", (1.0, 0.0, 0.0)),
        ("look_at", (4.0, 0.0, 0.0)),
        ("position", 3.0),
    ],
)
def test_numbers_that_are_not_a_camera_change_nothing(name: str, values: Any) -> None:
    reported = a_camera()
    browser = ClientCamera(cast(viser.ClientHandle, SimpleNamespace(camera=reported)))
    before = browser.camera
    setattr(reported, name, values)
    assert not browser.take()
    assert browser.camera is before
