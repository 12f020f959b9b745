"""One robot, config, joints, frames and displays, shown to one audience.

The audience is all browsers (shared) or one (private): `viser.ViserServer` and
`viser.ClientHandle` have the same scene and GUI, so the same classes serve both.
All state of a session changes under its one lock; what a change makes different goes
out at once, streams go out at the config's Frame Rate.
"""

from __future__ import annotations

from collections.abc import Callable, Generator, Iterator, Mapping, Sequence, Set
from contextlib import contextmanager
from pathlib import Path
from typing import Any, Literal, Protocol

import numpy as np
import viser

from sambot_viz.displays.display import Display, DisplayContext
from sambot_viz.displays.model_reader import ModelReader
from sambot_viz.displays.registry import DISPLAYS
from sambot_viz.displays.scene.frame_nodes import FrameNodes, short_id
from sambot_viz.displays.scene.session_assets import Reader, SessionAssets
from sambot_viz.displays.status import Status
from sambot_viz.errors import Problem, SambotVizError, UsageError
from sambot_viz.frames import FrameTree, Transform
from sambot_viz.frames.robot_frames import floating_problems
from sambot_viz.geometry import Matrix
from sambot_viz.joints import JointState
from sambot_viz.joints.presets import Presets
from sambot_viz.meshes.cache import MeshCache
from sambot_viz.options import Options
from sambot_viz.robot.model import Robot
from sambot_viz.rviz import DisplayConfig, FileProperty, RvizConfig
from sambot_viz.session.motion import Motion
from sambot_viz.session.robot_state import RobotState
from sambot_viz.session.throttle import Throttle
from sambot_viz.session.tool_control import ToolControl
from sambot_viz.session.user_frames import UserFrames
from sambot_viz.session.view_control import ViewControl
from sambot_viz.session.worker import Worker, log_error

Event = Literal[
    "robot", "config", "frames", "joints", "status", "problems", "view", "tools"
]
Listener = Callable[[Event], None]
Reloaded = Literal["model", "config", "watch", "fault"]
"""What a save may fail to change, the model or the config, or why it fails at all."""


class Audience(Protocol):
    """What a session needs of a viser server or client."""

    scene: viser.SceneApi
    gui: viser.GuiApi

    def flush(self) -> None:
        """Send what is waiting now."""

    def atomic(self) -> Any:
        """A context in which messages are held back and then sent together."""


class Session:
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
        self.options = options or Options()
        self.worker = worker
        self.lock = worker.lock
        worker.on_error = self.report_error
        self.audience = audience
        self.config = config
        self.tree = FrameTree()
        self.displays: list[Display] = []
        self.problems: tuple[Problem, ...] = ()
        self.reload_problems: dict[Reloaded, tuple[Problem, ...]] = {}
        self.listeners: list[Listener] = []
        self.poses = poses or Presets()
        self.added = UserFrames(self.tree)
        self._posed = RobotState(self.tree, self.added)
        self._of_frames: tuple[Problem, ...] = ()
        self._keys = 0
        self._drawn_tree = self.tree.version
        self._background: tuple[int, int, int] | None = None
        self.context = DisplayContext(
            scene=audience.scene,
            tree=self.tree,
            nodes=FrameNodes(audience.scene),
            assets=SessionAssets(meshes, reader, self._assets_read),
            models=models,
            apply=self._apply,
        )
        self._pacer = Throttle(worker, self.period, self._draw_moved)
        self._trust_named_files()
        self._take_globals()
        self.views = ViewControl(self)
        self.motion = Motion(self)
        self.tools = ToolControl(self)
        for added in self.options.transforms:
            self.set_static_transform(added.parent, added.child, added.transform)

    # Opening

    def show_config(self) -> None:
        """Make the displays of the document and draw them; those there are stay."""
        with self.change("config"):
            known = {id(display.config): display for display in self.displays}
            items = [i for i in walk(self.config.displays) if i.kind in DISPLAYS]
            for gone in known.keys() - {id(item) for item in items}:
                known.pop(gone).show(False)
            self.displays = [
                known.get(id(item))
                or DISPLAYS[item.kind](self.context, item, self._next_key())
                for item in items
            ]
            self._apply_boxes()

    def set_config(self, config: RvizConfig) -> None:
        """Show another document: its displays and options; cameras stay."""
        with self.change():
            self.config = config
            self._trust_named_files()
            self._take_globals()
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
            refused = self._build_tree()
            self._take_globals()
            wheels = self.motion.drive.problems
            self._of_frames = (*floating_problems(robot), *refused, *wheels)
            of_joints = self.joints.problems if self.joints else ()
            self.set_problems((*robot.problems, *of_joints))
            self._frames_changed()

    def _build_tree(self) -> tuple[Problem, ...]:
        """Set all frames again; returns why some that were added cannot be set."""
        refused = self._posed.build_tree()
        for display in self.displays:
            display.publish()
        self.context.moving = self._posed.moving
        return refused

    @property
    def robot(self) -> Robot | None:
        """What is shown, or None before the first robot."""
        return self._posed.robot

    @property
    def joints(self) -> JointState | None:
        """The positions of its joints; move them with the methods of the session."""
        return self._posed.joints

    # Changing

    @contextmanager
    def change(self, *events: Event) -> Generator[None]:
        """Change state under the lock; send everything together; notify the panels."""
        with self.lock:
            with self.audience.atomic():
                yield
                if self.tree.version != self._drawn_tree:
                    # A display has brought frames of its own.
                    self._frames_changed()
                for event in events:
                    self._tell(event)
            self.audience.flush()

    def set_joint_positions(self, positions: Mapping[str, float]) -> None:
        """Move some joints.

        Args:
            positions: joint → position [rad or m].

        Raises:
            JointError: an unknown joint, a follower, or no finite number.
        """
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
            if self.joints is not None:
                self._posed.mark(self.joints.set_all(positions))
            self._posed.sweep(frames)
        self._pacer.request()

    def center_joints(self) -> None:
        """All joints to their start values."""
        with self.lock:
            if self.joints is not None:
                self._posed.mark(self.joints.center())
        self._pacer.request()

    def randomize_joints(self, seed: int | None = None) -> None:
        """All joints to random values of their ranges."""
        with self.lock:
            if self.joints is not None:
                self._posed.mark(self.joints.randomize(seed))
        self._pacer.request()

    def set_static_transform(
        self, parent: str, child: str, transform: Transform
    ) -> None:
        """Set a transform that holds until it is set again.

        Raises:
            FrameError: parent and child are the same, or would form a ring.
        """
        self.add_frame(parent, child, transform, static=True)

    def add_frame(
        self, parent: str, child: str, transform: Transform, *, static: bool
    ) -> None:
        """The same for a frame that may move (`move`), such as base_link in odom.

        Raises:
            FrameError: parent and child are the same, or would form a ring.
        """
        with self.change("frames"):
            self.added.set(parent, child, transform, static=static)
            self._posed.forget_sweep(child)
            self._frames_changed()

    def remove_frame(self, child: str) -> None:
        """Take an added frame away again.

        Raises:
            FrameError: that frame was not added.
        """
        with self.change("frames"):
            self.added.forget(child)
            self._posed.forget_sweep(child)
            # The robot's own joint may have held that frame before.
            self._build_tree()
            self._frames_changed()

    def set_global(self, name: str, value: Any) -> None:
        """Set one of the Global Options."""
        with self.change("config"):
            self.config.global_options.set(name, value)
            before = self.context.fixed_frame
            self._take_globals()
            if self.context.fixed_frame != before:
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
        if refusal is not None:
            raise UsageError(refusal)

    def set_enabled(self, display: Display, enabled: bool) -> None:
        """Tick or untick a display's box."""
        with self.change("status"):
            display.config.set_enabled(enabled)
            self._apply_boxes()

    def refresh(self) -> None:
        """Draw what has changed in the files; what has not is not sent again."""
        with self.change():
            self.context.assets.look_again()
            self._redraw()

    def files_saved(self, files: Set[Path]) -> None:
        """Read again the robots that displays have from some of these files."""
        with self.change("status"):
            for display in self.displays:
                if not files.isdisjoint(display.files):
                    display.read_again()

    def _apply(self, action: Callable[[], None]) -> None:
        with self.change("config", "status"):
            action()

    def _assets_read(self) -> None:
        with self.change("status"):
            for display in self.displays:
                if display.shown:
                    display.assets_read()

    def set_problems(self, problems: Sequence[Problem]) -> None:
        """Show the audience what is wrong with the model."""
        with self.lock:
            self.problems = (*problems, *self._of_frames)
            self._tell("problems")

    def set_reload_problems(self, of: Reloaded, problems: Sequence[Problem]) -> None:
        """Show why the last save is not what is shown; an empty list when it is."""
        if self.reload_problems.get(of, ()) != tuple(problems):
            with self.change("problems"):
                self.reload_problems[of] = tuple(problems)

    def report_error(self, error: Exception) -> None:
        """Show an exception that nobody caught in the page, and log it once."""
        if isinstance(error, SambotVizError):
            problem = Problem("error", "refused", str(error))
        else:
            text = f"internal error: {type(error).__name__}: {error}"
            hint = "start the program again, and please report it"
            problem = Problem("error", "internal-error", text, hint)
        with self.lock:
            if self.reload_problems.get("fault") == (problem,):
                return
            if not isinstance(error, SambotVizError):
                log_error(error)
            self.set_reload_problems("fault", (problem,))

    # Asking

    def global_status(self) -> Status:
        """RViz's Global Status, Fixed Frame."""
        fixed = self.context.fixed_frame
        frames = self.tree.frames
        if fixed in frames:
            return Status("Ok", "OK")
        text = f"Frame [{fixed}] does not exist"
        if frames:
            return Status("Error", text)
        return Status("Warn", f"No tf data.  Actual error: {text}")

    def close(self) -> None:
        """Send nothing any more."""
        self.context.apply = lambda action: None
        self.motion.close()
        self.views.close()
        self.tools.close()
        self._pacer.close()
        self.worker.close()

    # Inside

    def _draw_moved(self) -> None:
        """Send the poses of all that moved since the last time."""
        with self.lock:
            frames = self._posed.settle()
            if not frames:
                return
            with self.audience.atomic():
                self.context.nodes.place(self.tree, self.context.fixed_frame, frames)
                for display in self.displays:
                    display.frames_moved(frames)
            # The poses leave before any panel is told.
            self.audience.flush()
            self._tell("joints")

    def _frames_changed(self) -> None:
        self._drawn_tree = self.tree.version
        self.context.nodes.sync(self.tree, self.context.fixed_frame)
        self._redraw()
        self._tell("frames")

    def _redraw(self) -> None:
        for display in self.displays:
            if display.shown:
                display.draw()
        self._tell("status")

    def _trust_named_files(self) -> None:
        """Remember which files the config names, before a browser can change it."""
        file = self.config.file
        self.context.config_file = None if file is None else Path(file)
        self.context.trusted_files = frozenset(
            str(display.get(path))
            for display in walk(self.config.displays)
            for path, declared in display.declared.items()
            if isinstance(declared.property, FileProperty)
        )

    def _take_globals(self) -> None:
        options = self.config.global_options
        self.context.fixed_frame = str(options.get("Fixed Frame"))
        background = options.get("Background Color")
        if background != self._background:
            self._background = self.context.background = background
            pixel = np.array([[background]], dtype=np.uint8)
            self.audience.scene.set_background_image(pixel, format="png")
        self._pacer.period = self.period

    @property
    def period(self) -> float:
        """Shortest time between two pictures of a stream [s]."""
        return 1.0 / max(1, int(self.config.global_options.acting("Frame Rate")))

    def _apply_boxes(self) -> None:
        """Show what is ticked itself and in all groups above it."""
        for display in self.displays:
            display.show(display.config.active)

    def _next_key(self) -> str:
        """A name that begins no other display's node names."""
        self._keys += 1
        return f"~{short_id(self._keys)}"

    def _tell(self, event: Event) -> None:
        for listener in tuple(self.listeners):
            try:
                listener(event)
            except Exception as error:
                # A panel that fails must not take the others, or the picture, along.
                self.report_error(error)


def walk(items: Sequence[DisplayConfig]) -> Iterator[DisplayConfig]:
    """All displays of a tree, groups before their members."""
    for item in items:
        yield item
        yield from walk(item.displays)
