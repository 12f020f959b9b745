"""The REST API of a JupyterHub, as far as a teacher's board asks for it.

with a_hub_api() as hub:
    hub.servers["ada"] = {"ready": True}
    Hub(hub.api, hub.token).users()
"""

from __future__ import annotations

import json
import threading
from collections.abc import Generator
from contextlib import contextmanager
from dataclasses import dataclass, field
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from typing import Any
from urllib.parse import parse_qs, urlsplit


@dataclass
class HubApi:
    """What the hub answers.

    Attributes:
        api: its address.
        servers: user → the server, as the hub describes it; None without one.
        status: of all answers.
        body: of all answers; None for the users.
        asked: number of questions.
        codes: code of a login → token of the user.
        logged_in: token → the user, as the hub describes it.
    """

    api: str
    token: str = "the-token-of-the-board"
    servers: dict[str, dict[str, Any] | None] = field(default_factory=dict[str, Any])
    status: int = 200
    body: bytes | None = None
    asked: int = 0
    codes: dict[str, str] = field(default_factory=dict[str, str])
    logged_in: dict[str, dict[str, Any]] = field(default_factory=dict[str, Any])

    def token_for(self, fields: dict[str, list[str]]) -> tuple[int, bytes]:
        """Answer a board that has come back from a login."""
        code, secret = fields["code"][0], fields["client_secret"][0]
        assert fields["grant_type"] == ["authorization_code"]
        if secret != self.token or code not in self.codes:
            return 400, b'{"error": "invalid_grant"}'
        return 200, json.dumps({"access_token": self.codes.pop(code)}).encode()

    def user(self, authorization: str) -> tuple[int, bytes]:
        """Answer who has a token."""
        found = self.logged_in.get(authorization.removeprefix("token "))
        return (403, b"{}") if found is None else (200, json.dumps(found).encode())

    def answer(self, query: str, authorization: str | None) -> tuple[int, bytes]:
        self.asked += 1
        if authorization != f"token {self.token}":
            return 403, b"{}"
        if self.status != 200 or self.body is not None:
            return self.status, self.body or b"{}"
        given = parse_qs(query)
        # Like a hub that gives fewer than one asks for.
        start, many = int(given["offset"][0]), min(int(given["limit"][0]), 2)
        names = sorted(self.servers)
        items = [
            {"kind": "user", "name": name, "servers": {"": one} if one else {}}
            for name, one in ((name, self.servers[name]) for name in names)
        ]
        after = {"offset": start + many, "limit": many, "url": "…"}
        document = {
            "items": items[start : start + many],
            "_pagination": {"next": after if start + many < len(items) else None},
        }
        return 200, json.dumps(document).encode()


@contextmanager
def a_hub_api() -> Generator[HubApi]:
    """Serve the API on this machine."""

    class Handler(BaseHTTPRequestHandler):
        def do_GET(self) -> None:
            found = urlsplit(self.path)
            known = self.headers["Authorization"]
            if found.path == "/hub/api/user":
                self._write(*hub.user(known))
                return
            assert found.path == "/hub/api/users"
            self._write(*hub.answer(found.query, known))

        def do_POST(self) -> None:
            assert self.path == "/hub/api/oauth2/token"
            content = self.rfile.read(int(self.headers["Content-Length"]))
            self._write(*hub.token_for(parse_qs(content.decode())))

        def _write(self, status: int, body: bytes) -> None:
            self.send_response(status)
            self.send_header("Content-Length", str(len(body)))
            self.end_headers()
            self.wfile.write(body)

        def log_message(self, format: str, *args: object) -> None:
            pass

    server = ThreadingHTTPServer(("127.0.0.1", 0), Handler)
    hub = HubApi(f"http://127.0.0.1:{server.server_port}/hub/api")
    thread = threading.Thread(target=server.serve_forever)
    thread.start()
    try:
        yield hub
    finally:
        server.shutdown()
        thread.join()
        server.server_close()
