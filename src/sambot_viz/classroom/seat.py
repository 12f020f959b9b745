"""A student's page, on a server that only this machine can reach.

All pages of the student share one session and are its presenters. The teacher, and
students who may see it, view the same session. The server saves the student's text in
the student's folder.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from sambot_viz.classroom.requests import NAME_HEADER
from sambot_viz.classroom.seat_state import SeatState
from sambot_viz.classroom.student_page import StudentPage
from sambot_viz.inputs import Inputs
from sambot_viz.lessons.lesson import Lesson
from sambot_viz.lessons.study import Study
from sambot_viz.options import Options
from sambot_viz.visualizer import Visualizer


class Seat:
    """A student's page, from the first visit on.

    Args:
        lesson: the lesson.
        folder: folder of the student.
        track: track of the lesson; None for the first, or the one the files follow.
        tell: receives the student's progress, at most once a period.

    Attributes:
        page: what watches the page, and shows the teacher's sentences in it.
    """

    def __init__(
        self,
        lesson: Lesson,
        folder: Path,
        track: str | None,
        tell: Callable[[SeatState], object],
    ) -> None:
        study = Study.begun(lesson, folder, track, trusted=False)
        options = Options(token="", presenter="", trust_user_header=NAME_HEADER)
        options = options.having(trusted=False, in_class=True).learning(study)
        inputs = Inputs(options, may_be_broken=True)
        self._viz = Visualizer.of_inputs(inputs)
        self.page = StudentPage(self._viz, study, tell)

    @property
    def port(self) -> int:
        """The port it listens on, reachable from this machine only."""
        return self._viz.viser.get_port()

    @property
    def student_secret(self) -> str:
        """The secret that lets a program in as the student."""
        return str(self._viz.server.options.presenter)

    @property
    def viewer_secret(self) -> str:
        """The secret that lets a program in as a viewer."""
        return str(self._viz.server.options.token)

    def close(self) -> None:
        """Stop the server, which saves unsaved texts."""
        self.page.close()
        self._viz.stop()
