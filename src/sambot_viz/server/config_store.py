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
    """The server's .rviz document: one for all browsers, or a copy for each.

    Args:
        document: document with the options of the command line applied.
        shared: whether all browsers share this document instead of getting copies.
        prepare: applies the options of the command line to a document.
        file: file of the document; None to follow no file.

    Attributes:
        current: the shown document, as last read.
        file: the file that is shown and followed.
        trusted: whether the shown file is the one from the command line, unchanged by
            browsers.
        view: the current view in the file, as last read.
        on_open: called after a user has opened another file.
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
        """Return the document for one more session."""
        return self.current if self._shared else self.current.copy()

    def read(self, file: Path) -> RvizConfig:
        """Read a file, without the options of the command line.

        Raises:
            ConfigError: the file cannot be read, or is not a .rviz document.
        """
        if reload_problems.is_pipe(file):
            problem = reload_problems.unreadable("config-unreadable", file)
            raise ConfigError([problem])
        return load_config(file)

    def replace(self, file: Path, document: RvizConfig) -> bool:
        """Take the newly read document of the shown file.

        Returns:
            False when a user has opened another file meanwhile.
        """
        self._prepare(document)
        with self._lock:
            if self.file != file:
                return False
            self.current, self.view = document, _view_of(document)
        return True

    def begin_again(self, shown: RvizConfig, document: RvizConfig) -> None:
        """Take the bundled config, adapted to another recording.

        Args:
            shown: config to replace; the call does nothing if it is no longer the
                current one, because a user has opened another.
            document: the new config.
        """
        with self._lock:
            if self.current is shown:
                self.current, self.view = document, _view_of(document)

    def open(
        self, path: Path, shown: ShownDocument, clients: Clients, robot: Robot | None
    ) -> None:
        """Show another file in the session of all browsers.

        Raises:
            ConfigError: the file cannot be read, or is not a .rviz document.
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
        """Follow this file, into which the page has saved the document."""
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
    """The files of a server, and the functions that read and show them.

    Attributes:
        model: the model file; None follows the file of the shown robot.
        load: reads a model from its file.
        show: shows a robot in all sessions.
        configs: gives sessions their config, and knows its file.
        opened: time when the files were first opened [ns].
    """

    model: Path | None
    load: Callable[[Path], Robot]
    show: Callable[[Robot], None]
    configs: ConfigStore
    opened: int
