"""The index of a lab: one page with the robots, their states and their links."""

from __future__ import annotations

import asyncio
import http
from asyncio import StreamWriter
from collections.abc import Sequence
from html import escape

from websockets.http11 import Request, Response

from sambot_viz.classroom.one_port import OnePort
from sambot_viz.classroom.requests import answer
from sambot_viz.content_policy import strict_policy
from sambot_viz.lab.indexed_robot import IndexedRobot, RobotState
from sambot_viz.lab.robots import RobotStates
from sambot_viz.lab.router_robots import RouterRobots
from sambot_viz.options import Options
from sambot_viz.server.listener import page_url
from sambot_viz.server.protection import access
from sambot_viz.server.protection.token_check import TokenCheck
from sambot_viz.sources.live.address import Address
from sambot_viz.text import text

_SAID: dict[RobotState, str] = {
    "ready": "ready",
    "waiting": "nothing is shown yet",
    "stopping": "stops",
    "locked": "behind a login",
    "other": "another program answers",
    "away": "does not answer",
}
_AGAIN = 10
"""Browsers reload the page after this time [s]."""
_STYLE = """
:root { color-scheme: light dark }
body { font: 16px/1.5 system-ui, sans-serif; max-width: 40em; margin: 2em auto;
  padding: 0 1em }
table { border-collapse: collapse; width: 100% }
td { border-top: 1px solid #8886; padding: .5em .3em; overflow-wrap: anywhere }
td:last-child { opacity: .75 }
.ready::before { content: "● "; color: #2a2 }
.waiting::before, .stopping::before { content: "● "; color: #c80 }
.away::before, .other::before, .locked::before { content: "○ " }
"""


def index_page(
    title: str,
    robots: Sequence[tuple[IndexedRobot, RobotState]],
    notes: Sequence[str],
    opened_at: str,
) -> str:
    """Return the index page.

    Args:
        title: heading of the page.
        robots: robots in order, each with its state.
        notes: what is wrong with the list itself.
        opened_at: name or address under which the browser opened the page.
    """
    rows = "".join(
        f"<tr><td>{_named(robot, opened_at)}</td>"
        f'<td class="{state}">{_SAID[state]}</td></tr>\n'
        for robot, state in robots
    )
    if not robots:
        rows = "<tr><td>No robot is there yet</td></tr>\n"
    below = "".join(f"<p>{escape(text(note))}</p>\n" for note in notes if note)
    shown = escape(text(title))
    return (
        '<!doctype html>\n<html lang="en"><head><meta charset="utf-8">'
        '<meta name="viewport" content="width=device-width">'
        '<meta name="robots" content="noindex">'
        f'<meta http-equiv="refresh" content="{_AGAIN}">'
        f"<title>{shown}</title><style>{_STYLE}</style></head><body>\n"
        f"<h1>{shown}</h1>\n<table>\n{rows}</table>\n{below}</body></html>\n"
    )


def _named(robot: IndexedRobot, opened_at: str) -> str:
    name, link = escape(text(robot.name)), robot.link(opened_at)
    if not link:
        return f"{name} <small>(only on its own machine)</small>"
    return f'<a href="{escape(link)}">{name}</a>'


class RobotIndex:
    """Serves the index, as a context.

    Args:
        options: address to listen on, and the token.
        title: heading of the page.
        robots: robots in order.
        routers: routers of zenoh with more robots.

    Raises:
        ServerError: the address cannot be listened on.
    """

    def __init__(
        self,
        options: Options,
        title: str,
        robots: Sequence[IndexedRobot],
        routers: Sequence[Address] = (),
    ) -> None:
        self.options = options
        self._title = title
        self._routers = [RouterRobots(address) for address in routers]
        self._states = RobotStates(robots, self._routers)
        check = TokenCheck(options.token, None, options.base_path)
        beside = self._hold if self._routers else None
        name = "sambot-viz-index"
        self._server = OnePort(options, name, check, self._answer, beside)
        self.port = self._server.port

    @property
    def url(self) -> str:
        """The address of the page."""
        return page_url(self.options, "", self.port)

    def __enter__(self) -> RobotIndex:
        """Start listening."""
        self._server.start()
        return self

    def __exit__(self, *_: object) -> None:
        """Stop, and free the port."""
        self._server.stop()

    async def _hold(self) -> None:
        await asyncio.gather(*(router.run() for router in self._routers))

    async def _answer(
        self, request: Request, path: str, writer: StreamWriter
    ) -> Response:
        if path.partition("?")[0] not in ("/", ""):
            return access.plain(http.HTTPStatus.NOT_FOUND, "No such page.")
        opened_at = access.hostname(request.headers["Host"])
        robots = await self._states.get()
        notes = [router.trouble for router in self._routers]
        page = index_page(self._title, robots, notes, opened_at)
        more = {"Content-Security-Policy": strict_policy("text")}
        return answer(page.encode(), "text/html", more=more)
