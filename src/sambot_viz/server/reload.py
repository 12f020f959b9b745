"""Showing what was saved: the model, its meshes and textures, the config.

A save with a mistake never takes the robot away: the last good one stays, marked as
such, until a save mends it (DESIGN §4.4).
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from sambot_viz.errors import ConfigError, Problem, RobotError
from sambot_viz.meshes.asset import Asset
from sambot_viz.open_config import load_config
from sambot_viz.robot.model import Robot
from sambot_viz.robot.shape_files import assets_of, something_missing
from sambot_viz.rviz import RvizConfig
from sambot_viz.rviz.yaml.nodes import Plain
from sambot_viz.server.server import Server
from sambot_viz.server.watch import FileWatcher
from sambot_viz.session import Session

_MANAGER = "Visualization Manager"
MOST_FOLDERS = 200
"""Of a package in which something is missing, so many folders are watched at most."""


class Documents:
    """The .rviz document of the server: one for all browsers, or a copy for each.

    Args:
        document: as it was read, with the program's own settings made.
        copy: makes a copy for a private session; None shares the document itself.
    """

    def __init__(
        self, document: RvizConfig, copy: Callable[[RvizConfig], RvizConfig] | None
    ) -> None:
        self.current = document
        self._copy = copy

    def __call__(self) -> RvizConfig:
        """The document for one more session."""
        return self.current if self._copy is None else self._copy(self.current)


@dataclass(frozen=True, slots=True)
class _Content:
    """What a document says: its current view, and all the rest."""

    view: Plain
    rest: Plain

    @classmethod
    def of(cls, document: RvizConfig) -> _Content:
        root = document.raw
        manager = root.get(_MANAGER) if isinstance(root, dict) else None
        views = manager.get("Views") if isinstance(manager, dict) else None
        view = views.pop("Current", None) if isinstance(views, dict) else None
        return cls(view, root)


class Reloader:
    """Reloads what a server shows when its files are saved.

    Args:
        server: what shows it.
        load: reads the model from its file.
        config: the .rviz file, or None when there is none to follow.
        documents: where sessions take their document from.
        prepare: makes the program's own settings in a document that was read anew.
        report: told what is wrong with the model whenever that has changed, and what is
            wrong with a config that was saved.
    """

    def __init__(
        self,
        server: Server,
        load: Callable[[Path], Robot],
        config: Path | None,
        documents: Documents,
        prepare: Callable[[RvizConfig], None],
        report: Callable[[Sequence[Problem]], None] | None = None,
    ) -> None:
        self._server = server
        self._load = load
        robot = server.robot
        self._model = robot.files[0] if robot is not None and robot.files else None
        self._config = config
        self._documents = documents
        self._prepare = prepare
        self._report = report
        self._shown = _Content.of(documents.current)
        self._suspects: tuple[Path, ...] = ()
        self._told = () if robot is None else robot.problems
        self._watcher = FileWatcher(
            self._files, self._folders, self._changed, self._cannot_watch
        )
        self._watcher.start()

    def close(self) -> None:
        """Follow the files no longer."""
        self._watcher.close()

    # What is watched

    def _model_files(self) -> set[Path]:
        robot = self._server.robot
        return {*(() if robot is None else robot.files), *self._suspects}

    def _asset_files(self) -> set[Path]:
        robot = self._server.robot
        assets: Iterator[Asset] = iter(()) if robot is None else assets_of(robot)
        return {file for asset in assets for file in self._server.meshes.files(asset)}

    def _files(self) -> set[Path]:
        config = {self._config} if self._config is not None else set[Path]()
        return self._model_files() | self._asset_files() | config

    def _folders(self) -> list[Path]:
        """Where a file that is missing now may appear."""
        if self._model is None or not self._hoping:
            return []
        for folder in self._model.resolve().parents:
            if (folder / "package.xml").is_file():
                return list(_folders_in(folder))
        return []

    @property
    def _hoping(self) -> bool:
        """Whether a file that nobody knows yet may mend something."""
        robot = self._server.robot
        return bool(self._suspects) or (robot is not None and something_missing(robot))

    # What is done

    def _changed(self, changed: frozenset[Path], appeared: frozenset[Path]) -> None:
        try:
            self._show_changed(changed, appeared)
        except Exception as error:
            # A fault of ours must not end the watching; the page says what it was.
            self._server.set_reload_problems("fault", (_our_fault(error),))

    def _show_changed(
        self, changed: frozenset[Path], appeared: frozenset[Path]
    ) -> None:
        model, assets = self._model_files(), self._asset_files()
        if self._config is not None and self._config in changed:
            self._reload_config(self._config)
        gone = any(not path.is_file() for path in changed & assets)
        if self._model is None:
            return
        if changed & model or gone or (appeared and self._hoping):
            self._reload_model(self._model)
        elif changed & assets:
            self._server.refresh()

    def _reload_model(self, path: Path) -> None:
        try:
            robot = self._load(path)
        except RobotError as error:
            files = (Path(p.file) for p in error.problems if p.file is not None)
            self._suspects = (path, *files)
            self._server.set_reload_problems("model", error.problems)
            self._tell(error.problems)
        else:
            if self._watcher.closed:
                return
            self._suspects = ()
            self._server.set_reload_problems("model", ())
            self._server.show_robot(robot)
            self._server.set_reload_problems("fault", ())
            self._tell(robot.problems)

    def _tell(self, problems: tuple[Problem, ...]) -> None:
        """Report what is wrong with the model, unless that was told already."""
        if self._report is not None and problems != self._told:
            self._report(problems)
        self._told = problems

    def _reload_config(self, path: Path) -> None:
        try:
            document = load_config(path)
        except ConfigError as error:
            self._server.set_reload_problems("config", error.problems)
            if self._report is not None:
                self._report(error.problems)
            return
        text = document.to_yaml()
        self._prepare(document)
        self._documents.current = document
        before, self._shown = self._shown, _Content.of(document)
        sessions = self._server.sessions()
        kept = [s for s in sessions if not self._take(s, text, before)]
        self._server.set_reload_problems("config", (_kept(path),) if kept else ())

    def _take(self, session: Session, text: str, before: _Content) -> bool:
        """Show the file, unless that would throw away what a user has changed.

        A camera that was moved is no change to be asked about: it stays where it is,
        unless the file was given another view.
        """
        with session.lock:
            if session.config.to_yaml() == text:
                # The page itself has saved it.
                return True
            if _Content.of(session.config).rest != before.rest:
                return False
            document = self._documents()
            if self._shown.view == before.view:
                document.use_view(session.config.view)
            session.set_config(document)
            if self._shown.view != before.view:
                session.views.show()
            return True

    def _cannot_watch(self, reason: str) -> None:
        self._server.set_reload_problems("watch", (_unwatched(reason),))
        if self._report is not None:
            self._report((_unwatched(reason),))


def _folders_in(folder: Path) -> Iterator[Path]:
    """A folder and those in it, hidden ones left out, the nearest first."""
    pending, count = [folder], 0
    while pending and count < MOST_FOLDERS:
        folder = pending.pop(0)
        yield folder
        count += 1
        try:
            inner = sorted(p for p in folder.iterdir() if p.name[:1] != ".")
            pending += [p for p in inner if p.is_dir() and not p.is_symlink()]
        except OSError:
            continue


def _kept(path: Path) -> Problem:
    return Problem(
        "warning",
        "config-changes-kept",
        f"{path.name} was saved elsewhere, but the page has unsaved changes; "
        "they are kept, and the new version of the file is not shown",
        "save the config from the page, or load the file again",
        str(path),
    )


def _our_fault(error: Exception) -> Problem:
    return Problem(
        "error",
        "reload-failed",
        "what was saved could not be shown, by a fault of ours: "
        f"{type(error).__name__}: {error}",
        "start the program again, and please report it",
    )


def _unwatched(reason: str) -> Problem:
    return Problem(
        "warning",
        "watch-limited",
        f"the system does not watch the files for us ({reason}); they are looked at "
        "once a second instead",
        "raise fs.inotify.max_user_watches, or start with --no-watch",
    )
