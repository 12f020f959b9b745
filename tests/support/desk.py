"""A robot with its server and an open page, which several tests use in turn."""

from __future__ import annotations

import shutil
from collections.abc import Callable
from pathlib import Path

import robots
from live_peers import free_port
from recorded_page import RecordedPage, open_page
from user import User
from viewer_page import COARSE, ViewerPage, viewer_url

from sambot_viz import Visualizer, bundled
from sambot_viz.export.chromium import Chromium
from sambot_viz.session import Session
from sambot_viz.session.clients.client import Client

MODELS: dict[str, Callable[[Path], str]] = {
    "T": lambda _: robots.humanoid(),
    "C": lambda _: robots.chain(),
    "L": lambda _: robots.long_names(),
    "A": robots.arm,
}
"""Letter of the tasks → URDF; "S" is the robot that comes with the program."""

_START_TIME = 30.0
"""Until a page shows its robot; on a busy machine a large one takes long [s]."""
_TOOLS = ("toolbar", "Tools")


class Desk:
    """One robot, one server, one page.

    Args:
        letter: the robot, "S", "T", "C", "L" or "A"; or the text of a model.
        chromium: the browser.
        folder: an empty folder for the model and what is saved.
        config: the text of its config; None for the one of the program.
        resolution: of the 3D view while its pixels are not read.
        view: whether its pages have a 3D view; what reads no pixel, asks nothing of
            the scene and moves no camera by the mouse needs none.

    Attributes:
        viz: the program.
        viewer: the page.
        user: who uses it.
        model: the file of the model, which the program follows.
        downloads: where the browser puts files.
    """

    def __init__(
        self,
        letter: str,
        chromium: Chromium,
        folder: Path,
        config: str | None = None,
        resolution: float = COARSE,
        view: bool = False,
    ) -> None:
        self.has_view = view
        self.folder = folder
        self._config = None if config is None else folder / "desk.rviz"
        self._resolution = resolution
        self.downloads = folder / "downloads"
        self.downloads.mkdir(parents=True)
        if letter.startswith("<"):
            self.model = folder / "robot.urdf"
            self.model.write_text(letter, "utf-8")
        elif letter.startswith("S"):
            shutil.copytree(bundled.assets_folder(), folder, dirs_exist_ok=True)
            self.model = folder / "sam_bot.urdf.xacro"
        else:
            self.model = folder / f"{letter.lower()}.urdf"
            self.model.write_text(MODELS[letter](folder), "utf-8")
        if self._config is not None and config is not None:
            self._config.write_text(config, "utf-8")
        self._chromium = chromium
        self._start()

    def open(
        self,
        width: int = 1280,
        height: int = 720,
        *,
        touch: bool = False,
        address: str = "",
    ) -> ViewerPage:
        """Open one more page of it, perhaps by a permalink; `close` closes it too."""
        page = open_page(self._chromium, width, height, touch=touch)
        url = address or self.viz.url
        page.goto(viewer_url(url, self._resolution, self.has_view))
        page.take_downloads(self.downloads)
        page.allow("clipboardReadWrite", "clipboardSanitizedWrite")
        url = viewer_url(self.viz.url, view=self.has_view)
        return ViewerPage(page, url, touch, self.has_view)

    @property
    def user(self) -> User:
        """Who uses the page."""
        return self.viewer.user

    @property
    def page(self) -> RecordedPage:
        """The page of the browser itself."""
        return self.viewer.page

    @property
    def fixed_frame(self) -> str:
        """The frame in which all is drawn."""
        return str(self.session.document.config.global_options.get("Fixed Frame"))

    @property
    def session(self) -> Session:
        """What all pages share."""
        (session,) = self.viz.server.sessions.all()
        return session

    @property
    def browser(self) -> Client:
        """That of the first page; others of a task have left, or leave now."""
        browsers = self.session.clients.all
        return browsers[min(browsers)]

    def restart(self) -> None:
        """End program and page, and start both again."""
        self.close()
        self._start()

    def _start(self) -> None:
        # Studio takes longer to draw.
        # A server that a task starts again has the port that it had.
        self.viz = Visualizer(
            self.model, self._config, port=free_port(), watch=True, look="rviz"
        )
        self.viewer = self.open()
        self._wait_for_robot()
        self.settle()
        view = self.browser.view
        self._kind, self._view = view.view.kind, dict(view.values)
        self._tool = self.browser.tools.current.label
        self._joints = self.viz.joint_positions

    def _wait_for_robot(self) -> None:
        """Wait until the page shows the robot from near: Orbit begins 10 m away."""
        distance = ("Views", "Current View", "Distance")
        self.user.until(
            lambda: self.user.row(*distance).one("textbox").value != "10", _START_TIME
        )

    def tidy(self) -> None:
        """Put everything back as it was, without the page: that takes too long."""
        user, browser = self.user, self.browser
        tools = browser.tools
        self.viewer.set_resolution(self._resolution)
        user.keys("Escape", "Escape")
        # Keys of the next test are not for the field of this one.
        self.page.evaluate("document.activeElement.blur()")
        self.settle()
        if tools.selection:
            tools.select((), None)
        if tools.current.label != self._tool:
            self.choose_tool(self._tool)
        joints = user.see().one("tab", "Joints")
        if not joints.state("selected"):
            user.click_on(joints)
        self.undo_of(browser.client_id)
        # What another page has done cannot be undone by this one.
        if self.viz.joint_positions != self._joints:
            self.viz.set_joint_positions(self._joints)
        self._look_as_at_first()
        # The next test finds the picture at rest.
        self.settle()

    def _look_as_at_first(self) -> None:
        """Give the view of the start back."""
        view = self.browser.view
        if view.view.kind != self._kind:
            view.set_kind(self._kind)
        for name, value in self._view.items():
            if view.values[name] != value:
                view.set(name, value)

    def undo_of_others(self) -> None:
        """Undo what other pages have done, before they leave: nobody else can."""
        first = self.browser.client_id
        for client in [n for n in self.session.clients.all if n != first]:
            self.undo_of(client)

    def undo_of(self, client: int) -> None:
        """Undo all that a page has done."""
        undo = self.session.history
        while undo.state(client).value.undo is not None:
            undo.undo(client)

    def settle(self) -> None:
        """Wait until all that was done is in the picture of the page."""
        self.viewer.settle(self.viz)

    def choose_tool(self, tool: str) -> None:
        """Press the button of a tool, and wait until clicks are for it."""
        self.user.click("button", tool, _TOOLS)
        self.has_tool(tool)
        self.settle()

    def has_tool(self, tool: str) -> None:
        """Wait until a tool is the current one."""
        self.user.until(
            lambda: (
                [b.name for b in self.user.find(*_TOOLS).all("button") if b.is_on]
                == [tool]
            )
        )

    def close(self) -> None:
        """End page and program."""
        self.viewer.page.close()
        self.viz.stop()
