"""Shows saved files again: the model, its meshes and textures, and the config.

A save of a file beside the model, such as ekf.yaml, runs the checks again.

A save with a mistake never removes the robot: the last good one stays, with the problem
beside it, until a save fixes it. A file with a mistake at the start shows only its
problem, and the robot appears with the fix.
"""

from __future__ import annotations

import os.path
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path

from sambot_viz.displays.display import robot_displays
from sambot_viz.displays.robot_display import RobotDisplay
from sambot_viz.errors import ConfigError, JointError, Problem, RobotError
from sambot_viz.outlet import logger
from sambot_viz.robot.model import Robot, assets_of, something_missing
from sambot_viz.rviz import RvizConfig
from sambot_viz.rviz.yaml.yaml_nodes import Plain
from sambot_viz.server import reload_problems
from sambot_viz.server.config_store import Sources
from sambot_viz.server.sessions import Sessions
from sambot_viz.server.watch import FileWatcher, Watched
from sambot_viz.session import Session
from sambot_viz.session.signals import connect
from sambot_viz.text import text

_log = logger(__name__)


class Reloader:
    """Reloads what sessions show when its files are saved.

    Args:
        sessions: sessions that show the files.
        sources: the files, and the functions that read and show them.
        report: called with all problems of the model and the config whenever a save
            has changed them.
    """

    def __init__(
        self,
        sessions: Sessions,
        sources: Sources,
        report: Callable[[Sequence[Problem]], None] | None = None,
    ) -> None:
        self._sessions = sessions
        self._sources = sources
        self._report = report
        robot = sessions.robot
        files = () if robot is None else robot.files
        self._model = sources.model or next(iter(files), None)
        self._documents = sources.configs
        self._documents.on_open.append(self._opened)
        self._documents.on_save.append(self._ask_again)
        sessions.on_files = self._ask_again
        self._suspects: tuple[Path, ...] = ()
        self._of_model = () if robot is None else robot.problems
        self._of_config = self._documents.current.problems
        self._reported: tuple[Problem, ...] = ()
        self._watcher: FileWatcher | None = None
        self._end_waiting: list[Callable[[], None]] = []

    def start(self) -> None:
        """Follow the files from now on, and show saves since they were opened."""
        self._reported = self._problems()
        self._watcher = FileWatcher(
            self._watched,
            self._changed,
            self._cannot_watch,
            self._sources.opened,
        )
        self._watcher.start()

    def close(self) -> None:
        """Stop following the files."""
        self._wait_no_longer()
        if self._watcher is not None:
            self._watcher.close()

    # Watched files

    def _model_files(self) -> set[Path]:
        robot = self._sessions.robot
        return {*(() if robot is None else robot.files), *self._suspects}

    def _asset_files(self) -> set[Path]:
        others = (display.own_robot for display in self._displays())
        shown = (session.robot.model for session in self._sessions.all())
        reference = self._sessions.reference
        compared = None if reference is None else reference.robot
        known = (self._sessions.robot, compared, *shown, *others)
        # Many sessions show the same robot.
        robots = {id(robot): robot for robot in known if robot is not None}
        files = self._sessions.meshes.files
        return {
            f
            for robot in robots.values()
            for asset in assets_of(robot)
            for f in files(asset)
        }

    def _files_around(self) -> set[Path]:
        """Return the files that the checks compared with the model."""
        return {f for s in self._sessions.all() for f in s.checks.files.value}

    def _files_of_student(self) -> set[Path]:
        """Return a student's files and folders; a new file changes its folder."""
        study = self._sessions.options.study
        return set() if study is None else {*study.files()}

    def _files_of_reference(self) -> frozenset[Path]:
        reference = self._sessions.reference
        return frozenset() if reference is None else reference.files

    def _displays(self) -> Iterator[RobotDisplay]:
        for session in self._sessions.all():
            yield from robot_displays(session.scene.displays)

    def _watched(self) -> Watched:
        file = self._documents.file
        config = {file} if file is not None else set[Path]()
        own = {file for display in self._displays() for file in display.files}
        files = self._model_files() | self._asset_files() | config | own
        files |= self._files_around() | self._files_of_student()
        files |= self._files_of_reference()
        # A missing file may appear anywhere in the package.
        waits = self._waiting_for_files
        return Watched(frozenset(files), self._model if waits else None)

    def _ask_again(self) -> None:
        if self._watcher is not None:
            self._watcher.ask_again()

    @property
    def _waiting_for_files(self) -> bool:
        """Return whether a file that does not exist yet could fix a problem."""
        robot = self._sessions.robot
        return bool(self._suspects) or (robot is not None and something_missing(robot))

    # Actions

    def _changed(self, changed: frozenset[Path], appeared: frozenset[Path]) -> None:
        try:
            self._show_changed(changed, appeared)
        except Exception as error:
            _log.exception("internal error while reloading")
            problem = reload_problems.internal_error(error)
            self._sessions.set_reload_problems("fault", (problem,))

    def _show_changed(
        self, changed: frozenset[Path], appeared: frozenset[Path]
    ) -> None:
        model, assets = self._model_files(), self._asset_files()
        config = self._documents.file
        if config is not None and config in changed:
            self._reload_config(config)
        if self._sessions.options.study is not None:
            self._ask_again()
        if changed & self._files_of_reference():
            self._reload_reference()
        self._sessions.for_each(lambda session: session.files_saved(changed))
        gone = any(not os.path.isfile(path) for path in changed & assets)
        if self._model is None:
            return
        anew = gone or bool(appeared and self._waiting_for_files)
        if changed & model or anew:
            self._reload_model(self._model, anew=anew)
            return
        if changed & assets:
            self._sessions.refresh()
        if changed & self._files_around():
            self._sessions.for_each(lambda session: session.checks.run_again())

    def _reload_model(self, path: Path, *, anew: bool) -> None:
        """Show the model again.

        Args:
            path: the model file.
            anew: whether a file other than the model's own texts has come or gone.
        """
        try:
            if reload_problems.is_pipe(path):
                raise RobotError([reload_problems.unreadable("model-unreadable", path)])
            robot = self._load(path, anew=anew)
            is_first = self._sessions.robot is None
            if is_first:
                # The joints on the command line could not be checked before.
                self._sessions.options.start_pose.state(robot)
        except RobotError as error:
            self.refuse_model(error)
        except JointError as error:
            self.refuse_model(RobotError([reload_problems.start_pose(error)]))
        else:
            if self._watcher is None or self._watcher.closed:
                return
            self._suspects = ()
            self._sessions.set_reload_problems("model", ())
            self._sources.show(robot)
            self._sessions.set_reload_problems("fault", ())
            self._of_model = robot.problems
            self._describe(robot)
        self._report_changed()

    def _load(self, path: Path, *, anew: bool) -> Robot:
        session, text = self._sessions.shared, self._sessions.model_text
        known = None
        if session is not None and text is not None:
            with session.lock:
                if anew:
                    text.forget()
                # The saved text may be loaded already.
                known = text.known(path, {}, self._sessions.options.trusted)
        if isinstance(known, RobotError):
            raise known
        return self._sources.load(path) if known is None else known

    def _reload_reference(self) -> None:
        if (reference := self._sessions.reference) is not None:
            reference.read()
            self._sessions.set_reload_problems("reference", reference.problems)
            self._sessions.show_reference()
            self._report_changed()

    def _describe(self, robot: Robot) -> None:
        """Send the saved model to a live robot, where that is allowed."""

        def told(node: str, why: str) -> None:
            made = reload_problems.described(text(node, 80), why)
            self._sessions.set_reload_problems("description", (made,))

        def send(session: Session) -> None:
            if not session.publisher.refusal("description"):
                session.publisher.describe(robot.urdf, "the saved model", told)

        self._sessions.for_each(send, copies=False)

    def refuse_model(self, error: RobotError) -> None:
        """Report why the model is not shown, and follow the files that may fix it."""
        named = (Path(p.file) for p in error.problems if p.file is not None)
        model = () if self._model is None else (self._model,)
        suspects = (*model, *error.files, *named)
        self._suspects = tuple(dict.fromkeys(map(Path.absolute, suspects)))
        self._of_model = error.problems
        self._ask_again()
        self._sessions.set_reload_problems("model", error.problems)

    def refuse_config(self, error: ConfigError) -> None:
        """Report why the config is not shown."""
        self._of_config = error.problems
        self._sessions.set_reload_problems("config", error.problems)

    def _problems(self) -> tuple[Problem, ...]:
        reference = self._sessions.reference
        of_reference = () if reference is None else reference.problems
        return (*self._of_model, *self._of_config, *of_reference)

    def _report_changed(self) -> None:
        """Report the problems if they differ from the last report."""
        problems = self._problems()
        if self._report is not None and problems != self._reported:
            self._report(problems)
        self._reported = problems

    def _opened(self) -> None:
        """Follow the config that a user has opened in the page."""
        self._wait_no_longer()
        self._of_config = self._documents.current.problems
        self._ask_again()
        self._sessions.set_reload_problems("config", ())

    def _reload_config(self, path: Path, before: Plain | None = None) -> None:
        """Show the config again.

        Args:
            path: the config file.
            before: view of the shown config; by default the view in the file as last
                read.
        """
        self._wait_no_longer()
        try:
            document = self._documents.read(path)
        except ConfigError as error:
            self.refuse_config(error)
        else:
            self._show_config(path, document, before or self._documents.view)
        self._report_changed()

    def _show_config(self, path: Path, document: RvizConfig, before: Plain) -> None:
        text = document.to_yaml()
        if not self._documents.replace(path, document):
            return
        kept: list[Session] = []

        def take(session: Session) -> None:
            if not self._take(session, path, text, before):
                kept.append(session)

        self._sessions.for_each(take, copies=False)
        problems = (reload_problems.kept(str(path)),) if kept else ()
        self._sessions.set_reload_problems("config", problems)
        self._of_config = problems or document.problems
        for session in kept:
            self._wait_for_undo(session, path, before)

    def _wait_for_undo(self, session: Session, path: Path, before: Plain) -> None:
        """Show the file after a user has undone or saved all changes."""
        modified = session.history.modified

        def look() -> None:
            if not modified.value:
                session.worker.post(lambda: self._reload_config(path, before))

        self._end_waiting.append(connect([modified], look))

    def _wait_no_longer(self) -> None:
        waiting, self._end_waiting = self._end_waiting, []
        for end in waiting:
            end()

    def _take(self, session: Session, path: Path, text: str, before: Plain) -> bool:
        """Show the file, unless a user's changes would be lost.

        Browsers keep their views, unless the view in the file has changed.

        Returns:
            False when a user's changes stay and the file is not shown.
        """
        with session.lock:
            if (
                session.document.config.to_yaml() == text
                or self._documents.file != path
            ):
                # The page saved the file itself, or has opened another one.
                return True
            if session.history.modified.value:
                return False
            session.document.replace(self._documents(), self._documents.trusted)
            if self._documents.view != before:
                session.clients.show_view()
            return True

    def _cannot_watch(self, reason: str) -> None:
        self._sessions.set_reload_problems(
            "watch", (reload_problems.unwatched(reason),)
        )
        if self._report is not None:
            self._report((reload_problems.unwatched(reason),))
