"""The Problems panel: order, escaping, long lists, and when it is there."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from protocol_client import ProtocolClient

from sambot_viz import Problem, Visualizer
from sambot_viz.panels import problems as panel_module
from sambot_viz.panels.problems import MOST_SHOWN, title
from sambot_viz.problem_groups import group_problems
from sambot_viz.session import Session


@pytest.fixture
def viz() -> Iterator[Visualizer]:
    with Visualizer(port=0) as visualizer:
        yield visualizer


@pytest.fixture
def session(viz: Visualizer) -> Session:
    return viz._server.sessions()[0]  # pyright: ignore[reportPrivateUsage]


@pytest.fixture
def client(
    viz: Visualizer, protocol: Callable[[int], ProtocolClient]
) -> ProtocolClient:
    return protocol(int(viz.url.rsplit(":", 1)[1]))


def panel(client: ProtocolClient) -> dict[str, Any]:
    """What a browser knows of the panel: its title and whether it is there."""
    made = next(
        m
        for m in client.messages
        if any(
            label.startswith("Problems")
            for label in m.fields.get("props", {}).get("_tab_labels", ())
        )
    )
    props = dict(made.fields["props"])
    for message in client.messages:
        if message.fields.get("uuid") == made.fields["uuid"]:
            props.update(message.fields.get("updates", {}))
    return props


def problems_html(problems: list[Problem]) -> str:
    return panel_module.problems_html(group_problems(problems))


def test_the_title_counts() -> None:
    assert title([]) == "Problems"
    notes = [Problem("info", "i", f"note {number}") for number in range(3)]
    assert title(group_problems(notes)) == "Problems (3)"


def test_what_comes_out_of_files_is_escaped(tmp_path: Path) -> None:
    path = tmp_path / "<img src=x>.urdf"
    path.write_text("<script>alert(1)</script>", "utf-8")
    message, hint = "<b>bold</b> & \ud800", "<i>\u202e"
    problem = Problem("error", "e", message, hint, str(path), 1, 1)
    written = problems_html([problem])
    for text in ("<img", "<script", "<b>bold", "<i>", "\ud800", "\u202e"):
        assert text not in written
    assert "&lt;b&gt;bold&lt;/b&gt; &amp;" in written


def test_the_place_and_the_line_are_shown_with_the_word_marked(tmp_path: Path) -> None:
    path = tmp_path / "model.urdf"
    path.write_text('\n  <robot nam="r"/>\n', "utf-8")
    written = problems_html([Problem("warning", "w", "hm", "do", str(path), 2, 10)])
    assert "model.urdf:2:10" in written
    assert "<pre>&lt;robot <u>nam</u>=&quot;r&quot;/&gt;</pre>" in written
    assert ">do<" in written


def test_of_a_long_line_the_part_with_the_mistake_is_shown(tmp_path: Path) -> None:
    path = tmp_path / "model.urdf"
    path.write_text("x " * 60 + "wrong " + "y " * 60, "utf-8")
    written = problems_html([Problem("error", "e", "no", "", str(path), 1, 121)])
    assert "<pre>…x" in written
    assert "<u>wrong</u>" in written


def test_of_three_hundred_problems_the_first_are_shown_and_the_rest_is_counted() -> (
    None
):
    problems = [Problem("warning", "w", f"number {i}") for i in range(300)]
    written = problems_html(problems)
    assert written.count('class="sambot-problem ') == MOST_SHOWN
    assert f"and {300 - MOST_SHOWN} warnings more" in written


def test_the_panel_is_there_while_there_is_something_to_tell(
    viz: Visualizer, session: Session, client: ProtocolClient
) -> None:
    assert not panel(client)["visible"]
    session.problems.set_saves("model", [Problem("error", "e", "it is broken")])
    client.settle(viz.viser)
    assert panel(client)["visible"]
    assert panel(client)["_tab_labels"] == ["Problems (1)"]
    assert any("last good version" in str(m.fields) for m in client.messages)
    session.problems.set_saves("model", [])
    client.settle(viz.viser)
    assert not panel(client)["visible"]
    assert panel(client)["_tab_labels"] == ["Problems"]


def test_the_same_problems_are_not_sent_twice(
    viz: Visualizer, session: Session, client: ProtocolClient
) -> None:
    session.problems.set_saves("model", [Problem("error", "e", "it is broken")])
    client.settle(viz.viser)
    mark = client.mark()
    session.problems.set_saves("model", [Problem("error", "e", "it is broken")])
    client.settle(viz.viser)
    assert client.since(mark) == []
