"""Runs work in a child process of Python, with a time limit and this one's lifetime."""

from __future__ import annotations

import contextlib
import os
import signal
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path


class ChildTimeoutError(Exception):
    """The child did not answer in time and was ended."""


class Child:
    """A script that has started and waits for its order.

    It runs in a separate process session, and reads the order from standard input,
    which stays open until the answer is there.

    Args:
        script: the script.
        arguments: its command line.
        environment: its environment variables, beside those that Windows needs.
    """

    def __init__(
        self, script: Path, arguments: Sequence[str] = (), **environment: str
    ) -> None:
        needed = {n: os.environ[n] for n in ("SYSTEMROOT",) if n in os.environ}
        # The child reads EOF from this pipe when this process dies, and then exits too.
        # Therefore the pipe stays open until the answer is there; `communicate` would
        # close it earlier.
        read_end, self._lifeline = os.pipe()
        try:
            self._process = subprocess.Popen(
                python(script, *arguments),
                stdin=read_end,
                stdout=subprocess.PIPE,
                stderr=subprocess.DEVNULL,
                env={**needed, **environment},
                start_new_session=True,
            )
        except BaseException:
            os.close(self._lifeline)
            raise
        finally:
            os.close(read_end)

    def ask(self, order: bytes, seconds: float) -> tuple[bytes, int | None]:
        """Send the only order, and return the child's standard output.

        Args:
            order: the order.
            seconds: time limit [s], after which the child and its processes end.

        Returns:
            The output, and the exit status.

        Raises:
            ChildTimeoutError: the child took longer.
        """
        try:
            _send(self._lifeline, framed(order))
            output, _ = self._process.communicate(timeout=seconds)
        except subprocess.TimeoutExpired:
            raise ChildTimeoutError(f"it took longer than {seconds:g} s") from None
        finally:
            os.close(self._lifeline)
            _end(self._process)
        return output, self._process.returncode


def python(script: Path, *arguments: str) -> list[str]:
    """Return the command that runs a script without site-packages."""
    return [sys.executable, "-I", "-S", "-X", "utf8", str(script), *arguments]


def framed(order: bytes) -> bytes:
    """Prefix an order with its length, as 16 characters."""
    return b"%16d" % len(order) + order


def _send(pipe: int, data: bytes) -> None:
    left = memoryview(data)
    # A child that ended early gives no answer; the caller reports a crash.
    with contextlib.suppress(BrokenPipeError):
        while left:
            left = left[os.write(pipe, left) :]


def _end(process: subprocess.Popen[bytes]) -> None:
    """End the child and all its processes, and collect it."""
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
