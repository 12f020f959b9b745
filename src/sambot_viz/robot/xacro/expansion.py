"""Expand xacro with the real xacro package, in a child process.

xacro evaluates Python expressions of the model, so it never runs in this process: a
child with limits on time, memory and output does it.
"""

from __future__ import annotations

import importlib.util
import json
import os
import re
from collections.abc import Generator, Mapping, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from sambot_viz import limits as table
from sambot_viz.robot.child_process import Child, ChildTimeoutError
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
    }
    return read_result(_run_child(job, limits), file)


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


class SpareChild:
    """Starts the child of the next expansion ahead, so that its answer comes sooner.

    It costs memory as long as it waits; it ends by itself after some time.
    """

    def __init__(self) -> None:
        self._child: Child | None = None

    @contextmanager
    def used(self) -> Generator[None]:
        """Expand with the child that waits, in this thread until the block ends.

        Then the next one is started.
        """
        token = _SPARE.set(self)
        try:
            yield
        finally:
            _SPARE.reset(token)
            if self._child is None:
                self._child = _new_child()

    def take(self) -> Child | None:
        """Return the child that waits; None when there is none."""
        child, self._child = self._child, None
        if child is None or child.waits:
            return child
        child.end()
        return None

    def end(self) -> None:
        """End the child that waits."""
        if (child := self.take()) is not None:
            child.end()


_SPARE: ContextVar[SpareChild | None] = ContextVar("spare child", default=None)


def _new_child() -> Child:
    return Child(_CHILD, _import_path())


def _run_child(job: Job, limits: Limits) -> ChildAnswer:
    order = json.dumps(job).encode()
    spare = _SPARE.get()
    waiting = None if spare is None else spare.take()
    try:
        output, status = (waiting or _new_child()).ask(order, limits.seconds)
        if waiting is not None and not output:
            # It may have ended by itself when the order came.
            output, status = _new_child().ask(order, limits.seconds)
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
