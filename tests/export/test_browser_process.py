"""Which browser is taken, and what is said when there is none."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

from sambot_viz.errors import ServerError
from sambot_viz.export.browser_process import find_browser, how_to_get_a_browser
from sambot_viz.export.devtools import BrowserError

posix = pytest.mark.skipif(sys.platform == "win32", reason="uses a shell script")


def program(folder: Path, name: str) -> Path:
    """A file that can be run."""
    path = folder / name
    path.write_text("#!/bin/sh\n", encoding="utf-8")
    path.chmod(0o755)
    return path


@posix
def test_the_first_known_command_on_path_is_taken(tmp_path: Path) -> None:
    program(tmp_path, "google-chrome")
    chromium = program(tmp_path, "chromium")
    assert find_browser({"PATH": str(tmp_path)}) == chromium


@posix
def test_the_environment_variable_takes_precedence_over_path(tmp_path: Path) -> None:
    program(tmp_path, "chromium")
    mine = program(tmp_path, "my browser")
    by_path = {"PATH": str(tmp_path), "SAMBOT_VIZ_BROWSER": str(mine)}
    by_name = {"PATH": str(tmp_path), "SAMBOT_VIZ_BROWSER": "my browser"}
    assert find_browser(by_path) == mine
    assert find_browser(by_name) == mine


def test_a_wrong_environment_variable_is_an_error_not_another_browser(
    tmp_path: Path,
) -> None:
    environment = {"PATH": str(tmp_path), "SAMBOT_VIZ_BROWSER": "chromum"}
    with pytest.raises(BrowserError) as error:
        find_browser(environment)
    assert isinstance(error.value, ServerError)
    assert str(error.value) == (
        "SAMBOT_VIZ_BROWSER is 'chromum', which is not a program here; "
        "give the path of a Chromium or Chrome, or unset it"
    )


def test_without_a_browser_none_is_found(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(sys, "platform", "linux")
    assert find_browser({"PATH": str(tmp_path)}) is None


def test_windows_and_mac_keep_browsers_outside_path(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    edge = tmp_path / "Microsoft" / "Edge" / "Application" / "msedge.exe"
    edge.parent.mkdir(parents=True)
    edge.touch()
    monkeypatch.setattr(sys, "platform", "win32")
    assert find_browser({"PATH": "", "PROGRAMFILES": str(tmp_path)}) == edge
    chrome = "Applications/Google Chrome.app/Contents/MacOS/Google Chrome"
    (tmp_path / chrome).parent.mkdir(parents=True)
    (tmp_path / chrome).touch()
    monkeypatch.setattr(sys, "platform", "darwin")
    monkeypatch.setattr(Path, "home", lambda: tmp_path)
    found = find_browser({"PATH": ""})
    # A Mac that runs this test may have one of its own before ours.
    assert found is not None and found.name in ("Google Chrome", "Chromium")


@pytest.mark.parametrize(
    ("platform", "part"),
    [
        ("linux", "Debian: 'apt-get install chromium'"),
        ("darwin", "brew install --cask chromium"),
        ("win32", "Edge"),
        ("freebsd", "install one"),
    ],
)
def test_every_system_gets_its_own_advice(
    platform: str, part: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(sys, "platform", platform)
    assert part in how_to_get_a_browser()
    assert how_to_get_a_browser().endswith("name its program in SAMBOT_VIZ_BROWSER")
