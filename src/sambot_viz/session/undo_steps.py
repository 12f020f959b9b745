"""The steps that each client can undo, also after its page was loaded again."""

from __future__ import annotations

import secrets
from collections import deque
from collections.abc import Callable, Container, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace

from sambot_viz import limits
from sambot_viz.session.signals import Change, Signal


@dataclass(frozen=True, slots=True)
class UndoableEdit:
    """A change that can be undone.

    Attributes:
        label: a few words for the change.
        undo: undoes it, or raises SambotVizError if that is no longer possible.
        redo: redoes it, or raises SambotVizError.
        touched: the thing that was added, removed, moved or named; None for other
            changes.
        page: the object of the page that was changed, such as its view; it is dropped
            with the page.
    """

    label: str
    undo: Callable[[], None]
    redo: Callable[[], None]
    touched: object = None
    page: object = None


@dataclass(frozen=True, slots=True)
class Step:
    """All that one action of a client has changed.

    Attributes:
        edits: in the order in which they were made.
        merge_keys: of each edit; steps of one gesture with the same keys are one.
        gesture: of which it was a part.
        number: in the set of changes of the document; None for other changes.
        by_viewer: whether it was made without control, so that no other sees it.
    """

    edits: tuple[UndoableEdit, ...]
    merge_keys: tuple[object, ...]
    gesture: object
    number: int | None
    by_viewer: bool

    def goes_on(self, last: Step) -> bool:
        """Whether this is one more movement of the gesture that made another step."""
        if self.gesture is None or self.gesture != last.gesture:
            return False
        return None not in self.merge_keys and self.merge_keys == last.merge_keys


@dataclass(frozen=True, slots=True)
class UndoState:
    """What one client can undo.

    Attributes:
        undo: the label of what `undo` would undo; None for nothing.
        redo: the label of what `redo` would do again; None for nothing.
        times: how often the client has undone or redone.
        touched: what the last of these touched.
    """

    undo: str | None = None
    redo: str | None = None
    times: int = 0
    touched: object = None


class ClientSteps:
    """The steps of one client.

    Args:
        change: sends the state to the client.

    Attributes:
        done: the steps to undo, the last step at the end.
        undone: the steps to redo, the next step at the end.
        state: both, as the client shows them.
        key: a secret of the client.
    """

    def __init__(self, change: Change) -> None:
        self.done: deque[Step] = deque(maxlen=limits.UNDO.value)
        self.undone: list[Step] = []
        self.state = Signal(change, UndoState())
        self.key = secrets.token_hex(16)

    def tell(self, step: Step | None = None) -> None:
        """Tell what can be undone now, after a step was undone or done again."""
        times, touched = self.state.value.times, self.state.value.touched
        if step is not None:
            times, touched = times + 1, step.edits[0].touched
        self.state.set(
            UndoState(_label(self.done), _label(self.undone), times, touched)
        )

    def take_over(
        self, before: ClientSteps, take_page: Callable[[object], bool]
    ) -> None:
        """Put the steps of the page that was loaded again before those since.

        Args:
            before: those steps.
            take_page: gives the client what was a page's, if that can be gone on with.
        """
        steps = (*before.done, *before.undone)
        pages = {id(edit.page): edit.page for step in steps for edit in step.edits}
        taken = {key for key, one in pages.items() if one is None or take_page(one)}
        if not self.undone and not self.done:
            self.undone[:] = _taken_over(before.undone, taken)
        done = [*_taken_over(before.done, taken), *self.done]
        before.clear()
        self.done.clear()
        self.done.extend(done)
        self.tell()

    def clear(self) -> None:
        """Forget all."""
        self.done.clear()
        self.undone.clear()
        self.state.set(UndoState())


def _label(steps: Sequence[Step]) -> str | None:
    return steps[-1].edits[0].label if steps else None


def _taken_over(steps: Iterable[Step], pages: Container[int]) -> Iterator[Step]:
    """Leave out what has ended with a page; its gestures have ended, too.

    Args:
        steps: of the page.
        pages: the ids of what has not ended.
    """
    for step in steps:
        stay = [n for n, edit in enumerate(step.edits) if id(edit.page) in pages]
        if stay:
            edits = tuple(step.edits[n] for n in stay)
            keys = tuple(step.merge_keys[n] for n in stay)
            yield replace(step, edits=edits, merge_keys=keys, gesture=None)


class LeftSteps:
    """The steps of clients that have closed or lost their page, by their keys."""

    def __init__(self) -> None:
        self._steps: dict[str, ClientSteps] = {}

    def keep(self, steps: ClientSteps) -> None:
        """Keep the steps of a client that left; above a limit drop the oldest ones."""
        if steps.done or steps.undone:
            self._steps[steps.key] = steps
        if len(self._steps) > limits.UNDO_PAGES.value:
            del self._steps[next(iter(self._steps))]

    def take(self, key: str) -> ClientSteps | None:
        """Return the steps of a client, which are not kept any longer."""
        return self._steps.pop(key, None)

    def clear(self) -> None:
        """Forget all."""
        self._steps.clear()
