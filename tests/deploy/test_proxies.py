"""The page behind real proxies, with the files of deploy/: TLS, a sub-path, a login."""

from __future__ import annotations

import base64
import contextlib
import http.client
import shutil
import socket
import ssl
import subprocess
from collections.abc import Callable, Generator, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

import msgspec.msgpack
import pytest
import viser
from a_jupyter import wait_until
from inside import session_of
from live_peers import free_port
from patience import patience, until
from protocol_client import CAMERA
from websockets.exceptions import InvalidStatus
from websockets.sync.client import connect
from websockets.typing import Origin, Subprotocol

from sambot_viz import Visualizer

# The same of our own code, without a proxy: tests/server/test_access.py, test_roles.py
# and test_token_check.py; the files of deploy/: test_containers.py.
pytestmark = pytest.mark.slow

PROTOCOL = Subprotocol(f"viser-v{viser.__version__}")
NAME, PASSWORD = "student", "tortoise"
LOGIN = {
    "Authorization": f"Basic {base64.b64encode(f'{NAME}:{PASSWORD}'.encode()).decode()}"
}


def needs(*programs: str) -> None:
    for program in programs:
        if shutil.which(program, path="/usr/sbin:/usr/bin:/usr/local/bin") is None:
            pytest.skip(f"needs {program} (Debian: apt-get install {program})")


def run(*command: str) -> str:
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


@dataclass(frozen=True)
class Proxy:
    """What a proxy shows at https://127.0.0.1:PORT/robot/."""

    port: int
    viz: Visualizer
    trust: ssl.SSLContext
    plain_port: int = 0
    second: Visualizer | None = None

    def get(self, path: str, headers: Mapping[str, str]) -> tuple[int, str]:
        """The status and the text of an answer."""
        status, text, _ = self.ask(path, headers)
        return status, text

    def ask(
        self, path: str, headers: Mapping[str, str]
    ) -> tuple[int, str, http.client.HTTPMessage]:
        """The status, the text and the headers of an answer."""
        connection = http.client.HTTPSConnection(
            "localhost", self.port, timeout=10.0, context=self.trust
        )
        with contextlib.closing(connection):
            connection.request("GET", path, headers=dict(headers))
            answer = connection.getresponse()
            return answer.status, answer.read().decode(), answer.headers

    def connect(
        self, headers: Mapping[str, str], origin: str = "", path: str = "/robot"
    ) -> int:
        """How many messages of the scene come through the proxy."""
        own = f"https://localhost:{self.port}"
        with connect(
            # As viser's page does: without the slash at the end.
            f"wss://localhost:{self.port}{path}",
            origin=Origin(origin or own),
            subprotocols=[PROTOCOL],
            additional_headers=headers,
            ssl=self.trust,
        ) as socket_:
            return len(socket_.recv(timeout=patience(10.0)))


@pytest.fixture(scope="module")
def certificate(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Path]:
    needs("openssl")
    folder = tmp_path_factory.mktemp("tls")
    public, private = folder / "lab.pem", folder / "lab.key"
    subject = ("-subj", "/CN=localhost", "-addext", "subjectAltName=DNS:localhost")
    kind = ("-x509", "-newkey", "rsa:2048", "-nodes", "-days", "2")
    files = ("-keyout", str(private), "-out", str(public))
    run("openssl", "req", *kind, *files, *subject)
    return public, private


def with_ports(site: str, upstream: list[str]) -> str:
    """A configuration with other ports of the two robots."""
    for before, after in zip(
        ("127.0.0.1:8080", "127.0.0.1:8081"), upstream, strict=True
    ):
        assert before in site
        site = site.replace(before, f"127.0.0.1:{after}")
    return site


def answers_or_ended(process: subprocess.Popen[str], port: int) -> bool:
    """Return whether a program has ended, or takes connections.

    Raises:
        OSError: it does not take any yet.
    """
    if process.poll() is None:
        socket.create_connection(("127.0.0.1", port), 0.2).close()
    return True


@contextlib.contextmanager
def behind(
    command: Callable[[list[str]], list[str]],
    port: int,
    certificate: Path,
    plain_port: int = 0,
) -> Generator[Proxy]:
    """Two robots, and a proxy on `port` in front of their ports, while this runs."""
    origins = [f"https://localhost:{port}"]
    trust = ssl.create_default_context(cafile=certificate)
    secrets = {
        "token": "for-the-class",
        "presenter": "for-the-teacher",
        "trust_user_header": "X-Remote-User",
    }
    with (
        Visualizer(base_path="/robot", allowed_origins=origins) as viz,
        Visualizer(base_path="/robot2", allowed_origins=origins, **secrets) as second,
    ):
        upstream = [str(each.viser.get_port()) for each in (viz, second)]
        process = subprocess.Popen(command(upstream), stderr=subprocess.PIPE, text=True)
        try:
            until(lambda: answers_or_ended(process, port), not_yet=OSError)
            assert process.poll() is None, process.communicate()[1]
            yield Proxy(port, viz, trust, plain_port, second)
        finally:
            process.terminate()
            process.communicate(timeout=patience(10.0))


@contextlib.contextmanager
def an_nginx(
    repository: Path,
    tmp_path: Path,
    certificate: tuple[Path, Path],
    *changes: tuple[str, str],
) -> Generator[Proxy]:
    """nginx with the file of deploy/, names and ports changed, and these texts."""
    needs("nginx", "openssl")
    port, plain_port = free_port(), free_port()
    public, private = certificate
    passwords = tmp_path / "robot.htpasswd"
    hashed = run("openssl", "passwd", "-apr1", PASSWORD).strip()
    passwords.write_text(f"{NAME}:{hashed}\n", "utf-8")
    site = (repository / "deploy" / "nginx.conf").read_text("utf-8")
    for before, after in (
        *changes,
        ("listen 80;", f"listen 127.0.0.1:{plain_port};"),
        ("443", f"127.0.0.1:{port}"),
        ("lab.example.org", "localhost"),
        ("/etc/ssl/certs/lab.pem", str(public)),
        ("/etc/ssl/private/lab.key", str(private)),
        ("/etc/nginx/robot.htpasswd", str(passwords)),
    ):
        assert before in site
        site = site.replace(before, after)
    folders = "".join(
        f"{kind}_temp_path {tmp_path}/{kind};"
        for kind in ("client_body", "proxy", "fastcgi", "uwsgi", "scgi")
    )
    config = tmp_path / "nginx.conf"

    def command(upstream: list[str]) -> list[str]:
        config.write_text(
            f"daemon off; pid {tmp_path}/pid; user root; events {{}}\n"
            f"http {{ access_log off; {folders}\n{with_ports(site, upstream)} }}\n",
            "utf-8",
        )
        return ["nginx", "-p", str(tmp_path), "-e", "stderr", "-c", str(config)]

    with behind(command, port, public, plain_port) as proxy:
        yield proxy


@pytest.fixture
def nginx(
    repository: Path, tmp_path: Path, certificate: tuple[Path, Path]
) -> Iterator[Proxy]:
    with an_nginx(repository, tmp_path, certificate) as proxy:
        yield proxy


@pytest.fixture
def caddy(
    repository: Path, tmp_path: Path, certificate: tuple[Path, Path]
) -> Iterator[Proxy]:
    needs("caddy")
    port = free_port()
    public, private = certificate
    hashed = run("caddy", "hash-password", "--plaintext", PASSWORD).strip()
    site = (repository / "deploy" / "Caddyfile").read_text("utf-8")
    for before, after in (
        (
            "\nlab.example.org {",
            f"\nlocalhost:{port} {{\n\tbind 127.0.0.1\n\ttls {public} {private}",
        ),
        ("HASH", hashed),
    ):
        assert before in site
        site = site.replace(before, after)
    config = tmp_path / "Caddyfile"
    options = "{\n\tadmin off\n\tauto_https disable_redirects\n}\n"

    def command(upstream: list[str]) -> list[str]:
        config.write_text(options + with_ports(site, upstream), "utf-8")
        return ["caddy", "run", "--adapter", "caddyfile", "--config", str(config)]

    with behind(command, port, public) as proxy:
        yield proxy


@pytest.fixture(params=["nginx", "caddy"])
def proxy(request: pytest.FixtureRequest) -> Proxy:
    return request.getfixturevalue(request.param)


def test_a_login_shows_the_page_and_the_robot(proxy: Proxy) -> None:
    assert proxy.viz.url.endswith("/robot")
    status, page = proxy.get("/robot/", LOGIN)
    assert (status, "</html>" in page) == (200, True)
    assert proxy.get("/robot", LOGIN)[0] == 303
    assert proxy.get("/robot/sambot/licenses.txt", LOGIN)[0] == 200
    assert proxy.connect(LOGIN) > 0


def test_nothing_comes_through_without_the_login(proxy: Proxy) -> None:
    assert proxy.get("/robot/", {})[0] == 401
    with pytest.raises(InvalidStatus) as refused:
        proxy.connect({})
    assert refused.value.response.status_code == 401


def test_a_foreign_page_is_refused_behind_a_proxy_too(proxy: Proxy) -> None:
    with pytest.raises(InvalidStatus) as refused:
        proxy.connect(LOGIN, origin="https://evil.example")
    assert refused.value.response.status_code == 403


def test_a_second_robot_has_the_same_name_and_another_path(proxy: Proxy) -> None:
    # It asks for a token too, and knows its presenter behind the proxy.
    assert proxy.get("/robot2/", LOGIN)[0] == 401
    for secret in ("for-the-class", "for-the-teacher"):
        status, _, headers = proxy.ask(f"/robot2/?token={secret}", LOGIN)
        cookie, *attributes = headers["Set-Cookie"].split("; ")
        assert (status, headers["Location"]) == (303, "./")
        assert {"Path=/robot2", "HttpOnly", "Secure"} <= set(attributes)
        known = {**LOGIN, "Cookie": cookie}
        assert proxy.get("/robot2/", known)[0] == 200
        assert proxy.connect(known, path="/robot2") > 0


def test_viewers_are_called_as_they_have_logged_in(proxy: Proxy) -> None:
    assert proxy.second is not None
    roles = session_of(proxy.second).roles
    spoofed = {**LOGIN, "X-Remote-User": "teacher"}
    with connect(
        f"wss://localhost:{proxy.port}/robot2?token=for-the-class",
        origin=Origin(f"https://localhost:{proxy.port}"),
        subprotocols=[PROTOCOL],
        additional_headers=spoofed,
        ssl=proxy.trust,
    ) as page:
        # A client joins with its first camera.
        camera = {"type": "ViewerCameraMessage", **CAMERA}
        page.send(msgspec.msgpack.encode(camera))
        wait_until(lambda: [p.name for p in roles.people.values()] == [NAME], 20.0)


def test_nginx_sends_http_to_https(nginx: Proxy) -> None:
    connection = http.client.HTTPConnection(
        "127.0.0.1", nginx.plain_port, timeout=patience(10.0)
    )
    with contextlib.closing(connection):
        connection.request("GET", "/robot/?a=b", headers={"Host": "localhost"})
        answer = connection.getresponse()
        assert answer.status == 301
        assert answer.headers["Location"] == "https://localhost/robot/?a=b"


def test_nginx_limits_requests_and_connections_of_one_address(
    repository: Path, tmp_path: Path, certificate: tuple[Path, Path]
) -> None:
    fewer = (("rate=20r/s", "rate=1r/m"), ("burst=200", "burst=4"))
    few = ("sambot_open 150", "sambot_open 1")
    with an_nginx(repository, tmp_path, certificate, *fewer, few) as nginx:
        with connect(
            f"wss://localhost:{nginx.port}/robot",
            origin=Origin(f"https://localhost:{nginx.port}"),
            subprotocols=[PROTOCOL],
            additional_headers=LOGIN,
            ssl=nginx.trust,
        ):
            with pytest.raises(InvalidStatus) as refused:
                nginx.connect(LOGIN)
            assert refused.value.response.status_code == 429
        answers = [nginx.get("/robot/", LOGIN)[0] for _ in range(8)]
        assert answers[-1] == 429 and set(answers) <= {200, 429}
