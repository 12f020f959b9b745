"""What xacro makes of a model, kept for tests that are not about xacro.

A process that expands a small model takes 0.1 s of a core, most of the time of a check.
The same model in another folder of another test has the same answer but for the folder.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, cast

from sambot_viz.robot.xacro import expansion
from sambot_viz.robot.xacro.child.exchange import ChildAnswer, Job
from sambot_viz.robot.xacro.expansion import Limits

RunChild = Callable[[Job, Limits], ChildAnswer]
_FOLDER = "/the/folder/of/a/test"
_MODELS = (".xacro", ".urdf", ".sdf", ".xml")


class XacroMemory:
    """Runs xacro once for each model, whichever test has it in its folder.

    Args:
        run: starts the process.
    """

    def __init__(self, run: RunChild | None = None) -> None:
        self._run = run or expansion._run_child  # pyright: ignore[reportPrivateUsage]
        self._kept: dict[str, tuple[str, Mapping[str, bytes | None]]] = {}

    def run_child(self, job: Job, limits: Limits, folder: Path) -> ChildAnswer:
        """Return what a process answers to a job, whose files are below a folder."""
        environment = {
            name: value
            for name, value in job["environment"].items()
            if not name.startswith("PYTEST")
        }
        asked: Any = [{**job, "environment": environment}, _models_below(folder)]
        key = json.dumps(asked).replace(str(folder), _FOLDER)
        if key in self._kept:
            answer, files = self._kept[key]
            if all(_content(name, folder) == files[name] for name in files):
                return json.loads(answer.replace(_FOLDER, str(folder)))
        found = self._run(job, limits)
        answer = json.dumps(found).replace(str(folder), _FOLDER)
        outcome: Any = next(filter(None, cast(Mapping[str, Any], found).values()))
        names = [name.replace(str(folder), _FOLDER) for name in outcome["files"]]
        self._kept[key] = (answer, {name: _content(name, folder) for name in names})
        return found


def _models_below(folder: Path) -> list[tuple[str, str]]:
    """Return what is in the files that xacro finds or may look at."""
    return [
        (str(path), path.read_bytes().hex())
        for path in sorted(folder.rglob("*"))
        if path.suffix in _MODELS and path.is_file()
    ]


def _content(name: str, folder: Path) -> bytes | None:
    path = Path(name.replace(_FOLDER, str(folder)))
    return path.read_bytes() if path.is_file() else None
