"""What belongs to one browser alone: its tool, its selection, its camera."""

from __future__ import annotations

from collections.abc import Generator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

import viser

from sambot_viz.rviz import ViewConfig
from sambot_viz.session.shared_state import Event, Listener
from sambot_viz.session.tool_control import ToolControl
from sambot_viz.views.camera import Camera, Vector
from sambot_viz.views.view import View

if TYPE_CHECKING:
    from sambot_viz.session import Session


class Browser:
    """One browser of a session.

    Args:
        session: what it is shown.
        client: viser's handle of it.

    Attributes:
        client: viser's handle of it.
        client_id: its number.
        listeners: called after a change of its tools ("tools") or of its view ("view"),
            with the session locked.
        tools: its current tool, selection and measurement.
    """

    def __init__(self, session: Session, client: viser.ClientHandle) -> None:
        self.client = client
        self.client_id = client.client_id
        self.listeners: list[Listener] = []
        self._session = session
        self.tools = ToolControl(session, self)
        self.view = BrowserView(session)

    @contextmanager
    def change(self, *events: Event) -> Generator[None]:
        """Change what belongs to this browser; send it together; notify listeners."""
        with self._session.lock:
            with self.client.atomic():
                yield
                for event in events:
                    self._session.call(self.listeners, event)
            self.client.flush()

    @property
    def camera(self) -> Camera:
        """Its camera, in the fixed frame."""
        return self._session.views.camera_of(self.client_id)

    def look_at(self, point: Vector) -> None:
        """Turn its camera to a point of the fixed frame, (3,) [m]."""
        self._session.views.look_at(point, self.client_id)

    def close(self) -> None:
        """It has left: follow the session no longer."""
        self.tools.close()


class BrowserView:
    """The camera of a browser; until each has its own, that of the session."""

    def __init__(self, session: Session) -> None:
        self._session = session

    @property
    def view(self) -> View:
        """The current view."""
        return self._session.views.view

    def set(self, path: str, value: Any) -> None:
        """Set a property of the current view."""
        self._session.views.set(path, value)

    def set_kind(self, kind: str) -> None:
        """Choose a type of view."""
        self._session.views.set_kind(kind)

    def zero(self) -> None:
        """Bring the view to where RViz's "Zero" brings it."""
        self._session.views.zero()

    def save(self) -> ViewConfig:
        """Add the current view to the saved ones."""
        return self._session.views.save()

    def use(self, saved: ViewConfig) -> None:
        """Make a copy of a saved view the current one."""
        self._session.views.use(saved)

    def rename(self, saved: ViewConfig, name: str) -> None:
        """Give a saved view another name."""
        self._session.views.rename(saved, name)

    def remove(self, saved: ViewConfig) -> None:
        """Remove a saved view from the document."""
        self._session.views.remove(saved)
