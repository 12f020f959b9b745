"""Expand xacro with the real xacro package, in a child process.

xacro evaluates Python expressions of the model, so it never runs in this process: a
child with limits on time, memory and output does it.
"""

from __future__ import annotations

import atexit
import importlib.util
import json
import os
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING

from sambot_viz import limits as table
from sambot_viz.robot.child_process import Child, ChildTimeoutError
from sambot_viz.robot.fork_server import CAN_FORK, ForkServer
from sambot_viz.robot.xacro.child_result import (
    ExpandedModel,
    ExpansionError,
    XacroFailure,
    read_result,
)

if TYPE_CHECKING:
    from sambot_viz.robot.xacro.child.exchange import ChildAnswer, Job

_CHILD = Path(__file__).parent / "child" / "main.py"
_SECRET_NAME = re.compile(
    r"TOKEN|PRESENTER|SECRET|PASSW|PASSPHRASE|CREDENTIAL|COOKIE|API_?KEY|PRIVATE|AUTH|_KEY\b",
    re.IGNORECASE,
)
_SECRET_VALUE = re.compile(r"://[^/@\s]*:[^/@\s]*@")


@dataclass(frozen=True, slots=True)
class Limits:
    """Bounds of an expansion: wall clock [s], memory [MiB], output [characters]."""

    seconds: float = table.XACRO_TIME.value
    megabytes: int = table.XACRO_MEMORY.value
    characters: int = table.XACRO_OUTPUT.value


def expand_model(
    file: str,
    text: str,
    *,
    folder: Path | None = None,
    arguments: Mapping[str, str],
    package_path: Sequence[Path | str],
    trusted: bool,
    edited: Mapping[str, str] | None = None,
    limits: Limits = Limits(),
) -> ExpandedModel:
    """Run xacro in a child process.

    Args:
        file: the model as the user wrote it, or a label for `text`.
        text: the content of the model.
        folder: the folder of the model, or None when it is only text.
        arguments: values for ``xacro:arg``.
        package_path: folders for package look-ups.
        trusted: False evaluates in the sandbox (`child/sandbox.py`) and with an empty
            environment.
        edited: as for `load_robot`, of the files that it includes.
        limits: time, memory and output.

    Raises:
        ExpansionError: xacro failed, or a limit ended it.
        ExpansionXmlError: the model or an included file is not XML.
    """
    job: Job = {
        "file": file,
        "text": text,
        "folder": None if folder is None else str(folder),
        "arguments": dict(arguments),
        "package_path": [str(entry) for entry in package_path],
        "environment": _environment(trusted),
        "untrusted": not trusted,
        "megabytes": limits.megabytes,
        "seconds": int(limits.seconds) + 1,
        "output_limit": limits.characters,
        "edited": dict(edited or {}),
        "working_folder": _working_folder(),
    }
    return read_result(_run_child(job, limits), file)


def _working_folder() -> str:
    """The folder that names are relative to; empty when that was removed."""
    try:
        return os.getcwd()
    except OSError:
        return ""


def _environment(trusted: bool) -> dict[str, str]:
    """The variables that $(env …) may see: none, or all but secrets."""
    shown = {"ROS_VERSION": "2", "ROS_DISTRO": "jazzy"}
    if trusted:
        for name, value in os.environ.items():
            if not (_SECRET_NAME.search(name) or _SECRET_VALUE.search(value)):
                shown[name] = value
    return shown


def _import_path() -> list[str]:
    folders: list[str] = []
    for name in ("xacro", "yaml"):
        spec = importlib.util.find_spec(name)
        if spec is not None and spec.origin is not None:
            folders.append(str(Path(spec.origin).parents[1]))
    return list(dict.fromkeys(folders))


@cache
def _forks() -> ForkServer:
    """Return what expands for this process, and ends with it."""
    server = ForkServer(_CHILD, ["forks", *_import_path()])
    atexit.register(server.end)
    return server


def _run_child(job: Job, limits: Limits) -> ChildAnswer:
    order = json.dumps(job).encode()
    child = _forks() if CAN_FORK else Child(_CHILD, ["once", *_import_path()])
    try:
        output, status = child.ask(order, limits.seconds)
    except ChildTimeoutError:
        text = f"expansion took longer than {limits.seconds:g} s"
        raise _own_failure("Timeout", text, job) from None
    try:
        return json.loads(output)
    except ValueError:
        text = f"the expansion ended without a result (status {status})"
        raise _own_failure("Crash", text, job) from None


def _own_failure(kind: str, text: str, job: Job) -> ExpansionError:
    return ExpansionError(XacroFailure(kind, text, job["file"]))
