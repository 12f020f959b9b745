"""Pictures and pages of what one browser shows, for its user's own computer."""

from __future__ import annotations

from collections.abc import Awaitable, Callable

from sambot_viz import limits
from sambot_viz.errors import SambotVizError, UsageError
from sambot_viz.panels.command import INTEGER, TEXT, command
from sambot_viz.panels.panel import Panel
from sambot_viz.panels.rows.row import Level
from sambot_viz.session.client_picture import (
    SHORTEST_SIDE,
    PictureError,
    picture_of,
)
from sambot_viz.session.clients.client import Client
from sambot_viz.session.robot.motion_recorder import Past
from sambot_viz.session.robot.robot_state import RobotState
from sambot_viz.session.scene.scene import Scene
from sambot_viz.session.session_copy import SessionCopy
from sambot_viz.session.worker import Worker

MakePage = Callable[[], Awaitable[bytes]]
"""Makes an HTML file, on the event loop; raises SambotVizError when there is none."""
AskPage = Callable[[SessionCopy, Past, Client, str, str], MakePage]
"""Records the present view of a browser, for a page with a motion ("sweep", "past" or
"none") and a look; raises SambotVizError for an unknown motion or look."""
_UNNAMED = "robot"
"""Name of a picture or a page when there is no robot."""


class PicturesPanel(Panel):
    """Makes files of a browser's view; one of each kind at a time.

    Args:
        client: the client that gets the files.
        scene: the scene, with its background.
        robot: gives the files their name.
        copy: copies the state of the session.
        worker: waits for the browser without blocking other work.
        ask_page: makes a page of the view; None leaves that out.
        say: shows a sentence to this browser.
    """

    name = "pictures"

    def __init__(
        self,
        client: Client,
        scene: Scene,
        robot: RobotState,
        copy: Callable[[], SessionCopy],
        worker: Worker,
        ask_page: AskPage | None,
        say: Callable[[str, Level], None],
    ) -> None:
        self._client = client
        self._context = scene.context
        self._robot = robot
        self._copy = copy
        self._worker = worker
        self._ask_page = ask_page
        self._say = say
        self._drawing = False
        self._making = False

    def offers(self, command_id: str) -> bool:
        """Return whether pages can be made."""
        return command_id != "file/page" or self._ask_page is not None

    @command("file/picture", INTEGER, INTEGER, name="picture", client_local=True)
    def _picture(self, width: int, height: int) -> None:
        for length in (width, height):
            most = limits.PAGE_PICTURE.value
            if not SHORTEST_SIDE <= length <= most:
                raise UsageError(
                    f"a picture has {SHORTEST_SIDE} to {most:,} pixels on a side"
                )
        if self._drawing:
            raise UsageError("a picture is being drawn already")
        self._drawing = True
        self._worker.run_on_loop(self._draw(width, height), self._client.client_id)

    async def _draw(self, width: int, height: int) -> None:
        """Have the browser draw, and send it the file; runs on the event loop."""
        name = f"{self._name()}.png"
        sentence, level = f"Saved {name}, {width} × {height} pixels", "ok"
        try:
            background = self._context.background
            picture = await picture_of(self._client, background, width, height)
            self._client.download(name, picture)
        except PictureError as error:
            sentence, level = f"No picture: {error}", "error"
        finally:
            self._drawing = False
        # The loop serves every browser and waits for no lock.
        self._worker.post(lambda: self._say(sentence, level))

    @command("file/page", TEXT, TEXT, name="page", client_local=True)
    def _page(self, motion: str, look: str) -> None:
        if self._ask_page is None:
            raise UsageError("pages cannot be made here")
        if self._making:
            raise UsageError("a page is being made already")
        past = self._robot.recorder.last_minute()
        make = self._ask_page(self._copy(), past, self._client, motion, look)
        self._making = True
        self._worker.run_on_loop(self._make(make), self._client.client_id)

    async def _make(self, make: MakePage) -> None:
        """Have a page made, and send it; runs on the event loop."""
        name = f"{self._name()}.html"
        sentence, level = "No page: internal error", "error"
        try:
            page = await make()
            self._client.download(name, page)
            sentence, level = f"Saved {name}, {len(page) / 1e6:.1f} MB", "ok"
        except SambotVizError as error:
            sentence = f"No page: {error}"
        finally:
            self._making = False
            self._worker.post(lambda: self._say(sentence, level))

    def _name(self) -> str:
        robot = self._robot.model
        return _UNNAMED if robot is None else _plain(robot.name)


def _plain(name: str) -> str:
    """Return a name that any disk takes."""
    return "".join(c if c.isalnum() or c in "-_. " else "_" for c in name)[:100]
