"""Find the Chromium or Chrome of this machine. Nothing here downloads one."""

from __future__ import annotations

import os
import shutil
import sys
from collections.abc import Mapping
from pathlib import Path

from sambot_viz.export.devtools import BrowserError

ENVIRONMENT_VARIABLE = "SAMBOT_VIZ_BROWSER"
"""Names the browser to use: a path, or a command on PATH."""

COMMANDS = (
    "chromium",
    "chromium-browser",
    "google-chrome",
    "google-chrome-stable",
    "chrome",
    "msedge",
    "microsoft-edge",
)
_MAC_PLACES = (
    "Google Chrome.app/Contents/MacOS/Google Chrome",
    "Chromium.app/Contents/MacOS/Chromium",
    "Microsoft Edge.app/Contents/MacOS/Microsoft Edge",
)
_WINDOWS_PLACES = (
    "Google/Chrome/Application/chrome.exe",
    "Chromium/Application/chrome.exe",
    "Microsoft/Edge/Application/msedge.exe",
)


def how_to_get_a_browser() -> str:
    """Say how a user of this system installs one."""
    ways = {
        "linux": "install one (Debian: 'apt-get install chromium')",
        "darwin": "install one ('brew install --cask chromium')",
        "win32": "install one, or use the Edge that Windows brings",
    }
    way = ways.get(sys.platform, "install one")
    return f"{way}, or name its program in {ENVIRONMENT_VARIABLE}"


def find_browser(environment: Mapping[str, str] = os.environ) -> Path | None:
    """Return the Chromium-like browser of this machine, or None.

    Args:
        environment: PATH and SAMBOT_VIZ_BROWSER are read from it.

    Raises:
        BrowserError: SAMBOT_VIZ_BROWSER names nothing that can be run.
    """
    path = environment.get("PATH", os.defpath)
    wanted = environment.get(ENVIRONMENT_VARIABLE, "")
    if wanted:
        found = shutil.which(wanted, path=path)
        if found is None:
            raise BrowserError(
                f"{ENVIRONMENT_VARIABLE} is '{wanted}', which is not a program here; "
                "give the path of a Chromium or Chrome, or unset it"
            )
        return Path(found)
    for command in COMMANDS:
        found = shutil.which(command, path=path)
        if found is not None:
            return Path(found)
    return next((p for p in _usual_places(environment) if p.is_file()), None)


def _usual_places(environment: Mapping[str, str]) -> list[Path]:
    """List where browsers are on systems that do not put them on PATH."""
    if sys.platform == "darwin":
        folders = (Path("/Applications"), Path.home() / "Applications")
        return [folder / place for folder in folders for place in _MAC_PLACES]
    if sys.platform == "win32":
        names = ("PROGRAMFILES", "PROGRAMFILES(X86)", "LOCALAPPDATA")
        roots = [Path(environment[name]) for name in names if name in environment]
        return [root / place for root in roots for place in _WINDOWS_PLACES]
    return []
