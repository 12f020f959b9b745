"""A student's page, on a server that only this machine can reach.

All pages of the student share one session and are its presenters. The teacher, and
students who may see it, view the same session. The server saves the student's text in
the student's folder.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path

from sambot_viz.classroom.requests import NAME_HEADER
from sambot_viz.classroom.seat_state import SeatState
from sambot_viz.inputs import Inputs
from sambot_viz.lessons.evaluation import faults_in
from sambot_viz.lessons.lesson import Lesson
from sambot_viz.lessons.study import Study
from sambot_viz.options import Options
from sambot_viz.session.signals import connect
from sambot_viz.session.worker import Throttle
from sambot_viz.visualizer import Visualizer

PERIOD = 1.0
"""Shortest time between two reports on a student to the board [s]."""
REST = 2.0
"""The server saves a text once the student pauses for this time [s] …"""
LONGEST = 10.0
"""… and after this time in any case [s]."""


class Seat:
    """A student's page, from the first visit on.

    Args:
        lesson: the lesson.
        folder: folder of the student.
        track: track of the lesson; None for the first, or the one the files follow.
        tell: receives the student's progress, at most once a period.
    """

    def __init__(
        self,
        lesson: Lesson,
        folder: Path,
        track: str | None,
        tell: Callable[[SeatState], object],
    ) -> None:
        self._lesson = lesson
        study = self._study = Study.begun(lesson, folder, track, trusted=False)
        options = Options(token="", presenter="", trust_user_header=NAME_HEADER)
        options = options.having(trusted=False, in_class=True).learning(study)
        inputs = Inputs(options, may_be_broken=True)
        self._viz = Visualizer.of_inputs(inputs)
        place = self._viz.server.sessions.shared_place
        assert place is not None and place.session is not None
        assert place.window is not None and place.window.text is not None
        assert place.window.lesson is not None
        self._session, self._window = place.session, place.window
        self._text, self._shown = place.window.text, place.window.lesson
        self._tell = tell
        self._changed = self._typed = 0.0
        self._saves = False
        self._since, self._trouble = SeatState.on_disk(lesson, folder).since, ""
        self._passed = self._count_passed()
        self._throttle = Throttle(self._session.worker, PERIOD, self._send)
        facts = (
            self._session.problems.shown,
            self._session.roles.changed,
            self._shown.changed,
        )
        self._ends = [
            connect(facts, self._throttle.request),
            connect([self._text.changed], self._note_text),
        ]
        self._throttle.request()

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

    def say(self, sentence: str) -> None:
        """Show a sentence of the teacher in the student's pages."""
        with self._session.lock:
            self._window.say(sentence, "warn")
            self._shown.announce(sentence)

    def point_to(self, link: str, name: str) -> None:
        """Offer a link to another student's page; an empty link withdraws the offer."""
        with self._session.lock:
            self._shown.point_to(link, name)

    def close(self) -> None:
        """Stop the server, which saves unsaved texts."""
        with self._session.lock:
            for end in self._ends:
                end()
        self._throttle.close()
        self._viz.stop()

    # Text from the student

    def _note_text(self) -> None:
        now = time.time()
        if not self._text.unsaved:
            return
        self._changed = now
        if not self._saves:
            self._saves, self._typed = True, now
            self._session.worker.post_later(REST, self._save_later)
        self._throttle.request()

    def _save_later(self) -> None:
        now = time.time()
        if now - self._changed < REST and now - self._typed < LONGEST:
            left = REST - (now - self._changed)
            self._session.worker.post_later(left, self._save_later)
            return
        self._saves = False
        self._save()

    def _save(self) -> None:
        """Save each text; report a failed save to the board."""
        before, refused = self._trouble, self._text.save_all()
        self._trouble = f"not saved: {refused[-1]}" if refused else ""
        if self._trouble and self._trouble != before:
            self._window.say(self._trouble.capitalize(), "error")
        if self._trouble != before:
            self._throttle.request()

    # Reports to the board

    def _count_passed(self) -> int:
        steps, progress = self._lesson.steps, self._study.progress
        return sum(progress.of(step.name).passed for step in steps)

    def _send(self) -> None:
        with self._session.lock:
            state = self._state()
        with suppress(OSError):
            self._tell(state)

    def _state(self) -> SeatState:
        passed, self._passed = self._passed, self._count_passed()
        if self._passed > passed:
            self._since = time.time()
        listed = self._session.problems.shown.value.listed
        faults = faults_in(self._shown.outcomes or ())
        errors = [problem for problem in listed if problem.severity == "error"]
        said = [fault.message for fault in faults] + [one.message for one in errors]
        people = self._session.roles.people.values()
        return SeatState.of(
            self._lesson,
            self._study.progress,
            errors=len(errors),
            warnings=sum(problem.severity == "warning" for problem in listed),
            unmet=len(faults),
            first=said[0][:200] if said else "",
            pages=sum(person.presenter for person in people),
            changed=self._changed,
            since=self._since,
            trouble=self._trouble or self._shown.trouble,
        )
