"""Windows and macOS, as far as Linux can prove something of them.

They are run by .github/workflows/other-systems.yml; here no such system was ever tried.
"""

from __future__ import annotations

import io
import ntpath
import socket
import subprocess
import sys
import threading
from pathlib import Path

import pytest

from sambot_viz import files, outlet
from sambot_viz.robot.packages.package_index import PackageIndex
from sambot_viz.robot.packages.resolve import FileResolver
from sambot_viz.waiting import wait_for

ONLY_POSIX = "fcntl grp pty pwd resource termios tty".split()
"""Modules that Windows does not have."""


def test_every_module_is_imported_without_what_windows_lacks() -> None:
    names = ", ".join(map(repr, ONLY_POSIX))
    script = (
        "import importlib, os, pkgutil, signal, socket, subprocess, sys\n"
        f"sys.modules.update(dict.fromkeys([{names}]))\n"
        "for name in ('killpg', 'geteuid', 'getuid', 'getpgrp', 'setsid', 'fork'):\n"
        "    delattr(os, name)\n"
        "del signal.SIGKILL, signal.SIGHUP, socket.AF_UNIX\n"
        "import sambot_viz\n"
        "for found in pkgutil.walk_packages(sambot_viz.__path__, 'sambot_viz.'):\n"
        "    if not found.name.endswith('__main__'):\n"
        "        importlib.import_module(found.name)\n"
    )
    done = subprocess.run(
        [sys.executable, "-W", "ignore", "-c", script],
        capture_output=True,
        text=True,
        timeout=120,
    )
    assert done.returncode == 0, done.stderr


def test_a_file_on_another_drive_has_its_whole_path(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(files.os, "path", ntpath)
    assert files.relative_path(r"C:\ws\arm\a.xacro", r"C:\ws") == r"arm\a.xacro"
    assert files.relative_path(r"D:\arm\a.xacro", r"C:\ws") == r"D:\arm\a.xacro"


def test_a_wait_looks_for_signals_where_they_do_not_end_it(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    waited: list[float | None] = []

    class Slow(threading.Event):
        def wait(self, timeout: float | None = None) -> bool:
            waited.append(timeout)
            return len(waited) > 2

    wait_for(Slow())
    assert waited == [None] * 3
    waited.clear()
    monkeypatch.setattr(sys, "platform", "win32")
    wait_for(Slow())
    assert all(timeout is not None and timeout <= 1.0 for timeout in waited)


def test_a_pipe_of_windows_gets_utf8(monkeypatch: pytest.MonkeyPatch) -> None:
    pipe = io.BytesIO()
    stream = io.TextIOWrapper(pipe, encoding="cp1252")
    monkeypatch.setattr(sys, "stdout", stream)
    monkeypatch.setattr(sys, "platform", "win32")
    with outlet.guarded():
        outlet.write_lines("π → 3\n")
    assert pipe.getvalue().decode("utf-8").rstrip() == "π → 3"


def test_a_file_address_with_a_drive_is_that_file(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    # Linux takes the drive for a folder, which is made here.
    part = tmp_path / "C:" / "robot" / "part.stl"
    part.parent.mkdir(parents=True)
    part.touch()
    resolver = FileResolver(PackageIndex(None, ()), tmp_path)
    monkeypatch.setattr(sys, "platform", "win32")
    assert resolver.resolve("file:///C:/robot/part.stl").path == part


def test_a_port_is_asked_for_without_sharing_it_where_that_is_possible() -> None:
    """Two programs of Windows may have one port if both allow it."""
    from sambot_viz.server import listener

    option = listener._OF_A_PROBE  # pyright: ignore[reportPrivateUsage]
    assert option == getattr(socket, "SO_EXCLUSIVEADDRUSE", socket.SO_REUSEADDR)
