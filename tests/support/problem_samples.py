"""Every code of the program, with the smallest model that gives it.

They are listed in tests/data/problems.yaml. The page docs/problems.md is made by
checking these models, so that it shows what the program really says; for what a small
model cannot show (a full disk, an RViz config) the list has the words.
"""

from __future__ import annotations

import tempfile
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cache
from pathlib import Path
from typing import Any

from quick_yaml import quick_yaml

from sambot_viz.checks import check
from sambot_viz.errors import Problem

LIST = Path(__file__).parents[1] / "data" / "problems.yaml"
"""The list of the samples."""


@dataclass(frozen=True)
class Sample:
    """A code, and a model that gives it.

    Attributes:
        code: the code it must give.
        title: what is wrong, a few words.
        why: what will happen; only for what ROS accepts.
        name: file name of the model.
        files: file name → content; empty when a model cannot show it.
        trusted: False when the model is checked as one of unknown origin.
        stated: what is said of it, for codes without a model.
        line: where the mistake is.
        says: words that name the cause.
        around: it is about the model and the files around it.
    """

    code: str
    title: str
    why: str = ""
    name: str = "robot.urdf"
    files: Mapping[str, str | bytes] = field(default_factory=dict[str, "str | bytes"])
    trusted: bool = True
    stated: Problem | None = None
    line: int | None = None
    says: str = ""
    around: bool = False

    @property
    def problem(self) -> Problem:
        """The problem with this code."""
        return next(p for p in self.problems() if p.code == self.code)

    def problems(self) -> tuple[Problem, ...]:
        """What `check` says about it; files are named without their folder."""
        return _problems(self.code)

    def write(self, folder: Path) -> Path:
        """Write its files into a new folder; returns the path of the model."""
        folder.mkdir()
        for name, content in self.files.items():
            target = folder / name
            target.parent.mkdir(parents=True, exist_ok=True)
            data = content.encode() if isinstance(content, str) else content
            target.write_bytes(data)
        return folder / self.name

    def find_problems(self) -> list[Problem]:
        """The same, checked again."""
        if self.stated is not None:
            return [self.stated]
        with tempfile.TemporaryDirectory() as folder:
            root = Path(folder).resolve() / "model"
            found = check(self.write(root), trusted=self.trusted)
        return [_without_folder(problem, str(root)) for problem in found]


def _without_folder(problem: Problem, folder: str) -> Problem:
    """The same words wherever the sample was written."""

    def short(text: str) -> str:
        return text.replace(f"{folder}/", "").replace(folder, "the model's folder")

    file = short(problem.file) if problem.file else None
    message, hint = short(problem.message), short(problem.hint)
    edits = tuple(replace(edit, file=short(edit.file)) for edit in problem.edits)
    return replace(problem, message=message, hint=hint, file=file, edits=edits)


@cache
def all_samples() -> tuple[Sample, ...]:
    """One for every code, in the order of the list."""
    entries: list[dict[str, Any]] = quick_yaml(LIST)
    return tuple(_sample(entry) for entry in entries)


@cache
def _problems(code: str) -> tuple[Problem, ...]:
    sample = next(sample for sample in all_samples() if sample.code == code)
    return tuple(sample.find_problems())


def _sample(entry: dict[str, Any]) -> Sample:
    code, title = str(entry["code"]), str(entry["title"])
    if "hint" in entry:
        stated = Problem(entry["severity"], code, title, str(entry["hint"]))
        return Sample(code, title, stated=stated)
    name = str(entry.get("name", "robot.urdf"))
    files: dict[str, str | bytes] = dict(entry.get("files", {}))
    if "model" in entry:
        files[name] = str(entry["model"]).encode(entry.get("encoding", "utf-8"))
    return Sample(
        code,
        title,
        str(entry.get("why", "")),
        name,
        files,
        bool(entry.get("trusted", True)),
        line=entry.get("line"),
        says=str(entry.get("says", "")),
        around=bool(entry.get("around", False)),
    )
