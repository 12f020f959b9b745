"""Expanding xacro with the real xacro package, in a child process.

xacro evaluates Python that stands in the model (spec/ros-nodes.md §5.5), so it never
runs in this process: a child with limits on time, memory and output does it.
"""

from __future__ import annotations

import contextlib
import importlib.util
import json
import os
import re
import signal
import subprocess
import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from sambot_viz.errors import Place, Problem
from sambot_viz.robot.xacro.diagnose.prefix import missing_prefix
from sambot_viz.robot.xacro.result import (
    Definition,
    ExpansionError,
    ExpansionXmlError,
    XacroCall,
    XacroFailure,
)
from sambot_viz.robot.xml.decode import XmlFault
from sambot_viz.robot.xml.parse import MarkOrigin

_CHILD = Path(__file__).parent / "child" / "main.py"
_SECRET_NAME = re.compile(
    r"TOKEN|SECRET|PASSW|PASSPHRASE|CREDENTIAL|COOKIE|API_?KEY|PRIVATE|AUTH|_KEY\b",
    re.IGNORECASE,
)
_SECRET_VALUE = re.compile(r"://[^/@\s]*:[^/@\s]*@")


@dataclass(frozen=True, slots=True)
class Limits:
    """What an expansion may use: wall clock [s], memory [MiB], output [characters]."""

    seconds: float = 20.0
    megabytes: int = 1024
    characters: int = 64_000_000


@dataclass(frozen=True, slots=True)
class ExpandedModel:
    """What xacro made of a model.

    Attributes:
        text: the URDF as the xacro command prints it.
        origins: for each element of `text` in document order, where it was written.
        files: every file that was read, the model first.
        problems: xacro's warnings.
    """

    text: str
    origins: tuple[MarkOrigin, ...]
    files: tuple[Path, ...]
    problems: tuple[Problem, ...]


def expand_model(
    file: str,
    text: str | None,
    *,
    arguments: Mapping[str, str],
    package_path: Sequence[Path | str],
    trusted: bool,
    limits: Limits = Limits(),
) -> ExpandedModel:
    """Run xacro in a child process.

    Args:
        file: the model as the user wrote it, or a label for `text`.
        text: the model's text when it is no file, else None.
        arguments: values for ``xacro:arg``.
        package_path: folders for package look-ups.
        trusted: False evaluates without Python's doors (`robot/xacro_guard.py`) and
            with an empty environment.
        limits: time, memory and output.

    Raises:
        ExpansionError: xacro or a limit ended it.
        ExpansionXmlError: the model or an included file is no XML.
    """
    folder = str(Path(file).absolute().parent) if text is None else None
    job = {
        "file": file,
        "text": text,
        "folder": folder,
        "arguments": dict(arguments),
        "package_path": [str(entry) for entry in package_path],
        "environment": _environment(trusted),
        "untrusted": not trusted,
        "megabytes": limits.megabytes,
        "seconds": int(limits.seconds) + 1,
        "output_limit": limits.characters,
        "import_path": _import_path(),
    }
    return _outcome(_run_child(job, limits), file)


def _environment(trusted: bool) -> dict[str, str]:
    """The variables that $(env …) may see: none, or all that look harmless."""
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


def _run_child(job: Mapping[str, Any], limits: Limits) -> dict[str, Any]:
    own = {name: os.environ[name] for name in ("SYSTEMROOT",) if name in os.environ}
    order = json.dumps(job).encode()
    # The child takes the end of this pipe for our end, and ends too: whatever kills
    # this process, nothing is left behind. So the pipe stays open until the outcome
    # is there, which `communicate` would not do.
    read_end, lifeline = os.pipe()
    try:
        process = subprocess.Popen(
            [sys.executable, "-I", "-S", "-X", "utf8", str(_CHILD)],
            stdin=read_end,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            env=own,
            start_new_session=True,
        )
    except BaseException:
        os.close(lifeline)
        raise
    finally:
        os.close(read_end)
    try:
        _send(lifeline, b"%16d" % len(order) + order)
        output, _ = process.communicate(timeout=limits.seconds)
    except subprocess.TimeoutExpired:
        text = f"expansion took longer than {limits.seconds:g} s"
        raise _own_failure("Timeout", text, job) from None
    finally:
        os.close(lifeline)
        _end(process)
    try:
        return json.loads(output)
    except ValueError:
        text = f"the expansion ended without a result (status {process.returncode})"
        raise _own_failure("Crash", text, job) from None


def _send(pipe: int, data: bytes) -> None:
    left = memoryview(data)
    # A child that ended early has no outcome, and that is told.
    with contextlib.suppress(BrokenPipeError):
        while left:
            left = left[os.write(pipe, left) :]


def _end(process: subprocess.Popen[bytes]) -> None:
    """End the child and all that it may have started, and collect it."""
    if os.name == "posix":
        try:
            os.killpg(process.pid, signal.SIGKILL)
        except (ProcessLookupError, PermissionError):
            pass
    elif process.poll() is None:
        process.kill()
    process.wait()
    if process.stdout is not None:
        process.stdout.close()


def _own_failure(kind: str, text: str, job: Mapping[str, Any]) -> ExpansionError:
    return ExpansionError(XacroFailure(kind, text, str(job["file"])))


def _outcome(result: Mapping[str, Any], main_file: str) -> ExpandedModel:
    if "failure" in result:
        raise ExpansionError(_failure(result["failure"]))
    if "xml_fault" in result:
        message, line, column, code = result["xml_fault"]
        fault = XmlFault(message, line, column, result["text"], code)
        raise ExpansionXmlError(result["file"], fault)
    names: list[str] = result["names"]
    problems = [_warning(*entry) for entry in result["warnings"]]
    problems += [
        missing_prefix(tag, is_macro, Place(*place))
        for tag, is_macro, *place in result["unprefixed"]
    ]
    return ExpandedModel(
        result["xml"],
        tuple(_origin(packed, names) for packed in result["places"]),
        tuple(Path(file) for file in result["files"]),
        tuple(dict.fromkeys(problems)),
    )


def _origin(packed: Sequence[int], names: Sequence[str]) -> MarkOrigin:
    place = Place(names[packed[0]], packed[1], packed[2])
    if len(packed) > 3:
        return MarkOrigin(place, names[packed[3]], packed[4])
    return MarkOrigin(place)


def _failure(data: Mapping[str, Any]) -> XacroFailure:
    missing = data["missing_package"]
    expressions = tuple(data["expressions"])
    return XacroFailure(
        kind=data["kind"],
        text=data["text"],
        file=data["file"],
        line=data["line"],
        column=data["column"],
        expression=expressions[0] if expressions else None,
        expressions=expressions,
        element=data["element"],
        macros=tuple((name, file) for name, file in data["macros"]),
        calls=tuple(XacroCall(*call) for call in data["calls"]),
        includes=tuple(data["includes"]),
        missing_package=(missing[0], tuple(missing[1])) if missing else None,
        known_packages=tuple(data["known_packages"]),
        lazy=tuple(data["lazy"]),
        definitions=tuple(Definition(*entry) for entry in data["definitions"]),
    )


def _warning(
    text: str, file: str, line: int | None = None, column: int | None = None
) -> Problem:
    hint = "xacro goes on, but ros2 launch takes any warning of xacro for a failure"
    return Problem("warning", "xacro-warning", text, hint, file, line, column)
