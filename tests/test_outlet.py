"""Whatever strangers' files hold: a terminal, a log, a page and a drawing stay calm."""

from __future__ import annotations

import io
import json
import logging
import re
import signal
import sys
import unicodedata
import warnings
from collections.abc import Callable, Iterator, Mapping
from dataclasses import asdict, is_dataclass
from datetime import datetime, timedelta
from pathlib import Path
from typing import Any, cast
from urllib.request import urlopen
from xml.etree import ElementTree

import numpy as np
import pytest
import rich
from hostile_texts import FORGED, HOSTILE, PLACES, write_hostile_bag
from program import address, rest_of, running
from protocol_client import ProtocolClient

from sambot_viz import Visualizer, outlet
from sambot_viz.cli import main
from sambot_viz.errors import FrameError, Problem, RobotError, UsageError
from sambot_viz.frames import FrameTree
from sambot_viz.frames.export.drawing import tree_dot, tree_json_text
from sambot_viz.frames.export.svg import tree_svg
from sambot_viz.frames.transform import Transform
from sambot_viz.graph.drawing import graph_dot, graph_json_text
from sambot_viz.graph.node_graph import GraphEdge, GraphNode, GraphTopic, node_graph
from sambot_viz.graph.svg import graph_svg
from sambot_viz.problems import write_problems

Capture = pytest.CaptureFixture[str]
FILLERS = "\u115f\u1160\u3164\uffa0\u034f"


CASES = [
    (place, kind)
    for place in PLACES
    for kind in HOSTILE
    # Half of a character is in names of files and in words, never in what was decoded.
    if kind != "half a character" or place.startswith(("names of files", "wh", "words"))
]


def unclean(written: str) -> set[str]:
    """What of a text is not seen, or is obeyed; and a line that a name has made."""
    found = {
        f"U+{ord(c):04X}"
        for c in written
        if unicodedata.category(c) in ("Cc", "Cf", "Cs", "Zl", "Zp") or c in FILLERS
        if c != "\n"
    }
    return found | {line for line in written.split("\n") if line.startswith(FORGED)}


def run(words: list[str]) -> None:
    try:
        main(words)
    except SystemExit:
        pass


@pytest.mark.parametrize(("place", "kind"), CASES)
def test_no_command_writes_what_a_terminal_obeys_or_does_not_show(
    place: str,
    kind: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: Capture,
) -> None:
    monkeypatch.chdir(tmp_path)
    written = 0
    for words in PLACES[place](tmp_path, HOSTILE[kind]):
        run(words)
        out, err = capsys.readouterr()
        assert (unclean(out), unclean(err)) == (set(), set()), (words, out, err)
        assert "internal error" not in err, err
        if "json" in words and out:
            json.loads(out)
        written += len(out) + len(err)
    assert written


@pytest.mark.parametrize("kind", ["refused by XML", "taken by XML"])
def test_drawings_of_frames_are_clean_and_json_keeps_the_names(kind: str) -> None:
    tree, name = FrameTree(), f"a{HOSTILE[kind]}b"
    tree.set_static("base", name, Transform(np.eye(4)))
    for draw in (tree_svg, tree_dot, tree_json_text):
        assert unclean(draw(tree)) == set()
    assert json.loads(tree_json_text(tree))["frames"] == ["base", name]


@pytest.mark.parametrize("kind", HOSTILE)
def test_graphs_of_nodes_are_clean_and_json_keeps_the_names(kind: str) -> None:
    name = f"/a{HOSTILE[kind]}<b>&\"'"
    graph = node_graph(
        [GraphNode(name, package=name, file=name, line=1)],
        [GraphTopic(f"{name}/t", types=(name,), problem=Problem("error", "x", name))],
        [GraphEdge(name, f"{name}/t", "publishes", remapped_from=name)],
        [name],
    )
    drawn = graph_svg(graph, Path())
    ElementTree.fromstring(drawn)
    for text in (drawn, graph_dot(graph), graph_json_text(graph)):
        assert unclean(text) == set()
    assert json.loads(graph_json_text(graph))["nodes"][0]["name"] == name


def test_a_model_is_expanded_to_the_same_xml(tmp_path: Path, capsys: Capture) -> None:
    name = HOSTILE["taken by XML"].replace("\x85", "").replace("\u2028", "")
    path = tmp_path / "r.urdf"
    path.write_text(f'<robot name="r"><link name="a{name}"/><!-- {name} --></robot>')
    assert main(["expand", str(path)]) == 0
    out = capsys.readouterr().out
    assert unclean(out) == set()
    (link,) = ElementTree.fromstring(out)
    assert link.get("name") == f"a{name}"


def test_the_page_its_export_and_the_log_are_clean(
    tmp_path: Path,
    protocol: Callable[..., ProtocolClient],
    caplog: pytest.LogCaptureFixture,
) -> None:
    bag = write_hostile_bag(tmp_path / "a.mcap", "".join(HOSTILE.values()))
    harmless = write_hostile_bag(tmp_path / "b.mcap", "")
    with Visualizer(model=bag, port=0) as viz:
        client = protocol(viz.viser.get_port())
        client.settle(viz.viser)
        assert any("twice" in said for said in strings(client.rows))
        for said in strings([client.rows, [each.fields for each in client.messages]]):
            assert unclean(said.replace("\n", " ")) == set(), said
        viz.export(tmp_path / "a.html")
    with Visualizer(model=harmless, port=0) as viz:
        viz.export(tmp_path / "b.html")
    # The scripts of the page have some of these characters themselves.
    pages = [(tmp_path / name).read_text("utf-8") for name in ("a.html", "b.html")]
    assert unclean(pages[0]) <= unclean(pages[1])
    assert all(unclean(record.getMessage()) == set() for record in caplog.records)


def strings(value: Any) -> Iterator[str]:
    """Yield every text in a value, keys too."""
    if isinstance(value, str):
        yield value
    elif isinstance(value, Mapping):
        for each in cast("Mapping[Any, Any]", value).items():
            yield from strings(each)
    elif isinstance(value, list | tuple):
        for each in cast("list[Any]", value):
            yield from strings(each)
    elif is_dataclass(value) and not isinstance(value, type):
        yield from strings(asdict(value))


def test_the_log_of_a_server_is_clean(tmp_path: Path) -> None:
    bag = write_hostile_bag(tmp_path / "a.mcap", HOSTILE["taken by XML"])
    name = f"a{HOSTILE['taken by XML']}"
    model = tmp_path / f"{name}.urdf"
    twice = f'<link name="{name}"/><link name="{name}"/>'
    model.write_text(f'<robot name="r">{twice}</robot>', "utf-8")
    words = (str(model), "--source", f"bag:{bag}", "--port", "0")
    with running(*words, cwd=tmp_path) as process:
        url = address(process)
        assert process.stderr is not None
        said = process.stderr.readline()
        with urlopen(url) as page:
            assert page.status == 200
        process.send_signal(signal.SIGINT)
        out, err = rest_of(process)
    assert "error[" in said
    assert unclean(out) == unclean(said + err) == set()


BAD = "".join(HOSTILE.values())


def of_print() -> None:
    print(BAD)
    print(BAD, file=sys.stderr)


def of_warnings() -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("always")
        # As Python does without pytest.
        sys.stderr.write(warnings.formatwarning(BAD, UserWarning, BAD, 1, BAD))


def of_a_thread() -> None:
    sys.__dict__["excepthook"](ValueError, ValueError(BAD), None)


def of_other_libraries() -> None:
    record = logging.LogRecord("viser", logging.ERROR, "", 0, "%s", (BAD,), None)
    assert logging.lastResort is not None
    logging.lastResort.handle(record)
    try:
        raise ValueError(BAD)
    except ValueError:
        record.exc_info = sys.exc_info()
    logging.lastResort.handle(record)


def of_rich() -> None:
    rich.print(BAD)
    rich.get_console().print(BAD, style="red")


@pytest.mark.parametrize(
    "write", [of_print, of_warnings, of_a_thread, of_other_libraries, of_rich]
)
def test_what_others_write_passes_the_outlet(
    write: Callable[[], None], capsys: Capture
) -> None:
    with outlet.guarded():
        write()
    out, err = capsys.readouterr()
    assert out or err
    found = {each for each in unclean(out + err) if not each.startswith(FORGED)}
    assert found == set()


def test_a_record_cannot_make_a_second_line(capsys: Capture) -> None:
    with outlet.guarded():
        of_other_libraries()
    err = capsys.readouterr().err
    assert unclean(err) == set()
    assert "ValueError" in err and "Traceback" in err


def test_records_of_this_package_are_clean_for_any_handler() -> None:
    stream = io.StringIO()
    handler = logging.StreamHandler(stream)
    log = outlet.logger("sambot_viz.test_outlet")
    log.addHandler(handler)
    try:
        log.error("topic %s", BAD)
    finally:
        log.removeHandler(handler)
    assert stream.getvalue().count("\n") == 1
    assert unclean(stream.getvalue()) == set()


def records(capsys: Capture) -> list[dict[str, str]]:
    """Return what standard error has got, a record in each line."""
    err = capsys.readouterr().err
    assert unclean(err) == set()
    return [json.loads(each) for each in err.splitlines()]


def test_as_json_each_note_and_problem_is_one_record(capsys: Capture) -> None:
    with outlet.guarded():
        outlet.write_records(True)
        outlet.write_err("sambot-viz: note: a note", "and its second line")
        outlet.write_err(f"sambot-viz: warning: {BAD}")
        problems = [
            Problem("error", "a-code", "no link", "write one"),
            Problem("info", "b-code", "no mass"),
        ]
        write_problems(problems)
    written = records(capsys)
    assert [each["level"] for each in written] == ["info", "warning", "error", "info"]
    assert written[0]["message"] == "sambot-viz: note: a note\nand its second line"
    assert "error[a-code]: no link; write one" in written[2]["message"]
    times = [datetime.fromisoformat(each["time"]) for each in written]
    assert all(time.utcoffset() == timedelta() for time in times)


@pytest.mark.parametrize(
    "write", [of_print, of_warnings, of_a_thread, of_other_libraries]
)
def test_as_json_what_others_write_is_records_too(
    write: Callable[[], None], capsys: Capture
) -> None:
    with outlet.guarded():
        outlet.write_records(True)
        write()
    assert "".join(each["message"] for each in records(capsys))


def test_as_json_a_record_of_the_log_names_its_logger(capsys: Capture) -> None:
    with outlet.guarded():
        outlet.write_records(True)
        of_other_libraries()
    without, written = records(capsys)
    assert written["logger"] == without["logger"] == "viser"
    assert written["level"] == "error"
    assert written["message"].startswith(f"{without['message']}\n  Traceback")


def test_after_a_command_lines_are_lines_again(capsys: Capture) -> None:
    with outlet.guarded():
        outlet.write_records(True)
    outlet.write_err("a line")
    assert capsys.readouterr().err == "a line\n"


class Terminal(io.StringIO):
    """A terminal, as far as programs ask."""

    def isatty(self) -> bool:
        return True


def test_a_terminal_gets_the_colors_of_the_program_alone(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.delenv("NO_COLOR", raising=False)
    for color in (True, False):
        if not color:
            monkeypatch.setenv("NO_COLOR", "1")
        monkeypatch.setattr(sys, "stderr", terminal := Terminal())
        with outlet.guarded():
            write_problems([Problem("error", "some-code", f"no {BAD}", "", "a.urdf")])
        written = terminal.getvalue()
        own = re.findall("\x1b\\[[0-9;]*m", written)
        assert bool(own) == color
        assert unclean(re.sub("\x1b\\[[0-9;]*m", "", written)) == set()
        # Each color of ours ends.
        assert own.count("\x1b[0m") * 2 == len(own)


def test_a_terminal_that_cannot_write_a_letter_gets_another(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    raw = io.BytesIO()
    monkeypatch.setattr(sys, "stdout", io.TextIOWrapper(raw, encoding="latin-1"))
    outlet.write_out("é바퀴\x9b")
    assert raw.getvalue() == "é???\n".encode("latin-1")


def test_the_mark_stands_below_its_column_in_a_clean_excerpt(
    tmp_path: Path, capsys: Capture
) -> None:
    path = tmp_path / "r.urdf"
    # Of these only the line breaks of XML end a line, for whoever counts them.
    path.write_bytes("<robot>\r\n<!-- \x85\u2028\u202e\t\x9b --> <linc/>\n".encode())
    column = path.read_text("utf-8").split("\n")[1].index("linc") + 1
    write_problems([Problem("error", "c", "m", "", str(path), 2, column)])
    _, excerpt, mark = capsys.readouterr().err.splitlines()
    assert excerpt[mark.index("^") :].startswith("linc")
    assert unclean(excerpt) == set()


def test_an_error_that_a_script_or_a_notebook_shows_is_clean() -> None:
    for error in (
        FrameError(BAD),
        UsageError(BAD),
        RobotError([Problem("error", "c", BAD, BAD, BAD), Problem("error", "d", BAD)]),
    ):
        assert unclean(str(error)) == set()
        assert unclean("\n".join(error._render_traceback_())) == set()
