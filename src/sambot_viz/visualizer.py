"""A robot in the browser, from a script or from the command line."""

from __future__ import annotations

import base64
import functools
import inspect
from collections.abc import Callable
from contextlib import suppress
from functools import partial
from pathlib import Path
from typing import Any, Concatenate, ParamSpec

import viser

from sambot_viz.errors import ServerError, did_you_mean
from sambot_viz.flags import keyword_help
from sambot_viz.inputs import Inputs
from sambot_viz.jupyter.notebook import HEIGHT, Cell, remember, stop_former
from sambot_viz.jupyter.notebook import notebook as here
from sambot_viz.options import Options
from sambot_viz.outlet import take_log
from sambot_viz.scripting.displays import first
from sambot_viz.scripting.robot import RobotControl
from sambot_viz.server.listener import Listener, listen
from sambot_viz.server.server import Server
from sambot_viz.server.shown_inputs import ShownInputs

_P = ParamSpec("_P")

_MESHES_WITHIN = 5.0
"""A cell waits so long for the meshes of its picture [s]."""


def _ask_page(*asked: Any) -> Any:
    from sambot_viz.export.page_file import ask_page

    return ask_page(*asked)


def _takes_the_keywords_of(
    options: Callable[_P, Options],
) -> Callable[[Callable[[Any, Options], None]], Callable[Concatenate[Any, _P], None]]:
    """Let a constructor that wants an `Options` take its fields as arguments."""

    def decorate(
        construct: Callable[[Any, Options], None],
    ) -> Callable[Concatenate[Any, _P], None]:
        @functools.wraps(construct)
        def with_keywords(self: Any, /, *args: _P.args, **kwargs: _P.kwargs) -> None:
            for name in kwargs.keys() - known:
                raise TypeError(
                    f"{type(self).__name__}() has no option '{name}'; "
                    f"{did_you_mean(name, known)}"
                )
            construct(self, options(*args, **kwargs))

        own = inspect.signature(construct).parameters["self"]
        parameters = inspect.signature(options).parameters
        known, given = list(parameters), parameters.values()
        with_keywords.__signature__ = inspect.Signature([own, *given])  # type: ignore[attr-defined]
        return with_keywords

    return decorate


class Visualizer(RobotControl):
    """A robot in the browser.

    Use it as a context manager, or call `stop`::

        with Visualizer(model="sam_bot.urdf.xacro", port=0) as viz:
            print(viz.url)
            viz.set_joint_positions({"drivewhl_l_joint": 1.0})
            viz.wait()

    As the last expression of a notebook's cell it shows the page in the notebook. It is
    stopped with the kernel, and when the cell is run again.

    The arguments are the fields of `Options`. With ``session="private"`` the methods
    act on the sessions of all browsers. Copies that browsers have made of a shared
    session are theirs alone.

    Raises:
        RobotError: the model cannot be shown.
        ConfigError: the config is not a .rviz document.
        UsageError: a file that does not exist, or a value that makes no sense.
        JointError: a joint at the start that does not exist or cannot be set, or a
            file of joint positions or poses that cannot be read.
        FrameError: static transforms that form a ring.
        ServerError: the address cannot be listened on.
    """

    @_takes_the_keywords_of(Options)
    def __init__(self, options: Options) -> None:
        notebook = self._notebook = here()
        if notebook is None:
            self._start(Inputs(options), None)
            return
        options = notebook.options(options)
        stop_former(notebook)
        inputs = Inputs(options)
        listening = listen(options, notebook.knows)
        try:
            self._start(inputs, listening)
        except BaseException:
            listening.close()
            raise
        remember(notebook, self)

    @classmethod
    def of_inputs(cls, inputs: Inputs, listening: Listener | None = None) -> Visualizer:
        """Show files that are opened already.

        Args:
            inputs: the model and the config, with their options. If they may be
                broken, their problems are shown, and the robot as soon as they are
                fixed.
            listening: a server that listens already, which replaces the options' host
                and port; it is stopped with the visualizer.

        Raises:
            SambotVizError: as the constructor.
        """
        visualizer = cls.__new__(cls)
        visualizer._notebook = None
        visualizer._start(inputs, listening)
        return visualizer

    def _start(self, inputs: Inputs, listening: Listener | None) -> None:
        take_log()
        shown = self._shown = ShownInputs(inputs, listening, _ask_page)
        self._configs = shown.configs
        super().__init__(shown.server)
        shown.start()

    @property
    def server(self) -> Server:
        """The server, with the sessions of its browsers."""
        return self._server

    @property
    def url(self) -> str:
        """The address to open in a browser: "http://127.0.0.1:PORT"."""
        return self._server.url

    @property
    def presenter_url(self) -> str | None:
        """The secret address for who drives; None without ``presenter``."""
        return self._server.presenter_url

    @property
    def viser(self) -> viser.ViserServer:
        """The viser server, to add your own nodes and widgets.

        Every node of viser is shown, and widgets in a panel "Script" over the view.
        The messages of browsers are checked, and only these reach your callbacks: the
        value of a visible and enabled widget, if it has the type of the last value
        (texts up to 1000 characters), pressed buttons, cameras, clicks and rectangles
        in the 3D view, and pictures from ``get_render``. Clicks on nodes, drags,
        transform controls, held buttons, keys of commands, forms and uploads are
        blocked: their callbacks are never called, and a warning is logged.

        With private sessions, nodes and widgets added here are shown to all browsers.
        """
        return self._server.viser

    def open_recording(self, path: Path | str, *, source: str | None = None) -> None:
        """Replace the shown recording by another.

        It is as if the program had started with it: topics, frames, displays and player
        are those of the new one, and so is the robot, unless a model was given. A given
        config stays. Private copies of browsers are not changed.

        Args:
            path: an MCAP file, rosbag2's sqlite3 file, a ROS 1 bag, or a folder.
            source: name of the recording to replace, where several are shown.

        Raises:
            SourceError: it cannot be opened; the shown one stays.
            UsageError: no recording is shown, or several without a `source`.
            ServerError: the visualizer was stopped.
        """
        self._server.sessions.require_open()
        self._shown.open_recording(Path(path), source)

    def wait(self) -> None:
        """Return when the server is stopped (by `stop`, or by Ctrl-C)."""
        self._server.wait()

    def stop(self) -> None:
        """Stop the server and free the port; a second call does nothing."""
        self._shown.stop()

    def __repr__(self) -> str:
        """Name the robot and the address, without a token."""
        robot = self._server.sessions.robot
        name = "no robot yet" if robot is None else f"'{robot.name}'"
        return f"<Visualizer of {name} at {self.url.partition('?')[0]}>"

    def show(self, height: int = HEIGHT, *, panels: bool = True) -> Cell:
        """Show the page in the cell of a notebook, as its last expression.

        Args:
            height: of the page [CSS pixels].
            panels: whether there are panels round the view.
        """
        return Cell(partial(self._in_cell, height, panels))

    def _repr_mimebundle_(self, **_: object) -> dict[str, str]:
        """The page, for the cell of a notebook."""
        return self._in_cell(HEIGHT, True)

    def _in_cell(self, height: int, panels: bool) -> dict[str, str]:
        found = {"text/plain": repr(self)}
        if self._notebook is None:
            return found
        picture = self._picture()
        found["text/html"] = self._notebook.frame(self.url, height, panels, picture)
        if picture is not None:
            found["image/png"] = base64.b64encode(picture).decode()
        return found

    def _picture(self) -> bytes | None:
        sessions = self._server.sessions
        if not sessions.all():
            return None
        # What is not read in time is not in the picture.
        with suppress(ServerError):
            sessions.wait_for_meshes(_MESHES_WITHIN)
        session = first(sessions)
        from sambot_viz.export.still_picture import still_picture

        return still_picture(session.lock, session.document_view, session.scene)

    def __enter__(self) -> Visualizer:
        return self

    def __exit__(self, *raised: object) -> None:
        self.stop()


Visualizer.__doc__ = (
    f"{inspect.cleandoc(Visualizer.__doc__ or '')}\n\n{keyword_help(Options)}"
)
