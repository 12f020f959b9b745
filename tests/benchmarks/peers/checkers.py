"""What programs that check models say of the wrong ones, and of right ones."""

from __future__ import annotations

import re
import statistics
import subprocess
import sys
import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import yaml
from tests.benchmarks.peers.peers import Checker

LONGEST = 20.0
"""A check that takes longer hangs [s]."""


@dataclass(frozen=True, slots=True)
class Case:
    """A wrong model.

    Attributes:
        path: of the model.
        line: where the mistake is.
        refused: ROS refuses it, or nothing is said of that; otherwise it works in ROS,
            but not as was meant.
    """

    path: Path
    line: int
    refused: bool


@dataclass(frozen=True, slots=True)
class Verdict:
    """How a checker did.

    Attributes:
        cases: how many wrong models it was given that ROS may refuse, and others.
        refused: of the first, so many it ended with an error on.
        noticed: of the others, so many it said something else about than about the
            right model.
        lines: of all, so many whose line its words name.
        hangs: so many took longer than `LONGEST`, or it crashed on.
        complaints: right models that it ended with an error on.
        right: how many right models it was given.
        seconds: the median time of one check [s].
    """

    cases: tuple[int, int]
    refused: int
    noticed: int
    lines: int
    hangs: int
    complaints: int
    right: int
    seconds: float


@dataclass(frozen=True, slots=True)
class _Answer:
    exit: int | None
    words: str
    seconds: float


def own_cases(repository: Path, folder: Path) -> Iterator[Case]:
    """Write the wrong models of the tests that are one file."""
    entries: list[dict[str, Any]] = yaml.safe_load(
        (repository / "tests" / "data" / "problems.yaml").read_text("utf-8")
    )
    for number, entry in enumerate(entries):
        if "model" not in entry or "line" not in entry or "files" in entry:
            continue
        text = str(entry["model"])
        kind = ".urdf.xacro" if "xmlns:xacro" in text else ".urdf"
        path = folder / f"{number:03}-{entry['code']}{kind}"
        path.write_text(text, "utf-8")
        yield Case(path, int(entry["line"]), "why" not in entry)


def further_cases(index: Path) -> Iterator[Case]:
    """The models of an index beside this repository, read where they are."""
    table = yaml.safe_load(index.read_text("utf-8"))
    for entry in table["models"]:
        path = index.parent / str(entry["file"])
        if path.is_file() and entry.get("line") and entry["severity"] != "none":
            yield Case(path, int(entry["line"]), entry["severity"] == "error")


def judge(
    checker: Checker,
    program: Path,
    cases: Sequence[Case],
    right: Sequence[Path],
    folder: Path,
) -> Verdict:
    """Give a checker all models."""
    good = [_ask(checker, program, path, folder) for path in right]
    usual = {_without_names(answer.words) for answer in good}
    refused = noticed = lines = hangs = 0
    times = [answer.seconds for answer in good]
    for case in cases:
        answer = _ask(checker, program, case.path, folder)
        times.append(answer.seconds)
        if answer.exit is None or answer.exit < 0 or "Traceback" in answer.words:
            hangs += 1
            continue
        said = _without_names(answer.words) not in usual
        refused += case.refused and answer.exit != 0
        noticed += not case.refused and said
        lines += said and _names_line(answer.words, case)
    count = sum(case.refused for case in cases)
    return Verdict(
        (count, len(cases) - count),
        refused,
        noticed,
        lines,
        hangs,
        sum(answer.exit != 0 for answer in good),
        len(right),
        statistics.median(times),
    )


def _ask(checker: Checker, program: Path, model: Path, folder: Path) -> _Answer:
    words: list[object] = [program, *checker.command[1:], model]
    if checker.packages == ():
        words = [program, *checker.command, model] if not checker.debian else words
    if checker.name == "urdf-validator":
        # It writes a report beside the model, unless it is told where.
        words += ["--output-dir", folder]
    began = time.perf_counter()
    try:
        done = subprocess.run(
            [str(word) for word in words],
            capture_output=True,
            timeout=LONGEST,
            text=True,
            errors="replace",
        )
    except subprocess.TimeoutExpired:
        return _Answer(None, "", LONGEST)
    return _Answer(
        done.returncode, done.stdout + done.stderr, time.perf_counter() - began
    )


def _without_names(words: str) -> str:
    """Words without what differs from file to file."""
    return re.sub(r"\S*\.urdf\S*|\S*_validation\S*|'\w+'|\d[\d.]*", "", words)


def _names_line(words: str, case: Case) -> bool:
    """Whether the words have the line as compilers or sentences write it."""
    line = case.line
    written = rf"{re.escape(case.path.name)}:{line}\b|\b[Ll]ine {line}\b"
    return re.search(written, words) is not None


def own_program() -> Path:
    """The interpreter that runs this program's own check."""
    return Path(sys.executable)
