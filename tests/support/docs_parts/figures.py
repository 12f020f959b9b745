"""Figures and install lines in sentences of the documents, from where they are known.

A row of `FIGURES` names a sentence by a pattern whose one group is the figure. The
sentence has to be there once.
"""

from __future__ import annotations

import json
import re
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from readme import commands

from sambot_viz.extras import PACKAGES

ROOT = Path(__file__).resolve().parents[3]


@dataclass(frozen=True, slots=True)
class Figure:
    """A figure in a document.

    Attributes:
        document: its path from the root of the repository.
        pattern: of the words around it; the group is the figure.
        value: returns what it has to be.
    """

    document: str
    pattern: str
    value: Callable[[], str]


def project(pattern: str) -> str:
    """Return what the group of a pattern is in pyproject.toml.

    Raises:
        ValueError: it is not there.
    """
    found = re.search(pattern, (ROOT / "pyproject.toml").read_text("utf-8"), re.M)
    if found is None:
        raise ValueError(f"pyproject.toml has nothing like {pattern}")
    return found[1]


def oldest_python() -> str:
    """Return the oldest version of Python that can run the program."""
    return project(r'^requires-python = ">=([\d.]+)"')


def installed() -> str:
    """Return how much an installation has, as last measured, such as "354 MB"."""
    return f"{_measured()['sizes']['sambot-viz']:.0f} MB"


def python_of_measure() -> str:
    """Return the Python of that measurement, such as "3.11"."""
    words = _measured()["runs"]["tree50"]["machine"]
    return re.findall(r"Python (\d+\.\d+)", words)[0]


def _measured() -> dict[str, dict[str, dict[str, str]]]:
    kept = ROOT / "docs" / "benchmarks" / "benchmarks.json"
    return json.loads(kept.read_text("utf-8"))


def with_pip() -> str:
    """Return README's first command without its last part, which shows a robot."""
    show, _ = commands(ROOT / "README.md")
    return " && ".join(show.split(" && ")[:-1])


def on_windows() -> str:
    """Return README's first command for PowerShell."""
    show, _ = commands(ROOT / "README.md")
    moved = show.replace(".venv/bin/", ".venv/Scripts/").replace("python3 ", "py ")
    return moved.replace("/", "\\").replace(" && ", "; ")


def extras() -> str:
    """Return the extras as an install line names them, in words."""
    *names, last = (f"`.[{name}]`" for name in PACKAGES)
    return f"{', '.join(names)} and {last}"


def size_of(package: str) -> str:
    """Return the size that pyproject.toml gives in the reason for a package."""
    return project(rf'^ +"{package}[^"]*",? .*?\b(\d+ MB)')


FIGURES = (
    Figure("README.md", r"With Python ([\d.]+) or newer", oldest_python),
    Figure("docs/install.md", r"needs Python ([\d.]+) or newer", oldest_python),
    Figure("docs/install.md", r"^\| pip \| `([^`]+)` \|$", with_pip),
    Figure("docs/install.md", r"^```powershell\n(.*)\n```$", on_windows),
    Figure("docs/install.md", r"^(`\.\[.*`) in place of `\.` add", extras),
    Figure("docs/install.md", r"has about (\d+ MB)", installed),
    Figure("docs/deploy.md", r"An installation has (\d+ MB)", installed),
    Figure("docs/deploy.md", r"\d MB with Python ([\d.]+) on Linux", python_of_measure),
    Figure("docs/deploy.md", r"which is (\d+ MB) of that", lambda: size_of("yourdfpy")),
    Figure("docs/live.md", r"10 MB to load and (\d+ MB)", lambda: size_of("eclipse")),
    Figure("docs/live.md", r"8 MB to load and (\d+ MB)", lambda: size_of("cyclone")),
)


def refreshed(name: str, document: str) -> str:
    """Return a document with the figures of now.

    Raises:
        ValueError: a sentence is not there, or more than once.
    """
    for figure in FIGURES:
        if figure.document == name:
            found = list(re.finditer(figure.pattern, document, re.MULTILINE))
            if len(found) != 1:
                raise ValueError(f"{len(found)} × {figure.pattern} in {name}")
            start, end = found[0].span(1)
            document = document[:start] + figure.value() + document[end:]
    return document
