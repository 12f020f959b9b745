"""The program of the child process that grades a student's files.

`lessons/grading.py` starts it as a script. The order comes as JSON on standard input,
the answer goes as JSON to standard output.
"""

from __future__ import annotations

import json
import os
import sys


def main() -> None:
    """Read the order, grade, write the answer."""
    size = int(sys.stdin.buffer.read(16))
    order = json.loads(sys.stdin.buffer.read(size))
    # Before this line, no import finds our package or any other.
    sys.path[:] = order["import_path"]
    from sambot_viz.robot.xacro.child.main import (
        end_with_parent,
        keep_result_channel,
        limit_resources,
    )

    end_with_parent()
    channel = keep_result_channel()
    limit_resources(order["megabytes"], order["seconds"])
    from pathlib import Path

    from sambot_viz.lessons.evaluation import messages
    from sambot_viz.lessons.read_lesson import read_lesson
    from sambot_viz.lessons.student_files import handed_in

    lesson = read_lesson(Path(order["lesson"]))
    given = handed_in(lesson, Path(order["path"]))
    steps = [lesson.step(name) for name in order["steps"]]
    try:
        said, refusal = messages(lesson, given, steps)
        answer = {"messages": said, "refusal": refusal}
    except MemoryError:
        answer = {"failure": "grading took too much memory"}
    except Exception as error:
        answer = {"failure": f"internal error of the grader: {error!r}; report it"}
    with os.fdopen(channel, "wb") as stream:
        stream.write(json.dumps(answer).encode())
    os._exit(0)


if __name__ == "__main__":
    main()
