"""Undo and redo: what each browser has changed, and whether the document is saved.

A browser undoes its own edits only. Whatever others have changed since stays, so an
edit puts back the values that it has set, never the whole document.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Generator
from contextlib import contextmanager
from dataclasses import dataclass, field, replace

from sambot_viz.errors import SambotVizError, UsageError
from sambot_viz.rviz.undo_log import Restore, record_changes
from sambot_viz.session.shared_state import SharedState

LIMIT = 200
"""So many edits of a browser can be undone."""

Apply = Callable[[Restore], None]
"""Puts something back in the document, and draws it."""


@dataclass(frozen=True, slots=True)
class Edit:
    """A change that can be undone.

    Attributes:
        label: what was done, in a few words.
        undo: undoes it, or raises SambotVizError when that is not possible any more.
        redo: does it again, or raises SambotVizError.
        touched: what was added, removed, moved or named; None for other changes.
    """

    label: str
    undo: Callable[[], None]
    redo: Callable[[], None]
    touched: object = None


@dataclass(frozen=True, slots=True)
class _Step:
    """All that one action of a browser has changed.

    Attributes:
        edits: in the order in which they were made.
        merge_keys: of each edit; steps of one gesture with the same keys are one.
        gesture: of which it was a part.
        number: in the set of changes of the document; None for other changes.
    """

    edits: tuple[Edit, ...]
    merge_keys: tuple[object, ...]
    gesture: object
    number: int | None

    def goes_on(self, last: _Step) -> bool:
        """Whether this is one more movement of the gesture that made another step."""
        if self.gesture is None or self.gesture != last.gesture:
            return False
        return None not in self.merge_keys and self.merge_keys == last.merge_keys


@dataclass
class _Action:
    """What a browser does at the moment."""

    browser: int
    gesture: object
    edits: list[Edit] = field(default_factory=list[Edit])
    merge_keys: list[object] = field(default_factory=list[object])
    of_document: bool = False


@dataclass
class _History:
    done: deque[_Step] = field(default_factory=lambda: deque[_Step](maxlen=LIMIT))
    undone: list[_Step] = field(default_factory=list[_Step])
    touched: object = None
    times: int = 0

    def went(self, step: _Step) -> str:
        """A step was undone or done again; its label."""
        self.touched, self.times = step.edits[0].touched, self.times + 1
        return step.edits[0].label


class EditHistory:
    """The edits of a session, for each of its browsers.

    Args:
        session: whose edits these are.
    """

    def __init__(self, session: SharedState) -> None:
        self._session = session
        self._histories: dict[int, _History] = {}
        self._action: _Action | None = None
        self._undoing = False
        self._count = 0
        self._applied: set[int] = set()
        self._by_program = 0
        self._saved: tuple[frozenset[int], int] = (frozenset(), 0)

    # Recording

    @contextmanager
    def acting(self, browser_id: int | None, gesture: object = None) -> Generator[None]:
        """Record what is changed inside as one edit of a browser.

        Args:
            browser_id: the browser; None for a program, whose edits cannot be undone.
            gesture: what all movements of one drag have in common; None for a single
                action.
        """
        with self._session.lock:
            if browser_id is None or self._action is not None:
                yield
                return
            action = self._action = _Action(browser_id, gesture)
            try:
                yield
            finally:
                self._action = None
                if action.edits:
                    self._keep(action)

    @property
    def actor(self) -> int | None:
        """The browser whose action runs now; None for a program's."""
        return None if self._action is None else self._action.browser

    @property
    def recording(self) -> bool:
        """Whether there is a browser that could undo what is changed now."""
        return self._action is not None and not self._undoing

    def record(
        self,
        label: str,
        undo: Callable[[], None],
        redo: Callable[[], None],
        merge: object = None,
        *,
        touched: object = None,
        of_document: bool = True,
    ) -> None:
        """Keep a change that has been made.

        Args:
            label: what was done, in a few words.
            undo: undoes it; it may raise SambotVizError.
            redo: does it again; it may raise SambotVizError.
            merge: what has changed: of one gesture, changes of the same thing in a
                row are one edit.
            touched: see `Edit`.
            of_document: whether it is lost unless the document is saved.
        """
        with self._session.lock:
            if self._undoing:
                return
            action = self._action
            if action is not None:
                action.edits.append(Edit(label, undo, redo, touched))
                action.merge_keys.append(merge)
                action.of_document |= of_document
            elif of_document:
                self._by_program += 1
                self._session.signals.edits.touch()

    @contextmanager
    def unrecorded(self) -> Generator[None]:
        """Keep nothing of what is changed inside: no user has asked for it."""
        with self._session.lock:
            before, self._undoing = self._undoing, True
            try:
                yield
            finally:
                self._undoing = before

    @contextmanager
    def setting(
        self, label: str, apply: Apply, merge: object = None
    ) -> Generator[None]:
        """Record the properties that are set in the document inside.

        Args:
            label: what is done, in a few words.
            apply: calls the function it is given, which puts the properties back, and
                draws them; it may raise SambotVizError instead.
            merge: see `record`.
        """
        with record_changes() as changes:
            yield
        if changes:
            self.record(
                label, lambda: apply(changes.undo), lambda: apply(changes.redo), merge
            )

    def _keep(self, action: _Action) -> None:
        history = self._histories.setdefault(action.browser, _History())
        number = self._next_number() if action.of_document else None
        step = _Step(
            tuple(action.edits), tuple(action.merge_keys), action.gesture, number
        )
        last = history.done[-1] if history.done and not history.undone else None
        if last is not None and step.goes_on(last):
            history.done.pop()
            self._applied.discard(last.number or 0)
            both = zip(last.edits, step.edits, strict=True)
            edits = tuple(replace(a, redo=b.redo) for a, b in both)
            step = _Step(edits, step.merge_keys, step.gesture, number)
        history.undone.clear()
        history.done.append(step)
        if number is not None:
            self._applied.add(number)
        self._session.signals.edits.touch()

    def _next_number(self) -> int:
        self._count += 1
        return self._count

    # Undoing

    def undo(self, browser_id: int) -> str | None:
        """Undo the last edit of a browser.

        Returns:
            What was undone; None when there is nothing to undo.

        Raises:
            UsageError: it cannot be undone any more, because of what was done since;
                it is forgotten.
        """
        with self._session.lock:
            history = self._histories.get(browser_id)
            if history is None or not history.done:
                return None
            step = history.done.pop()
            edits = step.edits[::-1]
            self._run("undone", step, [(e.undo, e.redo) for e in edits])
            history.undone.append(step)
            self._applied.discard(step.number or 0)
            label = history.went(step)
            self._session.signals.edits.touch()
            return label

    def redo(self, browser_id: int) -> str | None:
        """Do again what a browser has undone last.

        Returns:
            What was done again; None when there is nothing.

        Raises:
            UsageError: it cannot be done again; it is forgotten.
        """
        with self._session.lock:
            history = self._histories.get(browser_id)
            if history is None or not history.undone:
                return None
            step = history.undone.pop()
            self._run("done again", step, [(e.redo, e.undo) for e in step.edits])
            history.done.append(step)
            if step.number is not None:
                self._applied.add(step.number)
            label = history.went(step)
            self._session.signals.edits.touch()
            return label

    def _run(
        self,
        what: str,
        step: _Step,
        actions: list[tuple[Callable[[], None], Callable[[], None]]],
    ) -> None:
        """Run the first functions of all pairs; the second ones undo them."""
        reached: list[Callable[[], None]] = []
        self._undoing = True
        try:
            with self._session.change():
                for act, reverse in actions:
                    act()
                    reached.append(reverse)
        except SambotVizError as error:
            for reverse in reversed(reached):
                reverse()
            self._session.signals.edits.touch()
            label = step.edits[0].label
            raise UsageError(f"'{label}' cannot be {what}: {error}") from error
        finally:
            self._undoing = False

    def undo_label(self, browser_id: int) -> str | None:
        """What `undo` would undo; None for nothing."""
        history = self._histories.get(browser_id)
        return history.done[-1].edits[0].label if history and history.done else None

    def redo_label(self, browser_id: int) -> str | None:
        """What `redo` would do again; None for nothing."""
        history = self._histories.get(browser_id)
        return history.undone[-1].edits[0].label if history and history.undone else None

    def touched(self, browser_id: int) -> tuple[int, object]:
        """How often a browser has undone or redone, and what the last one touched."""
        history = self._histories.get(browser_id, _History())
        return history.times, history.touched

    def leave(self, browser_id: int) -> None:
        """Forget the history of a browser that has closed the page."""
        self._histories.pop(browser_id, None)

    # Saving

    @property
    def modified(self) -> bool:
        """Whether the document has edits that are not saved."""
        return self._saved != (self._applied, self._by_program)

    def saved(self) -> None:
        """The document has been saved as it is now."""
        with self._session.lock:
            self._saved = (frozenset(self._applied), self._by_program)
            self._session.signals.edits.touch()

    def clear(self) -> None:
        """Forget all edits: another document is shown, as it is in its file."""
        with self._session.lock:
            self._histories.clear()
            self._applied.clear()
            self.saved()
