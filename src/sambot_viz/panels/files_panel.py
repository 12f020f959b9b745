"""The .rviz file, for one browser: open, save, download."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence
from pathlib import Path
from typing import Any, Protocol

from sambot_viz.errors import ConfigError, UsageError
from sambot_viz.panels.command import FLAG, LIST, TEXT, command
from sambot_viz.panels.panel import Panel
from sambot_viz.panels.rows.row import Data, Json, Level
from sambot_viz.robot.model import Robot
from sambot_viz.session.clients.client import Client
from sambot_viz.session.clients.clients import Clients
from sambot_viz.session.config_file import UNNAMED, ConfigFile
from sambot_viz.session.document.document import ShownDocument
from sambot_viz.session.people.roles import Roles
from sambot_viz.session.robot.robot_state import RobotState
from sambot_viz.session.scene.scene import Scene
from sambot_viz.session.signals import Signal
from sambot_viz.session.undo import History

_OF_DISK = ("file/save", "file/save-as", "file/list", "file/open")


class Files(Protocol):
    """The disk of the server, for those who may use it."""

    def open(
        self, path: Path, shown: ShownDocument, clients: Clients, robot: Robot | None
    ) -> None:
        """Show another .rviz file.

        Raises:
            ConfigError: it cannot be read, or is not a .rviz document.
        """

    def saved(self, path: Path) -> None:
        """Note that the document is in this file now."""


class FilesPanel(Panel):
    """Opens, saves and downloads for the File menu.

    Args:
        client: the client that gets the downloads.
        files: the disk; None for a client that may only download.
        roles: knows whether the client may use the disk; others see no folder of it.
        keep_unfolded: writes into the document which rows are unfolded, from their
            ids.
        say: shows a sentence to this browser.
        remake: called when the answer changes.
    """

    name = "files"

    def __init__(
        self,
        client: Client,
        document: ShownDocument,
        robot: RobotState,
        scene: Scene,
        history: History,
        clients: Clients,
        files: Files | None,
        roles: Roles,
        keep_unfolded: Callable[[Collection[str]], None],
        say: Callable[[str, Level], None],
        remake: Callable[[Panel], None],
    ) -> None:
        self.remade_by = (document.file, robot.changed, roles.changed)
        self._roles = roles
        self._client = client
        self._document = document
        self._robot = robot
        self._context = scene.context
        self._history = history
        self._clients = clients
        self._files = files
        self._keep_unfolded = keep_unfolded
        self._say = say
        self._remake = remake
        self._file = ConfigFile(document, robot, scene)
        self._facts: dict[str, Json] = {}
        self._folder = ""
        self._files_of: object = None
        self._robot_of: Robot | None = None
        self._names: Sequence[str] = ()
        self._answer: Json = None
        self._answers = 0

    @property
    def moved_by(self) -> Sequence[Signal[Any]]:
        """Whether the document is saved."""
        return (self._history.modified,)

    def data(self) -> Sequence[Data]:
        """Return where the document is, the files there are, and the last answer."""
        made = [Data("file/state", self._state()), Data("file/answer", self._answer)]
        if self._files is not None:
            may = self._roles.may_edit(self._client.client_id)
            made.append(Data("file/names", self._names if may else ()))
        return made

    def values(self) -> Mapping[str, Json]:
        """Return whether the document is saved: that may change with every edit."""
        return {"file/state": self._state()}

    def _state(self) -> Json:
        """Return the facts about the file; read the disk only for a new file or robot.

        This is called for every step of a slider, once for each browser.
        """
        files = (self._document.config.file, self._context.config_file)
        robot = self._robot.model
        # Comparing two robots would compare all their links.
        if files != self._files_of or robot is not self._robot_of:
            self._files_of, self._robot_of = files, robot
            self._facts = self._look_up()
        facts = self._facts | {"modified": self._history.modified.value}
        if self._files is not None and self._roles.may_edit(self._client.client_id):
            facts["folder"] = self._folder
        return facts

    def _look_up(self) -> dict[str, Json]:
        file = self._file
        facts: dict[str, Json] = {
            "name": file.name,
            "own": file.target is not None,
            "private": self._files is None,
        }
        self._folder = str(file.folder)
        return facts

    def offers(self, command_id: str) -> bool:
        """Return whether this browser may use the disk."""
        return command_id not in _OF_DISK or self._files is not None

    @property
    def _disk(self) -> Files:
        if self._files is None:
            raise UsageError("a private session can only download")
        return self._files

    def _reply(self, to: str, **content: Json) -> None:
        """Answer a dialog that waits."""
        self._answers += 1
        self._answer = {"number": self._answers, "to": to, **content}
        self._remake(self)

    # Saving

    @command("file/save", LIST, name="Save")
    def _save_here(self, unfolded: list[Json]) -> None:
        self._save(None, unfolded)

    @command("file/save-as", TEXT, FLAG, LIST, name="Save as")
    def _save_as(self, name: str, replace: bool, unfolded: list[Json]) -> None:
        path = self._file.path(name)
        if not replace and self._file.is_taken(path):
            self._reply("save-as", exists=path.name)
            return
        self._save(path, unfolded)
        self._reply("save-as", done=path.name)

    def _save(self, path: Path | None, unfolded: list[Json]) -> None:
        self._client.view.store()
        self._keep_unfolded({row for row in unfolded if isinstance(row, str)})
        path = self._file.save(path)
        self._disk.saved(path)
        self._say(f"Saved {path.name} in {path.absolute().parent}", "ok")

    # Opening

    @command("file/list")
    def _list(self) -> None:
        self._names = self._file.names()
        self._remake(self)

    @command("file/open", TEXT, name="Open")
    def _open(self, name: str) -> None:
        path = self._file.listed(name)
        try:
            self._disk.open(path, self._document, self._clients, self._robot.model)
        except ConfigError as error:
            problem = error.problems[0]
            place = "" if problem.line is None else f"line {problem.line}: "
            raise UsageError(
                f"{path.name} cannot be opened: {place}{problem.message}"
            ) from error
        self._reply("open", done=path.name)
        self._say(f"Opened {path.name} from {self._file.origin}", "ok")

    # To the user's own computer

    @command("file/download", client_local=True)
    def _download(self) -> None:
        name = self._file.name or UNNAMED
        config = self._document.config
        before = config.detached_view()
        self._client.view.store()
        text = config.to_yaml()
        config.store_view(before)
        self._client.download(name, text.encode())
