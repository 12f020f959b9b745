"""Keeps a robot that is driven in the picture of the browser that drives it."""

from __future__ import annotations

from itertools import product
from typing import TYPE_CHECKING

import numpy as np

from sambot_viz.views.camera import Vector, vector

if TYPE_CHECKING:
    from sambot_viz.session import Browser, Session

ROOM = 0.9
"""So much of the floor round the robot is in the picture when it starts [m]."""
MIDDLE = 0.8
"""A robot that leaves this part of the picture is brought back to its middle."""


class DriverView:
    """The picture of the browser that drives.

    The camera stays where its user has put it, and moves only when the robot drives out
    of the picture.

    Args:
        session: whose robot is driven.
    """

    def __init__(self, session: Session) -> None:
        self._session = session
        self._driver: int | None = None
        self._before: Vector | None = None

    def begin(self) -> None:
        """The browser that acts at the moment drives from now on."""
        self._driver = self._session.history.actor

    def make_room(self) -> None:
        """Show the floor round the robot, as RViz's user would do by the wheel."""
        browser, box = self._browser, self._session.rays.robot_box()
        if browser is None or box is None:
            return
        aside = vector(ROOM, ROOM, 0.0)
        low, high = box[0] - aside, box[1] + aside
        corners = (np.where(upper, high, low) for upper in product((0, 1), repeat=3))
        if not all(_shows(browser, corner) for corner in corners):
            browser.view.fit((low, high))

    def follow(self, place: Vector | None) -> None:
        """Bring the robot back when it leaves the picture by its own motion.

        Args:
            place: of the robot in the fixed frame [m]; None when it has none.
        """
        before, self._before = self._before, place
        browser = self._browser
        if browser is None or before is None or place is None:
            return
        if _shows(browser, before, MIDDLE) and not _shows(browser, place, MIDDLE):
            away = place - browser.view.camera.look_at
            browser.view.pan(vector(away[0], away[1], 0.0))

    @property
    def _browser(self) -> Browser | None:
        return (
            None if self._driver is None else self._session.browsers.get(self._driver)
        )


def _shows(browser: Browser, point: Vector, part: float = 1.0) -> bool:
    window = browser.client.camera
    width, height = max(1, window.image_width), max(1, window.image_height)
    return browser.view.camera.shows(point, width, height, part)
