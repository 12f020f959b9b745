"""The camera of one browser: which reports of a page are taken over."""

from __future__ import annotations

import contextlib
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest
import viser

from sambot_viz.session.clients.camera import ClientCamera
from sambot_viz.views.camera import UP, Camera, vector


def looking_from(x: float) -> Camera:
    """A camera on the x axis that looks at the origin."""
    return Camera(vector(x, 0.0, 0.0), vector(0.0, 0.0, 0.0), UP)


def test_what_was_reported_before_another_camera_was_sent_is_no_answer_to_it() -> None:
    reported = a_camera()
    client = SimpleNamespace(
        camera=reported, atomic=contextlib.nullcontext, flush=lambda: None
    )
    browser = ClientCamera(cast(viser.ClientHandle, client))
    late = browser.report()
    browser.point(looking_from(5.0))
    browser.point(looking_from(6.0))
    assert not browser.take(late)
    # viser's handle has the camera that was sent; the page may not have it yet.
    reported.position = (5.0, 0.0, 0.0)
    assert not browser.take(browser.report())
    assert browser.camera.position == pytest.approx((6.0, 0.0, 0.0))


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
    assert not browser.take(browser.report())
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
    assert not browser.take(browser.report())
    assert browser.camera is before
