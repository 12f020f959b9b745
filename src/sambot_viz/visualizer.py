"""A robot in the browser, from a script or from the command line."""

from __future__ import annotations

import base64
import functools
import inspect
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from functools import partial
from pathlib import Path
from types import MappingProxyType, TracebackType
from typing import Any, Concatenate, ParamSpec, TypeVar

import viser

from sambot_viz.errors import JointError, RobotError, ServerError, did_you_mean
from sambot_viz.export.page_file import ask_page
from sambot_viz.export.still_picture import still_picture
from sambot_viz.files import write_atomically
from sambot_viz.flags import keyword_help
from sambot_viz.frames import Transform
from sambot_viz.frames.transform import Pose
from sambot_viz.inputs import Inputs
from sambot_viz.jupyter.notebook import HEIGHT, Cell, remember, stop_former
from sambot_viz.jupyter.notebook import notebook as here
from sambot_viz.options import Options
from sambot_viz.robot.model import Positions, Robot
from sambot_viz.rviz import RvizConfig
from sambot_viz.scripting.camera import CameraControl
from sambot_viz.scripting.displays import Displays, first
from sambot_viz.scripting.events import Moved, tell_moves
from sambot_viz.scripting.files import Motion, page_of, picture_of
from sambot_viz.scripting.links import FrameControl, LinkControl, Links
from sambot_viz.server.config_store import ConfigStore, Sources
from sambot_viz.server.listener import Listener, listen
from sambot_viz.server.model_thread import ModelThread
from sambot_viz.server.reload import Reloader
from sambot_viz.server.server import Server
from sambot_viz.session import Session
from sambot_viz.session.config_file import take_root
from sambot_viz.session.robot.frames import FrameView

_P = ParamSpec("_P")
_F = TypeVar("_F", bound=Moved)

_MESHES_WITHIN = 5.0
"""A cell waits so long for the meshes of its picture [s]."""
PANELS_WITHOUT_ROBOT = 1.0
"""The page gets its panels before the robot when a model takes longer to load [s]."""


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


class Visualizer:
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
            inputs: the model and the config, with their options. What is broken in
                them, if they may be, is shown by its problem, and drawn as soon as
                it is fixed.
            listening: a server that listens already, so that the options' host
                and port do not count; it is stopped with the visualizer.

        Raises:
            SambotVizError: as the constructor.
        """
        visualizer = cls.__new__(cls)
        visualizer._notebook = None
        visualizer._start(inputs, listening)
        return visualizer

    def _start(self, inputs: Inputs, listening: Listener | None) -> None:
        options = inputs.options
        inputs.begin()
        document = inputs.document()
        prepare = partial(_set_fixed_frame, fixed_frame=options.fixed_frame)
        prepare(document)
        self._configs = ConfigStore(
            document,
            options.session == "shared",
            prepare,
            inputs.config,
        )
        fits_any = inputs.takes_bundled_config and options.fixed_frame is None
        self._stand_in = document if fits_any else None
        self._stand_in_frame = document.global_options.get("Fixed Frame")
        self._reloader: Reloader | None = None
        models = ModelThread(inputs.load, options.package_path)
        self._server = Server(
            options,
            self._configs,
            models,
            listening,
            inputs.presets(),
            self._configs,
            ask_page,
        )
        self._camera = CameraControl(self._server.sessions)
        self._displays = Displays(self._server.sessions)
        self._links = Links(self._server.sessions)
        try:
            if not inputs.wait(PANELS_WITHOUT_ROBOT):
                self._server.sessions.show_panels()
            refusal = inputs.refusal()
            if refusal is None:
                self._show(inputs.robot())
            self._server.sessions.show_panels()
            if options.watch:
                self._follow(inputs, refusal)
        except BaseException:
            self._server.stop()
            raise

    def _show(self, robot: Robot) -> None:
        """Show a robot; the bundled config, which is sam_bot's, fits the first one."""
        sessions = self._server.sessions
        if sessions.robot is None and self._stand_in is self._configs.current:
            self._fit_fixed_frame(self._configs.current, robot)
            for session in sessions.all():
                with session.change(session.document.options):
                    self._fit_fixed_frame(session.document.config, robot)
        sessions.show_robot(robot)

    def _fit_fixed_frame(self, document: RvizConfig, robot: Robot) -> None:
        """Take the root of a robot as the fixed frame, unless a user has chosen one."""
        if document.global_options.get("Fixed Frame") == self._stand_in_frame:
            take_root(document, robot)

    def _follow(self, inputs: Inputs, refusal: RobotError | None) -> None:
        """Show the files again when they are saved."""
        # A program may go to another folder.
        model = None if inputs.model is None else inputs.model.absolute()
        sources = Sources(
            model,
            inputs.load,
            self._show,
            self._configs,
            inputs.opened,
        )
        reloader = Reloader(self._server.sessions, sources, inputs.options.on_reload)
        if refusal is not None:
            reloader.refuse_model(refusal)
        if inputs.broken_config is not None:
            reloader.refuse_config(inputs.broken_config)
        reloader.start()
        self._reloader = reloader

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
        What a browser sends back is checked, and only this reaches your callbacks: the
        value of a visible and enabled widget, if it has the type of the value before
        (texts up to 1000 characters), buttons that are pressed, cameras, clicks and
        rectangles in the 3D view, and pictures from ``get_render``. Not let through are
        clicks on nodes, drags, transform controls, buttons that are held, keys of
        commands, forms and uploads: their callbacks are never called, and a warning is
        logged.

        With private sessions, what is added here is shown to all browsers.
        """
        return self._server.viser

    @property
    def joint_positions(self) -> Mapping[str, float]:
        """Joint → position [rad or m], mimic joints included.

        With private sessions, those of the browser that came first.
        """
        session = self._first()
        with session.lock:
            joints = session.robot.joints
            return MappingProxyType({} if joints is None else joints.all_positions())

    @property
    def frames(self) -> FrameView:
        """The frames, for look-ups: ``viz.frames.lookup(target, source)``."""
        session = self._first()
        return FrameView(session.frames.tree, session.lock)

    @property
    def camera(self) -> CameraControl:
        """The camera of all pages: ``viz.camera.look_at("base_link", (2, 1, 1))``."""
        return self._camera

    @property
    def displays(self) -> Displays:
        """The displays: ``viz.displays["TF"].set("Show Names", False)``."""
        return self._displays

    def link(self, name: str) -> LinkControl:
        """Return a link of the robot, to colour it or to hang nodes of viser below it.

        ::

            viz.link("laser").color = (255, 0, 0)
            viz.viser.scene.add_label(f"{viz.link('laser').node}/text", "laser")

        Raises:
            UsageError: the robot has no such link.
        """
        return self._links.link(name)

    def frame(self, name: str) -> FrameControl:
        """Return a frame, to hang nodes of viser below it: see `FrameControl.node`.

        Raises:
            FrameError: there is no such frame.
            ServerError: no browser has opened a private session yet.
        """
        return self._links.frame(name)

    def set_joint_positions(self, positions: Positions) -> None:
        """Move some joints, in every browser.

        Args:
            positions: joint → position [rad or m], or a vector of all joints that take
                one, in the order of `Robot.joint_names`.

        Raises:
            JointError: an unknown joint, a mimic joint, no finite number, or a vector
                of another length.
            ServerError: the visualizer was stopped.
        """
        self._server.sessions.require_open()
        robot = self._server.sessions.robot
        if robot is not None:
            positions = robot.named_positions(positions)
        elif not isinstance(positions, Mapping):
            raise JointError("there is no robot yet whose joints a vector could move")
        for session in self._server.sessions.all(copies=False):
            session.robot.set_positions(positions)

    def on_joint_positions(self, callback: _F) -> _F:
        """Call a function whenever joints have moved, whoever has moved them.

        It can be used as a decorator. With private sessions it is called for each of
        them. An error that it raises is logged.

        Args:
            callback: takes joint → position [rad or m], mimic joints included. It is
                called after the browsers were told, at most at the Frame Rate of the
                config, in a thread of the session, which waits for it.

        Returns:
            The callback.
        """
        self._server.sessions.follow(partial(tell_moves, callback=callback))
        return callback

    def set_static_transform(
        self,
        parent: str,
        child: str,
        xyz: Pose = (0.0, 0.0, 0.0),
        rpy: Sequence[float] = (0.0, 0.0, 0.0),
    ) -> None:
        """Hang a frame on another, as static_transform_publisher does.

        Args:
            parent: the frame in which the pose is given.
            child: the frame whose pose it is.
            xyz: where the child is in the parent [m]; or its whole pose, as a
                `Transform` or a (4, 4) matrix.
            rpy: its roll, pitch and yaw about fixed axes [rad], or a quaternion
                (x, y, z, w).

        Raises:
            FrameError: a ring, the same name twice, an empty name, NaN, or what is no
                pose.
            ServerError: the visualizer was stopped.
        """
        self._server.sessions.require_open()
        transform = Transform.of(xyz, rpy)
        for session in self._server.sessions.all(copies=False):
            session.frames.add(parent, child, transform)

    def snapshot(self, path: Path | str, *, size: tuple[int, int] = (800, 600)) -> None:
        """Write the 3D view as a PNG, without a page that is open.

        A Chromium or Chrome of this machine draws it, from where a page begins: see
        `camera`. It takes some seconds, in which it is one of the viewers; the robot
        has to be at rest. What a program has added to `viser` is in the picture.

        Args:
            path: the file, which is written whole or not at all.
            size: width and height [pixels].

        Raises:
            BrowserError: no Chromium was found (the message says how to get one, or
                to name it), or it ended.
            ServerError: it did not show everything in time.
            UsageError: the size makes no sense, or the sessions are private.
            OSError: the file cannot be written.
        """
        write_atomically(Path(path), picture_of(self._server, size))

    def export(
        self, path: Path | str, *, sweep: bool = True, motion: Motion | None = None
    ) -> None:
        """Write what is shown as one HTML file that needs no server.

        What a program has added to `viser` is not in it.

        Args:
            path: the file, which is written whole or not at all.
            sweep: whether the page has a motion of each joint to its limits and back.
            motion: a motion of your own instead: times (T,) [s], and positions [rad or
                m], (T, N) in the order of `Robot.joint_names` or joint → (T,). It is
                linear in between, and plays 30 steps a second.

        Raises:
            JointError: a joint of the motion that does not exist or follows another
                one, no finite numbers, or another number of them.
            UsageError: the times of the motion do not grow, or are too many.
            OSError: it cannot be written.
        """
        content = page_of(self._first(), sweep=sweep, motion=motion)
        write_atomically(Path(path), content)

    def wait(self) -> None:
        """Return when the server is stopped (by `stop`, or by Ctrl-C)."""
        self._server.wait()

    def stop(self) -> None:
        """Stop the server and free the port; a second call does nothing."""
        if self._reloader is not None:
            self._reloader.close()
        self._server.stop()

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
        session = self._first()
        return still_picture(session.lock, session.document_view, session.scene)

    def __enter__(self) -> Visualizer:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.stop()

    def _first(self) -> Session:
        return first(self._server.sessions)


def _set_fixed_frame(document: RvizConfig, fixed_frame: str | None) -> None:
    if fixed_frame is not None:
        document.global_options.set("Fixed Frame", fixed_frame)


Visualizer.__doc__ = (
    f"{inspect.cleandoc(Visualizer.__doc__ or '')}\n\n{keyword_help(Options)}"
)
