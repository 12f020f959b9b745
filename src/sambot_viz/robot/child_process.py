"""Work in a child process of Python, which ends with this one and in time."""

from __future__ import annotations

import contextlib
import os
import signal
import subprocess
import sys
from pathlib import Path


class ChildTimeoutError(Exception):
    """The child did not answer in time; it was ended."""


def ask_child(
    script: Path, order: bytes, seconds: float, **environment: str
) -> tuple[bytes, int | None]:
    """Run a script, and return what it wrote to standard output.

    It runs without site-packages, in a session of its own.

    Args:
        script: it reads its order from standard input: 16 characters of length, then
            the order. That stays open until the answer is there.
        order: what it has to do.
        seconds: it is ended after this time [s], with all that it has started.
        environment: variables of its environment, beside those that Windows needs.

    Returns:
        Its output, and the status with which it has ended.

    Raises:
        ChildTimeoutError: it took longer.
    """
    needed = {name: os.environ[name] for name in ("SYSTEMROOT",) if name in os.environ}
    # The child reads EOF from this pipe when this process has died, and exits too.
    # Therefore the pipe stays open until the answer is there; `communicate` would
    # close it earlier.
    read_end, lifeline = os.pipe()
    try:
        process = subprocess.Popen(
            [sys.executable, "-I", "-S", "-X", "utf8", str(script)],
            stdin=read_end,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            env={**needed, **environment},
            start_new_session=True,
        )
    except BaseException:
        os.close(lifeline)
        raise
    finally:
        os.close(read_end)
    try:
        _send(lifeline, b"%16d" % len(order) + order)
        output, _ = process.communicate(timeout=seconds)
    except subprocess.TimeoutExpired:
        raise ChildTimeoutError(f"it took longer than {seconds:g} s") from None
    finally:
        os.close(lifeline)
        _end(process)
    return output, process.returncode


def _send(pipe: int, data: bytes) -> None:
    left = memoryview(data)
    # A child that ended early gives no answer, which is reported as a crash.
    with contextlib.suppress(BrokenPipeError):
        while left:
            left = left[os.write(pipe, left) :]


def _end(process: subprocess.Popen[bytes]) -> None:
    """End the child and everything it has started, and collect it."""
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
