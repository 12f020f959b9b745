"""The program of the child process that runs xacro.

`xacro/expansion.py` starts it as a script, with the folders of what it imports after a
first word: "forks" when standard input is a socket, and each job is for a fork; "once"
without forks. A job comes as JSON on standard input (its length first), the answer goes
as JSON to standard output. Only what this needs is imported, never the package's own
`__init__` files, so that it starts fast.
"""

from __future__ import annotations

import _thread
import json
import os
import signal
import sys
import types
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from sambot_viz.robot.xacro.child.exchange import Job

WAIT = 60.0
"""The process ends after this time without a job [s]."""


def limit_resources(megabytes: int, seconds: int) -> None:
    """Limit memory and CPU time where the platform can; the parent has a timeout."""
    try:
        import resource
    except ImportError:
        return
    for kind, amount in (
        (resource.RLIMIT_AS, megabytes * 1024 * 1024),
        (resource.RLIMIT_CPU, seconds + 1),
        (resource.RLIMIT_CORE, 0),
    ):
        _, hard = resource.getrlimit(kind)
        soft = amount if hard == resource.RLIM_INFINITY else min(amount, hard)
        try:
            resource.setrlimit(kind, (soft, hard))
        except (OSError, ValueError):
            continue


def make_packages(root: str, *names: str) -> None:
    """Let submodules of packages be imported without running their `__init__`.

    Args:
        root: the folder of the package `sambot_viz`.
        names: dotted names of packages, each after the one that contains it.
    """
    for name in names:
        module = types.ModuleType(name)
        module.__path__ = [os.path.join(root, *name.split(".")[1:])]
        sys.modules[name] = module


def keep_result_channel() -> int:
    """Redirect standard output, and return the original for the answer alone."""
    channel = os.dup(1)
    nowhere = os.open(os.devnull, os.O_WRONLY)
    os.dup2(nowhere, 1)
    os.dup2(nowhere, 2)
    return channel


def end_with_parent() -> None:
    """Let the kernel kill this process and its children when the parent dies.

    The parent holds the other end of standard input. On Linux the kernel sends the
    signal when that end closes, even inside a long call of C code; elsewhere a thread
    waits for the end.
    """
    try:
        import fcntl

        fcntl.fcntl(0, fcntl.F_SETOWN, -os.getpgrp())
        fcntl.fcntl(0, fcntl.F_SETSIG, signal.SIGKILL)
        flags = fcntl.fcntl(0, fcntl.F_GETFL)
        fcntl.fcntl(0, fcntl.F_SETFL, flags | os.O_ASYNC)
    except (ImportError, AttributeError, OSError):
        _thread.start_new_thread(_wait_for_end, ())
        return
    # The parent may have died before the kernel was asked.
    os.set_blocking(0, False)
    try:
        if not os.read(0, 1):
            os._exit(1)
    except BlockingIOError:
        pass


def _wait_for_end() -> None:
    while os.read(0, 4096):
        pass
    if hasattr(os, "killpg"):
        os.killpg(0, signal.SIGKILL)
    os._exit(1)


def main() -> None:
    """Read the job, expand, write the answer."""
    sys.path.extend(sys.argv[2:])
    root = os.path.abspath(__file__)
    for _ in range(4):
        root = os.path.dirname(root)
    make_packages(root, "sambot_viz", "sambot_viz.robot")
    from sambot_viz.robot.xacro.child.run import run

    if sys.argv[1] == "forks":
        from sambot_viz.robot.xacro.child.forks import serve

        serve(WAIT)
    size = int(sys.stdin.buffer.read(16))
    job: Job = json.loads(sys.stdin.buffer.read(size))
    end_with_parent()
    channel = keep_result_channel()
    limit_resources(job["megabytes"], job["seconds"])
    if job["working_folder"]:
        os.chdir(job["working_folder"])
    os.environ.clear()
    os.environ.update(job["environment"])
    answer = run(job)
    with os.fdopen(channel, "wb") as stream:
        stream.write(answer)
    # Threads and exit hooks that the model has left must not run.
    os._exit(0)


if __name__ == "__main__":
    main()
