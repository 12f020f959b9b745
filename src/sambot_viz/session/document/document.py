"""The .rviz document of a session: its options, and another one in its place."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

from sambot_viz.errors import UsageError
from sambot_viz.rviz import FileProperty, RvizConfig
from sambot_viz.rviz.declarations import short_name
from sambot_viz.session.scene.scene import Scene, walk
from sambot_viz.session.signals import Change, Signal
from sambot_viz.session.undo import History


class ShownDocument:
    """Keeps the document, and draws it.

    Args:
        config: the .rviz document; it changes as the user changes it.

    Attributes:
        config: the document that is shown.
        replaced: another document is shown.
        options: the Global Options.
        displays: which displays there are, in which order, and their values.
        values: numbers and colours of displays, on which nothing else depends.
        tools: the settings of tools.
        time: which display's messages say when frames are drawn.
        views: the saved views.
        file: the file of the document; None when it was never in one.
        period: shortest time between two pictures of a stream [s].
        first_fixed_frame: which one the document named.
    """

    def __init__(
        self, config: RvizConfig, scene: Scene, history: History, change: Change
    ) -> None:
        self.replaced = Signal(change, None)
        self.options = Signal(change, None)
        self.displays = Signal(change, None)
        self.values = Signal(change, None)
        self.tools = Signal(change, None)
        self.views = Signal(change, None)
        self.time = Signal(change, None)
        self.file = Signal(change, config.file)
        self._scene = scene
        self._history = history
        self._change = change
        history.is_as_saved = lambda: not self.config.modified
        scene.assumed_frame = lambda: self.config.assumed_frame
        self._take(config, trusted=True)

    def show(self) -> None:
        """Make the displays of the document and draw them; existing ones are kept."""
        with self._change(self.displays):
            self._scene.make_displays(self.config.displays)

    def replace(self, config: RvizConfig, trusted: bool = True) -> None:
        """Show another document: its displays and options.

        Clients keep their views, until `Clients.show_view`.

        Args:
            config: the document.
            trusted: False when a client has chosen or written its file: the models
                that it names are then read as those that a client names.
        """
        told = (self.replaced, self.options, self.views, self.tools, self.time)
        with self._change(*told):
            self._history.clear()
            self._take(config, trusted)
            context = self._scene.context
            context.nodes.sync(context.tree, context.fixed_frame)
            self.show()
            self._scene.draw_frames()

    def set_option(self, name: str, value: Any) -> None:
        """Set one of the Global Options.

        Raises:
            UsageError: an unknown option, or a value that it cannot have.
        """
        self._set(
            f"Global Options: {name}",
            self._apply_options,
            lambda: self.config.global_options.set(name, value),
            ("option", name),
        )

    def set_tool_property(self, kind: str, path: str, value: Any) -> None:
        """Set a property of a tool that the document lists, for all clients.

        Raises:
            UsageError: the document does not list the tool, or the value cannot be
                meant.
        """
        config = next((tool for tool in self.config.tools if tool.kind == kind), None)
        if config is None:
            raise UsageError(f"the config has no tool '{kind}'")

        self._set(
            f"{short_name(kind)}: {path}",
            self._telling(self.tools),
            lambda: config.set(path, value),
            ("tool", kind, path),
        )

    def synchronize(self, mode: int, source: str) -> None:
        """Draw frames where they were at the times of a display's messages.

        Args:
            mode: RViz's SyncMode: 0 off, 1 exact, 2 approximate.
            source: the name of the display.

        Raises:
            UsageError: there is no such mode.
        """

        def set_all() -> None:
            set_time = self.config.set_time
            set_time("SyncMode", mode)
            set_time("SyncSource", source)
            if mode:
                # RViz takes no notice of the others without it.
                set_time("Experimental", True)

        self._set("Synchronization", self._telling(self.time), set_all, ("time",))

    @property
    def synchronization(self) -> tuple[int, str]:
        """RViz's SyncMode as it acts, and the name of its display."""
        get = self.config.time.get
        return int(get("SyncMode")) * bool(get("Experimental")), str(get("SyncSource"))

    def _set(
        self,
        label: str,
        apply: Callable[[Callable[[], object]], None],
        action: Callable[[], object],
        merge: tuple[str, ...],
    ) -> None:
        """Set something in the document, as an edit that can be undone."""
        with self._history.setting(label, apply, merge=merge):
            apply(action)

    def _telling(self, signal: Signal[None]) -> Callable[[Callable[[], object]], None]:
        def apply(action: Callable[[], object]) -> None:
            with self._change(signal):
                action()

        return apply

    def save(self, file: Path) -> None:
        """Write the document into a file, which is its own from then on.

        Raises:
            ConfigError: it cannot be written.
        """
        with self._change():
            self.config.save(file)
            self._history.saved()
            self.file.set(self.config.file)

    def take_options(self) -> None:
        """Draw with the options that the document has now."""
        context = self._scene.context
        before = (context.fixed_frame, context.background)
        self._scene.take_options(self.config.global_options)
        rate = int(self.config.global_options.acting("Frame Rate"))
        self.period = 1.0 / max(1, rate)
        if context.fixed_frame != before[0]:
            self._scene.draw_frames()
        elif context.background != before[1]:
            self._scene.redraw()

    def _apply_options(self, action: Callable[[], object]) -> None:
        with self._change(self.options):
            action()
            self.take_options()

    def _take(self, config: RvizConfig, trusted: bool) -> None:
        self.config = config
        self.file.set(config.file)
        context = self._scene.context
        if trusted:
            context.config_file = None if config.file is None else Path(config.file)
            context.trusted_files = frozenset(
                str(display.get(path))
                for display in walk(config.displays)
                for path, declared in display.declared.items()
                if isinstance(declared.property, FileProperty)
            )
        self._scene.take_options(config.global_options)
        rate = int(config.global_options.acting("Frame Rate"))
        self.period = 1.0 / max(1, rate)
        self.first_fixed_frame = str(config.global_options.get("Fixed Frame"))
