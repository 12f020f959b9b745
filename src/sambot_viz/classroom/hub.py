"""The users of a JupyterHub and the states of their servers, by the hub's REST API."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, cast
from urllib.parse import urlsplit

from sambot_viz import limits
from sambot_viz.classroom.asking import ask
from sambot_viz.errors import ServerError, UsageError
from sambot_viz.text import text

PATIENCE = 10.0
"""Longest silence of the hub [s]."""
_AT_ONCE = 200
"""Number of users in one answer; a hub may give fewer."""
_PAGES = "application/jupyterhub-pagination+json"
SCOPES = "list:users, read:servers"
"""What the service may do at the hub, in the hub's words."""
_NOT_A_HUB = AttributeError, LookupError, RecursionError, TypeError, ValueError
"""Errors of reading an answer that has not the fields of a hub's."""
NO_SERVER, STARTS = "no server", "starts"
"""States of a user without a server that answers."""


@dataclass(frozen=True, slots=True)
class Hub:
    """A JupyterHub, as its service sees it.

    Attributes:
        api: address of its REST API, without a slash at the end.
        token: secret of the service.
        prefix: path below which the hub shows the service.
        client: name of the service in the hub's login; "" without that login.
        base: path of the hub, with a slash at the end.
    """

    api: str
    token: str
    prefix: str = "/"
    client: str = ""
    base: str = "/"

    @classmethod
    def of_environment(cls) -> Hub:
        """Return the hub that has started this program as its service.

        Raises:
            UsageError: no hub has.
        """
        names = ("API_URL", "API_TOKEN", "SERVICE_PREFIX", "CLIENT_ID", "BASE_URL")
        api, token, prefix, client, base = (
            os.environ.get(f"JUPYTERHUB_{name}", "") for name in names
        )
        if urlsplit(api).scheme not in ("http", "https") or not token:
            raise UsageError(
                "--hub is for a service of JupyterHub: let the hub start this program, "
                "or set JUPYTERHUB_API_URL, such as http://hub:8081/hub/api, and "
                "JUPYTERHUB_API_TOKEN to the token of the service"
            )
        base = f"{base.rstrip('/')}/"
        return cls(api.rstrip("/"), token, prefix.rstrip("/") or "/", client, base)

    def users(self) -> dict[str, str]:
        """Return the state of each user's server by the user's name; "" if it runs.

        Raises:
            ServerError: the hub does not answer, or not this service.
        """
        found: dict[str, str] = {}
        start: object = 0
        while isinstance(start, int) and len(found) < limits.HUB_STUDENTS.value:
            some, start = self._users(start)
            found |= some
        return found

    def _users(self, start: int) -> tuple[dict[str, str], object]:
        """Return some users, and where the next ones start; None after the last."""
        headers = {"Authorization": f"token {self.token}", "Accept": _PAGES}
        address = f"{self.api}/users?limit={_AT_ONCE}&offset={start}"
        largest = limits.HUB_ANSWER.value
        try:
            status, content = ask(address, PATIENCE, largest, headers)
        except (OSError, ValueError) as error:
            raise ServerError(f"the hub does not answer: {text(error)}") from error
        if status in (401, 403):
            raise ServerError(f"the hub refuses: give the service the scopes {SCOPES}")
        if status != 200 or len(content) > largest:
            raise ServerError(f"the hub does not list its users (status {status})")
        try:
            read: Any = json.loads(content)
            items = cast("list[Mapping[str, Any]]", read["items"])
            after = read["_pagination"]["next"]
            found = {text(item["name"]): _state(item) for item in items}
            return found, after and max(after["offset"], start + 1)
        except _NOT_A_HUB as error:
            raise ServerError("the hub does not list its users as expected") from error


def _state(user: Mapping[str, Any]) -> str:
    servers = cast("Mapping[str, Mapping[str, Any]]", user.get("servers") or {})
    if any(one.get("ready") for one in servers.values()):
        return ""
    return STARTS if any(one.get("pending") for one in servers.values()) else NO_SERVER
