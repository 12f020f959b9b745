"""The problems that a session shows: of its model, of saves, and of the program."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal

from sambot_viz.errors import Problem, SambotVizError
from sambot_viz.session.shared_state import SharedState
from sambot_viz.session.worker import log_error

Reloaded = Literal["model", "config", "watch", "fault"]
"""What a save failed to change (model, config), or why saves fail at all."""


class ProblemList:
    """Problems of one session.

    Args:
        session: whose problems these are.

    Attributes:
        of_model: what is wrong with the model that is shown.
        of_frames: what is wrong with its frames and wheels; `set_model` adds them.
        of_saves: why the last save is not what is shown.
    """

    def __init__(self, session: SharedState) -> None:
        self._session = session
        self.of_model: tuple[Problem, ...] = ()
        self.of_frames: tuple[Problem, ...] = ()
        self.of_saves: dict[Reloaded, tuple[Problem, ...]] = {}

    def set_model(self, problems: Sequence[Problem]) -> None:
        """Show what is wrong with the model."""
        with self._session.lock:
            self.of_model = (*problems, *self.of_frames)
            self._session.signals.problems.touch()

    def set_saves(self, of: Reloaded, problems: Sequence[Problem]) -> None:
        """Show why the last save is not what is shown; an empty list when it is."""
        if self.of_saves.get(of, ()) != tuple(problems):
            with self._session.change(self._session.signals.problems):
                self.of_saves[of] = tuple(problems)

    def report_error(self, error: Exception) -> None:
        """Show an exception that was not handled, and log it once."""
        if isinstance(error, SambotVizError):
            problem = Problem("error", "refused", str(error))
        else:
            text = f"internal error: {type(error).__name__}: {error}"
            hint = "start the program again, and please report it"
            problem = Problem("error", "internal-error", text, hint)
        with self._session.lock:
            if self.of_saves.get("fault") == (problem,):
                return
            if not isinstance(error, SambotVizError):
                log_error(error)
            self.set_saves("fault", (problem,))
