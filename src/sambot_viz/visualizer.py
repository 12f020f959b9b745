"""A robot in the browser, from a script or from the command line."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import Future
from functools import partial
from pathlib import Path
from types import MappingProxyType, TracebackType

import viser

from sambot_viz import bundled
from sambot_viz.background import Loading, finished, in_thread
from sambot_viz.bundled import find
from sambot_viz.errors import Problem, ServerError
from sambot_viz.frames import FrameTree, Transform
from sambot_viz.frames.hierarchy import plain_name
from sambot_viz.frames.static_transform import StaticTransform
from sambot_viz.geometry import Vector3
from sambot_viz.open_config import declarations, load_config
from sambot_viz.robot.load import load_robot
from sambot_viz.robot.model import Robot
from sambot_viz.rviz import RvizConfig
from sambot_viz.server.reload import Documents, Reloader
from sambot_viz.server.server import Server, ServerOptions, SessionMode
from sambot_viz.session import Session
from sambot_viz.session.drive_control import WheelOptions
from sambot_viz.session.start_state import make_setup, poses_beside

PathLike = Path | str


class Visualizer:
    """A robot in the browser.

    Use it as a context manager, or call `stop`::

        with Visualizer(model="sam_bot.urdf.xacro", port=0) as viz:
            print(viz.url)
            viz.set_joint_positions({"drivewhl_l_joint": 1.0})
            viz.wait()

    Args:
        model: a model file, a package folder, a `Robot` (also one that is still being
            loaded); None is the bundled sam_bot.
        config: a .rviz file, or an `RvizConfig`; None is the one that belongs to the
            model, or the bundled one.
        host: address to listen on; the default is this machine only.
        port: 0 takes a free one.
        fixed_frame: overrides the config's Fixed Frame.
        gui: whether there is a Joints panel.
        session: "shared" shows all browsers one robot, "private" each its own; the
            methods below then act on all of them.
        xacro_args: arguments for xacro, name → text.
        package_path: folders in which ROS packages are looked for.
        allowed_origins: web pages of other origins that may use the server, such as
            "https://lab.example.org" for one behind a proxy.
        server: a viser server that listens already (host and port then say nothing);
            None makes one. It is stopped with this.
        trusted: False for a model of unknown origin (see `load_robot`).
        watch: whether the page follows the files: the model with all that it
            includes, its meshes and textures, and the config. A save with a mistake
            leaves the last good robot standing and says what is wrong.
        zeros: joint → start value [rad or m], instead of 0 or the middle.
        joint_positions: joint → position [rad or m] to begin with.
        joint_state: a yaml file with recorded positions to begin with.
        static_transforms: frames to add, each a `StaticTransform` or the arguments of
            static_transform_publisher in one text.
        wheels: the wheels to drive with; None finds them in the model.
        poses: the yaml file for named poses; None is one beside the model.
        on_reload: told what is wrong with the model (or nothing) whenever a reload
            changes that.

    Raises:
        RobotError: the model cannot be shown.
        ConfigError: the config is no .rviz document.
        UsageError: a file is not there.
        ServerError: the address cannot be listened on.
    """

    def __init__(
        self,
        model: PathLike | Robot | Loading | None = None,
        config: PathLike | RvizConfig | None = None,
        *,
        host: str = "127.0.0.1",
        port: int = 0,
        fixed_frame: str | None = None,
        gui: bool = True,
        session: SessionMode = "shared",
        xacro_args: Mapping[str, str] | None = None,
        package_path: Sequence[PathLike] = (),
        allowed_origins: Sequence[str] = (),
        server: viser.ViserServer | None = None,
        trusted: bool = True,
        watch: bool = False,
        zeros: Mapping[str, float] | None = None,
        joint_positions: Mapping[str, float] | None = None,
        joint_state: PathLike | None = None,
        static_transforms: Sequence[StaticTransform | str] = (),
        wheels: WheelOptions | None = None,
        poses: PathLike | None = None,
        on_reload: Callable[[Sequence[Problem]], None] | None = None,
    ) -> None:
        self._trusted = trusted
        self._xacro_args = dict(xacro_args or {})
        self._package_path = tuple(package_path)
        path = Path(model) if isinstance(model, Path | str) else None
        config_path = None if isinstance(config, RvizConfig | None) else Path(config)
        found = find(path, config_path)
        if isinstance(model, Future):
            loading = model
        elif isinstance(model, Robot):
            loading = finished(model)
        else:
            loading = in_thread(partial(self._load, found.model))
        document = config if isinstance(config, RvizConfig) else None
        no_config = document is None and found.config is None
        document = document or load_config(found.config or bundled.config_path())
        _set_fixed_frame(document, fixed_frame)
        beside = None if isinstance(model, Robot) else poses_beside(found.model)
        setup = make_setup(
            zeros=zeros,
            joint_positions=joint_positions,
            joint_state=joint_state,
            static_transforms=static_transforms,
            wheels=wheels,
            poses=Path(poses) if poses else beside,
        )
        options = ServerOptions(
            host, port, session, gui, allowed_origins=allowed_origins, setup=setup
        )
        documents = Documents(document, None if session == "shared" else _copy)
        self._server = Server(options, documents, self._load, server)
        self._reloader: Reloader | None = None
        try:
            robot = loading.result()
            if no_config and fixed_frame is None:
                _fit_fixed_frame(document, robot)
            self._server.show_robot(robot)
            if watch:
                self._reloader = Reloader(
                    self._server,
                    self._load,
                    None if isinstance(config, RvizConfig) else found.config,
                    documents,
                    partial(_set_fixed_frame, fixed_frame=fixed_frame),
                    on_reload,
                )
        except BaseException:
            self._server.stop()
            raise

    @property
    def url(self) -> str:
        """The address to open in a browser: "http://127.0.0.1:PORT"."""
        return self._server.url

    @property
    def viser(self) -> viser.ViserServer:
        """The viser server, to add nodes and widgets of one's own."""
        return self._server.viser

    @property
    def joint_positions(self) -> Mapping[str, float]:
        """Joint → position [rad or m], mimic joints included.

        With private sessions, those of the browser that came first.
        """
        session = self._first()
        with session.lock:
            joints = session.joints
            return MappingProxyType({} if joints is None else joints.all_positions())

    @property
    def frames(self) -> FrameTree:
        """The frames, for look-ups: ``viz.frames.lookup(target, source)``."""
        return self._first().tree

    def set_joint_positions(self, positions: Mapping[str, float]) -> None:
        """Move some joints, in every browser.

        Args:
            positions: joint → position [rad or m].

        Raises:
            JointError: an unknown joint, a mimic joint, or no finite number.
        """
        for session in self._server.sessions():
            session.set_joint_positions(positions)

    def set_static_transform(
        self,
        parent: str,
        child: str,
        xyz: Vector3 = (0.0, 0.0, 0.0),
        rpy: Vector3 = (0.0, 0.0, 0.0),
    ) -> None:
        """Hang a frame on another, as static_transform_publisher does.

        Args:
            parent: the frame in which the pose is given.
            child: the frame whose pose it is.
            xyz: where the child is in the parent [m].
            rpy: its roll, pitch and yaw about fixed axes [rad].

        Raises:
            FrameError: a ring, the same name twice, an empty name, or NaN.
        """
        transform = Transform.from_xyz_rpy(xyz, rpy)
        for session in self._server.sessions():
            session.set_static_transform(parent, child, transform)

    def wait(self) -> None:
        """Return when the server is stopped (by `stop`, or by Ctrl-C)."""
        self._server.wait()

    def stop(self) -> None:
        """Stop the server and free the port; a second call does nothing."""
        if self._reloader is not None:
            self._reloader.close()
        self._server.stop()

    def __enter__(self) -> Visualizer:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.stop()

    def _load(self, path: PathLike) -> Robot:
        return load_robot(
            path,
            xacro_args=self._xacro_args,
            package_path=self._package_path,
            trusted=self._trusted,
        )

    def _first(self) -> Session:
        sessions = self._server.sessions()
        if not sessions:
            raise ServerError("no browser has opened a private session yet")
        return sessions[0]


def _copy(document: RvizConfig) -> RvizConfig:
    return RvizConfig.parse(document.to_yaml(), declarations(), file=document.file)


def _set_fixed_frame(document: RvizConfig, fixed_frame: str | None) -> None:
    if fixed_frame is not None:
        document.global_options.set("Fixed Frame", fixed_frame)


def _fit_fixed_frame(document: RvizConfig, robot: Robot) -> None:
    """Let the bundled config, which is sam_bot's, fit any robot: its root serves."""
    if document.global_options.get("Fixed Frame") not in robot.links:
        document.global_options.set("Fixed Frame", plain_name(robot.root))
