"""What a session draws: the nodes of its frames, its displays, the background."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence, Set
from pathlib import Path

import numpy as np

from sambot_viz.displays.display import Display, DisplayContext, robot_displays
from sambot_viz.displays.registry import DISPLAYS
from sambot_viz.displays.scene.frame_nodes import short_id
from sambot_viz.displays.status import Status
from sambot_viz.rviz import DisplayConfig, FileProperty, RvizConfig


class DrawnScene:
    """The drawing of one session; not thread-safe, the session holds the lock.

    Args:
        context: what displays draw with.
        config: the .rviz document, which the edits of the user change.

    Attributes:
        config: the document that is shown.
        displays: the supported displays of the document, in its order.
    """

    def __init__(self, context: DisplayContext, config: RvizConfig) -> None:
        self.context = context
        self.displays: list[Display] = []
        self._keys = 0
        self._tree_drawn = context.tree.version
        self._background: tuple[int, int, int] | None = None
        self.take_config(config)

    # The document

    def take_config(self, config: RvizConfig, trusted: bool = True) -> None:
        """Take the options of a document; `make_displays` makes its displays.

        Args:
            config: the document.
            trusted: whether the models that it names are trusted, and its folder is
                open; False when a browser has chosen or written the file.
        """
        self.config = config
        context, file = self.context, config.file
        if trusted:
            context.config_file = None if file is None else Path(file)
            context.trusted_files = frozenset(
                str(display.get(path))
                for display in walk(config.displays)
                for path, declared in display.declared.items()
                if isinstance(declared.property, FileProperty)
            )
        self.take_options()

    def make_displays(self) -> None:
        """Make the displays of the document and draw them; existing ones are kept."""
        known = {id(display.config): display for display in self.displays}
        items = [i for i in walk(self.config.displays) if i.kind in DISPLAYS]
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

    @property
    def period(self) -> float:
        """Shortest time between two pictures of a stream [s]."""
        return 1.0 / max(1, int(self.config.global_options.acting("Frame Rate")))

    # Drawing

    @property
    def outdated(self) -> bool:
        """Whether the tree has other frames than those that are drawn."""
        return self.context.tree.version != self._tree_drawn

    def draw_frames(self) -> None:
        """Draw after a change of frames or of the fixed frame."""
        self._tree_drawn = self.context.tree.version
        self.context.nodes.sync(self.context.tree, self.context.fixed_frame)
        self.redraw()

    def redraw(self) -> None:
        """Draw all displays that are shown; what is the same is not sent again."""
        for display in self.displays:
            if display.shown:
                display.draw()

    def place(self, frames: Set[str]) -> None:
        """Send the poses of frames that moved."""
        self.context.nodes.place(self.context.tree, self.context.fixed_frame, frames)
        for display in self.displays:
            display.frames_moved(frames)

    def assets_read(self) -> None:
        """Draw mesh files and textures that have been read in the background."""
        for display in robot_displays(self.displays):
            display.assets_read()

    def publish(self) -> None:
        """Let the displays set their own frames in a tree that was cleared."""
        for display in robot_displays(self.displays):
            display.publish()

    def read_again(self, files: Iterable[Path]) -> None:
        """Read again the robots that displays have from some of these files."""
        saved = frozenset(files)
        for display in robot_displays(self.displays):
            if not saved.isdisjoint(display.files):
                display.read_again()

    def global_status(self) -> Status:
        """RViz's Global Status, Fixed Frame."""
        fixed = self.context.fixed_frame
        frames = self.context.tree.frames
        if fixed in frames:
            return Status("Ok", "OK")
        text = f"Frame [{fixed}] does not exist"
        if frames:
            return Status("Error", text)
        return Status("Warn", f"No tf data.  Actual error: {text}")

    def take_options(self) -> None:
        """Take the fixed frame and the background from the document."""
        options = self.config.global_options
        self.context.fixed_frame = str(options.get("Fixed Frame"))
        background = options.get("Background Color")
        if background != self._background:
            self._background = self.context.background = background
            pixel = np.array([[background]], dtype=np.uint8)
            self.context.scene.set_background_image(pixel, format="png")

    def _next_key(self) -> str:
        """A name that begins no other display's node names."""
        self._keys += 1
        return f"~{short_id(self._keys)}"


def walk(items: Sequence[DisplayConfig]) -> Iterator[DisplayConfig]:
    """All displays of a tree, groups before their members."""
    for item in items:
        yield item
        yield from walk(item.displays)
