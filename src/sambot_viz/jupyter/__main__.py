"""The viewer behind the tile: ``python -m sambot_viz.jupyter FOLDER FLAG...``.

It shows the model of the variable SAMBOT_VIZ_MODEL, or else the one in the folder, or
else the bundled robot, and ends with the Jupyter server. With SAMBOT_VIZ_LESSON it
shows that lesson, and SAMBOT_VIZ_MODEL names the folder of the student's files.
"""

from __future__ import annotations

import os
import signal
import sys
import threading
from collections.abc import Sequence
from pathlib import Path

from sambot_viz import bundled, cli
from sambot_viz.errors import Problem, UsageError
from sambot_viz.outlet import write_err

MODEL = "SAMBOT_VIZ_MODEL"
"""The variable that names a model file or a package folder."""
LESSON = "SAMBOT_VIZ_LESSON"
"""The variable that names a lesson, as `sambot-viz lesson` takes it."""
ENDED = 1
"""Also of a viewer that was ended by a signal: jupyter-server-proxy starts one again
that has not ended with 0, and would show an error for ever otherwise."""
_STAND_IN = (
    "the bundled sam_bot is shown in its place; tell the person who has set that "
    "variable, such as your teacher"
)
LOOKS_EVERY = 1.0
"""How often it is looked whether the Jupyter server is still there [s]."""


def main(words: Sequence[str]) -> int:
    """Serve until the Jupyter server ends.

    Args:
        words: the folder, and flags of ``sambot-viz``.
    """
    folder, *flags = words
    threading.Thread(target=_end_with_parent, args=(os.getppid(),), daemon=True).start()
    named, lesson = os.environ.get(MODEL, ""), os.environ.get(LESSON, "")
    if lesson:
        return cli.main([*lesson_words(Path(folder), lesson, named), *flags]) or ENDED
    model, notes = model_of(Path(folder), named)
    more = [] if model is None else ["--model", str(model)]
    return cli.main([*flags, *more], notes) or ENDED


def lesson_words(folder: Path, lesson: str, named: str) -> list[str]:
    """Return the words that show a lesson, and report on it to a teacher's board.

    Args:
        folder: the folder that JupyterLab shows.
        lesson: name, file or folder of the lesson.
        named: folder of the student's files, also relative to `folder`; "" for one
            with the name of the lesson.
    """
    words = ["lesson", str(Path(lesson).expanduser()), "--report"]
    own = folder / Path(named or Path(lesson).stem).expanduser()
    return [*words, "--dir", str(own)]


def model_of(folder: Path, named: str) -> tuple[Path | None, list[Problem]]:
    """The model file or package folder to show; None for the bundled robot.

    If it is not the model that a user would expect, the reason is written to standard
    error, which is the log of the Jupyter server.

    Args:
        folder: the folder that JupyterLab shows.
        named: a file or folder, also relative to that folder; "" for none.

    Returns:
        The model, and a sentence for the page if the named one is missing.
    """
    model = folder / Path(named).expanduser() if named else folder
    try:
        bundled.find(model)
    except UsageError as error:
        why = f"{MODEL}: {error}" if named else str(error)
        write_err(f"sambot-viz: note: the bundled sam_bot is shown; {why}")
        problem = Problem("error", "model-not-found", f"{why}; {_STAND_IN}")
        return None, [problem] if named else []
    return model, []


def _end_with_parent(parent: int) -> None:
    """End this process when its parent has ended, however that was."""
    wait = threading.Event().wait
    while os.getppid() == parent:
        wait(LOOKS_EVERY)
    os.kill(os.getpid(), signal.SIGTERM)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
