"""How the page is served: viser's, with our scripts in it."""

from __future__ import annotations

import base64
import gzip
import hashlib
import http.client
import json
import re
from collections.abc import Iterator
from contextlib import closing
from pathlib import Path

import pytest
from patience import patience

import sambot_viz.page
from sambot_viz import Visualizer
from sambot_viz.server.connections.page_files import page_of_viser
from sambot_viz.server.connections.viser_page import taken_apart

PAGE = Path(sambot_viz.page.__file__).parent


@pytest.fixture(scope="module")
def port() -> Iterator[int]:
    with Visualizer(port=0) as viz:
        yield viz.viser.get_port()


def ask(port: int, path: str, **headers: str) -> tuple[http.client.HTTPResponse, bytes]:
    """The answer to a request for exactly this path, and its content."""
    with closing(
        http.client.HTTPConnection("127.0.0.1", port, timeout=patience(10.0))
    ) as server:
        server.request(
            "GET", path, headers={k.replace("_", "-"): v for k, v in headers.items()}
        )
        response = server.getresponse()
        return response, response.read()


def scripts_in(html: str) -> dict[str, str]:
    """Name → text of the scripts in the import map of the page."""
    found = re.search(r'<script type="importmap">(.*?)</script>', html)
    assert found is not None
    addresses = json.loads(found[1])["imports"]
    return {
        name: base64.b64decode(address.partition(",")[2]).decode()
        for name, address in addresses.items()
    }


def script_of_viser(html: str) -> str:
    """Where a page asks for the script of viser; "" where it does not."""
    found = re.search(r'<script data-src="([^"]+)">', html)
    return "" if found is None else found[1]


def test_the_page_has_our_scripts_and_our_style_sheet(port: int) -> None:
    for path in ("/", "/index.html", "/?fixedDpr=1"):
        response, content = ask(port, path)
        assert response.status == 200
        assert response.headers["Content-Type"] == "text/html; charset=utf-8"
        html = content.decode()
        assert 'import "sambot/main.js"' in html
        # Those of exported pages and of the board of a class are for these.
        others = ("player.css", "board.css")
        sheets = [p for p in PAGE.rglob("*.css") if p.name not in others]
    assert len(sheets) > 3
    for sheet in sheets:
        assert sheet.read_text("utf-8") in html, sheet
        assert 'id="root"' in html


def test_every_script_that_is_imported_is_in_the_page(port: int) -> None:
    scripts = scripts_in(ask(port, "/")[1].decode())
    left, seen = ["sambot/main.js"], set[str]()
    while left:
        name = left.pop()
        seen.add(name)
        imported = re.findall(r'(?:from|import) "([^"]+)"', scripts[name])
        left += [each for each in imported if each not in seen]
    assert {"sambot/wire/channel.js", "sambot/panels/displays.js"} <= seen
    # What nobody imports is not part of the page.
    assert seen == set(scripts)


def test_a_page_without_panels_has_only_what_the_view_needs() -> None:
    with Visualizer(port=0, panels=False) as viz:
        html = ask(viz.viser.get_port(), "/")[1].decode()
    assert 'import "sambot/view_only.js"' in html


def test_a_page_without_a_view_has_the_window_and_nothing_of_viser(port: int) -> None:
    whole = ask(port, "/")[1].decode()
    html = ask(port, "/?view=none")[1].decode()
    assert 'import "sambot/no_view.js"' in html
    scripts, all_scripts = scripts_in(html), scripts_in(whole)
    # The same scripts draw the window.
    assert {"sambot/start.js", "sambot/window/window.js"} <= set(scripts)
    same = set(scripts) & set(all_scripts)
    assert {name: scripts[name] for name in same} == {n: all_scripts[n] for n in same}
    # What draws and moves the scene is not there, nor is viser's own script.
    assert not {"sambot/view/rviz_look.js", "sambot/view/rviz_mouse.js"} & set(scripts)
    assert script_of_viser(html) == "" and "WebGL" not in html
    tags = {ask(port, path)[0].headers["ETag"] for path in ("/", "/?view=none")}
    assert len(tags) == 2


def test_the_page_is_sent_packed_to_who_takes_that(port: int) -> None:
    plain, content = ask(port, "/")
    packed, smaller = ask(port, "/", Accept_Encoding="gzip, deflate")
    assert plain.headers["Content-Encoding"] is None
    assert packed.headers["Content-Encoding"] == "gzip"
    assert gzip.decompress(smaller) == content
    assert len(smaller) < len(content)
    assert plain.headers["Content-Length"] == str(len(content))
    assert packed.headers["Content-Length"] == str(len(smaller))


def test_a_page_that_a_browser_has_is_not_sent_again(port: int) -> None:
    first, _ = ask(port, "/")
    tag = first.headers["ETag"]
    # Asked for each time, so that a new version of the program shows its own page.
    assert first.headers["Cache-Control"] == "no-cache"
    again, content = ask(port, "/", If_None_Match=tag)
    assert (again.status, content) == (304, b"")
    assert again.headers["ETag"] == tag
    other, content = ask(port, "/", If_None_Match='"another"')
    assert other.status == 200
    assert content


def test_the_editor_is_no_part_of_the_page_and_comes_when_it_is_asked_for(
    port: int,
) -> None:
    page = ask(port, "/")[1]
    vendored = (PAGE / "vendor" / "codemirror.js").read_bytes()
    assert not any("codemirror" in n for n in scripts_in(page.decode()))
    plain, content = ask(port, "/sambot/codemirror.js")
    assert content == vendored
    assert plain.headers["Content-Type"] == "text/javascript; charset=utf-8"
    packed, smaller = ask(port, "/sambot/codemirror.js", Accept_Encoding="gzip")
    assert gzip.decompress(smaller) == vendored and len(smaller) < 200_000
    tag = packed.headers["ETag"]
    again, nothing = ask(port, "/sambot/codemirror.js", If_None_Match=tag)
    assert (again.status, nothing) == (304, b"")


def test_each_package_in_the_editor_has_its_version_and_its_licence(port: int) -> None:
    folder = PAGE / "vendor" / "codemirror"
    wanted = json.loads((folder / "package.json").read_text("utf-8"))["dependencies"]
    locked = json.loads((folder / "package-lock.json").read_text("utf-8"))["packages"]
    licenses = ask(port, "/sambot/licenses.txt")[1].decode()
    for name, version in wanted.items():
        assert locked[f"node_modules/{name}"]["version"] == version
        assert f"== {name} {version}\n" in licenses


def test_the_script_of_viser_is_unpacked_and_a_browser_keeps_it(port: int) -> None:
    page = ask(port, "/")[1].decode()
    address = script_of_viser(page)
    assert f'<link rel="modulepreload" href="{address}">' in page
    plain, content = ask(port, f"/{address}")
    packed, smaller = ask(port, f"/{address}", Accept_Encoding="gzip")
    assert gzip.decompress(smaller) == content
    for response in (plain, packed):
        assert "immutable" in response.headers["Cache-Control"]
        assert response.headers["Content-Type"] == "text/javascript; charset=utf-8"
    # Another script would have another name.
    assert hashlib.sha256(content).hexdigest()[:20] in address
    assert b"globalThis.__viserZstdWasm" in content
    assert "globalThis.__viserZstdWasm=" in page and "data-p=" not in page
    # What a program or a page before this one had asked for is not there.
    assert ask(port, f"/{address[:-4]}0.js")[0].status == 404


def test_a_page_of_another_form_is_left_as_it_is() -> None:
    whole = page_of_viser()
    assert taken_apart(whole, "") is not None
    for change in ((b"data-cs=", b"data-xx="), (b"const a=de(d.p);", b"const b=0;")):
        assert taken_apart(whole.replace(*change, 1), "") is None
    assert taken_apart(b"<html><head></head></html>", "") is None


@pytest.mark.parametrize(
    "path",
    [
        "/sambot/main.js",
        "/page/main.js",
        "/../page/main.js",
        "/%2e%2e/page/main.js",
        "/..%2fpage/main.js",
        "//etc/hosts",
        "/%00.js",
        "/" + "x" * 5000 + ".js",
    ],
)
def test_nothing_else_is_served(port: int, path: str) -> None:
    response, content = ask(port, path)
    assert response.status == 404
    assert b"import" not in content
