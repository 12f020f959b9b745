"""The .rviz file and pictures, for one browser: open, save, download."""

from __future__ import annotations

from collections.abc import Awaitable, Callable, Collection, Mapping, Sequence
from pathlib import Path
from typing import Protocol

from sambot_viz.errors import ConfigError, SambotVizError, UsageError
from sambot_viz.panels.command import FLAG, INTEGER, LIST, TEXT, command
from sambot_viz.panels.panel import Panel
from sambot_viz.panels.row import Data, Json, Level
from sambot_viz.robot.model import Robot
from sambot_viz.session import Session
from sambot_viz.session.clients.client import Client
from sambot_viz.session.config_file import UNNAMED, ConfigFile
from sambot_viz.session.picture import (
    LONGEST_SIDE,
    SHORTEST_SIDE,
    PictureError,
    picture_of,
)

MakePage = Callable[[], Awaitable[bytes]]
"""Makes an HTML file, on the event loop; raises SambotVizError when there is none."""
AskPage = Callable[[Session, Client, str], MakePage]
"""Notes what a browser sees now, for a page with a motion: "sweep", "past" or "none";
raises SambotVizError when there is no such motion."""
_OF_DISK = ("file/save", "file/save-as", "file/list", "file/open")
_UNNAMED = "robot"
"""Name of a picture or a page when there is no robot."""


class Files(Protocol):
    """The disk of the server, for those who may use it."""

    def open(self, session: Session, path: Path) -> None:
        """Show another .rviz file.

        Raises:
            ConfigError: it cannot be read, or is not a .rviz document.
        """

    def saved(self, path: Path) -> None:
        """Note that the document is in this file now."""


class FilesPanel(Panel):
    """Opens, saves and downloads for the File menu.

    Args:
        session: whose document it is.
        browser: who asks, and gets the downloads.
        files: the disk; None for a visitor, who may only download.
        ask_page: makes a page of what is seen; None leaves that out.
        keep_unfolded: writes into the document which rows are unfolded, from their
            ids.
        say: shows a sentence to this browser.
        remake: called when there is another answer.
    """

    name = "files"

    def __init__(
        self,
        session: Session,
        browser: Client,
        files: Files | None,
        ask_page: AskPage | None,
        keep_unfolded: Callable[[Collection[str]], None],
        say: Callable[[str, Level], None],
        remake: Callable[[Panel], None],
    ) -> None:
        self.remade_by = (session.document.file, session.robot.changed)
        self.moved_by = (session.history.modified,)
        self._session = session
        self._browser = browser
        self._files = files
        self._ask_page = ask_page
        self._keep_unfolded = keep_unfolded
        self._say = say
        self._remake = remake
        self._file = ConfigFile(session.document, session.robot, session.scene)
        self._facts: dict[str, Json] = {}
        self._files_of: object = None
        self._robot_of: Robot | None = None
        self._names: Sequence[str] = ()
        self._answer: Json = None
        self._answers = 0
        self._drawing = False
        self._making = False

    def data(self) -> Sequence[Data]:
        """Return where the document is, the files there are, and the last answer."""
        made = [Data("file/state", self._state()), Data("file/answer", self._answer)]
        if self._files is not None:
            made.append(Data("file/names", self._names))
        return made

    def values(self) -> Mapping[str, Json]:
        """Return whether the document is saved: that may change with every edit."""
        return {"file/state": self._state()}

    def _state(self) -> Json:
        """Return what is known of the file; only another file or robot asks the disk.

        This is called for every step of a slider, once for each browser.
        """
        session = self._session
        files, robot = (
            (session.document.config.file, session.scene.context.config_file),
            session.robot.model,
        )
        # Comparing two robots would compare all their links.
        if files != self._files_of or robot is not self._robot_of:
            self._files_of, self._robot_of = files, robot
            self._facts = self._look_up()
        return self._facts | {"modified": session.history.modified.value}

    def _look_up(self) -> dict[str, Json]:
        file = self._file
        facts: dict[str, Json] = {
            "name": file.name,
            "own": file.target is not None,
            "private": self._files is None,
        }
        if self._files is not None:
            facts["folder"] = str(file.folder)
        return facts

    def offers(self, command_id: str) -> bool:
        """Tell whether this browser may use the disk, and whether pages can be made."""
        if command_id in _OF_DISK:
            return self._files is not None
        return command_id != "file/page" or self._ask_page is not None

    @property
    def _disk(self) -> Files:
        if self._files is None:
            raise UsageError("visitors can only download")
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
        with self._session.lock:
            self._browser.view.store()
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
            self._disk.open(self._session, path)
        except ConfigError as error:
            problem = error.problems[0]
            place = "" if problem.line is None else f"line {problem.line}: "
            raise UsageError(
                f"{path.name} cannot be opened: {place}{problem.message}"
            ) from error
        self._reply("open", done=path.name)
        self._say(f"Opened {path.name} of {self._file.origin}", "ok")

    # To the user's own computer

    @command("file/download", client_local=True)
    def _download(self) -> None:
        name = self._file.name or UNNAMED
        config = self._session.document.config
        before = config.detached_view()
        self._browser.view.store()
        text = config.to_yaml()
        config.store_view(before)
        self._send(name, text.encode())

    def _send(self, name: str, content: bytes) -> None:
        self._browser.client.send_file_download(name, content, save_immediately=True)
        self._browser.client.flush()

    @command("file/picture", INTEGER, INTEGER, name="picture", client_local=True)
    def _picture(self, width: int, height: int) -> None:
        for length in (width, height):
            if not SHORTEST_SIDE <= length <= LONGEST_SIDE:
                raise UsageError(
                    f"a picture has {SHORTEST_SIDE} to {LONGEST_SIDE} pixels on a side"
                )
        if self._drawing:
            raise UsageError("a picture is being drawn already")
        self._drawing = True
        self._session.worker.run_on_loop(self._draw(width, height))

    async def _draw(self, width: int, height: int) -> None:
        """Have the browser draw, and send it the file; runs on the event loop."""
        name = f"{self._name()}.png"
        sentence, level = f"Saved {name}, {width} × {height} pixels", "ok"
        try:
            background = self._session.scene.context.background
            picture = await picture_of(self._browser, background, width, height)
            self._send(name, picture)
        except PictureError as error:
            sentence, level = f"No picture: {error}", "error"
        finally:
            self._drawing = False
        # The loop serves every browser and waits for no lock.
        self._session.worker.post(lambda: self._say(sentence, level))

    @command("file/page", TEXT, name="page", client_local=True)
    def _page(self, motion: str) -> None:
        if self._ask_page is None:
            raise UsageError("pages cannot be made here")
        if self._making:
            raise UsageError("a page is being made already")
        make = self._ask_page(self._session, self._browser, motion)
        self._making = True
        self._session.worker.run_on_loop(self._make(make))

    async def _make(self, make: MakePage) -> None:
        """Have a page made, and send it; runs on the event loop."""
        name = f"{self._name()}.html"
        sentence, level = "No page: internal error", "error"
        try:
            page = await make()
            self._send(name, page)
            sentence, level = f"Saved {name}, {len(page) / 1e6:.1f} MB", "ok"
        except SambotVizError as error:
            sentence = f"No page: {error}"
        finally:
            self._making = False
            self._session.worker.post(lambda: self._say(sentence, level))

    def _name(self) -> str:
        robot = self._session.robot.model
        return _UNNAMED if robot is None else _plain(robot.name)


def _plain(name: str) -> str:
    """Return a name that any disk takes."""
    return "".join(c if c.isalnum() or c in "-_. " else "_" for c in name)[:100]
