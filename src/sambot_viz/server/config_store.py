"""The config of a server, and the files that it shows."""

from __future__ import annotations

import threading
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from sambot_viz.errors import ConfigError
from sambot_viz.inputs import load_config
from sambot_viz.robot.model import Robot
from sambot_viz.rviz import RvizConfig
from sambot_viz.rviz.yaml.yaml_nodes import Plain
from sambot_viz.server import reload_problems
from sambot_viz.session.clients.clients import Clients
from sambot_viz.session.document.document import ShownDocument
from sambot_viz.session.own_config import fit_own_config

_MANAGER = "Visualization Manager"


class ConfigStore:
    """The .rviz document of the server: one for all browsers, or a copy for each.

    Args:
        document: as it was read, with the options of the command line applied.
        shared: whether all browsers have this document, or each a copy.
        prepare: applies the options of the command line to a document that was read.
        file: where it was read from; None when no file is to be followed.

    Attributes:
        current: the document that is shown, as it was read last.
        file: the file that is shown, and followed.
        trusted: whether the file that is shown is that of the command line, and no
            browser has written it.
        view: the current view that it had when it was read.
        on_open: called after another file was opened.
        on_save: called after the page has saved the document.
    """

    def __init__(
        self,
        document: RvizConfig,
        shared: bool,
        prepare: Callable[[RvizConfig], None],
        file: Path | None,
    ) -> None:
        self._lock = threading.Lock()
        self.current = document
        self._shared = shared
        self._prepare = prepare
        self.file = file
        self.trusted = True
        self.view = _view_of(document)
        self.on_open: list[Callable[[], object]] = []
        self.on_save: list[Callable[[], object]] = []

    def __call__(self) -> RvizConfig:
        """The document for one more session."""
        return self.current if self._shared else self.current.copy()

    def read(self, file: Path) -> RvizConfig:
        """Read a file, without the options of the command line.

        Raises:
            ConfigError: it cannot be read, or is not a .rviz document.
        """
        if reload_problems.is_pipe(file):
            problem = reload_problems.unreadable("config-unreadable", file)
            raise ConfigError([problem])
        return load_config(file)

    def replace(self, file: Path, document: RvizConfig) -> bool:
        """Take what was read again from the file that is shown.

        Returns:
            False when another file was opened meanwhile.
        """
        self._prepare(document)
        with self._lock:
            if self.file != file:
                return False
            self.current, self.view = document, _view_of(document)
        return True

    def begin_again(self, shown: RvizConfig, document: RvizConfig) -> None:
        """Take the config that comes with the program, made for another recording.

        Args:
            shown: what it takes the place of; another one was opened meanwhile if it
                is no longer the current one.
            document: the config.
        """
        with self._lock:
            if self.current is shown:
                self.current, self.view = document, _view_of(document)

    def open(
        self, path: Path, shown: ShownDocument, clients: Clients, robot: Robot | None
    ) -> None:
        """Show another file in the session of all browsers.

        Raises:
            ConfigError: it cannot be read, or is not a .rviz document.
        """
        document = self.read(path)
        fit_own_config(document, robot)
        self._prepare(document)
        with self._lock:
            self.file, self.view = path, _view_of(document)
            self.current, self.trusted = document, False
        shown.replace(document, trusted=False)
        clients.show_view()
        for listener in self.on_open:
            listener()

    def saved(self, path: Path) -> None:
        """The page has saved the document into this file: follow it from now on."""
        with self._lock:
            self.file, self.trusted = path, False
        for listener in self.on_save:
            listener()


def _view_of(document: RvizConfig) -> Plain:
    root = document.raw
    manager = root.get(_MANAGER) if isinstance(root, dict) else None
    views = manager.get("Views") if isinstance(manager, dict) else None
    return views.get("Current") if isinstance(views, dict) else None


@dataclass(frozen=True, slots=True)
class Sources:
    """The files of a server, and how they are read and shown.

    Attributes:
        model: the model file; None follows that of the robot that is shown.
        load: reads a model from its file.
        show: shows a robot in all sessions.
        configs: where sessions take their config from, and which file it is in.
        opened: when the files were opened first [ns].
    """

    model: Path | None
    load: Callable[[Path], Robot]
    show: Callable[[Robot], None]
    configs: ConfigStore
    opened: int
