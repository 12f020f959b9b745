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
    """

    api: str
    token: str = "the-token-of-the-board"
    servers: dict[str, dict[str, Any] | None] = field(default_factory=dict[str, Any])
    status: int = 200
    body: bytes | None = None
    asked: int = 0

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
            assert found.path == "/hub/api/users"
            known = self.headers["Authorization"]
            status, body = hub.answer(found.query, known)
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
