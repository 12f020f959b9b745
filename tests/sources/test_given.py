"""What ``--source`` takes: files, folders and addresses, each with a name."""

from __future__ import annotations

from pathlib import Path

import pytest

from sambot_viz.commands.command_line import Parser, parse
from sambot_viz.errors import UsageError
from sambot_viz.options import Options
from sambot_viz.sources.given import GivenSource, given_source

FORMS = ("{}", "bag:{}", "lab={}", "lab=bag:{}")


@pytest.mark.parametrize("form", FORMS)
@pytest.mark.parametrize("file", ["run.mcap", "a=b.mcap", "odd:1", "folder"])
def test_a_recording_is_taken_however_it_is_written(
    form: str, file: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    path = Path(file)
    if file == "folder":
        path.mkdir()
    else:
        path.write_bytes(b"")
    name = "lab" if "lab" in form else ""
    given = given_source(form.format(file))
    assert given == GivenSource(f"bag:{file}", name)
    assert (given.is_live, str(given.path)) == (False, file)
    (taken,) = Options(source=form.format(file)).sources
    assert taken == given


def test_a_recording_that_does_not_exist_is_one_by_its_ending() -> None:
    assert given_source("none.mcap") == GivenSource("bag:none.mcap")
    assert given_source("lab=none.DB3") == GivenSource("bag:none.DB3", "lab")


@pytest.mark.parametrize("uri", ["foxglove://robot:8765", "rosbridge+wss://h/?a=b"])
def test_a_robot_may_have_a_name(uri: str) -> None:
    assert given_source(uri) == GivenSource(uri)
    assert given_source(f"lab={uri}") == GivenSource(uri, "lab")
    assert given_source(uri).is_live


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        ("robot:8765", "foxglove://robot:8765 of a foxglove_bridge, rosbridge://"),
        ("lab=10.0.0.2:9090/x", "say what is spoken there: foxglove://10.0.0.2:9090/x"),
        ("[::1]:9090", r"rosbridge://\[::1\]:9090"),
        ("robot", "robot: no such file or folder; known: FILE or folder"),
        ("", "no such file or folder"),
        ("lab=", "no such file or folder"),
        ("http://robot", "unknown kind of source; known: FILE"),
    ],
)
def test_what_is_no_source_is_refused_with_what_would_be(
    words: str, sentence: str
) -> None:
    with pytest.raises(UsageError, match=sentence):
        given_source(words)


@pytest.mark.parametrize("command", ["topics", "snapshot", "frames", "echo", "export"])
def test_commands_take_a_source_as_the_page_does(command: str) -> None:
    parser = Parser(prog=f"sambot-viz {command}", groups=("source",))
    words = ["--source", "lab=run.mcap", "--source", "robot=foxglove://robot"]
    _, options = parse(parser, words)
    recording, robot = options.sources
    assert (recording.name, str(recording.path)) == ("lab", "run.mcap")
    assert options.live_sources == (robot,)
