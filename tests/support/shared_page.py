"""One page of one server, in which scenes are shown one after the other.

    def test_the_grid_is_there(shared_page):
        with shared_page.shows(config=file, model="robot.urdf") as session:
            pixels = shared_page.picture(session, (480, 640))

A page takes seconds to load, to make its WebGL and to compile its shaders; a scene a
third of one. Each scene is a new session, which begins with nothing. Only the page
stays, and has to forget what it has shown: the order of the scenes makes no difference.
"""

from __future__ import annotations

import itertools
import json
from collections.abc import Generator, Sequence
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import Any

import numpy as np
from patience import patience, until
from pictures import Image

from sambot_viz.displays.robot_display import Description
from sambot_viz.export.chromium import Chromium
from sambot_viz.export.view_picture import DRAW_WHEN_ASKED, page_address, picture_in
from sambot_viz.inputs import Inputs
from sambot_viz.meshes.cache import MeshCache
from sambot_viz.options import Options
from sambot_viz.robot.model import Robot
from sambot_viz.robot.model_source import open_text
from sambot_viz.server.listener import listen
from sambot_viz.server.model_thread import ModelThread
from sambot_viz.server.server import prepare_page, prepare_scene
from sambot_viz.session import Session
from sambot_viz.session.worker import Worker

_FENCE = "/~fence"
_HAS_ALL = f"""(number => {{
  const {{ nodePoseData, messageQueue }} = __viserMutable;
  return messageQueue.length === 0
    && nodePoseData[{json.dumps(_FENCE)}]?.position[0] === number;
}})"""
"""Whether all that was sent before the fence has been taken."""
_IS_OPEN = "window.sambotVizLook && window.__viserMutable?.scene"
_FORGET_PICTURE = "sambotVizDrawn = false; sambotVizLook.frames = 0"
"""What was counted in the last picture is not true of the next scene."""


class SharedPage:
    """A server, and a page that shows nothing else. Close it in the end.

    Args:
        chromium: opens the page.
    """

    def __init__(self, chromium: Chromium) -> None:
        self._chromium = chromium
        self._numbers = itertools.count(1)
        self._open()

    def _open(self) -> None:
        """Open server and page."""
        self._is_whole = True
        self._size = (640, 480)
        options = Options(port=0, gui=False, panels=False, look="rviz")
        with ExitStack() as opened:
            listener = opened.enter_context(listen(options))
            self._viser = listener.viser
            prepare_page(self._viser)
            address = page_address(listener.url())
            self._page = self._chromium.open(address, width=640, height=480)
            opened.callback(self._page.close)
            self._page.evaluate(DRAW_WHEN_ASKED)
            self._page.wait_for(_IS_OPEN, patience(60.0))
            # viser knows a page from its first camera on.
            until(self._viser.get_clients, 20.0)
            self._opened = opened.pop_all()

    def close(self) -> None:
        """Close page and server."""
        self._opened.close()

    @contextmanager
    def shows(self, **options: Any) -> Generator[Session]:
        """Show a scene until the end of the block.

        A recording is shown as it is at its end.

        Args:
            options: as those of `Visualizer`.
        """
        if not self._is_whole:
            self.close()
            self._open()
        with Inputs(Options(**options)) as inputs:

            def load(described: Description) -> Robot:
                opened = open_text(described.text or "", described.label)
                return inputs.load(opened, trusted=False)

            models = ModelThread(inputs.load, inputs.options.package_path, load)
            session = Session(
                self._viser,
                Worker(self._viser.get_event_loop()),
                inputs.document(),
                MeshCache(),
                models,
                options=inputs.options,
                moved_by=inputs.moved_by,
            )
            try:
                session.document.show()
                if inputs.options.model is not None or inputs.moved_by is not None:
                    session.show_robot(inputs.robot())
                if session.data is not None and session.data.player is not None:
                    session.data.player.pause()
                    session.data.player.jump(session.data.player.end_ns)
                assert models.wait(patience(20.0))
                yield session
            finally:
                session.close()
                self._viser.scene.reset()
                prepare_scene(self._viser.scene)

    def picture(self, session: Session, shape: tuple[int, ...]) -> Image:
        """What a session that is shown looks like through the view of its config.

        Args:
            session: of `shows`.
            shape: of the picture: height, width, ….
        """
        height, width = shape[:2]
        # After a page that has crashed or hangs, the next scene gets another one.
        self._is_whole = False
        if (width, height) != self._size:
            self._page.set_viewport(width, height)
            self._size = width, height
        self._page.evaluate(_FORGET_PICTURE)
        number, scene = next(self._numbers), self._viser.scene
        fence = scene.add_frame(_FENCE, show_axes=False, visible=False)
        fence.position = (number, 0.0, 0.0)
        self._viser.flush()
        self._page.wait_for(f"{_HAS_ALL}({number})", patience(20.0))
        (client,) = self._viser.get_clients().values()
        camera = session.document_view.camera
        found = picture_in(self._page, client, scene, width, height, camera)
        self._is_whole = True
        return found.astype(np.int16)

    def end_of_recording(
        self, folder: Path, shape: tuple[int, ...], packages: Sequence[Path] = ()
    ) -> Image:
        """The messages of a case at their end, through the view of its config.

        Args:
            folder: with messages.mcap and config.rviz.
            shape: as for `picture`.
            packages: folders of packages with the meshes of markers.
        """
        source, config = f"bag:{folder / 'messages.mcap'}", folder / "config.rviz"
        shown = self.shows(source=source, config=config, package_path=packages)
        with shown as session:
            return self.picture(session, shape)
