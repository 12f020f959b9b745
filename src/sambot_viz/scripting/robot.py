"""The robot of a server, as a program moves it, looks at it and writes it to files."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import partial
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, TypeVar

from sambot_viz.errors import JointError, SourceError
from sambot_viz.files import write_atomically
from sambot_viz.frames import Transform
from sambot_viz.frames.transform import Pose
from sambot_viz.publishing.any_message import AnyMessage
from sambot_viz.publishing.outbound import GOAL_TOPIC, MAP, Goal
from sambot_viz.publishing.sent_message import SentMessage
from sambot_viz.robot.model import Positions, Robot
from sambot_viz.scripting.camera_control import CameraControl
from sambot_viz.scripting.displays import Displays, first
from sambot_viz.scripting.events import Moved, tell_moves
from sambot_viz.scripting.link_control import FrameControl, LinkControl, Links
from sambot_viz.scripting.player_control import PlayerControl
from sambot_viz.scripting.robots import AddedRobot, Robots
from sambot_viz.server.server import Server
from sambot_viz.session.robot.session_frames import FrameView
from sambot_viz.topics.account import Account

if TYPE_CHECKING:
    from sambot_viz.scripting.outputs import Motion

_F = TypeVar("_F", bound=Moved)
_P = TypeVar("_P", bound=Callable[[SentMessage], object])


class RobotControl:
    """The methods of a program for the robot that a server shows; see `Visualizer`."""

    def __init__(self, server: Server) -> None:
        self._server = server
        self._camera = CameraControl(server.sessions)
        self._player = PlayerControl(server.sessions)
        self._displays = Displays(server.sessions)
        self._links = Links(server.sessions)
        self._robots = Robots(server.sessions, self._move)

    @property
    def joint_positions(self) -> Mapping[str, float]:
        """Joint → position [rad or m], mimic joints included.

        With private sessions, those of the browser that came first.
        """
        session = first(self._server.sessions)
        with session.lock:
            joints = session.robot.joints
            return MappingProxyType({} if joints is None else joints.all_positions())

    @property
    def joints_over_limit(self) -> tuple[str, ...]:
        """The joints whose position is outside their limits: they are shown there.

        The Joints panel names them too. With private sessions, those of the browser
        that came first.
        """
        session = first(self._server.sessions)
        with session.lock:
            joints = session.robot.joints
            return () if joints is None else joints.over_limit()

    @property
    def frames(self) -> FrameView:
        """The frames, for look-ups: ``viz.frames.lookup(target, source)``."""
        session = first(self._server.sessions)
        return FrameView(session.frames.tree, session.lock)

    @property
    def camera(self) -> CameraControl:
        """The camera of all pages: ``viz.camera.look_at("base_link", (2, 1, 1))``."""
        return self._camera

    @property
    def player(self) -> PlayerControl:
        """The player of a recording: ``viz.player.jump(12.5)``."""
        return self._player

    @property
    def displays(self) -> Displays:
        """The displays: ``viz.displays["TF"].set("Show Names", False)``."""
        return self._displays

    def publish_goal(
        self,
        x: float,
        y: float,
        yaw: float,
        frame: str = MAP,
        *,
        topic: str = GOAL_TOPIC,
    ) -> str:
        """Send a live robot somewhere, as 2D Goal Pose does; `publish` must allow it.

        With private sessions nothing can be sent.

        Args:
            x: where [m].
            y: the same.
            yaw: the heading there [rad].
            frame: in which these are given.
            topic: where the robot takes goals.

        Returns:
            Who takes it, in words.

        Raises:
            PublishError: it is not allowed, or nothing would become of it, and why.
            SourceError: the robot takes no messages, or has left.
        """
        goal, session = Goal(frame, x, y, yaw), first(self._server.sessions)
        publisher = session.publisher
        with session.lock:
            publisher.prepare("goal", topic, goal.type_name)
        publisher.wait(topic, goal.type_name)
        with session.lock:
            return publisher.send(goal, topic, "Python")

    def publish(self, topic: str, type_name: str, message: Mapping[str, Any]) -> str:
        """Send a live robot a message once; `publish` must allow something.

        It is not latched. With private sessions nothing can be sent.

        Args:
            topic: the topic.
            type_name: the type of the message, such as
                "geometry_msgs/msg/PoseStamped".
            message: its fields by name; those that are left out are zero. A header
                without a stamp gets the time of the robot.

        Returns:
            The receivers, in words.

        Raises:
            PublishError: it is not allowed, it has no receiver, a number is not finite,
                a quaternion is not of length 1, or a field does not fit the type.
            SourceError: the robot accepts no messages, or has left.
        """
        made = AnyMessage(type_name, dict(message))
        session = first(self._server.sessions)
        publisher = session.publisher
        with session.lock:
            publisher.advertise(topic, type_name)
        publisher.wait(topic, type_name)
        with session.lock:
            return publisher.send_any(made, topic, "Python")

    def stop_robot(self) -> None:
        """Stop a live robot, as STOP does: zero velocities, and no goal any longer.

        Nothing happens where nothing may be sent. `stop` ends the server.

        Raises:
            SourceError: it did not reach the robot: the connection is lost, or the
                type of its velocities is not known.
        """
        session = first(self._server.sessions)
        failure = session.publisher.stop("Python")
        with session.change():
            session.roles.return_control()
        if failure:
            raise SourceError(failure)

    def on_published(self, callback: _P) -> _P:
        """Call back with each message that is sent to the robot, as `SentMessage`.

        Repeated velocities are reported once. Can be used as a decorator.
        """
        first(self._server.sessions).publisher.listeners.append(callback)
        return callback

    @property
    def topics(self) -> Mapping[str, Account]:
        """Topic → what became of it, as the Topics panel says it: ``.reason.text``.

        Some of the first messages of a recording are looked at. With private sessions,
        what the browser that came first sees.
        """
        session = first(self._server.sessions)
        with session.change():
            topics = None if session.data is None else session.data.topics
            if topics is None:
                return MappingProxyType({})
            topics.finish()
            return MappingProxyType({n: topics.account(n) for n in topics.names})

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
        """Return a frame, for viser nodes that move with it: see `FrameControl.node`.

        Raises:
            FrameError: there is no such frame.
            ServerError: no browser has opened a private session yet.
        """
        return self._links.frame(name)

    def set_joint_positions(self, positions: Positions) -> None:
        """Move some joints, in every browser; also outside their limits.

        `joints_over_limit` names those that are outside then.

        Args:
            positions: joint → position [rad or m], or a vector of all joints that take
                one, in the order of `Robot.joint_names`.

        Raises:
            JointError: an unknown joint, a mimic joint, no finite number, or a vector
                of another length.
            ServerError: the visualizer was stopped.
        """
        self._server.sessions.require_open()
        robot = self._server.sessions.opened
        if robot is not None:
            positions = robot.named_positions(positions)
        elif not isinstance(positions, Mapping):
            raise JointError("there is no robot yet whose joints a vector could move")
        self._move(positions)

    def _move(self, positions: Mapping[str, float]) -> None:
        self._server.sessions.require_open()
        for session in self._server.sessions.all(copies=False):
            session.robot.set_positions(positions)

    def add_robot(
        self,
        model: Path | str | Robot,
        name: str,
        *,
        parent: str | None = None,
        xyz: Pose = (0.0, 0.0, 0.0),
        rpy: Sequence[float] = (0.0, 0.0, 0.0),
    ) -> AddedRobot:
        """Show another robot beside the one that was opened, with its own joints.

        The page shows both as one: in the RobotModel display, and in the Joints panel
        with a group for each. Changes of its file are not followed. Vectors for
        `set_joint_positions` still mean the opened robot.

        Args:
            model: a file, the XML text, or a Robot.
            name: prefix of its links, joints and frames, such as "left" for
                "left/base_link".
            parent: the link that it is attached to; by default the root of the opened
                robot.
            xyz: position of its root link there [m]; or its whole pose, as a
                `Transform` or a (4, 4) matrix.
            rpy: its roll, pitch and yaw about fixed axes [rad], or a quaternion
                (x, y, z, w).

        Raises:
            UsageError: another robot has the name, there is no such parent, or no
                robot yet.
            RobotError: the model cannot be shown.
            FrameError: the pose is invalid.
            ServerError: the visualizer was stopped.
        """
        return self._robots.add(model, name, parent, xyz, rpy)

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
        """Attach a frame to another, as static_transform_publisher does.

        Args:
            parent: the frame in which the pose is given.
            child: the frame whose pose it is.
            xyz: position of the child in the parent [m]; or its whole pose, as a
                `Transform` or a (4, 4) matrix.
            rpy: its roll, pitch and yaw about fixed axes [rad], or a quaternion
                (x, y, z, w).

        Raises:
            FrameError: the frames would form a ring, a name is empty or used twice, or
                the pose is invalid.
            ServerError: the visualizer was stopped.
        """
        self._server.sessions.require_open()
        transform = Transform.of(xyz, rpy)
        for session in self._server.sessions.all(copies=False):
            session.frames.add(parent, child, transform)

    def snapshot(self, path: Path | str, *, size: tuple[int, int] = (800, 600)) -> None:
        """Write the 3D view as a PNG; no page needs to be open.

        A Chromium or Chrome of this machine draws it, with the camera of a new page:
        see `camera`. It takes some seconds, during which it is one of the viewers; the
        robot has to be at rest. Nodes that a program has added to `viser` are in it.

        Args:
            path: the file, which is written whole or not at all.
            size: width and height [pixels].

        Raises:
            BrowserError: no Chromium was found (the message says how to install or
                name one), or it ended.
            ServerError: it did not show everything in time.
            UsageError: the size is invalid, or the sessions are private.
            OSError: the file cannot be written.
        """
        from sambot_viz.scripting.outputs import picture_of

        write_atomically(Path(path), picture_of(self._server, size))

    def export(
        self, path: Path | str, *, sweep: bool = True, motion: Motion | None = None
    ) -> None:
        """Write the view as one HTML file that needs no server.

        Nodes that a program has added to `viser` are not in it.

        Args:
            path: the file, which is written whole or not at all.
            sweep: whether the page has a motion of each joint to its limits and back.
            motion: a motion of your own instead: times (T,) [s], and positions [rad or
                m], (T, N) in the order of `Robot.joint_names` or joint → (T,). It is
                linear in between, and plays 30 steps a second.

        Raises:
            JointError: a joint of the motion does not exist or follows another one, or
                its positions are not finite or of the wrong number.
            UsageError: the times of the motion do not grow, or are too many.
            OSError: the file cannot be written.
        """
        sessions, look = self._server.sessions, self._server.options.look or "rviz"
        shown, opened = first(sessions), sessions.opened
        from sambot_viz.scripting.outputs import page_of

        content = page_of(shown, opened, sweep=sweep, motion=motion, look=look)
        write_atomically(Path(path), content)
