"""The child process that runs xacro on somebody's file (spec/ros-nodes.md §5.5).

Started as a script by `robot/expansion.py`: a job as JSON on standard input (its
length first), the outcome as JSON on standard output. Only what this needs is
imported, never the package's own `__init__` files, so that the start stays cheap.
"""

from __future__ import annotations

import _thread
import json
import os
import signal
import sys
import types
from typing import Any


def limit_resources(megabytes: int, seconds: int) -> None:
    """Bound this process where the platform can; the parent has its own clock."""
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
        names: dotted names of packages, each after the one that holds it.
    """
    for name in names:
        module = types.ModuleType(name)
        module.__path__ = [os.path.join(root, *name.split(".")[1:])]
        sys.modules[name] = module


def keep_result_channel() -> int:
    """Move standard output away, so that nothing but the outcome is written there."""
    channel = os.dup(1)
    nowhere = os.open(os.devnull, os.O_WRONLY)
    os.dup2(nowhere, 1)
    os.dup2(nowhere, 2)
    return channel


def end_with_parent() -> None:
    """Wait for the end of standard input, which is the end of the parent."""
    while os.read(0, 4096):
        pass
    if hasattr(os, "killpg"):
        # What a model has started belongs to the session of this process.
        os.killpg(0, signal.SIGKILL)
    os._exit(1)


def main() -> None:
    """Read the job, expand, write the outcome."""
    size = int(sys.stdin.buffer.read(16))
    job: dict[str, Any] = json.loads(sys.stdin.buffer.read(size))
    _thread.start_new_thread(end_with_parent, ())
    channel = keep_result_channel()
    limit_resources(job["megabytes"], job["seconds"])
    os.environ.clear()
    os.environ.update(job["environment"])
    sys.path.extend(job["import_path"])
    root = os.path.abspath(__file__)
    for _ in range(4):
        root = os.path.dirname(root)
    make_packages(root, "sambot_viz", "sambot_viz.robot")
    from sambot_viz.robot.xacro.child.run import run

    outcome = json.dumps(run(job)).encode("utf-8", "surrogatepass")
    with os.fdopen(channel, "wb") as stream:
        stream.write(outcome)
    # Nothing is left to do; a model's leftovers (threads, hooks at exit) do not run.
    os._exit(0)


if __name__ == "__main__":
    main()
