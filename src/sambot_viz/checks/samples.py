"""Every code of the program, with the smallest model that gives it.

A code stands either with its rule (`registry.py`) or in `samples.yaml`. The page of
rules is made by checking these models, so that it shows what is really said; for what
no small model can show (a full disk, an RViz config) the words stand in the list.
"""

from __future__ import annotations

import tempfile
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from functools import cache
from importlib import resources
from pathlib import Path
from typing import Any

import yaml

from sambot_viz.checks import check
from sambot_viz.checks.registry import RULES
from sambot_viz.errors import Problem


@dataclass(frozen=True)
class Sample:
    """A code, and a model that gives it.

    Attributes:
        code: the code it must give.
        title: what is wrong, a few words.
        name: file name of the model.
        files: file name → content; empty when no model can show it.
        trusted: False when the model is checked as one of unknown origin.
        said: what is said of it, for codes without a model.
        why: for a rule: what will happen.
    """

    code: str
    title: str
    name: str = "robot.urdf"
    files: Mapping[str, str | bytes] = field(default_factory=dict[str, "str | bytes"])
    trusted: bool = True
    said: Problem | None = None
    why: str = ""

    def problems(self) -> list[Problem]:
        """What `check` says about it; files are named without their folder."""
        if self.said is not None:
            return [self.said]
        with tempfile.TemporaryDirectory() as folder:
            root = Path(folder).resolve() / "model"
            root.mkdir()
            for name, content in self.files.items():
                target = root / name
                target.parent.mkdir(parents=True, exist_ok=True)
                data = content.encode() if isinstance(content, str) else content
                target.write_bytes(data)
            found = check(root / self.name, trusted=self.trusted)
        return [_without_folder(problem, str(root)) for problem in found]


def _without_folder(problem: Problem, folder: str) -> Problem:
    """The same words wherever the sample was written."""

    def short(text: str) -> str:
        return text.replace(f"{folder}/", "").replace(folder, "the model's folder")

    file = short(problem.file) if problem.file else None
    message, hint = short(problem.message), short(problem.hint)
    return replace(problem, message=message, hint=hint, file=file)


@cache
def all_samples() -> tuple[Sample, ...]:
    """One for every code: the rules first, then in the order of a model's way."""
    return (*_of_rules(), *_written())


@cache
def problems_of(code: str) -> tuple[Problem, ...]:
    """What is said about the sample of a code; it is checked once."""
    sample = next(sample for sample in all_samples() if sample.code == code)
    return tuple(sample.problems())


def _of_rules() -> Iterator[Sample]:
    for rule in RULES:
        files = {rule.example_name: rule.example, **dict(rule.example_files)}
        yield Sample(rule.code, rule.title, rule.example_name, files, why=rule.why)


def _written() -> Iterator[Sample]:
    written = resources.files("sambot_viz.checks") / "samples.yaml"
    entries: list[dict[str, Any]] = yaml.safe_load(written.read_text("utf-8"))
    for entry in entries:
        yield _sample(entry)


def _sample(entry: dict[str, Any]) -> Sample:
    code, title = str(entry["code"]), str(entry["title"])
    if "mend" in entry:
        said = Problem(entry["severity"], code, title, str(entry["mend"]))
        return Sample(code, title, said=said)
    name = str(entry.get("name", "robot.urdf"))
    files: dict[str, str | bytes] = dict(entry.get("files", {}))
    if "model" in entry:
        files[name] = str(entry["model"]).encode(entry.get("encoding", "utf-8"))
    return Sample(code, title, name, files, bool(entry.get("trusted", True)))
