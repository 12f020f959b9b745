"""Read a recording on a web server in pieces, with HTTP ranges (RFC 9110, 14)."""

from __future__ import annotations

import re
import tempfile
import threading
from collections.abc import Iterable, Iterator, Sequence
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING
from urllib.parse import urlsplit

from sambot_viz import limits
from sambot_viz.files import name_of_address
from sambot_viz.sources.bag.file_bytes import FileBytes
from sambot_viz.sources.bag.refusals import refused

if TYPE_CHECKING:
    from requests import Response, Session

PIECE = 2**18
"""Size of the pieces that are asked for, each once [bytes]."""
_TIMES = (10.0, 30.0)
"""A server gets so long to take a connection, and to go on answering [s]."""
_RANGE = re.compile(r"bytes (\d+)-(\d+)/(\d+)")


class WebError(OSError):
    """Raised when a server does not send the requested part of a file.

    Args:
        message: the reason.
        address: the address of the file, without its secrets.

    Attributes:
        hint: what to do.
    """

    def __init__(self, message: str, address: str) -> None:
        super().__init__(message)
        self.hint = f"see what curl -I '{address}' says"


class WebBytes(FileBytes):
    """A file on a web server, read as `FileBytes` is.

    Only the requested parts are fetched, over one connection that stays open, and kept
    in a temporary file.

    Args:
        address: the address of the file; redirections are followed.

    Raises:
        SourceError: the server does not send parts of files.
        WebError: the server does not answer, or has no such file.
    """

    def __init__(self, address: str) -> None:
        import requests

        self._address = address
        # Pages show it: who may see the robot may not know the key of a bucket.
        parts = urlsplit(address)
        self._host = parts.netloc.rpartition("@")[2]
        self._shown = parts._replace(netloc=self._host, query="", fragment="").geturl()
        self.path = Path(name_of_address(address))
        self._session: Session = requests.Session()
        self._lock = threading.Lock()
        # The file as far as it has come: displays read the same seconds one by one.
        self._kept = tempfile.TemporaryFile(prefix="sambot-viz-")
        self._known = set[int]()
        self._is_closed = False
        self._version: dict[str, str] = {}
        # The size comes with it.
        try:
            self._keep((0,), self._ask(0, PIECE - 1))
        except BaseException:
            self.close()
            raise

    @property
    def is_remote(self) -> bool:
        """It is: each read costs bytes, and time of a connection."""
        return True

    @property
    def is_unpacked(self) -> bool:
        """It is never decompressed as a whole."""
        return False

    @property
    def content(self) -> Path:
        """Nothing on this disk.

        Raises:
            SourceError: always; with what to do instead.
        """
        raise refused(
            self.path,
            "web-file-kind",
            f"{self.path.name} is a database of sqlite3, and read from a disk only",
            f"download it with curl -LO '{self._shown}', or make an MCAP file of it "
            "with ros2 bag convert",
        )

    def _read(self, at: int, count: int) -> bytes:
        """Return bytes from the pieces on the disk; ask for those that are missing."""
        if self._is_closed:
            raise ValueError("the file was closed")
        first, last = at // PIECE, (at + count - 1) // PIECE
        if (len(self._known) + last - first) * PIECE >= limits.WEB_PIECES.value:
            self._forget()
        try:
            for run in _runs(n for n in range(first, last + 1) if n not in self._known):
                end = min((run[-1] + 1) * PIECE, self.size) - 1
                self._keep(run, self._ask(run[0] * PIECE, end))
            self._kept.seek(at)
            return self._kept.read(count)
        except WebError:
            raise
        except OSError:
            # The disk is full: it goes without.
            self._forget()
            return self._ask(at, at + count - 1)

    def _keep(self, run: Sequence[int], data: bytes) -> None:
        self._kept.seek(run[0] * PIECE)
        self._kept.write(data)
        self._known.update(run)

    def _forget(self) -> None:
        self._known.clear()
        with suppress(OSError):
            self._kept.truncate(0)

    def close(self) -> None:
        """End the connection; may be called again."""
        with self._lock:
            self._is_closed = True
            self._known.clear()
            self._kept.close()
            self._session.close()

    def _ask(self, first: int, last: int) -> bytes:
        """Return the bytes from one place to another, both included.

        If the server has closed the connection, as it does when idle, the request is
        sent once more.
        """
        import requests

        for is_last in (False, True):
            try:
                return self._answer(first, last)
            except requests.RequestException as error:
                if is_last or not isinstance(error, requests.ConnectionError):
                    raise self._error(
                        f"{self._host}: {request_failure(error)}"
                    ) from error
        raise AssertionError

    def _error(self, message: str) -> WebError:
        return WebError(message, self._shown)

    def _answer(self, first: int, last: int) -> bytes:
        headers = {
            "Range": f"bytes={first}-{last}",
            "Accept-Encoding": "identity",
            **self._version,
        }
        with self._session.get(
            self._address, headers=headers, stream=True, timeout=_TIMES
        ) as answer:
            begin, end, size = self._range(answer)
            if not self._version:
                self._remember(answer, size)
            last = min(last, size - 1)
            if (begin, end, size) != (first, last, self.size):
                raise self._error(f"{self._host} sent other bytes than were asked for")
            data = bytes(answer.raw.read(last - first + 1))
        if len(data) != last - first + 1:
            raise self._error(f"{self._host} ended in the middle of an answer")
        return data

    def _range(self, answer: Response) -> tuple[int, int, int]:
        """Return what an answer holds: its first and last byte, and the size of all.

        Raises:
            SourceError: it is not a part.
            WebError: it is none of the file.
        """
        if answer.status_code == 412:
            raise self._error(
                "it has changed on the server since it was opened; open it again"
            )
        if answer.status_code == 416:
            # A file without a byte has no first one.
            return 0, -1, 0
        if answer.status_code == 206:
            found = _RANGE.fullmatch(answer.headers.get("Content-Range", "").strip())
            if found is not None:
                begin, end, size = map(int, found.groups())
                return begin, end, size
        if answer.status_code == 200 and urlsplit(answer.url).path.endswith("/"):
            raise self._error("it is a folder: end its address with /")
        if answer.status_code in (200, 206):
            raise refused(
                self.path,
                "web-without-ranges",
                f"{self._host} sends {self.path.name} only as a whole: it does not "
                "know HTTP ranges, as python3 -m http.server does not",
                f"download it with curl -LO '{self._shown}', or put it on a server "
                "with ranges, such as nginx, Caddy or a bucket",
            )
        raise self._error(f"{self._host} answered {answer.status_code} {answer.reason}")

    def _remember(self, answer: Response, size: int) -> None:
        """Remember which version of the file it is: parts of two fit no file."""
        self.size = size
        tag = answer.headers.get("ETag", "")
        since = answer.headers.get("Last-Modified", "")
        if tag and not tag.startswith("W/"):
            self._version = {"If-Match": tag}
        elif since:
            self._version = {"If-Unmodified-Since": since}


def _runs(numbers: Iterable[int]) -> Iterator[list[int]]:
    """Yield ascending numbers as runs without a gap."""
    run: list[int] = []
    for number in numbers:
        if run and number != run[-1] + 1:
            yield run
            run = []
        run.append(number)
    if run:
        yield run


def request_failure(error: Exception) -> str:
    """Return a sentence about a failed connection."""
    import requests

    if isinstance(error, requests.Timeout):
        return "it does not answer"
    if isinstance(error, requests.exceptions.SSLError):
        return "its certificate is not trusted"
    if isinstance(error, requests.TooManyRedirects):
        return "it leads in a circle"
    if isinstance(error, requests.ConnectionError):
        return "there is no connection"
    return type(error).__name__
