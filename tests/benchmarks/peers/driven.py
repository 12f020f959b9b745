"""A driver as a process of its own, and what it takes of the machine."""

from __future__ import annotations

import json
import os
import select
import subprocess
import tempfile
import time
from collections.abc import Generator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from tests.benchmarks.peers.environments import Environment
from tests.benchmarks.peers.peers import DRIVERS, Viewer
from tests.benchmarks.peers.robots import Model
from usage import Usage, family, family_usage

LONGEST = 120.0
"""How long a driver may take for an answer [s]."""


class NotMeasured(Exception):
    """A peer does not do what is measured; says why."""


class Driven:
    """A running driver.

    Attributes:
        url: of its page.
        said: all that it has said at the beginning.
        started: when its process was started (`time.perf_counter`) [s].
    """

    def __init__(self, process: subprocess.Popen[bytes], log: Path) -> None:
        self.started = time.perf_counter()
        self._process = process
        self._log = log
        self.said = self._answer()
        self.url = str(self.said["url"])

    def ask(self, **order: Any) -> dict[str, Any]:
        """Give an order, and return the answer.

        Raises:
            NotMeasured: it has ended, does not answer, or cannot do this.
        """
        self.tell(**order)
        return self._answer()

    def tell(self, **order: Any) -> None:
        """Give an order whose answer `heard` takes later."""
        assert self._process.stdin is not None
        try:
            self._process.stdin.write(json.dumps(order).encode() + b"\n")
        except OSError as error:
            raise NotMeasured(self._last_words()) from error

    def heard(self) -> dict[str, Any]:
        """The answer to what was told."""
        return self._answer()

    def load(self) -> Usage:
        """What it has taken until now, with its children."""
        return family_usage(self._process.pid)

    def _answer(self) -> dict[str, Any]:
        assert self._process.stdout is not None
        line, ready = b"\n", True
        # What a viewer itself prints is no answer.
        while line and not line.startswith(b"{"):
            ready = bool(select.select([self._process.stdout], [], [], LONGEST)[0])
            line = self._process.stdout.readline() if ready else b""
        if not line:
            raise NotMeasured(self._last_words() if ready else "does not answer")
        answer: dict[str, Any] = json.loads(line)
        if "error" in answer:
            raise NotMeasured(str(answer["error"]))
        return answer

    def _last_words(self) -> str:
        lines = self._log.read_text("utf-8", "replace").strip().splitlines()
        return lines[-1][:160] if lines else "ended without a word"


@contextmanager
def drive(viewer: Viewer, environment: Environment, model: Model) -> Generator[Driven]:
    """Show a model with a viewer until the block ends.

    Raises:
        NotMeasured: it does not show it.
    """
    # After the first start modules are compiled, as pip leaves them for users.
    without = ("PYTHONPATH", "PYTHONDONTWRITEBYTECODE")
    outside = {k: v for k, v in os.environ.items() if k not in without}
    if viewer.is_ours:
        outside["PYTHONPATH"] = os.environ.get("PYTHONPATH", "")
    if environment.modules is not None:
        outside["NODE_MODULES"] = str(environment.modules)
    shown = [model.path] if model.config is None else [model.path, model.config]
    with tempfile.TemporaryDirectory() as folder:
        log = Path(folder) / "stderr"
        with log.open("w") as errors:
            process = subprocess.Popen(
                [environment.python, DRIVERS / f"{viewer.driver}.py", *shown],
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=errors,
                # With a buffer, a line that has come already would be waited for.
                bufsize=0,
                env=outside,
            )
        try:
            yield Driven(process, log)
        finally:
            end(process)


def end(process: subprocess.Popen[bytes]) -> None:
    """Close what it reads, which ends it; insist on it, and on its children."""
    children = [*family(process.pid)][1:]
    for stream in (process.stdin, process.stdout):
        if stream is not None:
            stream.close()
    try:
        process.wait(5.0)
    except subprocess.TimeoutExpired:
        process.kill()
        process.wait(5.0)
    for child in children:
        # One that outlives its parent belongs to nobody else.
        if (Path("/proc") / str(child)).is_dir():
            os.kill(child, 15)
