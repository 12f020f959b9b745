"""Which files xacro opens for untrusted models; run as a program of its own.

It reads jobs of the child process as a JSON list on standard input, and writes for each
the files that were opened while the model was expanded, and the answer. Each job has a
process of its own, because the child patches xacro.
"""

import importlib
import json
import os
import sys
from typing import Any

from sambot_viz.robot.xacro.child.run import run


def opened_by(job: dict[str, Any]) -> dict[str, Any]:
    """Expand in a child process, under an audit hook."""
    read_end, write_end = os.pipe()
    child = os.fork()
    if child == 0:
        files: list[str] = []

        def note(event: str, arguments: tuple[Any, ...]) -> None:
            if event == "open" and isinstance(arguments[0], str):
                files.append(os.path.realpath(arguments[0]))

        sys.addaudithook(note)
        answer = run(job).decode()
        with os.fdopen(write_end, "w") as stream:
            json.dump({"files": files, "answer": answer}, stream)
        os._exit(0)
    os.close(write_end)
    with os.fdopen(read_end) as stream:
        text = stream.read()
    os.waitpid(child, 0)
    return json.loads(text)


if __name__ == "__main__":
    jobs = json.load(sys.stdin)
    # Everything is imported before the first job, so that only the model opens files.
    for name in ("yaml", "xacro", "xacro.substitution_args"):
        importlib.import_module(name)
    json.dump([opened_by(job) for job in jobs], sys.stdout)
