"""The viser server, its browsers, and their sessions: from start to stop."""

from __future__ import annotations

import asyncio
import atexit
import threading
import time
from collections.abc import Callable, Coroutine
from concurrent.futures import TimeoutError as FutureTimeoutError
from contextlib import suppress
from typing import TYPE_CHECKING, Any

import viser

from sambot_viz.joints.presets import Presets
from sambot_viz.options import Options
from sambot_viz.outlet import logger
from sambot_viz.panels.files_panel import Files
from sambot_viz.panels.saved_pictures import AskPage
from sambot_viz.server.client_sessions import ClientSessions
from sambot_viz.server.listener import Listener, listen
from sambot_viz.server.model_thread import ModelThread
from sambot_viz.server.outgoing import outbox
from sambot_viz.server.readiness import ServerState
from sambot_viz.server.sessions import MakeConfig, Sessions
from sambot_viz.topics.source_robot import SourceRobot
from sambot_viz.waiting import wait_for

# Most servers show no recording.
if TYPE_CHECKING:
    from sambot_viz.server.recordings import Recordings

_log = logger(__name__)

_LAST_ROUNDS = 1.0
"""The event loop gets this long to finish when the server stops [s]."""
_LAST_EDITS = 5.0
"""What pages have sent before is done within this time [s], or dropped."""


class Server:
    """A viser server whose every browser sees a session.

    Args:
        options: the address, the users, and the start state of every session.
        make_config: returns a fresh .rviz document; called once per session.
        models: reads other models, for a RobotModel from a file.
        listening: a server that already listens; None makes one.
        poses: the named poses; a private session has a copy that writes no file.
        files: opens and follows .rviz files for the shared session; None hides Open
            and Save.
        ask_page: exports the visible state as a page; None hides the export.
        moved_by: the robot of a live source, or of a recording, which every session
            plays for itself.
        recordings: opens other recordings than the shown ones; None hides that.

    Attributes:
        sessions: the sessions.
        clients: the clients, each with its session.

    Raises:
        ServerError: the address cannot be listened on.
        FrameError: the static transforms form a ring.
    """

    def __init__(
        self,
        options: Options,
        make_config: MakeConfig,
        models: ModelThread | None = None,
        listening: Listener | None = None,
        poses: Presets | None = None,
        files: Files | None = None,
        ask_page: AskPage | None = None,
        moved_by: SourceRobot | None = None,
        recordings: Recordings | None = None,
    ) -> None:
        self.options = options
        self._open = threading.Semaphore()
        self._stopped = threading.Event()
        self._end_broadcast: Callable[[], None] = lambda: None
        self._listener = listening or listen(options)
        self._viser = self._listener.viser
        self._moved_by = moved_by
        sessions = self.sessions = Sessions(
            self._viser, options, make_config, models, poses, moved_by
        )
        clients = self.clients = ClientSessions(
            self._viser,
            sessions,
            files,
            ask_page,
            recordings,
            self._listener.tell_joined,
        )
        self._listener.give(clients)
        answers = self._listener.answers
        answers.state = self._state
        if options.metrics:
            from sambot_viz.server.metrics import Metrics

            answers.metrics = Metrics(sessions, answers.traffic, moved_by).answer
        prepare_page(self._viser)
        outgoing = outbox.keep_apart(self._viser, clients.has_copy)
        if options.session == "shared":
            try:
                clients.open_shared()
            except BaseException:
                self.stop()
                raise
        # It runs before viser's handler, which would print a line, and would find
        # clients and sessions that still send.
        atexit.register(self.stop)
        self._viser.on_client_connect(clients.join)
        self._viser.on_client_disconnect(clients.leave)
        if options.broadcast is not None:
            # Few servers have followers.
            from sambot_viz.server.followers.broadcast import broadcast

            self._end_broadcast = broadcast(
                options, self._listener, outgoing, self.clients
            )

    @property
    def url(self) -> str:
        """The address for browsers: "http://127.0.0.1:8080"."""
        return self._listener.url()

    @property
    def presenter_url(self) -> str | None:
        """The presenter's link; None when everyone may change the robot."""
        if self.options.presenter is None:
            return None
        return self._listener.url(presenter=True)

    @property
    def viser(self) -> viser.ViserServer:
        """The viser server, for a program's own nodes and widgets."""
        return self._viser

    def _state(self) -> ServerState:
        """Return whether a robot, a lesson or data of a source is visible."""
        if self._stopped.is_set():
            return "stopping"
        if self.sessions.robot is not None or self.options.study is not None:
            return "ready"
        shows_data = self._moved_by is not None and self._moved_by.types
        return "ready" if shows_data else "waiting"

    def wait(self) -> None:
        """Wait until the server stops."""
        wait_for(self._stopped)

    def stop(self) -> None:
        """Stop the server and free the port; further calls do nothing."""
        if not self._open.acquire(blocking=False):
            return
        atexit.unregister(self.stop)
        self._stopped.set()
        loop = self._viser.get_event_loop()
        # The order matters: pages hold back new edits, the server handles the edits
        # that they have sent, and then it saves or keeps their texts.
        _run(loop, self._listener.tell_stop())
        self._save_texts()
        self._end_broadcast()
        self.sessions.close()
        _run(loop, _rounds())
        self._listener.close()

    def _save_texts(self) -> None:
        """Save a student's texts, and keep others, after all edits that pages sent."""
        place = self.sessions.shared_place
        if not self.options.edit or place is None or place.session is None:
            return
        text = None if place.window is None else place.window.text
        if text is None:
            return
        done, pages = threading.Semaphore(0), [*place.session.clients.all]
        for client_id in pages:
            place.worker.post(lambda: done.release(), client=client_id)
        end = time.monotonic() + _LAST_EDITS
        for _ in pages:
            done.acquire(timeout=max(0.0, end - time.monotonic()))
        with place.session.lock:
            # Other programs run the files, but for those of a lesson.
            for sentence in () if self.options.study is None else text.save_all():
                _log.warning("a text of the lesson is not saved: %s", sentence)
            for sentence in text.keep_drafts():
                _log.warning("an unsaved text is lost: %s", sentence)


def prepare_page(server: viser.ViserServer) -> None:
    """Add light to the page, and hide viser's controls except a panel for scripts."""
    server.gui.configure_theme(dark_mode=True, show_logo=False, show_share_button=False)
    server.gui.set_panel_label("Script")
    prepare_scene(server.scene)


def prepare_scene(scene: viser.SceneApi) -> None:
    """Replace viser's lights; a page without our script still has some light."""
    scene.configure_default_lights(enabled=False)
    scene.configure_environment_map(None)
    scene.add_light_ambient("/~ambient", intensity=2.0)


async def _rounds() -> None:
    """Let an event loop run the work that threads have posted, so that none remains.

    Setting the value of a widget takes three rounds of the loop.
    """
    for _ in range(5):
        await asyncio.sleep(0)


def _run(loop: asyncio.AbstractEventLoop, last: Coroutine[Any, Any, None]) -> None:
    """Run a coroutine on an event loop, if the loop still runs, and wait a moment."""
    if loop.is_closed():
        last.close()
        return
    with suppress(FutureTimeoutError):
        asyncio.run_coroutine_threadsafe(last, loop).result(_LAST_ROUNDS)
