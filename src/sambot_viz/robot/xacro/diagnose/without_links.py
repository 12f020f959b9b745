"""Explain a robot without links: what the file is, and which file includes it.

Files of macros are meant for xacro:include; elements without their prefix are copied to
the output, where they mean nothing.
"""

from __future__ import annotations

import dataclasses
import os
import re
from collections.abc import Iterable, Iterator
from itertools import islice
from pathlib import Path

from sambot_viz import limits
from sambot_viz.errors import Problem
from sambot_viz.robot.packages.package_index import PackageIndex
from sambot_viz.robot.xml.element import Element
from sambot_viz.unsaved import unsaved_text

_ENDINGS = (".xacro", ".urdf", ".sdf")


def explain_without_links(
    problems: Iterable[Problem], document: Element, path: Path | None
) -> list[Problem]:
    """Explain a robot without links: what the file is, and which file includes it.

    Args:
        problems: what was found; only "robot-without-links" changes.
        document: the root element as written, before xacro.
        path: the file, or None for a text.
    """
    found = list(problems)
    cause = next((p for p in found if p.code == "xacro-prefix-missing"), None)
    clear: list[Problem] = []
    for problem in found:
        if problem.code != "robot-without-links":
            clear.append(problem)
        elif cause is not None:
            message = f"{cause.message}, so the robot has no links"
            error = dataclasses.replace(cause, severity="error", message=message)
            clear.append(error)
        else:
            clear.append(_clearer(problem, document, path))
    return [problem for problem in clear if problem is not cause]


def _clearer(problem: Problem, document: Element, path: Path | None) -> Problem:
    macros = [
        element.get("name") or "?"
        for element in document.iter()
        if element.tag == "xacro:macro"
    ]
    message = "the robot has no links"
    if macros:
        shown = ", ".join(macros[:5]) + (", …" if len(macros) > 5 else "")
        message += f": this file only defines the macro {shown} for other files"
    elif any(element.tag.startswith("xacro:") for element in document.iter()):
        message += ": this is a file for xacro:include"
    users = list(islice(_includers(path), 3)) if path is not None else []
    if users:
        hint = f"open a file that includes it: {', '.join(users)}"
    elif macros:
        hint = f"open the file that includes it, or call it: <xacro:{macros[0]} …/>"
    else:
        hint = problem.hint
    return dataclasses.replace(problem, message=message, hint=hint)


def _includers(path: Path) -> Iterator[str]:
    """Files of the same package that include this one."""
    pattern = re.compile(
        r"<xacro:include\b[^>]*[/\"']" + re.escape(path.name) + r"[\"']"
    )
    root = PackageIndex(path.absolute().parent).own_roots()[-1]
    files = (file for file in _files(root) if file.suffix in _ENDINGS)
    for file in islice(files, limits.XACRO_NEIGHBOURS.value):
        if file.name != path.name and pattern.search(_text(file)):
            yield str(file.relative_to(root))


def _files(root: Path) -> Iterator[Path]:
    """Yield the files of a folder, in the same order on every file system."""
    for folder, inner, names in os.walk(root):
        inner.sort()
        yield from (Path(folder, name) for name in sorted(names))


def _text(file: Path) -> str:
    if (text := unsaved_text(file)) is not None:
        return text
    try:
        if file.stat().st_size > limits.XML_EXPLAINED.value:
            return ""
        return file.read_text("utf-8", "replace")
    except OSError:
        return ""
