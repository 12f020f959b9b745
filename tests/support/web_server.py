"""A web server with one file, which sends parts of it, as buckets do."""

from __future__ import annotations

import re
import threading
from collections.abc import Generator
from contextlib import contextmanager
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from typing import Any

_RANGE = re.compile(r"bytes=(\d+)-(\d+)")


class WebServer(ThreadingHTTPServer):
    """Serves some bytes under any name that does not begin with "no-".

    Attributes:
        content: what it serves.
        version: the ETag.
        has_ranges: whether it sends parts.
        hangs_up: whether it ends each connection after an answer without saying so.
        asked: the first and the last byte of each part that was asked for.
    """

    daemon_threads = True

    def __init__(self, content: bytes) -> None:
        super().__init__(("127.0.0.1", 0), _Handler)
        self.content = content
        self.version = '"1"'
        self.has_ranges = True
        self.hangs_up = False
        self.asked: list[tuple[int, int]] = []

    def address(self, name: str = "run.mcap") -> str:
        """The address of the file."""
        return f"http://127.0.0.1:{self.server_address[1]}/a/{name}"

    @property
    def sent(self) -> int:
        """So much was asked for [bytes]."""
        return sum(last - first + 1 for first, last in self.asked)


class _Handler(BaseHTTPRequestHandler):
    protocol_version = "HTTP/1.1"
    server: WebServer

    def log_message(self, *_: Any) -> None:
        """Write nothing."""

    def do_GET(self) -> None:
        server = self.server
        found = _RANGE.fullmatch(self.headers.get("Range", ""))
        size = len(server.content)
        if "/no-" in self.path:
            self._answer(404, b"")
        elif self.headers.get("If-Match", server.version) != server.version:
            self._answer(412, b"")
        elif found is None or not server.has_ranges:
            self._answer(200, server.content)
        elif int(found[1]) >= size:
            self._answer(416, b"")
        else:
            first, last = int(found[1]), min(int(found[2]), size - 1)
            server.asked.append((first, last))
            where = {"Content-Range": f"bytes {first}-{last}/{size}"}
            self._answer(206, server.content[first : last + 1], where)
        self.close_connection = server.hangs_up

    def _answer(
        self, status: int, data: bytes, headers: dict[str, str] | None = None
    ) -> None:
        self.send_response(status)
        self.send_header("Content-Length", str(len(data)))
        self.send_header("ETag", self.server.version)
        for name, value in (headers or {}).items():
            self.send_header(name, value)
        self.end_headers()
        self.wfile.write(data)


@contextmanager
def web_server(content: bytes) -> Generator[WebServer]:
    """Serve some bytes on loopback until the block ends."""
    with WebServer(content) as server:
        thread = threading.Thread(target=server.serve_forever, args=(0.01,))
        thread.start()
        try:
            yield server
        finally:
            server.shutdown()
            thread.join()
