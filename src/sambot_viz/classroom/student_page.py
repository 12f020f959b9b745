"""A student's page on a server: it saves the texts by itself, and reports the state."""

from __future__ import annotations

import time
from collections.abc import Callable, Generator
from contextlib import contextmanager, suppress
from dataclasses import replace

from sambot_viz.classroom.seat_state import SeatState
from sambot_viz.lessons.evaluation import faults_in
from sambot_viz.lessons.study import Study
from sambot_viz.session.signals import connect
from sambot_viz.session.worker import Throttle
from sambot_viz.visualizer import Visualizer

PERIOD = 1.0
"""Shortest time between two reports on a student to a board [s]."""
REST = 2.0
"""The server saves a text once the student pauses for this time [s] …"""
LONGEST = 10.0
"""… and after this time in any case [s]."""
_FILE_PERIOD, _FILE_AGAIN = 3.0, 30.0
"""Shortest and longest time between two reports in a file [s]."""


class StudentPage:
    """Watches the page of a lesson, until `close`.

    Args:
        viz: the server of the page, whose pages share one session.
        study: the lesson and the student's folder.
        tell: receives the student's state; an OSError of it is ignored.
        period: shortest time between two reports [s].
        again: longest time between two reports [s]; None if only changes count.
    """

    def __init__(
        self,
        viz: Visualizer,
        study: Study,
        tell: Callable[[SeatState], object],
        period: float = PERIOD,
        again: float | None = None,
    ) -> None:
        place = viz.server.sessions.shared_place
        assert place is not None and place.session is not None
        assert place.window is not None and place.window.text is not None
        assert place.window.lesson is not None
        self._study, self._tell, self._again = study, tell, again
        self._session, self._window = place.session, place.window
        self._text, self._shown = place.window.text, place.window.lesson
        self._changed = self._typed = 0.0
        self._saves, self._closed = False, False
        self._since = SeatState.on_disk(study.lesson, study.folder).since
        self._trouble, self._passed = "", self._count_passed()
        self._throttle = Throttle(self._session.worker, period, self._send)
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
        if again is not None:
            self._session.worker.post_later(again, self._report_again)

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
        """Watch no more."""
        with self._session.lock:
            self._closed = True
            for end in self._ends:
                end()
        self._throttle.close()

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
        steps, progress = self._study.lesson.steps, self._study.progress
        return sum(progress.of(step.name).passed for step in steps)

    def _report_again(self) -> None:
        if self._closed or self._again is None:
            return
        self._throttle.request()
        self._session.worker.post_later(self._again, self._report_again)

    def _send(self) -> None:
        with suppress(OSError):
            self._tell(self.state())

    def state(self) -> SeatState:
        """Return the student's present state."""
        with self._session.lock:
            return self._state()

    def _state(self) -> SeatState:
        passed, self._passed = self._passed, self._count_passed()
        if self._passed > passed:
            self._since = time.time()
        listed = self._session.problems.shown.value.listed
        faults = faults_in(self._shown.outcomes or ())
        errors = [problem for problem in listed if problem.severity == "error"]
        said = [fault.message for fault in faults] + [one.message for one in errors]
        roles = self._session.roles
        people = roles.people.values()
        return SeatState.of(
            self._study.lesson,
            self._study.progress,
            errors=len(errors),
            warnings=sum(problem.severity == "warning" for problem in listed),
            unmet=len(faults),
            first=said[0][:200] if said else "",
            # Others only look, such as the teacher of a class.
            pages=sum(one.presenter or not roles.presented for one in people),
            changed=self._changed,
            since=self._since,
            trouble=self._trouble or self._shown.trouble,
        )


@contextmanager
def reported(study: Study, viz: Visualizer) -> Generator[None]:
    """Save the texts of a page by themselves, and report its state in a file.

    Args:
        study: the lesson and the student's folder, which gets the file.
        viz: the server of the page.
    """

    def report(state: SeatState) -> None:
        state.report(study.folder)

    page = StudentPage(viz, study, report, _FILE_PERIOD, _FILE_AGAIN)
    try:
        yield
    finally:
        page.close()
        with suppress(OSError):
            report(replace(page.state(), pages=0))
