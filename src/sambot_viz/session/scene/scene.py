"""The scene of a session: the nodes of its frames, its displays, the background."""

from __future__ import annotations

from collections.abc import Callable, Generator, Iterable, Iterator, Sequence, Set
from contextlib import contextmanager
from pathlib import Path

from sambot_viz.displays.display import Display, DisplayContext, Status, robot_displays
from sambot_viz.displays.registry import DISPLAYS
from sambot_viz.displays.robot_display import ModelReader
from sambot_viz.displays.scene.frame_nodes import FrameNodes, short_id
from sambot_viz.displays.scene.session_assets import Reader, SessionAssets
from sambot_viz.frames import FrameTree, LookupRefused
from sambot_viz.meshes.cache import MeshCache
from sambot_viz.robot.model import Robot
from sambot_viz.rviz import ConfigItem, DisplayConfig
from sambot_viz.session.scene.anchors import Anchors
from sambot_viz.session.signals import Audience, Change, Signal, connect
from sambot_viz.topics.whole_run import WholeRun
from sambot_viz.viser_private import fill_background


class Scene:
    """Draws for one audience; not thread-safe, the session holds the lock.

    Args:
        audience: the viser scene of its clients.
        tree: the frames.
        change: sends the drawing.
        meshes: mesh files that are read already (shared by all sessions).
        models: reads other models, for a RobotModel from a file.
        reader: reads mesh files in the background; None reads them while drawing.

    Attributes:
        context: the objects that displays draw with.
        anchors: nodes of a program that move with frames.
        displays: the supported displays of the document, in its order.
        statuses: emitted when reports of displays or their read files change.
        frames: emitted when the drawn frames, their parents or poses, or the fixed
            frame change; the robot has another signal for moves of joints.
        data: emitted when displays have drawn messages.
        progress: numbers of read files and of all files; None when all have been read.
        assumed_frame: returns the fixed frame chosen by the program; "" for none.
        whole_run: returns the places of frames over the length of a recording.
    """

    def __init__(
        self,
        audience: Audience,
        tree: FrameTree,
        change: Change,
        meshes: MeshCache,
        models: ModelReader | None = None,
        reader: Reader | None = None,
    ) -> None:
        self.context = DisplayContext(
            scene=audience.scene,
            tree=tree,
            nodes=FrameNodes(audience.scene),
            assets=SessionAssets(meshes, reader, self._assets_read),
            models=models,
            displays=lambda: self.displays,
            apply=self._apply,
            place=self.place,
        )
        self.anchors = Anchors(self.context)
        self.displays: list[Display] = []
        self.assumed_frame: Callable[[], str] = str
        self.whole_run: Callable[[], WholeRun] = WholeRun
        self.statuses = Signal(change, None)
        self.frames = Signal(change, None)
        self.data = Signal(change, None)
        self.progress: Signal[tuple[int, int] | None] = Signal(change, None)
        self._change = change
        self._keys, self._closed = 0, False
        self._tree_drawn = tree.version
        self._background: tuple[int, int, int] | None = None
        self._fixed_frame = self.context.fixed_frame
        change.finish = self._finish
        # Files are asked for, and arrive, only where displays are drawn.
        connect([self.statuses], self._tell_progress)

    # The document

    def make_displays(self, items: Sequence[DisplayConfig]) -> None:
        """Make the displays of a document and draw them; existing ones are kept."""
        known = {id(display.config): display for display in self.displays}
        items = [i for i in walk(items) if i.kind in DISPLAYS]
        for gone in known.keys() - {id(item) for item in items}:
            known.pop(gone).show(False)
        self.displays = [
            known.get(id(item))
            or DISPLAYS[item.kind](self.context, item, self._next_key())
            for item in items
        ]
        self.apply_enabled()

    def apply_enabled(self) -> None:
        """Show the displays that are enabled, with all groups above them."""
        for display in self.displays:
            display.show(display.config.active)
        self.statuses.touch()

    def clear(self) -> None:
        """Take out what displays draw, until `apply_enabled`; they listen no longer."""
        for display in self.displays:
            display.show(False)

    def close(self) -> None:
        """Draw nothing more of what threads bring, also of what waits for its turn."""
        self._closed = True

    def display_of(self, config: DisplayConfig) -> Display | None:
        """Return what draws a display of the document; None for an unsupported one."""
        found = (d for d in self.displays if d.config is config)
        return next(found, None)

    def take_options(self, options: ConfigItem) -> None:
        """Take the fixed frame and the background of a document."""
        self._fixed_frame = str(options.get("Fixed Frame"))
        self.context.fixed_frame = self.context.only_meant(self._fixed_frame)
        background = options.get("Background Color")
        if background != self._background:
            self._background = self.context.background = background
            fill_background(self.context.scene, background)

    # Drawing

    def take_robot(self, robot: Robot, moving: dict[str, str]) -> None:
        """Take the robot that displays draw.

        Args:
            robot: the robot.
            moving: child frame → the joint type that moves it.
        """
        self.context.robot, self.context.moving = robot, moving
        self.context.assets.look_again()

    def draw_frames(self) -> None:
        """Draw after a change of frames or of the fixed frame."""
        self._tree_drawn = self.context.tree.version
        # Which robot is meant is known once its frames are.
        self.context.fixed_frame = self.context.only_meant(self._fixed_frame)
        self.context.nodes.sync(self.context.tree, self.context.fixed_frame)
        self.anchors.place()
        self.redraw()
        self.frames.touch()

    def redraw(self) -> None:
        """Draw all shown displays; unchanged nodes are not sent again."""
        for display in self.displays:
            if display.shown:
                display.draw()
        self.statuses.touch()

    def refresh(self) -> None:
        """Draw what has changed in the files; what has not is not sent again."""
        with self._change():
            self.context.assets.look_again()
            self.redraw()

    def place(self, frames: Set[str]) -> None:
        """Send the poses of frames that moved."""
        if self.context.tree.version != self._tree_drawn:
            # The end of the change draws all: some may be gone, or hang elsewhere.
            return
        self.context.nodes.place(self.context.tree, self.context.fixed_frame, frames)
        self.anchors.place()
        with self._telling_statuses():
            for display in self.displays:
                display.frames_moved(frames)

    def time_passed(self) -> None:
        """Let what grows old grow older; nothing is sent where nothing changes."""
        with self._change(), self._telling_statuses():
            for display in self.displays:
                display.time_passed()

    def messages_came(self) -> None:
        """Let displays draw what has come for them; else nothing is sent."""
        messages = self.context.messages
        if messages is not None and messages.has_news:
            with self._change(self.data), self._telling_statuses():
                messages.deliver()

    @contextmanager
    def _telling_statuses(self) -> Generator[None]:
        before = [display.status.version for display in self.displays]
        yield
        if before != [display.status.version for display in self.displays]:
            self._change.mark(self.statuses)

    def publish(self) -> None:
        """Let the displays set their own frames in a tree that was cleared."""
        for display in robot_displays(self.displays):
            display.publish()

    def files_saved(self, files: Iterable[Path]) -> None:
        """Read again the robots that displays have from some of these files."""
        saved = frozenset(files)
        with self._change(self.statuses):
            for display in robot_displays(self.displays):
                if not saved.isdisjoint(display.files):
                    display.read_again()

    def global_status(self) -> Status:
        """Return RViz's Global Status, Fixed Frame."""
        fixed = self.context.fixed_frame
        frames = self.context.tree.frames
        if fixed in frames:
            return Status("Ok", "OK")
        text = f"Frame [{fixed}] does not exist"
        if len(meant := self.context.meant(fixed)) > 1:
            text = f"{text}: each robot has one, choose {' or '.join(meant)}"
        if frames:
            return Status("Error", text)
        if fixed == self.assumed_frame():
            return Status("Ok", "No tf data")
        return Status("Warn", f"No tf data.  Actual error: {text}")

    def fault_of(self, frame: str) -> LookupRefused | None:
        """Return why a frame has no place in the fixed frame; None when it has one."""
        try:
            self.context.tree.lookup(self.context.fixed_frame, frame)
        except LookupRefused as refused:
            return refused
        return None

    def _apply(self, action: Callable[[], object]) -> None:
        if self._closed:
            return
        with self._change(self.statuses):
            # It may have waited for the session, which has ended meanwhile.
            if not self._closed:
                action()

    def _assets_read(self) -> None:
        """Draw mesh files and textures that have been read in the background."""

        def draw() -> None:
            for display in self.displays:
                display.assets_read()

        self._apply(draw)

    def _finish(self) -> None:
        """Draw the parts that a change made outdated, before it is sent."""
        if self.context.tree.version != self._tree_drawn:
            # A display, or an undone edit, has set frames.
            self.draw_frames()

    def _tell_progress(self) -> None:
        self.progress.set(self.context.assets.progress)

    def _next_key(self) -> str:
        """Return a name that begins no other display's node names."""
        self._keys += 1
        return f"~{short_id(self._keys)}_"


def walk(items: Sequence[DisplayConfig]) -> Iterator[DisplayConfig]:
    """Yield all displays of a tree, groups before their members."""
    for item in items:
        yield item
        yield from walk(item.displays)
