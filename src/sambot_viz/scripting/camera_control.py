"""The camera as a program moves it: in all open pages, and in those that come."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

import numpy as np

from sambot_viz.errors import (
    FrameError,
    SambotVizError,
    UsageError,
    did_you_mean,
)
from sambot_viz.geometry import finite
from sambot_viz.rviz import FIXED_FRAME, ViewConfig
from sambot_viz.rviz.declarations import short_name
from sambot_viz.scripting.displays import first, for_all
from sambot_viz.server.sessions import Sessions
from sambot_viz.session import Session
from sambot_viz.views.camera import Vector, length
from sambot_viz.views.registry import VIEWS

NEAREST, FARTHEST = 1e-6, 1e9
"""From the camera to what it looks at, and from the origin to both [m]."""

Point = Sequence[float] | Vector | str
"""A point of the fixed frame (x, y, z) [m], or the name of a frame: its origin."""


class CameraControl:
    """Moves the camera of all open pages, and the first one of those to come.

    Values that are not given are taken from the page that was opened first. The Views
    panel shows the new numbers, and users may move their cameras afterwards. Users
    cannot undo these changes. Private copies keep their views.

    Every method raises ServerError while there is no session: with private sessions,
    before the first page is open.
    """

    def __init__(self, sessions: Sessions) -> None:
        self._sessions = sessions
        self._first: ViewConfig | None = None
        sessions.follow(self._begin)

    def look_at(self, target: Point, position: Point | None = None) -> None:
        """Turn the camera to a point, or put it somewhere and turn it to the point.

        Args:
            target: the middle of the picture: a point of the fixed frame (x, y, z) [m],
                or the name of a frame, at its present place.
            position: the new place of the camera, as a point or a frame; by default the
                present one. A view from above then becomes an orbit.

        Raises:
            UsageError: a number is not finite, or both are the same point.
            FrameError: a frame does not exist, or has no place in the fixed one.
        """

        def change(session: Session) -> None:
            point = _point(session, target)
            eye = None if position is None else _point(session, position)
            if eye is not None and length(eye - point) < NEAREST:
                raise UsageError("the camera cannot be in the point that it looks at")
            session.document_view.look_at(point, eye)

        self._change(change)

    def view(
        self, name: str | None = None, values: Mapping[str, object] | None = None
    ) -> None:
        """Choose a type of view or a saved view, and set numbers of it.

        Args:
            name: a type ("Orbit", "XYOrbit", "FPS", "TopDownOrtho") or the name of a
                saved view of the config; by default the present view stays.
            values: row of the Views panel → value, such as ``{"Distance": 2.0, "Yaw":
                0.5}``, in metres, radians and pixels per metre ("Scale").

        Raises:
            UsageError: no such view or value, or a value that it cannot have.
        """

        def change(session: Session) -> None:
            if name is not None:
                _choose(session, name)
            session.document_view.set(values or {})

        self._change(change)

    def follow(self, frame: str | None) -> None:
        """Move the camera with a frame from now on; the picture stays as it is.

        As in RViz, XYOrbit and TopDownOrtho turn with it, and other types do not.

        Args:
            frame: the target frame; None is the fixed frame, which does not move.

        Raises:
            FrameError: there is no such frame.
        """

        def change(session: Session) -> None:
            frames = session.frames.tree.frames
            if frame is not None and frame not in frames:
                near = did_you_mean(frame, frames)
                raise FrameError(f"there is no frame '{frame}'; {near}")
            session.document_view.follow(FIXED_FRAME if frame is None else frame)

        self._change(change)

    def _change(self, change: Callable[[Session], None]) -> None:
        """Change the view of every session; an error changes nothing in its session."""

        def change_one(session: Session) -> None:
            config = session.document.config
            before = config.detached_view()
            try:
                session.clients.store_view()
                change(session)
            except SambotVizError:
                config.store_view(before)
                raise
            session.clients.show_view()

        for_all(self._sessions, change_one)
        self._first = first(self._sessions).document.config.detached_view()

    def _begin(self, session: Session) -> None:
        """Let a private session that is opened now begin with the same view."""
        if self._first is not None:
            with session.lock:
                session.document.config.store_view(self._first)
                session.document.config.view.fill()


def _choose(session: Session, name: str) -> None:
    """Take a type of view, or a copy of a saved view."""
    kinds = {short_name(kind): kind for kind in VIEWS}
    saved = {view.name: view for view in session.document.config.saved_views}
    if name in kinds or name in VIEWS:
        session.document_view.set_kind(kinds.get(name, name))
    elif name in saved:
        session.document_view.use(saved[name])
    else:
        near = did_you_mean(name, [*kinds, *saved])
        raise UsageError(f"there is no view '{name}'; {near}")


def _point(session: Session, point: Point) -> Vector:
    """Return a point of the fixed frame, (3,) [m]."""
    if isinstance(point, str):
        return _origin(session, point)
    try:
        numbers = [finite(number) for number in point]
    except TypeError:
        numbers = []
    found = [n for n in numbers if n is not None and abs(n) < FARTHEST]
    if len(numbers) != 3 or len(found) != 3:
        raise UsageError(f"{point!r} is not a point: give x, y, z [m] or a frame")
    return np.array(found, np.float64)


def _origin(session: Session, frame: str) -> Vector:
    fixed = session.scene.context.fixed_frame
    return session.frames.tree.lookup(fixed, frame).matrix[:3, 3]
