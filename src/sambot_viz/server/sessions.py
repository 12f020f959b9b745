"""All sessions of a server: their shared state, and actions in each of them."""

from __future__ import annotations

import threading
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import cast

import viser

from sambot_viz.errors import Problem, ServerError
from sambot_viz.joints.presets import Presets
from sambot_viz.meshes.asset import Asset
from sambot_viz.meshes.cache import MeshCache
from sambot_viz.options import Options
from sambot_viz.outlet import logger
from sambot_viz.panels.window import Window
from sambot_viz.robot.model import Robot
from sambot_viz.rviz import RvizConfig
from sambot_viz.server import reload_problems
from sambot_viz.server.mesh_thread import MeshThread
from sambot_viz.server.model_thread import ModelThread
from sambot_viz.server.reference import ReferenceModel
from sambot_viz.session import Audience, Reloaded, Session
from sambot_viz.session.editor.model_files import ModelFiles
from sambot_viz.session.editor.model_text import ModelText
from sambot_viz.session.model_edits import ModelEdits
from sambot_viz.session.session_copy import SessionCopy
from sambot_viz.session.signals import connect
from sambot_viz.session.worker import Worker
from sambot_viz.topics.source_robot import SourceRobot

_log = logger(__name__)

MakeConfig = Callable[[], RvizConfig]


@dataclass(eq=False)
class SessionPlace:
    """A thread, its session, and the session's window, as they are created."""

    worker: Worker
    session: Session | None = None
    window: Window | None = None


class Sessions:
    """The sessions of a server: one for all clients, and those of single clients.

    Args:
        server: the server, whose browsers see the sessions.
        options: start state of every session.
        make_config: returns a fresh .rviz document; called once per session.
        models: reads other models, for a RobotModel from a file.
        poses: the named poses; a private session has a copy that writes no file.
        moved_by: the robot of a live source, or of a recording, which every session
            plays for itself.

    Attributes:
        lock: guards the list of sessions, and the start state of new ones.
        closed: set at the end; no session opens after it.
        options: start state of every session.
        meshes: contents of mesh files, shared by all sessions.
        opened: last robot that was shown.
        robot: the opened robot with the robots that a program has added; sessions
            without a private model show it.
        assemble: makes `robot` from `opened`.
        edits: writes fixes into the model's files, where browsers may; only in the
            shared session.
        model_files: the model's files that browsers see; None without a file.
        reference: model with which all sessions can compare theirs; None for none.
        on_files: called when the set of shown files may have changed, in any thread.
    """

    def __init__(
        self,
        server: viser.ViserServer,
        options: Options,
        make_config: MakeConfig,
        models: ModelThread | None,
        poses: Presets | None,
        moved_by: SourceRobot | None = None,
    ) -> None:
        self._moved_by = moved_by
        self._server = server
        self.options = options
        self._make_config = make_config
        self._models = models
        self._poses = poses or Presets()
        self.on_files: Callable[[], object] = lambda: None
        self.edits: ModelEdits | None = None
        self.model_files: ModelFiles | None = None
        self.reference: ReferenceModel | None = None
        self.meshes = MeshCache()
        self.meshes.on_read = self._tell_files
        self._mesh_thread = MeshThread(self.meshes, self._drawing_failed)
        self.opened: Robot | None = None
        self.robot: Robot | None = None
        self.assemble: Callable[[Robot], Robot] = lambda robot: robot
        self._reload_problems: dict[Reloaded, tuple[Problem, ...]] = {}
        self._followers: list[Callable[[Session], object]] = []
        self._places: dict[int | None, SessionPlace] = {}
        self.lock = threading.RLock()
        self.closed = False

    # Places

    def add_place(self, client_id: int | None) -> SessionPlace:
        """Create the place of a client; None for the shared place."""
        place = SessionPlace(Worker(self._server.get_event_loop()))
        with self.lock:
            self._places[client_id] = place
        return place

    def remove_place(self, client_id: int) -> None:
        """Forget the place of a client."""
        with self.lock:
            del self._places[client_id]

    @property
    def shared_place(self) -> SessionPlace | None:
        """The shared place; None when each client has a private one."""
        return self._places.get(None)

    def own_place(self, client_id: int) -> SessionPlace | None:
        """Return the private place of a client; None when it has none."""
        return self._places.get(client_id)

    def place_of(self, client_id: int) -> SessionPlace | None:
        """Return the place of a client, private or shared."""
        return self.own_place(client_id) or self.shared_place

    @property
    def shared(self) -> Session | None:
        """The shared session; None when each client has a private one."""
        place = self.shared_place
        return None if place is None else place.session

    @property
    def copies(self) -> int:
        """The number of private sessions."""
        with self.lock:
            places = list(self._places.items())
        return sum(n is not None and p.session is not None for n, p in places)

    def close(self) -> None:
        """End all sessions and their threads."""
        with self.lock:
            self.closed = True
            places = list(self._places.values())
        for place in places:
            if place.session is not None:
                with place.session.lock:
                    if place.window is not None:
                        place.window.close()
                place.session.close()
            place.worker.close()
        self._mesh_thread.close()

    def require_open(self) -> None:
        """Raise ServerError after `close`: no client would see a program's changes."""
        if self.closed:
            raise ServerError("it was stopped; make a new Visualizer")

    def all(self, *, copies: bool = True) -> list[Session]:
        """Return all sessions that exist now.

        Args:
            copies: include private copies of the shared session.
        """
        if not copies and self.shared is not None:
            return [self.shared]
        with self.lock:
            sessions = [place.session for place in self._places.values()]
        return [session for session in sessions if session is not None]

    # Actions in the sessions

    def follow(self, action: Callable[[Session], object]) -> None:
        """Call an action once with every session, present and future, but no copy."""
        # A session that opens meanwhile is in exactly one of the two lists.
        with self.lock:
            self._followers.append(action)
            present = self.all(copies=False)
        for session in present:
            action(session)

    @property
    def model_text(self) -> ModelText | None:
        """The texts of the session that may save them; None without one."""
        place = self.shared_place
        return None if place is None or place.window is None else place.window.text

    def for_each(
        self, action: Callable[[Session], object], *, copies: bool = True
    ) -> None:
        """Call an action with every session; a failure does not stop the others.

        Args:
            action: the action.
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
        """Show a robot in all sessions, present and future, without a private model."""
        with self.lock:
            self.opened = robot
            self.robot = robot = self.assemble(robot)
        self.on_files()
        try:
            self.for_each(lambda session: session.show_robot(robot))
        finally:
            self._forget_unused_files()
            self.for_each(lambda session: session.checks.run())

    def show_sources(
        self,
        session: Session | None,
        moved_by: SourceRobot,
        robot: Robot | None,
        document: RvizConfig | None,
    ) -> None:
        """Show other sources; copies of the shared session keep theirs.

        Args:
            session: the session; None for all, present and future.
            moved_by: the robot of the sources.
            robot: the robot in the sources; None shows the opened robot.
            document: the config; None keeps the shown one.
        """
        for_all = session is None or session is self.shared
        shown = self.all(copies=False) if session is None else [session]
        if for_all:
            self._take_sources(shown, moved_by, robot)
        own = robot is not None and not for_all
        if own and robot is not None:
            robot = self.assemble(robot)
        for one in shown:
            config = document
            if config is not None and one is not self.shared:
                config = config.copy()
            one.replace_sources(moved_by, robot if own else self.robot, config, own=own)
        self.on_files()
        self._forget_unused_files()
        for one in shown:
            one.checks.run()

    def _take_sources(
        self, shown: Sequence[Session], moved_by: SourceRobot, robot: Robot | None
    ) -> None:
        """Start new sessions with other sources; others keep their robot."""
        for other in self.all() if robot is not None else ():
            if other not in shown:
                with other.lock:
                    other.own_model = True
        with self.lock:
            self._moved_by = moved_by
            if robot is not None:
                self.opened = robot
                self.robot = self.assemble(robot)

    def show_reference(self) -> None:
        """Compare all sessions with the reference, after a new read of it."""
        self.on_files()
        try:
            self.for_each(self._give_reference)
        finally:
            self._forget_unused_files()

    def _give_reference(self, session: Session) -> None:
        reference = self.reference
        if reference is not None and reference.was_read:
            session.comparison.take_reference(reference.name, reference.robot)

    def show_again(self) -> None:
        """Show the opened robot again, after a change of `assemble`."""
        if self.opened is not None:
            self.show_robot(self.opened)

    def _tell_files(self) -> None:
        self.on_files()

    def refresh(self) -> None:
        """Redraw the contents of changed mesh files and textures."""
        try:
            self.for_each(lambda session: session.scene.refresh())
        finally:
            self._forget_unused_files()

    def _forget_unused_files(self) -> None:
        """Release meshes and textures that no session draws."""
        used = (session.scene.context.assets.used for session in self.all())
        self.meshes.keep_only(set[Asset]().union(*used))

    def _drawing_failed(self, error: Exception) -> None:
        """Report that a session could not draw what the mesh thread has read."""
        self.set_reload_problems("fault", (reload_problems.drawing_failed(error),))

    def set_reload_problems(self, of: Reloaded, problems: Sequence[Problem]) -> None:
        """Report in every session, present and future, why a save is not shown."""
        with self.lock:
            self._reload_problems[of] = tuple(problems)
        try:
            self.for_each(lambda s: s.problems.set_saves(of, problems))
        except Exception:
            # The other sessions show the save nevertheless.
            _log.exception("a session could not show the problems of a save")

    def wait_for_meshes(self, timeout: float) -> None:
        """Wait until every model, mesh file and texture is read and drawn.

        Args:
            timeout: longest wait for each session [s].

        Raises:
            ServerError: the wait took longer.
        """
        if self._models is not None and not self._models.wait(timeout):
            raise ServerError(f"a model was not read within {timeout:g} s")
        for session in self.all():
            if not session.comparison.wait(timeout):
                raise ServerError(f"models were not compared within {timeout:g} s")
            if not session.scene.context.assets.wait(timeout):
                raise ServerError(f"the meshes were not read within {timeout:g} s")

    def open(
        self, audience: object, worker: Worker, copy: SessionCopy | None = None
    ) -> Session:
        """Open a session that shows the shared state.

        Args:
            audience: the server, for all clients, or one client.
            worker: the session's thread.
            copy: state to start with instead.

        Raises:
            FrameError: the static transforms form a ring.
        """
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
            self._moved_by if copy is None else copy.moved_by,
        )
        if audience is self._server and session.data is not None:
            # Its pages have not come yet.
            session.data.rest()
        connect([session.scene.statuses, session.checks.files], self._tell_files)
        if copy is not None:
            session.prepare(copy)
        session.document.show()
        self._give_reference(session)
        own = copy is not None and copy.own_model
        robot = copy.robot if copy is not None and own else self.robot
        if robot is not None:
            _show(session, robot, own=own)
        if copy is not None:
            session.take(copy)
        return session

    def admit(self, place: SessionPlace, session: Session, *, copied: bool) -> None:
        """Add a session to the list of all; the worker of its place calls this.

        A robot that all sessions start to show meanwhile waits for the session's lock,
        which the worker holds, and so appears after this one.

        Args:
            place: place of the session.
            session: the new session.
            copied: whether it is a copy of the shared session.
        """
        with self.lock:
            place.session = session
            followers = () if copied else tuple(self._followers)
            robot, problems = self.robot, dict(self._reload_problems)
        for action in followers:
            action(session)
        self.on_files()
        self._give_reference(session)
        if robot is not None and robot is not session.robot.model:
            _show(session, robot)
        for of, found in problems.items():
            session.problems.set_saves(of, found)


def _show(session: Session, robot: Robot, *, own: bool = False) -> None:
    """Show a robot in a session that opens; the findings of the rules come later."""
    session.show_robot(robot, own=own)
    session.worker.post(session.checks.run)
