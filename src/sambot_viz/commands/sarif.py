"""Problems as SARIF 2.1.0, which GitHub, GitLab and editors show at their lines."""

from __future__ import annotations

import os
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any
from urllib.parse import quote

from sambot_viz._version import __version__
from sambot_viz.edits import SourceFile, source_of
from sambot_viz.errors import Edit, Problem, Severity
from sambot_viz.explanations import as_text, codes
from sambot_viz.problems import in_order

_SCHEMA = "https://json.schemastore.org/sarif-2.1.0.json"
_LEVELS: dict[Severity, str] = {"error": "error", "warning": "warning", "info": "note"}
_ROOT = "%SRCROOT%"
"""Stands for the folder in which the command runs; readers replace it by theirs."""


def sarif_log(problems: Iterable[Problem], model: Path) -> dict[str, Any]:
    """Return a log with one run.

    Args:
        problems: the results.
        model: the place of problems that are in no file.
    """
    results = in_order(problems)
    found = sorted({problem.code for problem in results})
    driver = {
        "name": "sambot-viz",
        "version": __version__,
        "rules": [_rule(code) for code in found],
    }
    run = {
        "tool": {"driver": driver},
        "columnKind": "unicodeCodePoints",
        "results": [_result(each, found.index(each.code), model) for each in results],
    }
    return {"$schema": _SCHEMA, "version": "2.1.0", "runs": [run]}


def _rule(code: str) -> dict[str, Any]:
    said = code.replace("-", " ").capitalize()
    return {
        "id": code,
        "shortDescription": {"text": said},
        "help": {"text": as_text(code) if code in codes() else said},
    }


def _result(problem: Problem, rule: int, model: Path) -> dict[str, Any]:
    hint = f"; {problem.hint}" if problem.hint else ""
    place: dict[str, Any] = {"artifactLocation": _location(problem.file or str(model))}
    if problem.line is not None:
        place["region"] = {"startLine": problem.line}
        if problem.column is not None:
            place["region"]["startColumn"] = problem.column
    result: dict[str, Any] = {
        "ruleId": problem.code,
        "ruleIndex": rule,
        "level": _LEVELS[problem.severity],
        "message": {"text": f"{problem.message}{hint}"},
        "locations": [{"physicalLocation": place}],
    }
    made = _artifact_changes(problem.edits)
    if made:
        description = {"text": problem.hint or "fix it"}
        result["fixes"] = [{"description": description, "artifactChanges": made}]
    return result


def _location(file: str) -> dict[str, str]:
    """Return the address of a file: relative, where it is below the working folder."""
    path = Path(os.path.abspath(file))
    for each in (path, Path(os.path.realpath(path))):
        if each.is_relative_to(Path.cwd()):
            below = each.relative_to(Path.cwd()).as_posix()
            return {"uri": quote(below), "uriBaseId": _ROOT}
    return {"uri": path.as_uri()}


def _artifact_changes(edits: Sequence[Edit]) -> list[dict[str, Any]]:
    made: list[dict[str, Any]] = []
    for file in dict.fromkeys(edit.file for edit in edits):
        if (source := source_of(file)) is None:
            return []
        own = [_replacement(edit, source) for edit in edits if edit.file == file]
        made.append({"artifactLocation": _location(file), "replacements": own})
    return made


def _replacement(edit: Edit, source: SourceFile) -> dict[str, Any]:
    start, end = source.place(edit.start), source.place(edit.end)
    region = {
        "startLine": start[0],
        "startColumn": start[1],
        "endLine": end[0],
        "endColumn": end[1],
        "charOffset": edit.start,
        "charLength": edit.end - edit.start,
    }
    return {"deletedRegion": region, "insertedContent": {"text": edit.text}}
