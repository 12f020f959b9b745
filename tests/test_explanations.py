"""What a code means, in the terminal and as a page; a link in Problems leads to it."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from html.parser import HTMLParser
from urllib.error import HTTPError
from urllib.request import Request, urlopen

import pytest
from panel_rows import rows_of
from problem_samples import Sample, all_samples
from websockets.datastructures import Headers
from websockets.http11 import Request as Asked

from sambot_viz import Problem, Visualizer, explanations
from sambot_viz.cli import main
from sambot_viz.panels.problems.problems_panel import ProblemsPanel
from sambot_viz.server.handshake import Answers
from sambot_viz.session import Session

Capture = pytest.CaptureFixture[str]


class Read(HTMLParser):
    """The elements of a page, their attributes, and its text."""

    def __init__(self, html: str) -> None:
        super().__init__()
        self.tags: set[str] = set()
        self.attributes: list[tuple[str, str | None]] = []
        self.text = ""
        self.feed(html)
        self.close()

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.add(tag)
        self.attributes += attrs if tag != "meta" else []

    def handle_data(self, data: str) -> None:
        self.text += data


def follow(path: str) -> tuple[int, str, Headers]:
    answer = Answers().of(Asked(path, Headers()))
    assert answer is not None

    async def wait() -> tuple[int, str, Headers]:
        response = await answer
        return response.status_code, response.body.decode(), response.headers

    return asyncio.run(wait())


def test_the_row_of_each_problem_has_its_link(session: Session) -> None:
    panel = ProblemsPanel(session.problems, session.history, lambda _: None)
    for sample in all_samples():
        session.problems.set_model([Problem("error", sample.code, sample.title)])
        rows = [row.json() for row in rows_of(panel).values()]
        assert [row["about"] for row in rows if "about" in row] == [sample.code]


@pytest.mark.parametrize("sample", all_samples(), ids=lambda sample: sample.code)
def test_the_link_of_each_code_leads_to_its_explanation(sample: Sample) -> None:
    status, html, headers = follow(f"/help/{sample.code}")
    assert status == 200
    page = Read(html)
    allowed = set("html meta title style h1 p pre code strong em blockquote a".split())
    assert page.tags <= allowed | {"br"}
    assert {name for name, _ in page.attributes} <= {"lang", "href"}
    assert headers["Content-Security-Policy"].startswith("default-src 'none'")
    said = " ".join(page.text.split())
    for words in (sample.code, sample.title.split("`")[0], sample.why):
        assert " ".join(words.split()) in said
    for name, content in sample.files.items() if sample.why else ():
        text = content if isinstance(content, str) else content.decode()
        assert name in said and " ".join(text.split()) in said


def test_all_codes_are_listed_with_links() -> None:
    status, html, _ = follow("/help/")
    links = [value for name, value in Read(html).attributes if name == "href"]
    assert status == 200
    assert links == sorted(sample.code for sample in all_samples())
    assert follow("/copy/help/")[0] == 200


@pytest.mark.parametrize("code", ["<script>", "%3Cscript%3E", "../etc", "x" * 5000])
def test_an_unknown_code_is_plain_text(code: str) -> None:
    status, text, headers = follow(f"/help/{code}")
    assert status == 404
    assert headers["Content-Type"].startswith("text/plain")
    assert text.startswith("no code ")


def test_explanations_are_behind_the_token(make_viz: Callable[..., Visualizer]) -> None:
    viz = make_viz(token="the-token-of-the-lab", base_path="/robot")
    address = f"http://127.0.0.1:{viz.viser.get_port()}/robot/help/xacro-left-over"
    with pytest.raises(HTTPError, match="401"):
        urlopen(address)
    allowed = {"Authorization": "Bearer the-token-of-the-lab"}
    with urlopen(Request(address, headers=allowed)) as page:
        assert b"left over from xacro" in page.read()


def test_the_terminal_prints_the_same(capsys: Capture) -> None:
    assert main(["check", "--explain", "xacro-left-over"]) == 0
    out = capsys.readouterr().out
    assert out.startswith(
        "xacro-left-over\n\nA macro call in a finished URDF (warning)."
    )
    assert '    <robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">\n' in out
    assert "delete it, or include the file of the macro" in out


def test_an_unknown_code_in_the_terminal_is_answered_with_the_nearest(
    capsys: Capture,
) -> None:
    assert main(["check", "--explain", "xacro-leftover"]) == 2
    assert "did you mean 'xacro-left-over'?" in capsys.readouterr().err


def test_what_a_section_has_cannot_become_html() -> None:
    for code in explanations.codes():
        assert "<script" not in explanations.as_html(code)
