"""One robot, config, joints, frames and displays, shown to one audience.

The audience is all browsers (shared) or one (private): `viser.ViserServer` and
`viser.ClientHandle` have the same scene and GUI, so the same classes serve both.
All state of a session changes under its one lock. A single change is sent at once,
streams at the config's Frame Rate.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from types import MappingProxyType

import viser

from sambot_viz.displays.model_reader import ModelReader
from sambot_viz.displays.scene.session_assets import Reader
from sambot_viz.frames import Transform
from sambot_viz.frames.hierarchy import plain_name
from sambot_viz.frames.robot_frames import floating_problems
from sambot_viz.geometry import Matrix
from sambot_viz.joints import JointState
from sambot_viz.joints.presets import Presets
from sambot_viz.meshes.cache import MeshCache
from sambot_viz.options import Options
from sambot_viz.robot.model import Robot
from sambot_viz.rviz import RvizConfig
from sambot_viz.session.browser import Browser
from sambot_viz.session.display_edits import DisplayEdits
from sambot_viz.session.motion import Motion
from sambot_viz.session.pick_rays import PickRays
from sambot_viz.session.problem_list import ProblemList
from sambot_viz.session.robot_state import RobotState
from sambot_viz.session.shared_state import Audience
from sambot_viz.session.throttle import Throttle
from sambot_viz.session.user_frames import UserFrame, UserFrames
from sambot_viz.session.view_control import ViewControl
from sambot_viz.session.worker import Worker


class Session(DisplayEdits):
    """One robot and its displays, shown to one audience.

    Args:
        audience: where to draw.
        worker: the thread that browsers, timers and files act in; it is closed with
            the session.
        config: the .rviz document; the session changes it as the user does.
        meshes: mesh files that are read already (shared by all sessions).
        models: reads other models, for a RobotModel from a file.
        reader: reads mesh files in the background; None reads them while drawing.
        options: the start pose, the static transforms and the wheels.
        poses: the named poses; None keeps new ones in memory.

    Attributes:
        browser_listeners: called with a browser that joined (True) or left (False),
            with the session locked.

    Raises:
        FrameError: static transforms that form a ring.
    """

    def __init__(
        self,
        audience: Audience,
        worker: Worker,
        config: RvizConfig,
        meshes: MeshCache,
        models: ModelReader | None = None,
        reader: Reader | None = None,
        options: Options | None = None,
        poses: Presets | None = None,
    ) -> None:
        super().__init__(audience, worker, config, meshes, models, reader)
        self.options = options or Options()
        self.problems = ProblemList(self)
        worker.on_error = self.problems.report_error
        self.poses = poses or Presets()
        self.added = UserFrames(self.tree)
        self._posed = RobotState(self.tree, self.added)
        self._pacer = Throttle(worker, self.period, self._draw_moved)
        self.views = ViewControl(self)
        self.motion = Motion(self)
        self.rays = PickRays(self)
        self._browsers: dict[int, Browser] = {}
        self.browser_listeners: list[Callable[[Browser, bool], None]] = []
        for added in self.options.transforms:
            self.add_frame(added.parent, added.child, added.transform)

    @property
    def robot(self) -> Robot | None:
        """What is shown, or None before the first robot."""
        return self._posed.robot

    @property
    def joints(self) -> JointState | None:
        """The positions of its joints; move them with the methods of the session."""
        return self._posed.joints

    # Browsers

    @property
    def browsers(self) -> Mapping[int, Browser]:
        """The browsers that see the session, by their numbers; read-only."""
        return MappingProxyType(self._browsers)

    def join_browser(self, client: viser.ClientHandle) -> Browser:
        """A browser has opened the page."""
        with self.lock:
            self.views.join(client)
            browser = self._browsers[client.client_id] = Browser(self, client)
            for listener in tuple(self.browser_listeners):
                listener(browser, True)
            return browser

    def leave_browser(self, client_id: int) -> None:
        """A browser has closed the page: what belongs to it alone is forgotten."""
        with self.lock:
            self.views.leave(client_id)
            browser = self._browsers.pop(client_id, None)
            if browser is not None:
                browser.close()
                self.edits.leave(client_id)
                for listener in tuple(self.browser_listeners):
                    listener(browser, False)

    # Robot, joints and frames

    def show_robot(self, robot: Robot) -> None:
        """Show a robot, or the same after an edit: joints keep their values."""
        with self.change("robot"):
            self.context.robot = robot
            self.context.assets.look_again()
            self._posed.take(robot, self.options.start_pose)
            self.motion.drive.take(robot)
            refused = self._posed.build_tree()
            self.context.moving = self._posed.moving
            self.drawn.publish()
            self.drawn.take_options()
            wheels = self.motion.drive.problems
            self.problems.of_frames = (*floating_problems(robot), *refused, *wheels)
            of_joints = self.joints.problems if self.joints else ()
            self.problems.set_model((*robot.problems, *of_joints))
            self._frames_changed()

    def set_joint_positions(self, positions: Mapping[str, float]) -> None:
        """Move some joints, as an edit that can be undone; see `move`."""
        names = tuple(positions)
        label = f"Move {names[0]}" if len(names) == 1 else "Move joints"
        self._move_joints(label, partial(self._posed.move, positions, {}), names)

    def use_pose(self, name: str) -> tuple[str, ...]:
        """Move the joints to a named pose.

        Returns:
            The joints of the pose that cannot be set in this robot.

        Raises:
            JointError: an unknown pose.
        """
        pose = self.poses.get(name)
        free = self.joints.free if self.joints is not None else ()
        known = {joint: pose[joint] for joint in pose if joint in free}
        self._move_joints(f"Pose {name}", partial(self._posed.move, known, {}))
        return tuple(joint for joint in pose if joint not in known)

    def move(
        self, positions: Mapping[str, float], frames: Mapping[str, Matrix]
    ) -> None:
        """Move some joints and some added frames, drawn together.

        Args:
            positions: joint → position [rad or m].
            frames: added frame → (4, 4) T_parent_child; kept, not copied.

        Raises:
            JointError: an unknown joint, a follower, or no finite number.
        """
        with self.lock:
            self._posed.move(positions, frames)
        self._pacer.request()

    def center_joints(self) -> None:
        """Move all joints to their start values."""
        self._move_joints("Center the joints", self._posed.center)

    def randomize_joints(self, seed: int | None = None) -> None:
        """Move all joints to random values of their ranges."""
        self._move_joints("Randomize the joints", lambda: self._posed.randomize(seed))

    def _move_joints(
        self, label: str, move: Callable[[], None], merge: tuple[str, ...] | None = None
    ) -> None:
        """Move joints; where they were is noted only for a browser that may undo it."""
        recording, joints = self.edits.recording, self.joints
        before = dict(joints.positions) if recording and joints is not None else {}
        with self.lock:
            move()
        self._pacer.request()
        if recording and joints is not None:
            after = {n: q for n, q in joints.positions.items() if before.get(n) != q}
            before = {name: before[name] for name in after}
            if after:
                self.edits.record(
                    label,
                    partial(self.move, before, {}),
                    partial(self.move, after, {}),
                    merge and ("joints", *merge),
                    of_document=False,
                )

    def add_frame(
        self, parent: str, child: str, transform: Transform, *, static: bool = True
    ) -> None:
        """Add a frame, or give an added one another pose or parent.

        Args:
            parent: the frame it is attached to.
            child: the frame.
            transform: T_parent_child.
            static: False for a frame that moves (see `move`), such as odom's child.

        Raises:
            FrameError: parent and child are the same, or would form a ring.
        """
        before = self.added.all.get(plain_name(child))
        self._set_frame(child, UserFrame(parent, transform, static))
        if static:
            self._record_frame(f"Add frame {child}", child, before)

    def remove_frame(self, child: str) -> None:
        """Remove an added frame.

        Raises:
            FrameError: that frame was not added.
        """
        before = self.added.all.get(plain_name(child))
        self._set_frame(child, None)
        self._record_frame(f"Remove frame {child}", child, before)

    def _record_frame(self, label: str, child: str, before: UserFrame | None) -> None:
        after = self.added.all.get(plain_name(child))
        self.edits.record(
            label,
            lambda: self._set_frame(child, before),
            lambda: self._set_frame(child, after),
            ("frame", plain_name(child)),
            of_document=False,
        )

    def _set_frame(self, child: str, frame: UserFrame | None) -> None:
        """Add a frame, or change it; None removes it."""
        with self.change("frames"):
            if frame is not None:
                parent, transform = frame.parent, frame.transform
                self.added.set(parent, child, transform, static=frame.static)
                self._posed.forget_pose(child)
            else:
                self.added.forget(child)
                self._posed.forget_pose(child)
                # A joint of the robot may hold that frame again.
                self._posed.build_tree()
                self.drawn.publish()
            self._frames_changed()

    def close(self) -> None:
        """Send nothing any more."""
        self.context.apply = lambda action: None
        self.motion.close()
        self.views.close()
        for browser in self._browsers.values():
            browser.close()
        self.rays.close()
        self._pacer.close()
        self.worker.close()

    def _draw_moved(self) -> None:
        """Send the poses of all that moved since the last time."""
        with self.lock:
            frames = self._posed.settle()
            if not frames:
                return
            with self.audience.atomic():
                self.drawn.place(frames.keys())
            # The poses are sent before any panel is notified.
            self.audience.flush()
            self.notify("joints")

    def _period_changed(self) -> None:
        self._pacer.period = self.period
