"""An environment of its own for every peer, kept below tests/.venv/peers."""

from __future__ import annotations

import importlib.metadata
import json
import shutil
import subprocess
import sys
import venv
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

LONGEST = 900.0
"""What an installation may take [s]."""


class NotHere(Exception):
    """A peer cannot be had on this machine; says why."""


@dataclass(frozen=True, slots=True)
class Environment:
    """Where a peer is installed.

    Attributes:
        python: its interpreter.
        modules: its folder of npm's packages; None when it has none.
        version: of the peer.
        size: of all that was installed for it [MB]; of this program, with what a user's
            `pip install` brings.
    """

    python: Path
    modules: Path | None
    version: str
    size: float

    def program(self, name: str) -> Path:
        """A program of this environment."""
        return self.python.with_name(name)


def prepare(
    folder: Path,
    key: str,
    packages: Sequence[str],
    modules: Sequence[str],
    version_of: str,
) -> Environment:
    """Install a peer, or find it installed.

    Args:
        folder: where environments are kept.
        key: the environment's name.
        packages: of PyPI, or folders of source.
        modules: of npm.
        version_of: the package whose version is told.

    Raises:
        NotHere: it cannot be installed; why is in its words.
    """
    home = folder / key
    stamp = home / "packages.json"
    wanted = json.dumps([*packages, "|", *modules])
    if not stamp.is_file() or stamp.read_text("utf-8") != wanted:
        shutil.rmtree(home, ignore_errors=True)
        _install(home, packages, modules)
        stamp.write_text(wanted, "utf-8")
    python = home / "bin" / "python"
    npm = home / "node_modules" if modules else None
    return Environment(python, npm, _version(python, npm, version_of), _size(home))


def _install(home: Path, packages: Sequence[str], modules: Sequence[str]) -> None:
    venv.create(home, with_pip=True)
    python = home / "bin" / "python"
    if packages:
        _run([python, "-m", "pip", "install", "-q", "--no-compile", *packages])
    # What has installed the rest is no part of it.
    _run([python, "-m", "pip", "uninstall", "-q", "-y", "pip", "setuptools"])
    if modules:
        npm = shutil.which("npm")
        if npm is None:
            raise NotHere("npm is not installed")
        _run([npm, "install", "--silent", "--prefix", str(home), *modules])


def _run(command: Sequence[object]) -> None:
    words = [str(word) for word in command]
    try:
        subprocess.run(
            words, check=True, timeout=LONGEST, capture_output=True, text=True
        )
    except subprocess.CalledProcessError as error:
        said = (error.stderr or error.stdout or "").strip().splitlines()
        raise NotHere(f"cannot be installed: {said[-1] if said else error}") from error
    except subprocess.TimeoutExpired as error:
        raise NotHere(f"was not installed within {LONGEST:.0f} s") from error


def _version(python: Path, modules: Path | None, package: str) -> str:
    if modules is not None:
        about = modules / package / "package.json"
        return str(json.loads(about.read_text("utf-8"))["version"])
    if package == "sambot-viz":
        return importlib.metadata.version(package)
    script = f"import importlib.metadata as m; print(m.version({package!r}))"
    done = subprocess.run(
        [python, "-c", script], capture_output=True, text=True, check=True
    )
    return done.stdout.strip()


def _size(home: Path) -> float:
    # Compiled modules come with the first start.
    files = (p for p in home.rglob("*") if p.is_file() and p.suffix != ".pyc")
    return sum(p.stat().st_size for p in files if not p.is_symlink()) / 1e6


def debian(programs: Sequence[str]) -> Environment:
    """The system's own Python, when Debian's packages are installed; none is installed.

    Raises:
        NotHere: they are not.
    """
    here = Path("/usr/bin/python3")
    places = [Path("/usr/bin"), *(Path("/usr/lib") / name for name in programs)]
    for name in (*programs, "roscore", "Xvfb"):
        if not any((place / name).is_file() for place in places):
            raise NotHere(f"Debian's packages are not installed: no {name}")
    needs = [here, "-c", "import numpy, rospy, sensor_msgs.msg"]
    if subprocess.run(needs, capture_output=True).returncode:
        raise NotHere("Debian's python3-numpy or python3-rospy is not installed")
    asked = ["dpkg-query", "--show", "--showformat=${Version}", programs[0]]
    version = subprocess.run(asked, capture_output=True, text=True).stdout.strip()
    return Environment(here, None, version, 0.0)


def own(repository: Path, folder: Path) -> Environment:
    """This program, installed from the source beside this file as a user would."""
    found = prepare(folder, "sambot-viz", (str(repository),), (), "sambot-viz")
    return Environment(Path(sys.executable), None, found.version, found.size)
