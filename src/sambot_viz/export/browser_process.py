"""The Chromium or Chrome of this machine: found, started, and ended with its children.

Nothing here downloads one.
"""

from __future__ import annotations

import os
import shutil
import signal
import subprocess
import sys
import threading
from collections import deque
from collections.abc import Mapping, Sequence
from contextlib import suppress
from pathlib import Path
from typing import IO

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


_ADDRESS_MARK = "DevTools listening on "

_TETHER = """
profile=$1; shift
"$@" --remote-debugging-pipe 3<&0 4>/dev/null </dev/null
rm -rf -- "$profile"
"""
"""A shell script that starts the browser and removes its profile at the end. Chromium
ends when the pipe at its descriptor 3 is closed, which is our child's standard input:
the system closes it however this process ends, also when it is killed."""


class BrowserProcess:
    """A running browser, which ends with this process even when that is killed.

    On Windows only `end` ends it.

    Args:
        command: the program and its flags.
        profile: the folder of its profile.

    Raises:
        OSError: the program cannot be started.
    """

    def __init__(self, command: Sequence[str], profile: Path) -> None:
        flag = f"--user-data-dir={profile}"
        tethered = sys.platform != "win32"
        if tethered:
            command = ["/bin/sh", "-c", _TETHER, "sh", str(profile), *command]
        self._process = subprocess.Popen(
            [*command, flag],
            stdin=subprocess.PIPE if tethered else subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.PIPE,
            encoding="utf-8",
            errors="replace",
            start_new_session=True,
        )
        assert self._process.stderr is not None
        self._output = _Output(self._process.stderr)

    def wait_for_address(self, timeout: float) -> str | None:
        """Return the debugging address, or None when the browser ended or time is up.

        Args:
            timeout: how long it may take [s].
        """
        return self._output.wait_for_address(timeout)

    def last_lines(self) -> str:
        """Return what the browser wrote last, or "nothing"."""
        return self._output.last_lines()

    def end(self, patience: float) -> None:
        """End the browser with its children.

        Args:
            patience: how long it may take to end by itself [s].
        """
        if self._process.stdin is not None:
            self._process.stdin.close()
        with suppress(subprocess.TimeoutExpired):
            self._process.wait(patience)
        self._kill()
        self._output.wait_for_end(timeout=5.0)

    def _kill(self) -> None:
        number = self._process.pid
        if sys.platform == "win32":
            subprocess.run(
                ["taskkill", "/PID", str(number), "/T", "/F"],
                check=False,
                capture_output=True,
            )
            self._process.wait()
            return
        # The children are in the process group of the first process, and only they are.
        for kind in (signal.SIGTERM, signal.SIGKILL):
            with suppress(ProcessLookupError):
                os.killpg(number, kind)
            with suppress(subprocess.TimeoutExpired):
                self._process.wait(timeout=2.0)


class _Output:
    """Read the error output of the browser until all its processes end."""

    def __init__(self, pipe: IO[str]) -> None:
        self._pipe = pipe
        self._changed = threading.Condition()
        self._lines: deque[str] = deque(maxlen=4)
        self._address: str | None = None
        self._ended = False
        self._thread = threading.Thread(target=self._read, daemon=True)
        self._thread.start()

    def wait_for_address(self, timeout: float) -> str | None:
        with self._changed:
            self._changed.wait_for(lambda: self._address or self._ended, timeout)
            return self._address

    def wait_for_end(self, timeout: float) -> None:
        """Wait until no process of the browser holds its error output any more."""
        self._thread.join(timeout)

    def last_lines(self) -> str:
        with self._changed:
            return " | ".join(self._lines) or "nothing"

    def _read(self) -> None:
        with self._pipe:
            for line in self._pipe:
                with self._changed:
                    self._lines.append(line.strip())
                    if line.startswith(_ADDRESS_MARK):
                        self._address = line[len(_ADDRESS_MARK) :].strip()
                    self._changed.notify_all()
        with self._changed:
            self._ended = True
            self._changed.notify_all()
