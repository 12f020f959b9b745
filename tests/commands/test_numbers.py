"""Any number on the command line is taken, or refused in words."""

from __future__ import annotations

import importlib
from collections.abc import Iterator
from pathlib import Path

import pytest
from made_recording import described, write_recording

from sambot_viz import Visualizer, outlet
from sambot_viz.cli import COMMANDS, main
from sambot_viz.commands import show
from sambot_viz.commands.command_line import Parser, parse
from sambot_viz.errors import SambotVizError, ServerError
from sambot_viz.export import chromium
from sambot_viz.inputs import Inputs

Capture = pytest.CaptureFixture[str]
NUMBERS = ("1e308", "-1e308", "inf", "nan", "-1", "0", "1e-320", f"1{400 * '0'}", "")
FORMS = {
    "SECONDS": "{}",
    "METRES": "{}",
    "PORT": "{}",
    "NAME=VALUE": "a_b={}",
    '"X Y Z YAW PITCH ROLL PARENT CHILD"': "{} 0 0 0 0 {} a c",
    "WxH": "{}x{}",
    "TIME": "{}min",
}
"""The placeholder of an option with numbers → how they stand in its value."""
OTHERS = {
    "MODEL", "PATH", "DIR", "FILE", "FILE.png", "FILE.html", "FILE.rviz", "URI",
    "[NAME=]URI", "NAME=PREFIX", "FRAME", "ORIGIN", "HEADER", "VALUE", "=VALUE",
    "A", "B", "JOINT", "NAME", "SOURCE", "TARGET", "HOST", "TOPIC", "KINDS",
    None,
    "FROM:=TO", "FORMAT", "LESSON", "STEP", "TRACK", "zenoh://ROUTER:7447/NAME",
    "CODE", "FOLDER", "[NAME=]ADDRESS", "TEXT",
}  # fmt: skip
"""Placeholders of what is no number."""


def parsers() -> Iterator[tuple[str, Parser]]:
    yield "show", show.parser()
    for name in COMMANDS:
        yield name, importlib.import_module(f"sambot_viz.commands.{name}").parser()


def numbers_of(parser: Parser) -> Iterator[tuple[str, str]]:
    """Yield the options with numbers, and the form of their values."""
    for action in parser.actions:
        form = FORMS.get(str(action.metavar)) or ("{}" if action.type else None)
        if form is not None and action.option_strings:
            yield action.option_strings[-1], form


CASES = [
    (command, flag, form)
    for command, parser in parsers()
    for flag, form in numbers_of(parser)
]


def test_it_is_known_which_options_are_numbers() -> None:
    actions = [a for _, parser in parsers() for a in parser.actions if a.nargs != 0]
    known = {*FORMS, *OTHERS}
    assert {a.metavar for a in actions if not a.type} <= known
    assert {"--at", "--for", "--size", "--port", "--joint"} <= {c[1] for c in CASES}


@pytest.fixture
def bag(tmp_path: Path) -> Path:
    told = [("/tf", float(n), {"b": "a"}) for n in range(3)]
    return write_recording(
        tmp_path / "a.mcap", {"/robot_description": described("a", "b")}, told
    )


@pytest.mark.parametrize(("command", "flag", "form"), CASES)
def test_a_number_is_taken_or_refused_in_words(
    command: str,
    flag: str,
    form: str,
    bag: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: Capture,
) -> None:
    def missing(*_: object, **__: object) -> None:
        raise ServerError("no browser here")

    # Not the name: who imports it meanwhile would have it for good.
    monkeypatch.setattr(chromium.Chromium, "__init__", missing)
    monkeypatch.chdir(bag.parent)
    for number in NUMBERS:
        value = form.format(*2 * [number])
        model = ["1", "2", "0", "--source"] if command == "goal" else []
        words = [*model, str(bag), f"{flag}={value}"]
        if flag != "--for":
            words += [] if command == "show" else ["--for=0.1"]
        words += {"echo": ["a", "b"], "snapshot": ["-o", "a.png"]}.get(command, [])
        words += ["-o", "a.html", "--motion=none"] if command == "export" else []
        code = served(words) if command == "show" else called([command, *words])
        err = capsys.readouterr().err
        assert code in (0, 1, 2), (words, err)
        assert "internal error" not in err and "Traceback" not in err, (words, err)
        assert code == 0 or "error:" in err, (words, err)


def called(words: list[str]) -> int | str | None:
    try:
        return main(words)
    except SystemExit as end:
        return end.code


def served(words: list[str]) -> int | str | None:
    """Start a server as the command does, and stop it when it runs."""
    port = [] if any(word.startswith("--port") for word in words) else ["--port=0"]
    try:
        _, options = parse(show.parser(), [*words, *port])
        with Inputs(options) as inputs, Visualizer.of_inputs(inputs):
            return 0
    except SystemExit as end:
        return end.code
    except SambotVizError as error:
        outlet.write_err(f"error: {error}")
        return 2
