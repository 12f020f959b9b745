"""`sambot-viz index`: the robots of a lab, their states and links."""

from __future__ import annotations

import re
from collections.abc import Callable, Generator, Iterator
from contextlib import contextmanager
from html import unescape
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from threading import Thread
from urllib.error import HTTPError
from urllib.request import Request, urlopen

import pytest
from live_peers import WAIT, free_port
from lower_limit import lower
from patience import patience, until
from program import address, serving
from zenoh_peer import ZenohPeer

from sambot_viz import Visualizer
from sambot_viz.cli import main
from sambot_viz.lab.index import RobotIndex
from sambot_viz.options import Options
from sambot_viz.sources.registry import live_address

Capture = pytest.CaptureFixture[str]
SECRET = "the-secret-of-the-lab"
MARKED = """<b title 'x'>"&amp;</b>"""
BAD = '<img src=x onerror="alert(1)">'


def rows(url: str, **headers: str) -> dict[str, tuple[str, str]]:
    """Name of each robot → its link and what is said of it."""
    asked = Request(url, headers=headers)
    with urlopen(asked, timeout=patience(20)) as answer:
        page = answer.read().decode()
        policy = answer.headers["Content-Security-Policy"]
    assert "default-src 'none'" in policy and "<script" not in page
    found = re.findall(r"<tr><td>(.*?)</td><td class=\"\w+\">(.*?)</td>", page)
    return {
        unescape(re.sub(r"</?(?:a|small)\b.*?>", "", n)): (link_in(n), s)
        for n, s in found
    }


def link_in(cell: str) -> str:
    """The address in a cell; "" without one."""
    return unescape("".join(re.findall('href="(.*?)"', cell)))


@contextmanager
def answering(status: int, content: bytes = b"") -> Generator[str]:
    """Another program that answers everything alike; its address."""

    class Handler(BaseHTTPRequestHandler):
        def do_GET(self) -> None:
            self.send_response(status)
            self.send_header("Location", "http://127.0.0.1:9/")
            self.end_headers()
            self.wfile.write(content)

        def log_message(self, format: str, *args: object) -> None:
            del format, args

    with ThreadingHTTPServer(("127.0.0.1", 0), Handler) as server:
        thread = Thread(target=server.serve_forever)
        thread.start()
        yield f"http://127.0.0.1:{server.server_address[1]}"
        server.shutdown()
        thread.join()


def test_robots_of_a_folder_have_their_states_and_links(tmp_path: Path) -> None:
    folder = tmp_path / "robots"
    folder.mkdir()
    with Visualizer(token=SECRET, base_path="/turtle") as viz:
        port, other = viz.viser.get_port(), free_port()
        (folder / "turtle.conf").write_text(
            "# the first robot\n"
            f'ARGS="--port {port} --base-path /turtle --host 0.0.0.0 '
            f'--token {SECRET}"\n'
        )
        (folder / "arm.conf").write_text(
            f"ARGS=x.urdf --port {other} --allow-origin https://lab.example.org "
            f"--base-path /arm --presenter={SECRET}\n"
        )
        (folder / "near.conf").write_text(f"ARGS=--port {free_port()}\n")
        words = ("index", str(folder), "--port", "0", "--host", "0.0.0.0")
        with serving(*words, cwd=tmp_path) as program:
            url = address(program)
            found = rows(url)
            assert found["turtle"] == (f"http://127.0.0.1:{port}/turtle/", "ready")
            assert found["arm"] == ("https://lab.example.org/arm/", "does not answer")
            assert found["near"][0].startswith("http://127.0.0.1:")
            # From another machine, links lead to the name by which it knows this one.
            far = rows(url, Host="robot-pc:8080")
            assert far["turtle"][0] == f"http://robot-pc:{port}/turtle/"
            assert far["near (only on its own machine)"][0] == ""
            with urlopen(url, timeout=patience(20)) as answer:
                assert SECRET not in answer.read().decode()
            code, _, err = program.end()
            assert code == 0 and "anyone who can reach port" in err


def test_robots_by_address_and_what_else_may_answer_there(tmp_path: Path) -> None:
    with (
        answering(200, b"ready\n") as ready,
        answering(503, b"waiting\n") as waiting,
        answering(503, b"stopping\n") as stopping,
        answering(401) as locked,
        answering(302) as login,
        answering(200, b"<html>ready</html>") as page,
        answering(503, b"ready\n") as strange,
    ):
        asked = {
            MARKED: ready,
            "w": waiting,
            "s": stopping,
            "l": locked,
            "i": login,
            "p": page,
            "x": strange,
            "a": f"http://127.0.0.1:{free_port()}",
        }
        sources = [f"--source={name}={where}" for name, where in asked.items()]
        words = ("index", *sources, "--port", "0", "--title", BAD, "--token", SECRET)
        with serving(*words, cwd=tmp_path) as program:
            link = address(program)
            url = link.partition("?")[0]
            with pytest.raises(HTTPError) as refused:
                rows(url)
            with refused.value as answer:
                assert answer.code == 401, "nobody sees the list without the token"
            found = rows(url, Authorization=f"Bearer {SECRET}")
            said = {name: state for name, (_, state) in found.items()}
            assert said == {
                MARKED: "ready",
                "w": "nothing is shown yet",
                "s": "stops",
                "l": "behind a login",
                "i": "behind a login",
                "p": "another program answers",
                "x": "another program answers",
                "a": "does not answer",
            }
            assert found[MARKED][0] == f"{ready}/"
            with urlopen(f"{url}readyz", timeout=patience(20)) as answer:
                assert answer.read() == b"ready\n"


@pytest.fixture
def router() -> Iterator[ZenohPeer]:
    """A router, which forwards and knows nothing."""
    peer = ZenohPeer(has_nodes=False)
    yield peer
    peer.stop()


def test_the_robots_of_a_router_come_and_go(router: ZenohPeer, tmp_path: Path) -> None:
    words = ("index", "--source", router.uri, "--port", "0", "--host", "0.0.0.0")
    with serving(*words, cwd=tmp_path) as program:
        url = address(program)
        assert rows(url) == {}
        arm = Visualizer(broadcast=f"{router.uri}/arm", port=0, base_path="/arm")
        turtle = Visualizer(
            broadcast=f"{router.uri}/turtle",
            port=0,
            allowed_origins=["https://lab.example.org"],
            token=SECRET,
        )
        with turtle:
            with arm:
                link = f"http://127.0.0.1:{arm.viser.get_port()}/arm/"
                ready = {
                    "arm": (link, "ready"),
                    "turtle": ("https://lab.example.org/", "ready"),
                }
                until(lambda: rows(url) == ready, WAIT)
                assert rows(url, Host="robot-pc:8080").keys() == {
                    "arm (only on its own machine)",
                    "turtle",
                }
            # Its name and its link stay: it may come back.
            ended = {**ready, "arm": (link, "does not answer")}
            until(lambda: rows(url) == ended, WAIT)
            router.stop()
            until(lambda: "zenoh router" in note(url), WAIT)
            away = "does not answer"
            until(lambda: {said for _, said in rows(url).values()} == {away}, WAIT)


def note(url: str) -> str:
    """What is said below the robots."""
    with urlopen(url, timeout=patience(20)) as answer:
        page = answer.read().decode()
    return unescape("".join(re.findall("<p>(.*?)</p>", page)))


def test_a_router_with_too_many_robots_is_listed_in_part(
    router: ZenohPeer, monkeypatch: pytest.MonkeyPatch
) -> None:
    lower(monkeypatch, "INDEXED_ROBOTS", 2)
    for name in ("a", "b", BAD.replace("/", "")):
        router.declare(f"sambot-viz/{name}/origin/1/0")
    routers = [live_address(router.uri)]
    with RobotIndex(Options(port=0), "Robots", [], routers) as index:
        until(lambda: "the first 2 are listed" in note(index.url), WAIT)
        # None of them is a program that answers.
        assert {state for _, state in rows(index.url).values()} == {"does not answer"}
        assert len(rows(index.url)) == 2


def test_states_are_asked_for_once_for_many_who_look(tmp_path: Path) -> None:
    count = 0

    class Counted(BaseHTTPRequestHandler):
        def do_GET(self) -> None:
            nonlocal count
            count += 1
            self.send_error(404)

        def log_message(self, format: str, *args: object) -> None:
            del format, args

    with ThreadingHTTPServer(("127.0.0.1", 0), Counted) as server:
        Thread(target=server.serve_forever, daemon=True).start()
        source = f"a=http://127.0.0.1:{server.server_address[1]}"
        words = ("index", "--source", source, "--port", "0")
        with serving(*words, cwd=tmp_path) as program:
            url = address(program)
            looks = [Thread(target=rows, args=(url,)) for _ in range(20)]
            for look in looks:
                look.start()
            for look in looks:
                look.join()
        server.shutdown()
    # A slow machine may take longer for them than a state is fresh.
    assert 1 <= count < 10


def write(name: str, text: str) -> Callable[[Path], None]:
    def do(folder: Path) -> None:
        (folder / name).write_text(text)

    return do


@pytest.mark.parametrize(
    ("prepare", "words", "said"),
    [
        (None, [], "an index needs robots: name a folder"),
        (None, ["nowhere"], "'nowhere' is not a folder"),
        (None, ["robots"], "has no file NAME.conf; write one for each robot"),
        (write("a.conf", "PORT=1\n"), ["robots"], "robots/a.conf: no line ARGS="),
        (
            write("a.conf", "\nARGS=--port 0\n"),
            ["robots"],
            "robots/a.conf:2: the index needs to know its port",
        ),
        (
            write("a.conf", "ARGS=--prot 1\n"),
            ["robots"],
            "robots/a.conf:1: unrecognized arguments: --prot",
        ),
        (
            write("a.conf", "ARGS=x 'y\n"),
            ["robots"],
            "robots/a.conf:1: a quote is not closed",
        ),
        (
            None,
            ["--source", "a=ftp://b"],
            "is not NAME=ADDRESS of a robot's page: write it as --source a=http",
        ),
        (None, ["--source", "a=http://b/?token=x"], "leave out what is behind ?"),
    ],
)
def test_a_wrong_call_says_where_and_what_to_do(
    prepare: Callable[[Path], None] | None,
    words: list[str],
    said: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: Capture,
) -> None:
    (tmp_path / "robots").mkdir()
    if prepare is not None:
        prepare(tmp_path / "robots")
    monkeypatch.chdir(tmp_path)
    # One that is not refused has no address to listen on, and ends with 1.
    assert main(["index", *words, "--host", "192.0.2.1"]) == 2
    assert said in capsys.readouterr().err


def test_two_robots_with_one_port_are_refused(tmp_path: Path, capsys: Capture) -> None:
    for name in ("a", "b"):
        (tmp_path / f"{name}.conf").write_text("ARGS=--port 8081\n")
    assert main(["index", str(tmp_path), "--host", "192.0.2.1"]) == 2
    assert "b.conf: port 8081 is that of a, too" in capsys.readouterr().err
