"""What is reported when the browser does not start, and that nothing is left behind."""

from __future__ import annotations

import signal
import sys
import tempfile
import textwrap
from pathlib import Path

import pytest
from browser_input import Keyboard, Mouse

from sambot_viz.export.chromium import Chromium
from sambot_viz.export.devtools import BrowserError, Fields

posix = pytest.mark.skipif(sys.platform == "win32", reason="uses a shell script")


@pytest.fixture
def profiles(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The folder in which the browser's profile is made."""
    folder = tmp_path / "profiles"
    folder.mkdir()
    monkeypatch.setattr(tempfile, "tempdir", str(folder))
    return folder


def program(folder: Path, script: str) -> Path:
    path = folder / "browser"
    path.write_text(f"#!/bin/sh\n{textwrap.dedent(script)}", encoding="utf-8")
    path.chmod(0o755)
    return path


def is_running(process: int) -> bool:
    """Whether a process runs; one that only waits to be buried does not."""
    try:
        state = Path(f"/proc/{process}/stat").read_text("utf-8")
    except (FileNotFoundError, ProcessLookupError):
        return False
    return state.rpartition(")")[2].split()[0] != "Z"


@posix
def test_a_browser_that_ends_at_once_is_quoted(tmp_path: Path, profiles: Path) -> None:
    wrong = program(tmp_path, "echo 'No usable sandbox!' >&2; exit 1")
    with pytest.raises(BrowserError) as error, Chromium(wrong):
        pass
    assert str(error.value) == (
        f"the browser {wrong} ended or did not answer in 30 s; it said: "
        "No usable sandbox!; name another one in SAMBOT_VIZ_BROWSER"
    )
    assert list(profiles.iterdir()) == []


@pytest.mark.skipif(sys.platform != "linux", reason="looks into /proc")
def test_a_browser_that_never_answers_is_ended_with_its_children(
    tmp_path: Path, profiles: Path
) -> None:
    noted = tmp_path / "child"
    silent = program(tmp_path, f"sleep 60 & echo $! > {noted}; wait")
    with (
        pytest.raises(
            BrowserError, match=r"did not answer in 0\.3 s; it said: nothing"
        ),
        Chromium(silent, timeout=0.3),
    ):
        pass
    assert not is_running(int(noted.read_text("utf-8")))
    assert list(profiles.iterdir()) == []


@posix
def test_a_file_that_is_no_program_is_said_so(tmp_path: Path, profiles: Path) -> None:
    wrong = tmp_path / "browser"
    wrong.touch()
    with pytest.raises(BrowserError, match=r"cannot be started: Permission denied; "):
        Chromium(wrong).__enter__()
    assert list(profiles.iterdir()) == []


@posix
def test_an_address_without_a_server_is_an_error(
    tmp_path: Path, profiles: Path
) -> None:
    # Port 9 of this machine is closed as far as any machine has one.
    line = "DevTools listening on ws://127.0.0.1:9/devtools/browser/1"
    wrong = program(tmp_path, f"echo '{line}' >&2; exec sleep 60")
    with pytest.raises(BrowserError, match="the browser does not answer at ws://"):
        Chromium(wrong).__enter__()
    assert list(profiles.iterdir()) == []


def test_a_browser_outside_its_with_block_says_so() -> None:
    with pytest.raises(BrowserError, match="use it in a 'with' block"):
        Chromium().open()
    Chromium().close()


def test_no_browser_at_all_is_one_clear_sentence(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("sambot_viz.export.chromium.find_browser", lambda: None)
    with pytest.raises(BrowserError, match="no Chromium or Chrome found") as error:
        Chromium().__enter__()
    assert "SAMBOT_VIZ_BROWSER" in str(error.value)


class Recorder:
    """A page that only notes what it was asked for."""

    def __init__(self) -> None:
        self.calls: list[Fields] = []

    def call(self, method: str, params: Fields | None = None) -> Fields:
        self.calls.append(params or {})
        return {}


def test_keys_carry_text_only_when_no_command_key_is_held() -> None:
    page = Recorder()
    keyboard = Keyboard(page)
    keyboard.press("a")
    keyboard.press("a", "Control")
    assert [call.get("text") for call in page.calls] == ["a", None, None, None]
    assert page.calls[0]["code"] == "KeyA"
    assert page.calls[2]["modifiers"] == 2


def test_an_unknown_key_or_modifier_offers_the_nearest_one() -> None:
    with pytest.raises(ValueError, match="no key 'ArrowLef'; did you mean 'ArrowLeft'"):
        Keyboard(Recorder()).press("ArrowLef")
    with pytest.raises(ValueError, match="no modifier 'Ctrl'; did you mean 'Control'"):
        Keyboard(Recorder()).press("a", "Ctrl")


def test_a_drag_holds_the_button_until_its_end() -> None:
    page = Recorder()
    Mouse(page).drag((0.0, 0.0), (10.0, 20.0), "Shift", button="middle", steps=2)
    assert [call["type"] for call in page.calls] == [
        "mouseMoved",
        "mousePressed",
        "mouseMoved",
        "mouseMoved",
        "mouseReleased",
    ]
    assert [call["buttons"] for call in page.calls] == [0, 4, 4, 4, 0]
    assert {call["modifiers"] for call in page.calls} == {8}
    assert (page.calls[-1]["x"], page.calls[-1]["y"]) == (10.0, 20.0)


def test_signals_are_left_as_they_were() -> None:
    before = signal.getsignal(signal.SIGINT)
    Chromium().close()
    assert signal.getsignal(signal.SIGINT) is before
