"""The program as a user starts it, for tests.

`running` starts a process, which takes 0.7 s of a core: for signals, the exit code and
what is imported. `serving` runs the same command in a thread of the test's process.
"""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import threading
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, redirect_stderr, redirect_stdout
from pathlib import Path
from unittest import mock

from patience import patience

from sambot_viz.cli import main
from sambot_viz.commands import show


@contextmanager
def running(*words: str, cwd: Path | None = None) -> Iterator[subprocess.Popen[str]]:
    """Start `sambot-viz` with these words, and end it by its own handle."""
    # A job in the background of a script ignores Ctrl-C, and would pass that on.
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        process = subprocess.Popen(
            [sys.executable, "-m", "sambot_viz", *words],
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            cwd=cwd,
            env={**os.environ, "PYTHONIOENCODING": "utf-8"},
        )
    finally:
        signal.signal(signal.SIGINT, before)
    try:
        yield process
    finally:
        if process.poll() is None:
            process.kill()
        process.communicate()


class Serving:
    """`sambot-viz` in a thread, which serves until it is ended.

    Args:
        words: the command line.

    Attributes:
        stdout: what it writes there.
        stderr: what it writes there.
    """

    def __init__(self, words: Sequence[str]) -> None:
        self._stop = threading.Event()
        self._words = words
        self._code: int | None = None
        streams = [os.pipe() for _ in range(2)]
        self.stdout, self.stderr = (open(end, encoding="utf-8") for end, _ in streams)
        self._written = [
            open(end, "w", encoding="utf-8", buffering=1) for _, end in streams
        ]
        self._thread = threading.Thread(target=self._run, name="sambot-viz-command")

    def __enter__(self) -> Serving:
        self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._end()
        self.stdout.close()
        self.stderr.close()

    def end(self) -> tuple[int | None, str, str]:
        """End it as Ctrl-C does, unless it has ended by itself.

        Returns:
            The exit code, and what was not read yet of both streams.
        """
        self._end()
        return self._code, self.stdout.read(), self.stderr.read()

    def _end(self) -> None:
        self._stop.set()
        self._thread.join(patience(30.0))
        assert not self._thread.is_alive()

    def _run(self) -> None:
        out, err = self._written
        try:
            with redirect_stdout(out), redirect_stderr(err):
                self._code = main(self._words)
        finally:
            out.close()
            err.close()

    @contextmanager
    def _until_told(
        self, give_up: Callable[[], object] = lambda: None
    ) -> Iterator[threading.Event]:
        """Take the place of what ends the program at a signal."""
        # Only the first thread of a process may say what a signal does.
        del give_up
        stop = threading.Event()
        self._stop, before = stop, self._stop
        if before.is_set():
            stop.set()
        yield stop


@contextmanager
def serving(*words: str, cwd: Path) -> Iterator[Serving]:
    """Run `sambot-viz` with these words in a folder, and end it after that."""
    here = Path.cwd()
    os.chdir(cwd)
    made = Serving(words)
    try:
        with mock.patch.object(show, "until_signal", made._until_told), made:
            yield made
    finally:
        os.chdir(here)


def rest_of(process: subprocess.Popen[str]) -> tuple[str, str]:
    """Wait until a process has ended; what was not read yet of its two streams.

    A signal may come while the process imports, which a busy machine does for long.
    """
    return process.communicate(timeout=patience(60.0))


def address(process: subprocess.Popen[str] | Serving) -> str:
    """The address that the program prints when its page can be opened.

    With a presenter, each comes behind the word for whom it is.
    """
    assert process.stdout is not None
    return process.stdout.readline().rpartition(" ")[2].strip()
