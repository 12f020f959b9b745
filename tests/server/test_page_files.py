"""How the page's own files are served."""

from __future__ import annotations

import gzip
import http.client
import re
from collections.abc import Iterator
from contextlib import closing

import pytest

from sambot_viz import Visualizer, page


@pytest.fixture(scope="module")
def port() -> Iterator[int]:
    with Visualizer(port=0) as viz:
        yield viz.viser.get_port()


def ask(port: int, path: str, **headers: str) -> tuple[http.client.HTTPResponse, bytes]:
    """The answer to a request for exactly this path, and its content."""
    with closing(http.client.HTTPConnection("127.0.0.1", port, timeout=10)) as server:
        server.request(
            "GET", path, headers={k.replace("_", "-"): v for k, v in headers.items()}
        )
        response = server.getresponse()
        return response, response.read()


def names_in(text: str) -> list[str]:
    """The scripts and style sheets that a page loads by a relative name."""
    return re.findall(r'(?:src|href)="(\./[^"]+\.(?:js|css))"', text)


def test_the_page_loads_our_script_and_style_sheet(port: int) -> None:
    for path in ("/", "/index.html", "/?fixedDpr=1"):
        response, html = ask(port, path)
        assert response.status == 200
        assert response.headers["Content-Type"] == "text/html; charset=utf-8"
        own = [name for name in names_in(html.decode()) if page.FOLDER in name]
        assert own == [f"./{page.FOLDER}/window.css", f"./{page.FOLDER}/main.js"]
        assert b'id="root"' in html


def test_every_file_that_a_script_imports_is_there(port: int) -> None:
    left, seen = ["main.js"], set[str]()
    while left:
        path = left.pop()
        seen.add(path)
        response, script = ask(port, f"/{page.FOLDER}/{path}")
        assert response.status == 200, path
        assert response.headers["Content-Type"] == "text/javascript; charset=utf-8"
        folder = path.rpartition("/")[0]
        for name in re.findall(r'(?:from|import) "(\.[^"]+)"', script.decode()):
            up, name = name.startswith("../"), re.sub(r"^\.\.?/", "", name)
            found = name if up or not folder else f"{folder}/{name}"
            if found not in seen:
                left.append(found)
    assert {"channel.js", "panels/displays.js", "vendor/preact.js"} <= seen


@pytest.mark.parametrize("path", ["/", f"/{page.FOLDER}/main.js"])
def test_a_file_is_sent_packed_to_who_takes_that(port: int, path: str) -> None:
    plain, content = ask(port, path)
    packed, smaller = ask(port, path, Accept_Encoding="gzip, deflate")
    assert plain.headers["Content-Encoding"] is None
    assert packed.headers["Content-Encoding"] == "gzip"
    assert gzip.decompress(smaller) == content
    assert len(smaller) < len(content)
    assert plain.headers["Content-Length"] == str(len(content))
    assert packed.headers["Content-Length"] == str(len(smaller))


@pytest.mark.parametrize("path", ["/", f"/{page.FOLDER}/main.js"])
def test_a_file_that_a_browser_has_is_not_sent_again(port: int, path: str) -> None:
    first, _ = ask(port, path)
    tag = first.headers["ETag"]
    # Asked for each time, so that a new version of the program shows its own page.
    assert first.headers["Cache-Control"] == "no-cache"
    again, content = ask(port, path, If_None_Match=tag)
    assert (again.status, content) == (304, b"")
    assert again.headers["ETag"] == tag
    other, content = ask(port, path, If_None_Match='"another"')
    assert other.status == 200
    assert content


@pytest.mark.parametrize(
    "path",
    [
        "no_such_file.js",
        "",
        "panels",
        "panels/",
        "__init__.py",
        "vendor/LICENSES.txt",
        "../text.py",
        "../page/main.js",
        "panels/../main.js",
        "%2e%2e/page/main.js",
        "..%2fpage/main.js",
        "/etc/hosts.js",
        "%00.js",
        "x" * 5000 + ".js",
    ],
)
def test_nothing_else_is_served(port: int, path: str) -> None:
    response, content = ask(port, f"/{page.FOLDER}/{path}")
    assert response.status == 404
    assert b"import" not in content
