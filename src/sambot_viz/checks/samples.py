"""The smallest wrong model for each code that is not a rule's.

Every code of the program stands either with its rule (`registry.py`) or in
`samples.yaml`. The page of rules is made by checking these models, so that it shows
what is really said.
"""

from __future__ import annotations

import tempfile
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
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
    """A model that gives one code.

    Attributes:
        code: the code it must give.
        title: what is wrong, a few words.
        name: file name of the model.
        files: file name → content, the model among them.
        arguments: values for xacro's arguments.
    """

    code: str
    title: str
    name: str
    files: Mapping[str, str | bytes]
    arguments: Mapping[str, str] = field(default_factory=dict[str, str])

    def problems(self) -> list[Problem]:
        """What `check` says about it; files are named without their folder."""
        with tempfile.TemporaryDirectory() as folder:
            root = Path(folder).resolve()
            for name, content in self.files.items():
                target = root / name
                target.parent.mkdir(parents=True, exist_ok=True)
                if isinstance(content, bytes):
                    target.write_bytes(content)
                else:
                    target.write_text(content, encoding="utf-8", newline="")
            found = check(root / self.name, xacro_args=self.arguments)
        return [_without_folder(problem, str(root)) for problem in found]


def _without_folder(problem: Problem, folder: str) -> Problem:
    def short(text: str) -> str:
        return text.replace(folder + "/", "").replace(folder, "the model's folder")

    return Problem(
        problem.severity,
        problem.code,
        short(problem.message),
        short(problem.hint),
        short(problem.file) if problem.file else None,
        problem.line,
        problem.column,
    )


@cache
def all_samples() -> tuple[Sample, ...]:
    """A sample for every code, those of the rules last."""
    return (*_written(), *_of_rules())


def _written() -> Iterator[Sample]:
    text = (
        resources.files("sambot_viz.checks").joinpath("samples.yaml").read_text("utf-8")
    )
    entries: list[dict[str, Any]] = yaml.safe_load(text)
    for entry in entries:
        name = str(entry.get("name", "robot.urdf"))
        model: str | bytes = entry["model"]
        if "encoding" in entry and isinstance(model, str):
            model = model.encode(str(entry["encoding"]))
        files: dict[str, str | bytes] = {name: model, **entry.get("files", {})}
        yield Sample(
            str(entry["code"]),
            str(entry["title"]),
            name,
            files,
            entry.get("arguments", {}),
        )


def _of_rules() -> Iterator[Sample]:
    for rule in RULES:
        files = {rule.example_name: rule.example, **dict(rule.example_files)}
        yield Sample(rule.code, rule.title, rule.example_name, files)
