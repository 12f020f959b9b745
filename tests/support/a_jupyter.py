"""Programs of Jupyter, started by tests in an environment and folders of their own."""

from __future__ import annotations

import contextlib
import json
import os
import secrets
import shutil
import signal
import subprocess
import tempfile
import time
import urllib.error
import urllib.request
from collections.abc import Callable, Generator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest

ROOT = Path(__file__).resolve().parents[2]
PYTHON = ROOT / "tests" / ".venv" / "jupyter" / "bin" / "python"
"""Of the environment with JupyterLab and JupyterHub, which tests/run makes."""
QUICKLY = 60.0
"""How long anything of Jupyter may take on a busy machine [s]."""
_MARK = "SAMBOT_VIZ_TEST"
"""The variable by which the processes that a test has started are known."""


def wait_until(condition: Callable[[], Any], timeout: float = QUICKLY) -> Any:
    """The value of a condition as soon as it is true."""
    end = time.monotonic() + timeout
    while not (value := condition()):
        assert time.monotonic() < end, condition
        time.sleep(0.05)
    return value


@dataclass(frozen=True)
class Place:
    """Where a program of Jupyter runs, and all that it starts.

    Attributes:
        folder: what it may write to; its path is short, as those of sockets must be.
        mark: every process has it in its environment.
    """

    folder: Path
    mark: str

    @property
    def work(self) -> Path:
        """The folder that JupyterLab shows."""
        return self.folder / "work"

    @property
    def log(self) -> str:
        """What the programs have said."""
        return (self.folder / "log").read_text("utf-8", "replace")

    def environment(self, more: Mapping[str, str]) -> dict[str, str]:
        """A new user's; nothing of Jupyter comes from the one who runs the tests."""
        kept = {
            k: v for k, v in os.environ.items() if not k.startswith(("JUPY", "JPY"))
        }
        return {
            **kept,
            "PATH": f"{PYTHON.parent}{os.pathsep}{kept['PATH']}",
            "PYTHONPATH": str(ROOT / "src"),
            "HOME": str(self.folder),
            "TMPDIR": str(self.folder),
            "IPYTHONDIR": str(self.folder / "ipython"),
            "JUPYTER_PREFER_ENV_PATH": "1",
            _MARK: self.mark,
            **more,
        }

    def processes(self) -> dict[int, str]:
        """Number → command of each process that was started here and runs."""
        found: dict[int, str] = {}
        for folder in Path("/proc").glob("[0-9]*"):
            with contextlib.suppress(OSError):
                mark = f"{_MARK}={self.mark}".encode()
                if mark in (folder / "environ").read_bytes().split(b"\0"):
                    words = (folder / "cmdline").read_bytes().split(b"\0")
                    if words[0]:  # otherwise it has ended, and nobody has asked how
                        found[int(folder.name)] = b" ".join(words).decode()
        return found

    @contextmanager
    def running(
        self, words: Sequence[str], more: Mapping[str, str]
    ) -> Generator[subprocess.Popen[bytes]]:
        """Run a command of the environment, and end all that it has started."""
        with open(self.folder / "log", "ab") as log:
            process = subprocess.Popen(
                [str(PYTHON), *words],
                cwd=self.work,
                env=self.environment(more),
                stdout=log,
                stderr=log,
                start_new_session=True,
            )
        try:
            yield process
        finally:
            process.terminate()
            with contextlib.suppress(subprocess.TimeoutExpired):
                process.wait(15.0)
            process.kill()
            process.wait()
            for number in self.processes():
                with contextlib.suppress(ProcessLookupError):
                    os.kill(number, signal.SIGKILL)


@contextmanager
def a_place() -> Generator[Place]:
    """Folders for a program of Jupyter; without one here the test is skipped."""
    if not PYTHON.is_file():
        pytest.skip("no JupyterLab and JupyterHub here; tests/run installs them")
    folder = Path(tempfile.mkdtemp(prefix="sj-"))
    try:
        (folder / "work").mkdir()
        yield Place(folder, secrets.token_hex(8))
    finally:
        shutil.rmtree(folder, ignore_errors=True)


@dataclass(frozen=True)
class Lab:
    """A JupyterLab that runs.

    Attributes:
        url: its address, with a slash at the end.
        token: the secret with which it lets in.
        place: where it runs.
        process: its process.
    """

    url: str
    token: str
    place: Place
    process: subprocess.Popen[bytes]

    def ask(
        self, path: str, method: str = "GET", body: object = None, known: bool = True
    ) -> tuple[int, str]:
        """The status and the text of an answer; redirects are not followed."""
        headers = {"Authorization": f"token {self.token}"} if known else {}
        return ask(f"{self.url}{path}", method, body, headers)

    def sockets(self) -> list[Path]:
        """The sockets that viewers listen on."""
        return sorted(self.place.folder.glob("jupyter-server-proxy-*/socket"))


class _Stay(urllib.request.HTTPRedirectHandler):
    """Follows no redirect."""

    def redirect_request(self, *_: Any) -> None:
        return None


def ask(
    url: str, method: str = "GET", body: object = None, headers: Mapping[str, str] = {}
) -> tuple[int, str]:
    """The status and the text of an answer; redirects are not followed."""
    data = None if body is None else json.dumps(body).encode()
    request = urllib.request.Request(url, data, dict(headers), method=method)
    try:
        with urllib.request.build_opener(_Stay).open(request, timeout=QUICKLY) as got:
            return got.status, got.read().decode("utf-8", "replace")
    except urllib.error.HTTPError as error:
        with error:
            return error.code, error.read().decode("utf-8", "replace")


@contextmanager
def a_lab(place: Place, *flags: str, **more: str) -> Generator[Lab]:
    """A JupyterLab on this machine only.

    Args:
        place: where it runs.
        flags: more of its flags.
        more: more variables of its environment.
    """
    words = ("-m", "jupyterlab", "--no-browser", "--allow-root", "--port=0")
    where = ("--ServerApp.ip=127.0.0.1", "--LabApp.news_url=", *flags)
    with place.running([*words, *where], more) as process:
        runtime = place.folder / ".local" / "share" / "jupyter" / "runtime"

        def info() -> Any:
            assert process.poll() is None, place.log
            for path in runtime.glob("jpserver-*.json"):
                with contextlib.suppress(ValueError):
                    return json.loads(path.read_text("utf-8"))

        found = wait_until(info)
        yield Lab(found["url"], found["token"], place, process)
