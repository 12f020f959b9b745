"""The view of a session, and the cameras of its browsers.

A session has one view, the current one of its .rviz document; each browser has its
own camera. What is set in the Views panel (a type, a number, Zero, a saved view)
moves the cameras of all browsers. A mouse moves the camera of its own browser, and the
document takes over the values of the camera that moved last. With `follow_presenter`,
all other cameras follow that one.
"""

from __future__ import annotations

import math
from functools import partial
from typing import TYPE_CHECKING, Any

import viser

from sambot_viz.errors import UsageError
from sambot_viz.rviz import FIXED_FRAME, ViewConfig
from sambot_viz.rviz.config_findings import ConfigFindings
from sambot_viz.rviz.yaml.nodes import copied_map
from sambot_viz.session.browser_camera import BrowserCamera, same_picture
from sambot_viz.session.throttle import Throttle
from sambot_viz.views.camera import Camera, Vector
from sambot_viz.views.orbit import OrbitView
from sambot_viz.views.registry import VIEWS
from sambot_viz.views.view import WORLD, Target, Values, View

if TYPE_CHECKING:
    from sambot_viz.session import Event, Session

READ_PERIOD = 0.1
"""The document follows a moving camera this often [s]."""
DIGITS = 7
"""Decimals that are kept of what a mouse has moved [m, rad]."""


class ViewControl:
    """Keeps the current view and the cameras of all browsers in agreement.

    Args:
        session: the session whose view it is.

    Attributes:
        follow_presenter: whether all cameras follow the one that moved last.
    """

    def __init__(self, session: Session) -> None:
        self.follow_presenter = False
        self._session = session
        self._browsers: dict[int, BrowserCamera] = {}
        self._target = WORLD
        self._view: tuple[ViewConfig, View] | None = None
        self._mover: int | None = None
        self._reader = Throttle(session.worker, READ_PERIOD, self._read)
        session.listeners.append(self._hear)

    def close(self) -> None:
        """Stop reading cameras."""
        self._reader.close()

    # Asking

    @property
    def view(self) -> View:
        """The current view; one of an unknown type is shown as Orbit."""
        item = self._session.config.view
        if self._view is None or self._view[0] is not item:
            known = VIEWS.get(item.kind)
            self._view = (item, known(item) if known else _as_orbit(item))
        return self._view[1]

    @property
    def supported(self) -> bool:
        """Whether the current view's type is known."""
        return self._session.config.view.kind in VIEWS

    @property
    def camera(self) -> Camera:
        """The camera of the current view, in the fixed frame."""
        return self.view.camera(self._find_target())

    def camera_of(self, client_id: int) -> Camera:
        """The camera of a browser; that of the view for a browser that has left."""
        browser = self._browsers.get(client_id)
        return self.camera if browser is None else browser.camera

    # Browsers

    def join(self, client: viser.ClientHandle) -> None:
        """Give a browser that opened the page the current view.

        A page that comes back after a broken connection keeps the view it has.
        """
        browser = BrowserCamera(client)
        with self._session.lock:
            self._browsers[client.client_id] = browser
            self._target = self._find_target()
            if browser.is_fresh or (
                browser.camera.orthographic != self.view.orthographic
            ):
                browser.point(self.camera)

        take_over = partial(self._camera_moved, client.client_id)

        async def moved(handle: viser.CameraHandle) -> None:
            del handle
            self._session.worker.post(take_over, latest_of=browser)

        client.camera.on_update(moved)

    def leave(self, client_id: int) -> None:
        """A browser has closed the page."""
        with self._session.lock:
            self._browsers.pop(client_id, None)

    # Changing the view of the session

    def set(self, path: str, value: Any) -> None:
        """Set a property of the current view, and move all cameras."""
        with self._session.change("view"):
            view = self.view
            if path == "Target Frame":
                before = self._find_target()
                view.config.set(path, value)
                self._target = self._find_target()
                # The picture stays as it is, except for a turn of the target.
                offset = before.position - self._target.position
                self._apply(view.shifted(offset))
                if not view.follows_yaw:
                    return
            else:
                view.config.set(path, value)
            self._point_all()

    def set_kind(self, kind: str) -> None:
        """Choose a type of view; the new one takes over what the old one showed.

        Raises:
            UsageError: an unknown type.
        """
        if kind not in VIEWS:
            known = ", ".join(VIEWS)
            raise UsageError(f"there is no view type '{kind}'; there are {known}")
        with self._session.change("view"):
            old, config = self.view, self._session.config
            frame = old.config.get("Target Frame")
            new = config.set_view_class(kind)
            view = VIEWS[kind](new)
            # As in RViz, all other values start at their defaults.
            for path, declared in new.declared.items():
                if path in new.properties and path != "Target Frame":
                    new.set(path, declared.property.default)
            new.set("Target Frame", frame)
            self._apply(view.mimic(old))
            self._point_all()

    def zero(self) -> None:
        """Bring the current view to where RViz's "Zero" brings it."""
        with self._session.change("view"):
            self._apply(self.view.zero())
            self._point_all()

    def show(self) -> None:
        """Move all cameras to the current view, out of another document for example."""
        with self._session.change("view"):
            self._target = self._find_target()
            self._point_all()

    def look_at(self, point: Vector, client_id: int | None = None) -> None:
        """Look at a point of the fixed frame.

        Args:
            point: (3,) [m].
            client_id: the browser whose camera turns; None turns all.
        """
        with self._session.change("view"):
            target = self._find_target()
            browser = None if client_id is None else self._browsers.get(client_id)
            if browser is not None:
                self._apply(self.view.read(browser.camera, target))
            self._apply(self.view.look_at(point, target))
            self._show(browser)

    # The saved views

    def save(self) -> ViewConfig:
        """Add the current view to the saved ones, named after its type."""
        with self._session.change("view"):
            return self._session.config.save_view()

    def use(self, saved: ViewConfig) -> None:
        """Make a copy of a saved view the current one."""
        with self._session.change("view"):
            self._session.config.use_view(saved)
            self._target = self._find_target()
            self._point_all()

    def rename(self, saved: ViewConfig, name: str) -> None:
        """Give a saved view another name; an empty one changes nothing."""
        if name.strip():
            with self._session.change("view"):
                saved.rename(name.strip())

    def remove(self, saved: ViewConfig) -> None:
        """Remove a saved view from the document."""
        with self._session.change("view"):
            self._session.config.remove_view(saved)

    # Inside

    def _apply(self, values: Values) -> None:
        for path, value in values.items():
            self.view.config.set(path, value)

    def _show(self, browser: BrowserCamera | None) -> None:
        """Move one camera to the current view, or all."""
        if browser is None or self.follow_presenter:
            self._point_all()
        else:
            browser.point(self.camera)

    def _point_all(self, besides: BrowserCamera | None = None) -> None:
        camera = self.camera
        for browser in self._browsers.values():
            if browser is not besides:
                browser.point(camera)

    def _camera_moved(self, client_id: int) -> None:
        """A browser reports its camera; most reports are echoes of what we sent."""
        with self._session.lock:
            browser = self._browsers.get(client_id)
            if browser is None or not browser.take():
                return
            self._mover = client_id
        self._reader.request()

    def _read(self) -> None:
        """The document takes over the camera that moved last."""
        with self._session.lock:
            mover, self._mover = self._mover, None
            browser = None if mover is None else self._browsers.get(mover)
            if browser is None or same_picture(browser.camera, self.camera):
                return
            with self._session.change("view"):
                self._apply(_rounded(self.view.read(browser.camera, self._target)))
                if self.follow_presenter:
                    self._point_all(besides=browser)

    def _hear(self, event: Event) -> None:
        if event in ("joints", "frames", "robot"):
            self._follow_target()

    def _follow_target(self) -> None:
        """Move all cameras with the target frame."""
        if not self._browsers:
            return
        before, now = self._target, self._find_target()
        if not now.same_as(before):
            self._target = now
            for browser in self._browsers.values():
                browser.point(self.view.moved(browser.camera, before, now))

    def _find_target(self) -> Target:
        """The target frame in the fixed one; its last pose when it has none now."""
        session = self._session
        fixed, name = session.context.fixed_frame, self.view.config.get("Target Frame")
        if name in (FIXED_FRAME, fixed):
            return WORLD
        if not session.tree.can_lookup(fixed, str(name)):
            return self._target
        T = session.tree.lookup(fixed, str(name)).matrix
        return Target(T[:3, 3], math.atan2(T[1, 0], T[0, 0]))


def _rounded(values: Values) -> Values:
    """Values without their last digits, which a page changes at random."""
    return {path: _round(value) for path, value in values.items()}


def _round(value: Any) -> Any:
    if isinstance(value, float):
        return round(value, DIGITS)
    x, y, z = value
    return (round(x, DIGITS), round(y, DIGITS), round(z, DIGITS))


def _as_orbit(item: ViewConfig) -> View:
    """An Orbit view in place of an unknown type, whose own values stay unchanged."""
    copy = copied_map(item.node)
    return OrbitView(ViewConfig(copy, OrbitView.properties, ConfigFindings(None)))
