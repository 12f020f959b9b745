"""Undo and redo: what each client has changed, and whether the document is saved.

A client undoes its own edits only. Whatever others have changed since stays, so an
edit puts back the values that it has set, never the whole document.
"""

from __future__ import annotations

from collections.abc import Callable, Generator, MutableSequence
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from functools import partial

from sambot_viz.errors import SambotVizError, UsageError
from sambot_viz.rviz.undo_log import Restore, record_changes
from sambot_viz.session.people.roles import VIEW_ONLY
from sambot_viz.session.signals import Change, Signal
from sambot_viz.session.undo_steps import (
    ClientSteps,
    LeftSteps,
    Step,
    UndoableEdit,
    UndoState,
)

Apply = Callable[[Restore], None]
"""Puts something back in the document, and draws it."""


@dataclass
class _Action:
    """The edit that a client is making."""

    client_id: int
    gesture: object
    by_viewer: bool
    edits: list[UndoableEdit] = field(default_factory=list[UndoableEdit])
    merge_keys: list[object] = field(default_factory=list[object])
    of_document: bool = False


class NotNow(Exception):
    """A step cannot be undone or done again now, but later it can; says why."""


def _check(step: Step, may_edit: bool) -> None:
    """Let viewers touch only what they have done as viewers."""
    if not (may_edit or step.by_viewer):
        raise UsageError(VIEW_ONLY)


def _never() -> bool:
    return False


class History:
    """The edits of a session, for each of its clients.

    Args:
        change: undoes and redoes, and sends the changes.

    Attributes:
        modified: whether the document has unsaved edits.
        is_as_saved: returns whether the document equals its file; it compares all of
            it, so it is called after single edits only, not in a drag.
        take_page: gives a client the state of another page (see `UndoableEdit`), and
            returns whether that is possible.
    """

    def __init__(self, change: Change) -> None:
        self.modified = Signal(change, False)
        self.is_as_saved: Callable[[], bool] = _never
        self.take_page: Callable[[int, object], bool] = lambda client, page: False
        self._change = change
        self._steps: dict[int, ClientSteps] = {}
        self._left = LeftSteps()
        self._action: _Action | None = None
        self._undoing = False
        self._count = 0
        self._applied: set[int] = set()
        self._by_program = 0
        self._saved: tuple[frozenset[int], int] = (frozenset(), 0)

    # Recording

    @contextmanager
    def acting(
        self, client_id: int | None, gesture: object = None, *, by_viewer: bool = False
    ) -> Generator[None]:
        """Record the changes of the block as one edit of a client.

        Args:
            client_id: the client; None for a program, whose edits cannot be undone.
            gesture: a value that all movements of one drag share; None for a single
                action.
            by_viewer: whether the client has no control.
        """
        with self._change.lock:
            if client_id is None or self._action is not None:
                yield
                return
            action = self._action = _Action(client_id, gesture, by_viewer)
            try:
                yield
            finally:
                self._action = None
                if action.edits:
                    self._keep(action)

    @property
    def actor(self) -> int | None:
        """The client whose action runs now; None for a program's."""
        return None if self._action is None else self._action.client_id

    @property
    def recording(self) -> bool:
        """Whether a client could undo the changes that are being made."""
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
        page: object = None,
    ) -> None:
        """Keep a change that has been made.

        Args:
            label: what was done, in a few words.
            undo: undoes it; it may raise SambotVizError, or NotNow.
            redo: does it again; it may raise these, too.
            merge: what has changed: of one gesture, changes of the same thing in a
                row are one edit.
            touched: see `UndoableEdit`.
            of_document: whether it is lost unless the document is saved.
            page: see `UndoableEdit`.
        """
        with self._change.lock:
            if self._undoing:
                return
            action = self._action
            if action is not None:
                action.edits.append(UndoableEdit(label, undo, redo, touched, page))
                action.merge_keys.append(merge)
                action.of_document |= of_document
            elif of_document:
                self._by_program += 1
                self._tell_modified()

    @contextmanager
    def unrecorded(self) -> Generator[None]:
        """Leave the changes of the block out of the history: no user made them."""
        with self._change.lock:
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
            label: a few words for the edit.
            apply: calls its argument, which restores the properties, and draws them; it
                may raise SambotVizError instead.
            merge: see `record`.
        """
        with record_changes() as changes:
            yield
        if changes:
            self.record(
                label, lambda: apply(changes.undo), lambda: apply(changes.redo), merge
            )

    def _keep(self, action: _Action) -> None:
        history = self._steps_of(action.client_id)
        number = self._next_number() if action.of_document else None
        step = Step(
            tuple(action.edits),
            tuple(action.merge_keys),
            action.gesture,
            number,
            action.by_viewer,
        )
        last = history.done[-1] if history.done and not history.undone else None
        if last is not None and step.goes_on(last):
            history.done.pop()
            self._applied.discard(last.number or 0)
            both = zip(last.edits, step.edits, strict=True)
            edits = tuple(replace(a, redo=b.redo) for a, b in both)
            step = replace(step, edits=edits)
        history.undone.clear()
        history.done.append(step)
        if number is not None:
            self._applied.add(number)
        history.tell()
        self._tell_modified(look=step.gesture is None)

    def _next_number(self) -> int:
        self._count += 1
        return self._count

    # Undoing

    def undo(self, client_id: int, *, may_edit: bool = True) -> str | None:
        """Undo the last edit of a client.

        Args:
            client_id: the client.
            may_edit: whether it has control; others undo their edits as viewers.

        Returns:
            The label of the edit; None when there is nothing to undo.

        Raises:
            UsageError: it needs control, or cannot be undone now, or never again
                because of later edits; then it is forgotten.
        """
        with self._change.lock:
            history = self._steps_of(client_id)
            if not history.done:
                return None
            _check(history.done[-1], may_edit)
            step = history.done.pop()
            edits = step.edits[::-1]
            actions = [(e.undo, e.redo) for e in edits]
            self._run("undone", history, history.done, step, actions)
            history.undone.append(step)
            self._applied.discard(step.number or 0)
            history.tell(step)
            self._tell_modified(look=True)
            return step.edits[0].label

    def redo(self, client_id: int, *, may_edit: bool = True) -> str | None:
        """Redo the edit that a client last undid.

        Args:
            client_id: the client.
            may_edit: as for `undo`.

        Returns:
            The label of the edit; None when there is nothing to redo.

        Raises:
            UsageError: it needs control, or cannot be redone now, or never again; then
                it is forgotten.
        """
        with self._change.lock:
            history = self._steps_of(client_id)
            if not history.undone:
                return None
            _check(history.undone[-1], may_edit)
            step = history.undone.pop()
            actions = [(e.redo, e.undo) for e in step.edits]
            self._run("done again", history, history.undone, step, actions)
            history.done.append(step)
            if step.number is not None:
                self._applied.add(step.number)
            history.tell(step)
            self._tell_modified(look=True)
            return step.edits[0].label

    def _run(
        self,
        what: str,
        history: ClientSteps,
        steps: MutableSequence[Step],
        step: Step,
        actions: list[tuple[Callable[[], None], Callable[[], None]]],
    ) -> None:
        """Run the first functions of all pairs; the second ones undo them.

        A step that cannot be now goes back to those that it was taken from.
        """
        reached: list[Callable[[], None]] = []
        self._undoing = True
        try:
            with self._change():
                for act, reverse in actions:
                    act()
                    reached.append(reverse)
        except (SambotVizError, NotNow) as error:
            for reverse in reversed(reached):
                reverse()
            if isinstance(error, NotNow):
                steps.append(step)
            history.tell()
            label = step.edits[0].label
            raise UsageError(f"'{label}' cannot be {what}: {error}") from error
        finally:
            self._undoing = False

    def state(self, client_id: int) -> Signal[UndoState]:
        """Return the edits that a client can undo and redo."""
        return self._steps_of(client_id).state

    def key(self, client_id: int) -> str:
        """Return the secret under which a page that is loaded again gets its edits."""
        return self._steps_of(client_id).key

    def leave(self, client_id: int) -> None:
        """Keep the edits of a client that has closed the page for `resume`."""
        steps = self._steps.pop(client_id, None)
        if steps is not None:
            self._left.keep(steps)

    def resume(self, client_id: int, key: str) -> None:
        """Give a client its edits from before its page was loaded again.

        Nothing happens if they are no longer known.

        Args:
            client_id: the client.
            key: the value of `key` for the earlier page.
        """
        with self._change.lock:
            steps = self._steps_of(client_id)
            # The server may still believe in the connection that was lost.
            there = [s for s in self._steps.values() if s.key == key and s is not steps]
            before = there[0] if there else self._left.take(key)
            if before is not None:
                take = partial(self.take_page, client_id)
                steps.take_over(before, take)

    def _steps_of(self, client_id: int) -> ClientSteps:
        if client_id not in self._steps:
            self._steps[client_id] = ClientSteps(self._change)
        return self._steps[client_id]

    # Saving

    def saved(self) -> None:
        """Take the document as saved as it is now."""
        with self._change.lock:
            self._saved = (frozenset(self._applied), self._by_program)
            self._tell_modified()

    def _tell_modified(self, look: bool = False) -> None:
        modified = self._saved != (self._applied, self._by_program)
        if modified and look and self.is_as_saved():
            # One edit has taken another back, as by ticking a box twice.
            self._saved = (frozenset(self._applied), self._by_program)
            modified = False
        self.modified.set(modified)

    def clear(self) -> None:
        """Forget all edits: another document is shown, as it is in its file."""
        with self._change.lock:
            for steps in self._steps.values():
                steps.clear()
            self._left.clear()
            self._applied.clear()
            self.saved()
