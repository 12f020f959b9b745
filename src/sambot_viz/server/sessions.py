"""The sessions that browsers see: one for all, one for each, and copies of it."""

from __future__ import annotations

import logging
import threading
from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import dataclass
from functools import partial
from typing import cast

import viser

from sambot_viz import viser_private
from sambot_viz.errors import Problem, ServerError
from sambot_viz.joints.presets import Presets
from sambot_viz.meshes.asset import Asset
from sambot_viz.meshes.cache import MeshCache
from sambot_viz.options import Options
from sambot_viz.panels.files import Files
from sambot_viz.panels.pictures import AskPage
from sambot_viz.panels.row_store import ClientRows
from sambot_viz.panels.window import Window
from sambot_viz.robot.model import Robot
from sambot_viz.rviz import RvizConfig
from sambot_viz.server import reload_problems
from sambot_viz.server.connection import ClientContext, Connection
from sambot_viz.server.links import invite
from sambot_viz.server.mesh_thread import MeshThread
from sambot_viz.server.model_thread import ModelThread
from sambot_viz.session import Audience, Reloaded, Session
from sambot_viz.session.session_copy import SessionCopy
from sambot_viz.session.signals import connect
from sambot_viz.session.worker import Worker

_log = logging.getLogger(__name__)

MakeConfig = Callable[[], RvizConfig]


@dataclass(eq=False)
class _Place:
    """A thread, the session that lives in it, and its window, as they come."""

    worker: Worker
    session: Session | None = None
    window: Window | None = None
    left: bool = False


class Sessions:
    """The sessions of a server, each with a thread and a window of its own.

    Args:
        server: whose browsers see them.
        options: what every session begins with.
        make_config: a fresh .rviz document; called once per session.
        models: reads other models, for a RobotModel from a file.
        poses: the named poses; a private session has a copy that writes no file.
        files: opens and follows .rviz files for the shared session; None leaves Open
            and Save out.
        ask_page: makes a page of what is seen; None leaves that out.

    Attributes:
        options: what every session begins with.
        meshes: what was read of mesh files, for all of them.
        opened: the robot that was shown last.
        robot: what is shown in all of them that have no model of their own: the opened
            one, with those that a program has added.
        assemble: makes the second of the first.
        on_joined: called when a client has its rows, in any thread.
        on_files: called after other files may be shown than before, in any thread.
    """

    def __init__(
        self,
        server: viser.ViserServer,
        options: Options,
        make_config: MakeConfig,
        models: ModelThread | None,
        poses: Presets | None,
        files: Files | None,
        ask_page: AskPage | None,
    ) -> None:
        self._server = server
        self.options = options
        self._make_config = make_config
        self._models = models
        self._poses = poses or Presets()
        self._files = files
        self._ask_page = ask_page
        self.on_files: Callable[[], object] = lambda: None
        self.meshes = MeshCache()
        self.meshes.on_read = self._tell_files
        self._mesh_thread = MeshThread(self.meshes, self._drawing_failed)
        self.opened: Robot | None = None
        self.robot: Robot | None = None
        self.assemble: Callable[[Robot], Robot] = lambda robot: robot
        self._reload_problems: dict[Reloaded, tuple[Problem, ...]] = {}
        # By client, and with None that of all; changed under the lock.
        self._places: dict[int | None, _Place] = {}
        self._lock = threading.RLock()
        self._joined = threading.Condition()
        self._closed = False
        self._followers: list[Callable[[Session], object]] = []
        self.on_joined: Callable[[], object] = lambda: None

    @property
    def shared(self) -> Session | None:
        """The session of all browsers; None when each has its own."""
        return self._places[None].session if None in self._places else None

    def open_shared(self) -> None:
        """Open the session of all browsers.

        Raises:
            FrameError: static transforms that form a ring.
        """
        place = self._add_place(None)
        place.session = self._open(self._server, place.worker)
        place.session.roles.end_connection = self._end_connection

    def close(self) -> None:
        """End all sessions and their threads."""
        with self._lock:
            self._closed = True
            places = list(self._places.values())
        for place in places:
            if place.session is not None:
                place.session.close()
            place.worker.close()
        self._mesh_thread.close()

    def require_open(self) -> None:
        """Raise ServerError after `close`: nobody would see what a program changes."""
        if self._closed:
            raise ServerError("it was stopped; make a new Visualizer")

    def all(self, *, copies: bool = True) -> list[Session]:
        """All sessions there are at the moment.

        Args:
            copies: also those that browsers have made of the shared one.
        """
        if not copies and self.shared is not None:
            return [self.shared]
        with self._lock:
            places = list(self._places.values())
        return [place.session for place in places if place.session is not None]

    def follow(self, action: Callable[[Session], object]) -> None:
        """Call an action once with every session, present and to come; not copies."""
        # A session that opens meanwhile is in one of both, and in no more.
        with self._lock:
            self._followers.append(action)
            present = self.all(copies=False)
        for session in present:
            action(session)

    def for_each(
        self, action: Callable[[Session], object], *, copies: bool = True
    ) -> None:
        """Call an action with every session; one that fails does not stop the others.

        Args:
            action: what to do.
            copies: as for `all`.

        Raises:
            Exception: the first error of the action, after the last session.
        """
        errors: list[Exception] = []
        for session in self.all(copies=copies):
            try:
                action(session)
            except Exception as error:
                errors.append(error)
        if errors:
            raise errors[0]

    def show_robot(self, robot: Robot) -> None:
        """Show a robot in every session, present and to come, without its own model."""
        with self._lock:
            self.opened = robot
            self.robot = robot = self.assemble(robot)
        self.on_files()
        try:
            self.for_each(lambda session: session.show_robot(robot))
        finally:
            self._forget_unused_files()
            self.for_each(lambda session: session.checks.run())

    def show_again(self) -> None:
        """Show the opened robot, after `assemble` makes something else of it."""
        if self.opened is not None:
            self.show_robot(self.opened)

    def _tell_files(self) -> None:
        self.on_files()

    def show_panels(self) -> None:
        """Add the panels to the shared session, unless it has them or is to have none.

        Call it after `show_robot`: a browser draws what it receives in order, and the
        panels take it longer than the robot.
        """
        if self.shared is not None:
            self._add_panels(self._places[None], self.shared)

    def _add_panels(self, place: _Place, session: Session) -> None:
        # A model that is being read may change the displays while panels are made.
        with session.lock:
            if self.options.panels and place.window is None:
                # Visitors with a session of their own do not use the server's disk.
                shared = session is self.shared
                place.window = Window(
                    session,
                    self.options.gui,
                    self._files if shared else None,
                    self._ask_page,
                    partial(invite, self.options) if shared else None,
                )
        self.on_joined()

    def refresh(self) -> None:
        """Draw again what comes from mesh files and textures that have changed."""
        try:
            self.for_each(lambda session: session.scene.refresh())
        finally:
            self._forget_unused_files()

    def _forget_unused_files(self) -> None:
        """Let go of meshes and textures that no session draws any more."""
        used = (session.scene.context.assets.used for session in self.all())
        self.meshes.keep_only(set[Asset]().union(*used))

    def _drawing_failed(self, error: Exception) -> None:
        """Show that a session could not draw what the mesh thread has read."""
        self.set_reload_problems("fault", (reload_problems.drawing_failed(error),))

    def set_reload_problems(self, of: Reloaded, problems: Sequence[Problem]) -> None:
        """Show in every session, present and to come, why a save is not shown."""
        with self._lock:
            self._reload_problems[of] = tuple(problems)
        try:
            self.for_each(lambda s: s.problems.set_saves(of, problems))
        except Exception:
            # What was saved is shown to the others all the same.
            _log.exception("a session could not show the problems of a save")

    def wait_for_page(self, ticket: str, timeout: float) -> viser.ClientHandle:
        """The client of a page, as soon as it is there.

        Args:
            ticket: which page (see `ClientContext`).
            timeout: how long to wait [s].

        Raises:
            ServerError: it did not come in time.
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

    def wait_for_meshes(self, timeout: float) -> None:
        """Return when every model, mesh file and texture is read and drawn.

        Args:
            timeout: for each session [s].

        Raises:
            ServerError: that took longer.
        """
        if self._models is not None and not self._models.wait(timeout):
            raise ServerError(f"a model was not read within {timeout:g} s")
        for session in self.all():
            if not session.scene.context.assets.wait(timeout):
                raise ServerError(f"the meshes were not read within {timeout:g} s")

    def _open(
        self, audience: object, worker: Worker, copy: SessionCopy | None = None
    ) -> Session:
        if copy is not None:
            config, poses = copy.config, copy.poses
        else:
            config, poses = self._make_config(), self._poses
            poses = poses if audience is self._server else poses.in_memory()
        session = Session(
            cast(Audience, audience),
            worker,
            config,
            self.meshes,
            self._models,
            self._mesh_thread,
            self.options,
            poses,
        )
        connect([session.scene.statuses], self._tell_files)
        if copy is not None:
            session.prepare(copy)
        session.document.show()
        own = copy is not None and copy.own_model
        robot = copy.robot if copy is not None and own else self.robot
        if robot is not None:
            session.show_robot(robot, own=own)
            worker.post(session.checks.run)
        if copy is not None:
            session.take(copy)
        return session

    def take_edit(self, client_id: int, edit: object) -> None:
        """Give an edit of a browser to the window of its session."""
        window = self._window_of(client_id)
        if window is not None:
            window.receive(client_id, edit)

    def rows_of(self, client_id: int) -> ClientRows | None:
        """Return the rows that a client sees; None when it has none yet."""
        window = self._window_of(client_id)
        return None if window is None else window.rows_of(client_id)

    def may_edit(self, client_id: int) -> bool:
        """Whether a browser may use the widgets of a program, which all have."""
        return self.shared is None or self.shared.roles.may_edit(client_id)

    def behind(self, client_id: int, action: Callable[[], None]) -> None:
        """Run an action behind what a browser has caused in its session."""
        place = self._place_of(client_id)
        action() if place is None else place.worker.post(action, client=client_id)

    def _place_of(self, client_id: int) -> _Place | None:
        return self._places.get(client_id) or self._places.get(None)

    def _window_of(self, client_id: int) -> Window | None:
        place = self._place_of(client_id)
        return None if place is None else place.window

    def _add_place(self, client_id: int | None) -> _Place:
        place = _Place(Worker(self._server.get_event_loop()))
        self._places[client_id] = place
        return place

    def _end_connection(self, client_id: int) -> None:
        """Close the page of a client, which is not to come back by itself."""

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
            # It has left already.
            return ClientContext()
        return cast(Connection, connection).context

    def has_copy(self, client_id: int) -> bool:
        """Whether a browser sees a copy, and so nothing of the shared session."""
        return self.shared is not None and self._context(client_id).copy

    async def join(self, client: viser.ClientHandle) -> None:
        """A browser has opened the page."""
        viser_private.allow_late_messages(client)
        shared, context = self.shared, self._context(client.client_id)
        if shared is not None and not context.copy:
            shared.worker.post(
                partial(self._give_view, shared, client, context),
                client=client.client_id,
            )
            return
        with self._lock:
            if self._closed:
                return
            place = self._add_place(client.client_id)
        open_private = partial(self._open_private, client, place)
        if shared is None:
            place.worker.post(open_private)
        else:
            # Copied under the lock of all, and drawn in the thread of one.
            shared.worker.post(
                lambda: place.worker.post(partial(open_private, shared.copy())),
                client=client.client_id,
            )

    def _give_view(
        self, session: Session, client: viser.ClientHandle, context: ClientContext
    ) -> None:
        session.join(client, presenter=context.presenter, login=context.login)
        with self._joined:
            self._joined.notify_all()
        self.on_joined()

    def _open_private(
        self, client: viser.ClientHandle, place: _Place, copy: SessionCopy | None = None
    ) -> None:
        """Draw the session of one browser; its worker runs this and has its lock.

        A robot that is shown in all sessions meanwhile waits for that lock once this
        session is known, and so comes after what is shown here.
        """
        if place.left:
            return
        session = self._open(client, place.worker, copy)
        with self._lock:
            place.session = session
            followers = () if copy is not None else tuple(self._followers)
            robot, problems = self.robot, dict(self._reload_problems)
        for action in followers:
            action(session)
        self.on_files()
        if robot is not None and robot is not session.robot.model:
            session.show_robot(robot)
        for of, found in problems.items():
            session.problems.set_saves(of, found)
        self._add_panels(place, session)
        self._give_view(session, client, ClientContext())

    async def leave(self, client: viser.ClientHandle) -> None:
        """A browser has closed the page: a session of its own ends."""
        place = self._places.get(client.client_id)
        if place is not None:
            # A session that has not begun to open stays closed.
            place.left = True
            # Behind one that opens at the moment: this must not wait on the loop.
            # Behind what it has sent.
            close = partial(self._close_private, client.client_id, place)
            place.worker.post(close, client=client.client_id)
        elif (shared := self.shared) is not None:
            leave = partial(shared.leave, client.client_id)
            shared.worker.post(leave, client=client.client_id)

    def _close_private(self, client_id: int, place: _Place) -> None:
        with self._lock:
            del self._places[client_id]
        self.on_files()
        if place.window is not None:
            place.window.close()
        if place.session is not None:
            place.session.close()
        place.worker.close()
