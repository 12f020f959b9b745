"""What a page shows of a session's problems, as plain values."""

from __future__ import annotations

import os.path
from pathlib import Path
from typing import TYPE_CHECKING

from sambot_viz.errors import Problem
from sambot_viz.problem_groups import in_order

if TYPE_CHECKING:
    from sambot_viz.session import Session
    from sambot_viz.session.problem_list import Reloaded


def problems_of(session: Session) -> list[Problem]:
    """The problems to show, each once, errors first, then in the order of the files.

    While the saved model has a mistake, its problems take the place of those of the
    version that is shown, whose line numbers are out of date. What is wrong with other
    files, and with the robot that is shown, stays.
    """
    saved = session.problems.of_saves
    model, own = saved.get("model", ()), session.problems.of_model
    if model:
        own = tuple(problem for problem in own if not _is_in_model(problem, session))
    shapes = (p for display in session.displays for p in display.problems)
    config = saved.get("config", ()) or session.config.problems
    others = (*saved.get("fault", ()), *saved.get("watch", ()))
    return in_order((*model, *own, *shapes, *config, *others))


def _is_in_model(problem: Problem, session: Session) -> bool:
    """Whether a problem is at a place in a file of the model that is shown."""
    robot = session.robot
    if problem.file is None or robot is None:
        return False
    return Path(os.path.abspath(problem.file)) in robot.files


def last_good_note(session: Session) -> str:
    """What the page shows instead of files with a mistake, in words; or nothing."""
    notes: list[str] = []
    if _has_error(session, "model"):
        notes.append(
            "The model has a mistake: the robot appears as soon as it is fixed."
            if session.robot is None
            else "Showing the last good version: what was saved has a mistake."
        )
    if _has_error(session, "config"):
        notes.append(
            "The config has a mistake: its displays appear as soon as it is fixed."
        )
    return " ".join(notes)


def _has_error(session: Session, of: Reloaded) -> bool:
    faults = session.problems.of_saves.get(of, ())
    return any(fault.severity == "error" for fault in faults)
