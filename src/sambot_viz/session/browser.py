"""What belongs to one browser alone: its tool, its selection, its camera."""

from __future__ import annotations

from collections.abc import Generator
from contextlib import contextmanager
from typing import TYPE_CHECKING

import viser

from sambot_viz.session.shared_state import Event, Listener
from sambot_viz.session.tool_control import ToolControl
from sambot_viz.views.camera import Camera, Vector

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
