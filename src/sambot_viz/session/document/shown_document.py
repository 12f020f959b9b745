"""The document of a session, and what is drawn of it."""

from __future__ import annotations

from collections.abc import Callable, Set
from pathlib import Path

from sambot_viz.displays.display import Display, DisplayContext
from sambot_viz.displays.robot_display import ModelReader
from sambot_viz.displays.scene.frame_nodes import FrameNodes
from sambot_viz.displays.scene.session_assets import Reader, SessionAssets
from sambot_viz.frames import FrameTree
from sambot_viz.meshes.cache import MeshCache
from sambot_viz.rviz import RvizConfig
from sambot_viz.session.document.drawn_scene import DrawnScene
from sambot_viz.session.document.switches import first_switches
from sambot_viz.session.shared_state import SharedState
from sambot_viz.session.signals import Audience
from sambot_viz.session.undo import History
from sambot_viz.session.worker import Worker


class ShownDocument(SharedState):
    """Base of `Session`: the .rviz document, its displays, and the edits of both.

    Args:
        audience: where to draw.
        worker: the thread that browsers, timers and files act in.
        config: the .rviz document; the session changes it as the user does.
        meshes: mesh files that are read already (shared by all sessions).
        models: reads other models, for a RobotModel from a file.
        reader: reads mesh files in the background; None reads them while drawing.

    Attributes:
        tree: the frames.
        context: what displays draw with.
        drawn: the displays and the background.
        history: what clients can undo, and whether the document is saved.
        first_switches: how the switches of the document were before any edit.
        first_fixed_frame: which one the document named.
    """

    def __init__(
        self,
        audience: Audience,
        worker: Worker,
        config: RvizConfig,
        meshes: MeshCache,
        models: ModelReader | None,
        reader: Reader | None,
    ) -> None:
        super().__init__(audience, worker)
        self.change.finish = self._before_sending
        self.tree = FrameTree()
        self.context = DisplayContext(
            scene=audience.scene,
            tree=self.tree,
            nodes=FrameNodes(audience.scene),
            assets=SessionAssets(meshes, reader, self._assets_read),
            models=models,
            apply=self._apply,
        )
        self.drawn = DrawnScene(self.context, config)
        self.history = History(self.change)
        self._note_start(config)

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

    def show_config(self) -> None:
        """Make the displays of the document and draw them; existing ones are kept."""
        with self.change(self.signals.config):
            self.drawn.make_displays()

    def set_config(self, config: RvizConfig, trusted: bool = True) -> None:
        """Show another document: its displays and options.

        Browsers keep their views, until `Session.show_view`.

        Args:
            config: the document.
            trusted: False when a browser has chosen or written its file: the models
                that it names are then read as those that a browser names.
        """
        with self.change():
            self.history.clear()
            self.drawn.take_config(config, trusted)
            self._note_start(config)
            self._period_changed()
            self.context.nodes.sync(self.tree, self.context.fixed_frame)
            self.show_config()
            self._frames_changed()

    def _note_start(self, config: RvizConfig) -> None:
        self.first_switches = first_switches(config)
        self.first_fixed_frame = str(config.global_options.get("Fixed Frame"))

    def refresh(self) -> None:
        """Draw what has changed in the files; what has not is not sent again."""
        with self.change():
            self.context.assets.look_again()
            self._redraw()

    def files_saved(self, files: Set[Path]) -> None:
        """Read again the robots that displays have from some of these files."""
        with self.change(self.signals.status):
            self.drawn.read_again(files)

    def _apply(self, action: Callable[[], object]) -> None:
        with self.change(self.signals.config, self.signals.status):
            action()

    def _assets_read(self) -> None:
        with self.change(self.signals.status):
            self.drawn.assets_read()

    def _period_changed(self) -> None:
        """The document may have another Frame Rate; `Session` takes it."""

    def _before_sending(self) -> None:
        if self.drawn.outdated:
            # A display has set frames of its own.
            self._frames_changed()

    def _frames_changed(self) -> None:
        self.drawn.draw_frames()
        self.signals.status.touch()
        self.signals.frames.touch()

    def _redraw(self) -> None:
        self.drawn.redraw()
        self.signals.status.touch()
