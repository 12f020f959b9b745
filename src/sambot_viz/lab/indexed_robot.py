"""A robot in the index of a lab, and the link to its page."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from sambot_viz.server.protection.access import only_this_machine

RobotState = Literal["ready", "waiting", "stopping", "locked", "other", "away"]
"""The state that a server reports; "locked" for a server that requires a login,
"other" for another program, and "away" for a server that does not answer."""


@dataclass(frozen=True, slots=True)
class IndexedRobot:
    """A robot of the index.

    Attributes:
        name: name that users read.
        asked: address that reports its state, without a slash at the end; "" where a
            router tells that.
        shown: address that browsers open; "" for a port of this machine.
        host: address its server listens on, for a port of this machine.
        port: port of that server.
        base_path: base path of that server.
    """

    name: str
    asked: str
    shown: str = ""
    host: str = "127.0.0.1"
    port: int = 0
    base_path: str = "/"

    def link(self, opened_at: str) -> str:
        """Return the address of the page; "" where the user cannot open it.

        Args:
            opened_at: name or address under which the browser opened the index.
        """
        if self.shown:
            return self.shown
        if not self.port:
            return ""
        if only_this_machine(self.host) and not only_this_machine(opened_at):
            return ""
        name = f"[{opened_at}]" if ":" in opened_at else opened_at
        return f"http://{name}:{self.port}{self.base_path.rstrip('/')}/"
