"""`sambot-viz lesson NAME --static DIR`: a lesson as files for any web server."""

from __future__ import annotations

import re
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit

import pytest
from lesson_files import BASE

from sambot_viz.cli import main
from sambot_viz.lessons.read_lesson import open_lesson

Capture = pytest.CaptureFixture[str]
BOX = (
    '<robot name="{}"><link name="base_link"><visual><geometry><box size="1 1 1"/>'
    "</geometry></visual></link></robot>"
)
LESSON = """\
name: mine
title: Boxes <b>&
about: What is <i>not</i> HTML.
start: start
solution: solution
steps:
  - name: a
    title: A <script>alert(1)</script>
    model: robot.urdf
    text: |
      Some *words* with `<code>` and [a link](https://example.org/?a=1&b="2").

      ![A "box"](drawn.png)
    conditions: [robot: {name: right}]
    hints:
      - {after: 1, text: 'First `<box/>`.'}
      - {after: 3, text: Last.}
  - name: b
    title: B
    model: broken.urdf
    text: Mend it.
    conditions: [robot: {name: right}]
"""


class Page(HTMLParser):
    """What a browser finds in a page: elements, text, and what it would ask for.

    Attributes:
        tags: names of all elements.
        words: all texts.
        asks: addresses of pages, pictures and files.
    """

    def __init__(self, text: str) -> None:
        super().__init__()
        self.tags: list[str] = []
        self.words, self.asks = "", list[str]()
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append(tag)
        assert not any(name.startswith("on") for name, _ in attrs)
        self.asks += [v or "" for name, v in attrs if name in ("href", "src")]

    def handle_data(self, data: str) -> None:
        self.words += data


@pytest.fixture
def lesson(tmp_path: Path) -> Path:
    folder = tmp_path / "mine"
    for part in ("start", "solution"):
        (folder / part).mkdir(parents=True)
    (folder / "lesson.yaml").write_text(LESSON)
    (folder / "drawn.png").write_bytes(b"\x89PNG")
    (folder / "start" / "robot.urdf").write_text(BOX.format("begun"))
    (folder / "start" / "broken.urdf").write_text("<robot>")
    (folder / "start" / "a b%.txt").write_text("x")
    for name in ("robot.urdf", "broken.urdf"):
        (folder / "solution" / name).write_text(BOX.format("right"))
    return folder


def test_a_lesson_is_a_page_whose_files_are_all_there(
    lesson: Path, tmp_path: Path, capsys: Capture
) -> None:
    out = tmp_path / "site"
    assert main(["lesson", str(lesson), "--static", str(out)]) == 0
    said = capsys.readouterr()
    assert said.out == f"{out / 'index.html'}: Boxes <b>&\n"
    assert "broken.urdf has errors, and gets no page" in said.err

    page = Page((out / "index.html").read_text("utf-8"))
    # Nothing of the lesson is HTML, and nothing runs.
    assert not {"script", "b", "i", "form"} & set(page.tags)
    for words in (
        "Boxes <b>&",
        "What is <i>not</i> HTML.",
        "A <script>alert(1)</script>",
        "First <box/>.",
        "Last.",
        "cannot check your files",
        "sambot-viz lesson FOLDER",
        "has an error, so there is no picture of it",
    ):
        assert words in page.words
    own = [one for one in page.asks if not urlsplit(one).scheme and one[0] != "#"]
    assert {*own} >= {"pictures/drawn.png", "start/robot.urdf", "start/a%20b%25.txt"}
    assert all((out / unquote(one)).is_file() for one in own)
    robots = [(out / one).read_text("utf-8") for one in own if one.endswith(".html")]
    titles = [re.findall("<title>(.*?)</title>", text)[0] for text in robots]
    assert {*titles} == {"begun", "right"}
    # No file of the solution, and none of the conditions.
    assert not {*out.rglob("lesson.yaml")} and not {*out.rglob("solution*")}


def test_a_robot_of_several_steps_is_one_file(tmp_path: Path) -> None:
    solution = tmp_path / "robot.urdf"
    solution.write_text(BOX.format("done"))
    out = tmp_path / "site"
    words = ("lesson", str(BASE), "--static", str(out), "--solution", str(solution))
    assert main([*words]) == 0
    assert [path.name for path in out.glob("*.html")].count("robot-1.html") == 1
    page = Page((out / "index.html").read_text("utf-8"))
    assert page.asks.count("robot-1.html") == 2 * len(open_lesson(BASE).steps)


def test_a_lesson_that_ships_is_named_in_the_command(tmp_path: Path) -> None:
    out = tmp_path / "site"
    assert main(["lesson", "nav2-first-robot", "--static", str(out)]) == 0
    page = Page((out / "index.html").read_text("utf-8"))
    assert "sambot-viz lesson nav2-first-robot" in page.words
    assert "This is the track urdf; sdf is another one." in page.words


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["list", "--static", "x"], "--static writes a lesson: name one in place"),
        (["nav2-first-robot", "--static", "full"], "is there already; name a new"),
        (["nav2-first-robot", "--static", "x", "--track", "sd"], "no track 'sd'"),
        (["nav2-first-robot", "--static", "x", "--dir", "y"], "leave the other folder"),
        (["nav2-first-robot", "--static", "full/a/b"], "cannot write into 'full/a/b'"),
    ],
)
def test_a_wrong_call_says_what_to_do(
    words: list[str],
    said: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: Capture,
) -> None:
    (tmp_path / "full").mkdir()
    (tmp_path / "full" / "a").write_text("")
    monkeypatch.chdir(tmp_path)
    assert main(["lesson", *words]) == 2
    assert said in capsys.readouterr().err
