"""One robot, config, joints, frames and displays, shown to one audience.

The audience is all browsers (shared) or one (private): `viser.ViserServer` and
`viser.ClientHandle` have the same scene and GUI, so the same classes serve both.
All state of a session changes under its one lock. A single change is sent at once,
streams at the config's Frame Rate.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Set
from pathlib import Path
from typing import Any

from sambot_viz.displays.display import Display, DisplayContext
from sambot_viz.displays.model_reader import ModelReader
from sambot_viz.displays.scene.frame_nodes import FrameNodes
from sambot_viz.displays.scene.session_assets import Reader, SessionAssets
from sambot_viz.errors import UsageError
from sambot_viz.frames import FrameTree, Transform
from sambot_viz.frames.robot_frames import floating_problems
from sambot_viz.geometry import Matrix
from sambot_viz.joints import JointState
from sambot_viz.joints.presets import Presets
from sambot_viz.meshes.cache import MeshCache
from sambot_viz.options import Options
from sambot_viz.robot.model import Robot
from sambot_viz.rviz import RvizConfig
from sambot_viz.session.drawn_scene import DrawnScene
from sambot_viz.session.motion import Motion
from sambot_viz.session.problem_list import ProblemList
from sambot_viz.session.robot_state import RobotState
from sambot_viz.session.shared_state import Audience, SharedState
from sambot_viz.session.throttle import Throttle
from sambot_viz.session.tool_control import ToolControl
from sambot_viz.session.user_frames import UserFrames
from sambot_viz.session.view_control import ViewControl
from sambot_viz.session.worker import Worker


class Session(SharedState):
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
        super().__init__(audience, worker)
        self.options = options or Options()
        self.tree = FrameTree()
        self.problems = ProblemList(self)
        worker.on_error = self.problems.report_error
        self.poses = poses or Presets()
        self.added = UserFrames(self.tree)
        self._posed = RobotState(self.tree, self.added)
        self.context = DisplayContext(
            scene=audience.scene,
            tree=self.tree,
            nodes=FrameNodes(audience.scene),
            assets=SessionAssets(meshes, reader, self._assets_read),
            models=models,
            apply=self._apply,
        )
        self.drawn = DrawnScene(self.context, config)
        self._pacer = Throttle(worker, self.period, self._draw_moved)
        self.views = ViewControl(self)
        self.motion = Motion(self)
        self.tools = ToolControl(self)
        from sambot_viz.session.browser import Browser, Edits

        self.browsers = {}
        self.browser_listeners = []
        self.edits = Edits()
        for added in self.options.transforms:
            self.add_frame(added.parent, added.child, added.transform)

    @property
    def config(self) -> RvizConfig:
        """The document that is shown."""
        return self.drawn.config

    @property
    def displays(self) -> list[Display]:
        """The supported displays of the document, in its order."""
        return self.drawn.displays

    @property
    def period(self) -> float:
        """Shortest time between two pictures of a stream [s]."""
        return self.drawn.period

    @property
    def robot(self) -> Robot | None:
        """What is shown, or None before the first robot."""
        return self._posed.robot

    @property
    def joints(self) -> JointState | None:
        """The positions of its joints; move them with the methods of the session."""
        return self._posed.joints

    def join_browser(self, client):
        from sambot_viz.session.browser import Browser

        b = self.browsers[client.client_id] = Browser(self, client)
        for f in self.browser_listeners:
            f(b, True)

    def leave_browser(self, client_id):
        b = self.browsers.pop(client_id, None)
        for f in self.browser_listeners:
            if b:
                f(b, False)

    def set_entry(self, display, title, name, path, value):
        with self.change("status"):
            found = next(f for f in display.entries() if f.title == title)
            found.set(name, path, value)
            display.property_changed(f"{title}/{path}")

    def show_config(self) -> None:
        """Make the displays of the document and draw them; existing ones are kept."""
        with self.change("config"):
            self.drawn.make_displays()

    def set_config(self, config: RvizConfig) -> None:
        """Show another document: its displays and options; cameras stay."""
        with self.change():
            self.drawn.take_config(config)
            self._pacer.period = self.period
            self.context.nodes.sync(self.tree, self.context.fixed_frame)
            self.show_config()
            self._frames_changed()

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
        """Move some joints; see `move`."""
        self.move(positions, {})

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
        with self.lock:
            self._posed.center()
        self._pacer.request()

    def randomize_joints(self, seed: int | None = None) -> None:
        """Move all joints to random values of their ranges."""
        with self.lock:
            self._posed.randomize(seed)
        self._pacer.request()

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
        with self.change("frames"):
            self.added.set(parent, child, transform, static=static)
            self._posed.forget_pose(child)
            self._frames_changed()

    def remove_frame(self, child: str) -> None:
        """Remove an added frame.

        Raises:
            FrameError: that frame was not added.
        """
        with self.change("frames"):
            self.added.forget(child)
            self._posed.forget_pose(child)
            # A joint of the robot may hold that frame again.
            self._posed.build_tree()
            self.drawn.publish()
            self._frames_changed()

    def set_global(self, name: str, value: Any) -> None:
        """Set one of the Global Options."""
        with self.change("config"):
            fixed_frame_changed = self.drawn.set_option(name, value)
            self._pacer.period = self.period
            if fixed_frame_changed:
                self._frames_changed()
            elif name == "Background Color":
                self._redraw()

    def set_property(self, display: Display, path: str, value: Any) -> None:
        """Set one property of a display and draw what changes.

        Raises:
            UsageError: the value cannot be meant, or the display refuses it.
        """
        with self.change("status"):
            refusal = display.refusal(path, value)
            if refusal is None:
                display.config.set(path, value)
                display.property_changed(path)
        # Raised after the listeners were notified: the panel shows the old value again.
        if refusal is not None:
            raise UsageError(refusal)

    def set_enabled(self, display: Display, enabled: bool) -> None:
        """Enable or disable a display."""
        with self.change("status"):
            display.config.set_enabled(enabled)
            self.drawn.apply_enabled()

    def refresh(self) -> None:
        """Draw what has changed in the files; what has not is not sent again."""
        with self.change():
            self.context.assets.look_again()
            self._redraw()

    def files_saved(self, files: Set[Path]) -> None:
        """Read again the robots that displays have from some of these files."""
        with self.change("status"):
            self.drawn.read_again(files)

    def _apply(self, action: Callable[[], None]) -> None:
        with self.change("config", "status"):
            action()

    def _assets_read(self) -> None:
        with self.change("status"):
            self.drawn.assets_read()

    def close(self) -> None:
        """Send nothing any more."""
        self.context.apply = lambda action: None
        self.motion.close()
        self.views.close()
        self.tools.close()
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

    def _before_sending(self) -> None:
        if self.drawn.outdated:
            # A display has set frames of its own.
            self._frames_changed()

    def _frames_changed(self) -> None:
        self.drawn.draw_frames()
        self.notify("status")
        self.notify("frames")

    def _redraw(self) -> None:
        self.drawn.redraw()
        self.notify("status")
