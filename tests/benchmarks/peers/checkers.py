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

import yaml
from problem_samples import all_samples
from tests.benchmarks.peers.peers import Checker

LONGEST = 20.0
"""A check that takes longer hangs [s]."""
_MODELS = {".urdf", ".xacro", ".sdf"}
"""Launch files and configs are not for all of them."""


@dataclass(frozen=True, slots=True)
class Case:
    """A wrong model.

    Attributes:
        path: of the model.
        line: where the mistake is.
        refused: whether ROS refuses it, or shows it, though not as was meant; None
            where that is not known.
    """

    path: Path
    line: int
    refused: bool | None


@dataclass(frozen=True, slots=True)
class Verdict:
    """How a checker did.

    Attributes:
        cases: how many wrong models it was given.
        noticed: so many it said something else about than about the right model.
        lines: so many whose line its words name.
        refused: of those that ROS refuses, so many it ended with an error on, and how
            many these are.
        accepted: the same of those that ROS shows, without an error.
        hangs: so many took longer than `LONGEST`, or it crashed on.
        complaints: right models that it ended with an error on.
        right: how many right models it was given.
        seconds: the median time of one check [s].
    """

    cases: int
    noticed: int
    lines: int
    refused: tuple[int, int]
    accepted: tuple[int, int]
    hangs: int
    complaints: int
    right: int
    seconds: float


@dataclass(frozen=True, slots=True)
class _Answer:
    exit: int | None
    words: str
    seconds: float


def own_cases(folder: Path) -> Iterator[Case]:
    """Write the wrong models of the tests that are one file, each into its folder."""
    for sample in all_samples():
        is_one_file = list(sample.files) == [sample.name]
        if sample.line is not None and sample.trusted and is_one_file:
            path = sample.write(folder / sample.code)
            # What this program refuses, ROS may show.
            yield Case(path, sample.line, False if sample.why else None)


def further_cases(index: Path) -> Iterator[Case]:
    """The models of an index beside this repository, read where they are."""
    table = yaml.safe_load(index.read_text("utf-8"))
    for entry in table["models"]:
        path = index.parent / str(entry["file"])
        is_wrong = entry.get("line") and entry["severity"] != "none"
        if is_wrong and path.suffix in _MODELS and path.is_file():
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
    noticed = lines = hangs = 0
    # Whether ROS refuses a model, and how this checker ended; None when it hung.
    ends: list[tuple[bool | None, int | None]] = []
    times = [answer.seconds for answer in good]
    for case in cases:
        answer = _ask(checker, program, case.path, folder)
        times.append(answer.seconds)
        if answer.exit is None or answer.exit < 0 or "Traceback" in answer.words:
            hangs += 1
            ends.append((case.refused, None))
            continue
        ends.append((case.refused, answer.exit))
        said = _without_names(answer.words) not in usual
        noticed += said
        lines += said and _names_line(answer.words, case)
    refused = [end for is_refused, end in ends if is_refused]
    shown = [end for is_refused, end in ends if is_refused is False]
    return Verdict(
        len(cases),
        noticed,
        lines,
        (sum(end not in (0, None) for end in refused), len(refused)),
        (shown.count(0), len(shown)),
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
