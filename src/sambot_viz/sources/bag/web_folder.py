"""The folder of a recording on a web server: its list, and its files one by one."""

from __future__ import annotations

import re
import tempfile
from collections.abc import Generator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from datetime import timedelta
from email.utils import parsedate_to_datetime
from pathlib import Path
from typing import TYPE_CHECKING
from urllib.parse import quote, urlsplit

from sambot_viz import limits
from sambot_viz.sources.bag.folder import METADATA, RUNNING, STATE, names_in
from sambot_viz.sources.bag.web_bytes import WebError, request_failure

if TYPE_CHECKING:
    from requests import Response, Session

_TIMES = (10.0, 30.0)
"""A server gets so long to take a connection, and to go on answering [s]."""
_PIECE = 2**18
_SURE = timedelta(seconds=2)
_STATE = re.compile(rf"{re.escape(STATE)}[\"']?\s*:\s*[\"']?(\w+)")


class MissingPartError(WebError):
    """Raised when a server does not have a file that the list names."""


@dataclass(frozen=True, slots=True)
class PartList:
    """The list of a recording's files.

    Attributes:
        names: the closed files, in the order of their times.
        is_running: whether more will come.
    """

    names: tuple[str, ...] = ()
    is_running: bool = True


class WebFolder:
    """The folder of a recording on a web server. Its methods block.

    Args:
        address: the address of the folder, with a slash at its end.
    """

    def __init__(self, address: str) -> None:
        # It takes 0.1 s to import.
        import requests

        self._parts = urlsplit(address)
        self._host = self._parts.netloc.rpartition("@")[2]
        self._session: Session = requests.Session()
        self._known = PartList()
        self._version: dict[str, str] = {}
        self._folder = tempfile.TemporaryDirectory(
            prefix="sambot-viz-", ignore_cleanup_errors=True
        )

    def address_of(self, name: str) -> str:
        """Return the address of a file in the folder."""
        path = f"{self._parts.path or '/'}{quote(name)}"
        return self._parts._replace(path=path, fragment="").geturl()

    def read_list(self) -> PartList:
        """Return the files that are listed now; those of before if that is unchanged.

        A list of which a part is missing changes nothing: the next one is whole.

        Raises:
            WebError: the server does not answer, or has no such list.
        """
        with self._get(METADATA, self._version) as answer:
            if answer.status_code == 304:
                return self._known
            if answer.status_code != 200:
                raise self._refusal(METADATA, answer)
            data = bytes(answer.raw.read(limits.METADATA.value))
            version = _version_of(answer.headers)
        if not data.endswith(b"\n"):
            return self._known
        self._version = version
        content = data.decode("utf-8", "replace")
        state = _STATE.search(content)
        names = tuple(name for name in names_in(content) if name not in (".", ".."))
        is_running = state is not None and state[1] == RUNNING
        self._known = PartList(names[: limits.RECORDING_FILES.value], is_running)
        return self._known

    def fetch(self, name: str) -> Path:
        """Copy a file to a temporary folder, and return where it is.

        Raises:
            MissingPartError: the server does not have it.
            WebError: the server does not send all of it, or it is too large.
            OSError: the disk does not take it.
        """
        path = Path(self._folder.name) / "part"
        with self._get(name, {}) as answer, path.open("wb") as stream:
            if answer.status_code != 200:
                raise self._refusal(name, answer)
            size = 0
            while data := answer.raw.read(_PIECE):
                size += stream.write(data)
                if size > limits.FOLLOWED_PART.value:
                    most = limits.FOLLOWED_PART.said(size)
                    raise MissingPartError(
                        f"{name} is left out: it holds {most}", self._shown(name)
                    )
            stated = answer.headers.get("Content-Length", "")
            if stated.isdecimal() and int(stated) != size:
                raise self._error(name, f"{self._host} ended in the middle of {name}")
        return path

    def close(self) -> None:
        """Remove what was copied; may be called again."""
        self._session.close()
        self._folder.cleanup()

    @contextmanager
    def _get(self, name: str, headers: dict[str, str]) -> Generator[Response]:
        """Ask for a file; a connection that was closed while idle is made again."""
        import requests

        headers = {"Accept-Encoding": "identity", **headers}
        try:
            with self._session.get(
                self.address_of(name), headers=headers, stream=True, timeout=_TIMES
            ) as answer:
                yield answer
        except requests.RequestException as error:
            why = f"{self._host}: {request_failure(error)}"
            raise self._error(name, why) from error

    def _refusal(self, name: str, answer: Response) -> WebError:
        said = f"{self._host} answered {answer.status_code} {answer.reason} for {name}"
        if name != METADATA and answer.status_code in (404, 410):
            return MissingPartError(said, self._shown(name))
        return self._error(name, said)

    def _error(self, name: str, message: str) -> WebError:
        return WebError(message, self._shown(name))

    def _shown(self, name: str) -> str:
        """Return the address of a file without secrets."""
        parts = urlsplit(self.address_of(name))
        return parts._replace(netloc=self._host, query="").geturl()


def _version_of(headers: Mapping[str, str]) -> dict[str, str]:
    """Return what asks whether a list has changed; empty where that is not sure.

    A time of change has whole seconds: one of just now may be of the list before.
    """
    if tag := headers.get("ETag", ""):
        return {"If-None-Match": tag}
    since = headers.get("Last-Modified", "")
    try:
        age = parsedate_to_datetime(headers["Date"]) - parsedate_to_datetime(since)
    except (KeyError, ValueError, TypeError):
        return {}
    return {"If-Modified-Since": since} if age >= _SURE else {}
