"""A follower: a server that shows another server's content instead of a session.

It has no model, no recording and no robot. Its pages can only view; to change anything,
users follow their link to the origin.
"""

from __future__ import annotations

import asyncio
import random
import time
from collections import deque
from collections.abc import Callable

from sambot_viz import viser_private
from sambot_viz.options import Options
from sambot_viz.outlet import logger
from sambot_viz.panels.rows.row_store import ClientRows
from sambot_viz.server.followers import link
from sambot_viz.server.followers.followed_rows import FollowedRows
from sambot_viz.server.followers.wire import (
    VERSION,
    Label,
    Snapshot,
    label_of,
    snapshot_of,
)
from sambot_viz.server.listener import Listener
from sambot_viz.server.protection.client_messages import CameraReport
from sambot_viz.sources.broadcast_place import (
    BroadcastPlace,
    origin_of,
    parse_place,
)
from sambot_viz.sources.zenoh.broadcast_session import BroadcastSession

ASK_PERIOD = 1.0
"""Shortest time between two requests for a snapshot [s]."""
ASK_SPREAD = 0.3
"""Followers that lack the same snapshot spread their requests over this time [s]."""
LONGEST_ANSWER = 30.0
"""Time after which a follower asks a silent origin again [s]."""
MOST_BEHIND = 100
"""Limit for frames that wait in a slow follower, about two seconds of a robot; beyond
it, the follower skips to the current state."""
MOST_WAITING = 1000
"""Limit for frames that wait for a snapshot; beyond it, the follower asks again."""
_log = logger(__name__)


def follow(options: Options, listener: Listener) -> Callable[[], None]:
    """Show another server's broadcast in a server; return a function that stops it."""
    assert options.follow is not None
    made = Relay(parse_place(options.follow, "--follow"), listener)
    listener.give(made)
    return link.run(listener.viser.get_event_loop(), made.run)


class Relay:
    """Shows the broadcast of an origin in a server.

    Call all methods on the event loop of the server.

    Args:
        place: place of the broadcast.
        listener: a server that listens, without content.
    """

    def __init__(self, place: BroadcastPlace, listener: Listener) -> None:
        self._place = place
        self._scene = viser_private.FollowedScene(listener.viser)
        self._rows = FollowedRows()
        # A load balancer may give a page's two connections to two followers.
        listener.channels.rows_of_all = self._rows.all
        self._session: BroadcastSession | None = None
        self._origins: dict[str, str] = {}
        # Origin and last frame number of the shown content.
        self._origin, self._number, self._url = "", 0, ""
        self._waiting: deque[tuple[Label, bytes]] = deque()
        self._is_asking, self._next_ask = False, 0.0
        self._trouble = link.Trouble(f"Following {place.label}")

    async def run(self) -> None:
        """Follow until cancelled."""
        self._say(f"Waiting for the zenoh router at {self._place.address.label}")
        await link.hold(self._place.address, self)

    # The connection to the router

    def begin(self, session: BroadcastSession) -> None:
        """Start to receive the broadcast."""
        self._session, self._is_asking = session, False
        self._origins.clear()
        session.take_frames(
            self._place.frames, MOST_BEHIND, self._take_frame, self._too_large
        )
        session.watch(self._place.origins, self._take_origin, self._look)

    def cut(self, why: str) -> None:
        """Keep showing the last state."""
        self._session = None
        self._say(why)

    def _take_origin(self, token: str, is_there: bool) -> None:
        origin, version = origin_of(token)
        if is_there:
            self._origins[origin] = version
        else:
            self._origins.pop(origin, None)
        self._look()

    def _look(self) -> None:
        """Show who broadcasts, and ask for missing content."""
        if not self._origins:
            self._say(
                "The origin has ended; this is what it showed last"
                if self._origin
                else f"Nobody broadcasts to {self._place.label}"
            )
        elif VERSION not in self._origins.values():
            other = next(iter(self._origins.values()))
            self._say(
                f"The origin has version {other}, and this follower {VERSION}: "
                "install the same one for both"
            )
        else:
            self._ask()

    def _say(self, trouble: str) -> None:
        self._trouble.set(trouble)
        self._rows.say(self._url, trouble)

    # Snapshots

    def _ask(self) -> None:
        """Ask for a snapshot, at limited rate, and not together with all others."""
        if self._is_asking or self._session is None:
            return
        self._is_asking = True
        pause = max(0.0, self._next_ask - time.monotonic())
        pause += random.uniform(0.0, ASK_SPREAD)
        self._next_ask = time.monotonic() + pause + ASK_PERIOD
        asyncio.get_running_loop().call_later(pause, self._ask_now, self._session)

    def _ask_now(self, session: BroadcastSession) -> None:
        if session is not self._session:
            return

        # The answer contains all that was published before the question.
        self._waiting.clear()

        def answered(content: bytes) -> None:
            snapshot = snapshot_of(content)
            if session is self._session and snapshot is not None:
                self._is_asking = False
                self._show(snapshot)

        def ended() -> None:
            if session is self._session and self._is_asking:
                self._is_asking = False
                self._look()

        session.ask(self._place.snapshot, LONGEST_ANSWER, answered, ended)

    def _show(self, snapshot: Snapshot) -> None:
        same = snapshot.origin == self._origin
        self._scene.replace(snapshot.scene, same=same)
        self._rows.replace(snapshot.rows)
        self._origin, self._number = snapshot.origin, snapshot.number
        self._url = snapshot.url
        self._say("")
        waiting, self._waiting = self._waiting, deque()
        for label, content in waiting:
            self._take(label, content)

    # Frames

    def _take_frame(self, key: str, content: bytes, attached: bytes) -> None:
        del key
        label = label_of(attached)
        if label is not None and VERSION == self._origins.get(label.origin, VERSION):
            self._take(label, content)

    def _too_large(self, size: int) -> None:
        del size
        self._ask()

    def _take(self, label: Label, content: bytes) -> None:
        same = label.origin == self._origin
        if same and label.number <= self._number:
            return
        if self._is_asking or not same or label.number != self._number + 1:
            if len(self._waiting) >= MOST_WAITING:
                self._waiting.clear()
            self._waiting.append((label, content))
            self._ask()
            return
        self._number = label.number
        try:
            if label.part == "scene":
                self._scene.take(content)
            else:
                self._rows.take(content)
        except ValueError as error:
            _log.warning(f"A frame of {self._place.label} is dropped: {error}")

    # Requests of clients

    def take_edit(self, client_id: int, edit: object) -> None:
        """Drop an edit: the page shows that it can only view."""

    def take_camera(self, client_id: int, report: CameraReport) -> None:
        """Drop a report: each page keeps its camera."""

    def may_edit(self, client_id: int) -> bool:
        """Return that no client may set widgets."""
        return False

    def behind(self, client_id: int, action: Callable[[], None]) -> None:
        """Run an action at once: clients cause no effects here."""
        action()

    def rows_of(self, client_id: int) -> ClientRows:
        """Return the rows, which all clients share."""
        return self._rows.all
