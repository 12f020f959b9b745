"""Gives each client its session: the shared one, a private one or a private copy."""

from __future__ import annotations

import threading
from collections.abc import Callable
from contextlib import suppress
from functools import partial
from typing import TYPE_CHECKING, cast

import numpy as np
import viser

from sambot_viz import viser_private
from sambot_viz.errors import ServerError
from sambot_viz.panels.files_panel import Files
from sambot_viz.panels.rows.row_store import ClientRows
from sambot_viz.panels.saved_pictures import AskPage
from sambot_viz.panels.window import Window
from sambot_viz.server.connections.connection import ClientContext, Connection
from sambot_viz.server.invitation import invite
from sambot_viz.server.protection.client_messages import CameraReport
from sambot_viz.server.sessions import SessionPlace, Sessions
from sambot_viz.session import Session
from sambot_viz.session.clients.client_camera import reported
from sambot_viz.session.editor.model_text import ModelText
from sambot_viz.session.session_copy import SessionCopy
from sambot_viz.session.shown_lesson import ShownLesson

# Most servers show no recording.
if TYPE_CHECKING:
    from sambot_viz.server.recordings import Recordings


class ClientSessions:
    """The clients of a server: the session that each one sees and edits.

    Args:
        server: server of the clients.
        sessions: sessions of the server.
        files: opens and follows .rviz files for the shared session; None hides Open
            and Save.
        ask_page: exports the visible state as a page; None hides the export.
        recordings: opens other recordings than the shown ones; None hides that.
        on_joined: called when a client has its rows, in any thread.
    """

    def __init__(
        self,
        server: viser.ViserServer,
        sessions: Sessions,
        files: Files | None,
        ask_page: AskPage | None,
        recordings: Recordings | None,
        on_joined: Callable[[], object],
    ) -> None:
        self._server = server
        self._sessions = sessions
        self._options = sessions.options
        self._files = files
        self._ask_page = ask_page
        self._recordings = recordings
        self._on_joined = on_joined
        self._joined = threading.Condition()

    def open_shared(self) -> None:
        """Open the shared session.

        Raises:
            FrameError: the static transforms form a ring.
        """
        place = self._sessions.add_place(None)
        place.session = self._sessions.open(self._server, place.worker)
        place.session.roles.end_connection = self._end_connection

    def show_panels(self) -> None:
        """Add the panels to the shared session, unless it has or needs none.

        Call it after `show_robot`: browsers draw in the order of arrival, and panels
        take longer than the robot.
        """
        place = self._sessions.shared_place
        if place is not None and place.session is not None:
            self._add_panels(place, place.session)

    def _add_panels(self, place: SessionPlace, session: Session) -> None:
        options = self._options
        # A model in loading may change the displays while the panels are created.
        with session.lock:
            if options.panels and place.window is None:
                # Clients with a private session do not use the server's disk.
                shared = place is self._sessions.shared_place
                # Students share one server, whose disk and links belong to the teacher.
                at_home = shared and not options.in_class
                sessions, recordings = self._sessions, self._recordings
                edits, text = sessions.edits if shared else None, None
                if sessions.model_files is not None:
                    text = ModelText(
                        sessions.model_files,
                        session.robot,
                        session.checks,
                        session.problems,
                        session.saved,
                        session.show_edited,
                        session.change,
                        edits,
                    )
                place.window = Window(
                    session,
                    options.gui,
                    self._files if at_home else None,
                    self._ask_page,
                    partial(invite, options) if at_home else None,
                    None if recordings is None else recordings.of(sessions, session),
                    edits,
                    text,
                    self._lesson(session, text) if shared else None,
                )
        self._on_joined()

    def _lesson(self, session: Session, text: ModelText | None) -> ShownLesson | None:
        """Return the lesson of the shared session, which has a single student."""
        study = self._options.study
        if study is None:
            return None
        facts = [session.saved, *([] if text is None else [text.followed])]
        return ShownLesson(
            study, text, facts, session.change, session.problems.report_error
        )

    def take_edit(self, client_id: int, edit: object) -> None:
        """Pass an edit of a client to the window of its session."""
        window = self._window_of(client_id)
        if window is not None:
            window.receive(client_id, edit)

    def take_camera(self, client_id: int, report: CameraReport) -> None:
        """Pass a page's camera to its client; drop older reports that still wait."""
        place = self._sessions.place_of(client_id)
        camera = reported(
            np.array(report.position),
            np.array(report.look_at),
            np.array(report.up),
            report.fov,
            report.scale,
        )
        if place is not None and place.session is not None and camera is not None:
            take = partial(place.session.take_camera, client_id, report.camera, camera)
            place.worker.post(take, latest_of=CameraReport, client=client_id)

    def rows_of(self, client_id: int) -> ClientRows | None:
        """Return the rows of a client; None before it has any."""
        place = self._sessions.place_of(client_id)
        if place is None or place.session is None:
            return None
        if place.window is not None:
            return place.window.rows_of(client_id)
        client = place.session.clients.all.get(client_id)
        if client is None or self._options.panels:
            return None
        return ClientRows((), (client.view.shown,))

    def may_edit(self, client_id: int) -> bool:
        """Return whether a client may set a program's widgets, which all see."""
        shared = self._sessions.shared
        return shared is None or shared.roles.may_edit(client_id)

    def behind(self, client_id: int, action: Callable[[], None]) -> None:
        """Run an action after all effects of a client's messages in its session."""
        place = self._sessions.place_of(client_id)
        action() if place is None else place.worker.post(action, client=client_id)

    def _window_of(self, client_id: int) -> Window | None:
        place = self._sessions.place_of(client_id)
        return None if place is None else place.window

    def _end_connection(self, client_id: int) -> None:
        """Close the page of a client, and keep it from reconnecting."""

        def close() -> None:
            with suppress(KeyError):
                connection = viser_private.connection_of(self._server, client_id)
                cast(Connection, connection).removed = True
                connection.transport.abort()

        self._server.get_event_loop().call_soon_threadsafe(close)

    def _context(self, client_id: int) -> ClientContext:
        try:
            connection = viser_private.connection_of(self._server, client_id)
        except KeyError:
            # The client has already left.
            return ClientContext()
        return cast(Connection, connection).context

    def has_copy(self, client_id: int) -> bool:
        """Return whether a client sees a copy, and so nothing of the shared session."""
        return self._sessions.shared is not None and self._context(client_id).copy

    def wait_for_page(self, ticket: str, timeout: float) -> viser.ClientHandle:
        """Wait for the client of a page, and return it.

        Args:
            ticket: ticket of the page (see `ClientContext`).
            timeout: longest wait [s].

        Raises:
            ServerError: the client did not come in time.
        """

        def find() -> viser.ClientHandle | None:
            clients = self._server.get_clients().values()
            fitting = (
                c for c in clients if self._context(c.client_id).ticket == ticket
            )
            return next(fitting, None)

        with self._joined:
            found = self._joined.wait_for(find, timeout)
        if found is None:
            raise ServerError(f"no browser opened the page within {timeout:g} s")
        return found

    async def join(self, client: viser.ClientHandle) -> None:
        """Give a new client its session."""
        viser_private.allow_late_messages(client)
        shared, context = self._sessions.shared, self._context(client.client_id)
        if shared is not None and not context.copy:
            shared.worker.post(
                partial(self._give_view, shared, client, context),
                client=client.client_id,
            )
            return
        with self._sessions.lock:
            if self._sessions.closed:
                return
            place = self._sessions.add_place(client.client_id)
        open_private = partial(self._open_private, client, place)
        if shared is None:
            place.worker.post(open_private)
        else:
            # The shared session's lock covers the copying; the client's thread draws.
            shared.worker.post(
                lambda: place.worker.post(partial(open_private, shared.copy())),
                client=client.client_id,
            )

    def _give_view(
        self, session: Session, client: viser.ClientHandle, context: ClientContext
    ) -> None:
        if self._has_left(client):
            return
        session.join(
            client,
            presenter=context.presenter,
            login=context.login,
            only_looks=context.follows,
        )
        with self._joined:
            self._joined.notify_all()
        self._on_joined()

    def _open_private(
        self,
        client: viser.ClientHandle,
        place: SessionPlace,
        copy: SessionCopy | None = None,
    ) -> None:
        """Draw a private session; its worker calls this with its lock held."""
        if self._has_left(client):
            return
        session = self._sessions.open(client, place.worker, copy)
        self._sessions.admit(place, session, copied=copy is not None)
        self._add_panels(place, session)
        self._give_view(session, client, ClientContext())
        self._count_copies()

    def _count_copies(self) -> None:
        """Show users of the shared session how many private copies exist."""
        shared, sessions = self._sessions.shared, self._sessions
        if shared is not None:
            shared.worker.post(lambda: shared.roles.count_copies(sessions.copies))

    def _has_left(self, client: viser.ClientHandle) -> bool:
        """Return whether a client has left before its turn to join.

        `leave` is posted after viser has forgotten the client, so it runs after the
        joins of other clients.
        """
        return client.client_id not in self._server.get_clients()

    async def leave(self, client: viser.ClientHandle) -> None:
        """Remove a client that has left from its session; end its private session."""
        place = self._sessions.own_place(client.client_id)
        if place is not None:
            # Closing waits for a session that is opening, which the loop must not do,
            # and for all that the client has sent.
            close = partial(self._close_private, client.client_id, place)
            place.worker.post(close, client=client.client_id)
        elif (shared := self._sessions.shared) is not None:
            leave = partial(shared.leave, client.client_id)
            shared.worker.post(leave, client=client.client_id)

    def _close_private(self, client_id: int, place: SessionPlace) -> None:
        self._sessions.remove_place(client_id)
        self._count_copies()
        self._sessions.on_files()
        if place.window is not None:
            place.window.close()
        if place.session is not None:
            place.session.close()
        place.worker.close()
