"""What a page shows of a session's problems, as plain values."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from sambot_viz.displays.display import robot_displays
from sambot_viz.errors import Problem
from sambot_viz.problems import in_order

if TYPE_CHECKING:
    from sambot_viz.session import Session
    from sambot_viz.session.problem_list import Reloaded


def problems_of(session: Session) -> list[Problem]:
    """The problems to show, each once, errors first, then in the order of the files.

    While a saved file has a mistake, the problems of what is shown stay listed. What
    both have is listed once, where it is in the saved file.
    """
    saved = session.problems.of_saves
    shapes = (p for d in robot_displays(session.displays) for p in d.problems)
    model = _also(saved.get("model", ()), (*session.problems.of_model, *shapes))
    config = _also(saved.get("config", ()), session.config.problems)
    others = (*saved.get("fault", ()), *saved.get("watch", ()))
    return in_order((*model, *config, *others))


def _also(saved: Sequence[Problem], shown: Iterable[Problem]) -> list[Problem]:
    """Problems of a save, and those of what is shown that say something else."""
    said = {(problem.code, problem.message) for problem in saved}
    return [*saved, *(p for p in shown if (p.code, p.message) not in said)]


def last_good_note(session: Session) -> str:
    """What the page shows instead of files with a mistake, in words; or nothing."""
    notes: list[str] = []
    if _has_error(session, "model"):
        notes.append(
            "The model has a mistake: the robot appears as soon as it is fixed."
            if session.robot is None
            else f"Showing the last good version: {_what_is_wrong(session)}."
        )
    if _has_error(session, "config"):
        notes.append(
            "The config has a mistake: its displays appear as soon as it is fixed."
        )
    return " ".join(notes)


def _what_is_wrong(session: Session) -> str:
    """What became of the model's file."""
    for fault in session.problems.of_saves.get("model", ()):
        if fault.code == "model-not-found" and fault.file is not None:
            return f"{Path(fault.file).name} is gone"
    return "what was saved has a mistake"


def _has_error(session: Session, of: Reloaded) -> bool:
    faults = session.problems.of_saves.get(of, ())
    return any(fault.severity == "error" for fault in faults)
