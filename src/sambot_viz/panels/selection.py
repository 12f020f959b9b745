"""The Selection panel of one browser: facts about the selected links and frames."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence

from sambot_viz.frames import LookupRefused
from sambot_viz.frames.distance import distance_between
from sambot_viz.panels.frames.link_facts import Fact, facts_of
from sambot_viz.panels.numbers_text import shown_numbers
from sambot_viz.panels.panel import Panel
from sambot_viz.panels.row import Json, Row
from sambot_viz.rviz import FIXED_FRAME, TfFrameProperty
from sambot_viz.session import Session
from sambot_viz.session.browser.browser import Browser
from sambot_viz.tools.picking.hit import Selectable

SHOWN = 30
"""At most this many selected items are listed."""
SHORT = 3
"""The rows of so many items, or more, come folded."""
_FRAME = TfFrameProperty(
    "Poses in", default=FIXED_FRAME, help="The frame in which poses are shown."
)


class SelectionPanel(Panel):
    """Lists the selection, and how far two selected items are apart.

    Args:
        session: what is shown.
        browser: whose selection it is.
        remake: called when another frame was chosen.
    """

    name = "selection"
    # As often as RViz.
    period = 0.2

    def __init__(
        self, session: Session, browser: Browser, remake: Callable[[Panel], None]
    ) -> None:
        signals = session.signals
        self.remade_by = (
            signals.robot,
            signals.frames,
            signals.config,
            browser.tools.changed,
        )
        self.moved_by = (signals.joints,)
        self._session = session
        self._browser = browser
        self._remake = remake
        self._frame: str = FIXED_FRAME

    def rows(self) -> Sequence[Row]:
        """The frame of the poses, then a row per item with its facts."""
        items = list(self._browser.tools.selection)
        if not items:
            return [Row("selection/none", "", "note", value=_NOTHING)]
        made = [self._frame_row()]
        if len(items) == 2:
            made.extend(_fact_rows("apart", "", self._apart(items[0], items[1])))
        for item in items[:SHOWN]:
            head = _id(item)
            made.append(
                Row(
                    head,
                    "",
                    "group",
                    f"{item.kind.capitalize()} {item.name}",
                    icon=item.kind,
                    expanded=len(items) < SHORT,
                )
            )
            made.extend(_fact_rows(head, head, self._facts(item)))
        if len(items) > SHOWN:
            more = f"and {len(items) - SHOWN} more"
            made.append(Row("selection/more", "", "note", value=more))
        return made

    def values(self) -> dict[str, Json]:
        """What a motion may have changed."""
        items = list(self._browser.tools.selection)
        made: list[Row] = []
        if len(items) == 2:
            made.extend(_fact_rows("apart", "", self._apart(items[0], items[1])))
        for item in items[:SHOWN]:
            made.extend(_fact_rows(_id(item), "", self._facts(item)))
        return {row.id: row.value for row in made}

    def _frame_row(self) -> Row:
        return Row(
            "selection/frame",
            "",
            "frame",
            _FRAME.name,
            value=self._frame,
            options=(FIXED_FRAME,),
            help=_FRAME.help,
            client_local=True,
            set=self._set_frame,
        )

    def _set_frame(self, frame: str) -> None:
        self._frame = _FRAME.coerce(frame)
        self._remake(self)

    def _facts(self, item: Selectable) -> Sequence[Fact]:
        session = self._session
        return facts_of(session, item.name, session.context.frame(self._frame))

    def _apart(self, first: Selectable, second: Selectable) -> Iterator[Fact]:
        try:
            found = distance_between(self._session.tree, first.name, second.name)
        except LookupRefused as refused:
            yield "Distance", refused.rviz_text
            return
        yield "Distance", f"{found.length:.6g} m, from {first.name} to {second.name}"
        axes = f"along the axes of {first.name}"
        yield "Offset", f"{shown_numbers(found.offset)} m, {axes}"


def _id(item: Selectable) -> str:
    return f"selected/{item.kind}/{item.name}"


def _fact_rows(prefix: str, parent: str, facts: Iterable[Fact]) -> Iterator[Row]:
    """The rows of some facts; names such as "Visual" may occur twice."""
    for number, (name, value) in enumerate(facts):
        yield Row(f"{prefix}/{number}", parent, "readonly", name, value)


_NOTHING = (
    "Nothing is selected. Choose Select (S), then click on a link or a frame, or drag "
    "a rectangle. Shift adds, Ctrl takes away."
)
