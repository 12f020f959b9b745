"""A browser that does not start is reported, and nothing is left behind."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import tempfile
import textwrap
from pathlib import Path

import pytest
from browser_input import Keyboard, Mouse
from patience import until

from sambot_viz.export.browser_process import find_browser
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
    """Whether a process runs; one that has ended but was not waited for does not."""
    try:
        state = Path(f"/proc/{process}/stat").read_text("utf-8")
    except (FileNotFoundError, ProcessLookupError):
        return False
    return state.rpartition(")")[2].split()[0] != "Z"


def processes_with(text: str) -> list[int]:
    """The processes that have a text in their command lines."""
    found: list[int] = []
    for folder in Path("/proc").glob("[0-9]*"):
        try:
            words = (folder / "cmdline").read_bytes()
        except (FileNotFoundError, ProcessLookupError):
            continue
        if text.encode() in words:
            found.append(int(folder.name))
    return found


@pytest.mark.skipif(sys.platform != "linux", reason="looks into /proc")
@pytest.mark.skipif(find_browser() is None, reason="there is no browser")
def test_a_browser_ends_when_its_python_process_is_killed() -> None:
    # Chromium's socket is below it, and has room for 107 characters: a folder of pytest
    # is too long in a worker.
    tmp_path = Path(tempfile.mkdtemp())
    script = (
        "from sambot_viz.export.chromium import Chromium\n"
        "with Chromium(timeout=60.0) as browser:\n"
        "    browser.open()\n"
        "    print('open', flush=True)\n"
        "    input()\n"
    )
    with subprocess.Popen(
        [sys.executable, "-c", script],
        env={**os.environ, "TMPDIR": str(tmp_path)},
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
    ) as python:
        assert python.stdout is not None
        assert python.stdout.readline() == b"open\n"
        assert processes_with(str(tmp_path))
        python.kill()
    until(lambda: not processes_with(str(tmp_path)), 20.0)
    until(lambda: not list(tmp_path.glob("sambot-viz-browser-*")), 20.0)
    shutil.rmtree(tmp_path)


@posix
def test_a_browser_that_ends_at_once_is_quoted(tmp_path: Path, profiles: Path) -> None:
    wrong = program(tmp_path, "echo 'No usable sandbox!' >&2; exit 1")
    with pytest.raises(BrowserError) as error, Chromium(wrong):
        pass
    assert str(error.value) == (
        f"the browser {wrong} ended or did not answer in 30 s; its last "
        "output: No usable sandbox!; name another one in SAMBOT_VIZ_BROWSER"
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
            BrowserError, match=r"did not answer in 0\.3 s; its last output: nothing"
        ),
        Chromium(silent, timeout=0.3),
    ):
        pass
    assert not is_running(int(noted.read_text("utf-8")))
    assert list(profiles.iterdir()) == []


@posix
def test_a_file_that_is_not_a_program_is_refused(
    tmp_path: Path, profiles: Path
) -> None:
    wrong = tmp_path / "browser"
    wrong.touch()
    with pytest.raises(BrowserError, match=r"ended .* Permission denied; name another"):
        Chromium(wrong).__enter__()
    assert list(profiles.iterdir()) == []


@posix
def test_an_address_without_a_server_is_an_error(
    tmp_path: Path, profiles: Path
) -> None:
    # Nothing listens on port 9 (discard) of today's machines.
    line = "DevTools listening on ws://127.0.0.1:9/devtools/browser/1"
    wrong = program(tmp_path, f"echo '{line}' >&2; exec sleep 60")
    with pytest.raises(BrowserError, match="the browser does not answer at ws://"):
        Chromium(wrong).__enter__()
    assert list(profiles.iterdir()) == []


def test_a_browser_outside_its_with_block_is_an_error() -> None:
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
