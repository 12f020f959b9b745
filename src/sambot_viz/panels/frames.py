"""The Frames panel: the pose of one frame in another, and added static transforms."""

from __future__ import annotations

import math
from collections.abc import Sequence

import viser

from sambot_viz.errors import FrameError, UsageError
from sambot_viz.frames import Transform
from sambot_viz.frames.explain import Explanation, explain
from sambot_viz.frames.static_transform import parse_static_transform
from sambot_viz.panels.widgets import add_text, on_click, options, watch
from sambot_viz.session import Event, Session
from sambot_viz.session.throttle import Throttle
from sambot_viz.text import html_text, text

SHOW_PERIOD = 0.25
"""The numbers follow joints that move this often [s]."""
SEARCH_FROM = 13
"""From so many frames on there is a search box."""
EXAMPLE = "0.1 0 0.2 0 0 0 base_link base_laser"
NONE_ADDED = "none"


class FramesPanel:
    """Shows look-ups of a session, and adds and removes static transforms.

    Args:
        session: whose frames these are.
        container: the tab to fill.
    """

    def __init__(self, session: Session, container: viser.GuiTabHandle) -> None:
        self._session = session
        self._gui = session.audience.gui
        self._search = ""
        self._offered: tuple[str, ...] = ()
        self._show = Throttle(session.worker, SHOW_PERIOD, self._show_answer)
        with container:
            content = self._gui.add_folder(None)
        with content:
            self._add_choice()
            self._answer = self._gui.add_html("")
            self._add_static()
        session.listeners.append(self._hear)
        self._offer()
        self._show_answer()

    def close(self) -> None:
        """Follow the session no longer."""
        self._session.listeners.remove(self._hear)
        self._show.close()

    def _hear(self, event: Event) -> None:
        if event in ("frames", "robot"):
            self._offer()
        if event in ("frames", "robot", "joints"):
            self._show.request()

    def _add_choice(self) -> None:
        gui = self._gui
        self._box = add_text(
            self._session,
            "Search",
            "",
            self._look_for,
            hint="Part of the frames' names.",
        )
        first = text(self._session.context.fixed_frame)
        self._source = gui.add_dropdown(
            "From", (first,), hint="The frame to look from: tf2_echo's SOURCE."
        )
        self._target = gui.add_dropdown(
            "To", (first,), hint="The frame to look at: tf2_echo's TARGET."
        )
        for choice in (self._source, self._target):
            watch(self._session, choice, str, lambda _: self._show.request())

    def _look_for(self, typed: str) -> None:
        self._search = typed.strip().lower()
        self._offer()

    def _offer(self) -> None:
        """Offer the frames that there are, and that the search finds."""
        with self._session.lock:
            frames = sorted(self._session.tree.frames)
            moving = [*self._session.context.moving]
        self._box.visible = len(frames) >= SEARCH_FROM or bool(self._search)
        found = tuple(f for f in frames if self._search in f.lower())
        if self._offered == found and found:
            return
        untouched = not self._offered and bool(frames)
        self._offered = found
        for choice in (self._source, self._target):
            value = choice.value
            choice.options = options(found, value)
            choice.value = value
        if untouched and (moving or frames):
            # Something that moves is a good first thing to look at.
            self._target.value = text((moving or frames)[0])
        self._offer_added()

    def _show_answer(self) -> None:
        with self._session.lock:
            found = explain(
                self._session.tree,
                self._source.value,
                self._target.value,
                self._session.robot,
            )
        content = answer_html(found)
        if self._answer.content != content:
            self._answer.content = content

    def _add_static(self) -> None:
        gui = self._gui
        with gui.add_folder("Static transform", expand_by_default=False):
            self._arguments = add_text(
                self._session,
                "Arguments",
                EXAMPLE,
                lambda _: None,
                hint="X Y Z YAW PITCH ROLL PARENT CHILD, or with a quaternion X Y Z QX "
                "QY QZ QW PARENT CHILD, or --x … --frame-id PARENT --child-frame-id "
                "CHILD: metres, radians.",
            )
            on_click(self._session, gui.add_button("Add transform"), self._add)
            self._said = gui.add_html("")
            self._added = gui.add_dropdown("Added", options((), NONE_ADDED))
            watch(self._session, self._added, str, lambda _: None)
            self._remove_button = gui.add_button("Remove transform", disabled=True)
            on_click(self._session, self._remove_button, self._remove)
        self._offer_added()

    def _add(self) -> None:
        try:
            added = parse_static_transform(self._arguments.value)
            session = self._session
            session.add_frame(added.parent, added.child, added.transform)
        except (UsageError, FrameError) as error:
            self._say((str(error),), "error")
            return
        lines = [f"{added.parent} → {added.child} is set", *added.warnings]
        self._say(lines, "warn" if added.warnings else "ok")
        self._offer_added()
        self._added.value = text(added.child)

    def _remove(self) -> None:
        child = self._added.value
        try:
            self._session.remove_frame(child)
        except FrameError as error:
            self._say((str(error),), "error")
            return
        self._say((f"{child} is removed",), "ok")
        self._offer_added()

    def _offer_added(self) -> None:
        names = tuple(self._session.added.all) or (NONE_ADDED,)
        if self._added.options != names:
            self._added.options = options(names, names[0])
            self._added.value = text(names[-1])
        self._remove_button.disabled = names == (NONE_ADDED,)

    def _say(self, lines: Sequence[str], level: str) -> None:
        said = "<br>".join(html_text(line) for line in lines)
        self._said.content = f'<p class="sambot-note sambot-{level}">{said}</p>'


def answer_html(found: Explanation) -> str:
    """The chain step by step and the product; or why there is none."""
    if found.transform is None:
        tf2_text = html_text(found.refused.tf2_text) if found.refused else ""
        return (
            f'<div class="sambot-frames"><p class="sambot-error">'
            f"{html_text(found.reason)}</p><p>tf2 says: {tf2_text}</p></div>"
        )
    hops = "".join(
        f"<li>{html_text(hop.words)}<br><code>{_pose(hop.step)}</code></li>"
        for hop in found.hops
    )
    chain = f"<ol>{hops}</ol>" if hops else "<p>The same frame: no step.</p>"
    return f'<div class="sambot-frames">{chain}{_product_html(found)}</div>'


def _product_html(found: Explanation) -> str:
    T = found.transform or Transform.identity()
    roll, pitch, yaw = T.rpy
    degrees = (math.degrees(angle) for angle in (roll, pitch, yaw))
    matrix = "\n".join(
        " ".join(f"{_clean(c):8.4f}" for c in row) for row in T.matrix.tolist()
    )
    rows = (
        ("xyz [m]", _numbers(T.translation.tolist())),
        ("rpy [rad]", _numbers((roll, pitch, yaw))),
        ("rpy [°]", _numbers(degrees, 3)),
        ("xyzw", _numbers(T.rotation_xyzw.tolist())),
    )
    cells = "".join(f"<tr><th>{name}</th><td>{value}</td></tr>" for name, value in rows)
    return (
        f"<p><b>{html_text(found.source)}</b> in <b>{html_text(found.target)}</b></p>"
        f"<table>{cells}</table><pre>{matrix}</pre>"
    )


def _pose(T: Transform) -> str:
    return f"xyz {_numbers(T.translation.tolist())}, rpy {_numbers(T.rpy)}"


def _numbers(values: object, digits: int = 4) -> str:
    numbers: list[float] = list(values)  # pyright: ignore[reportArgumentType, reportUnknownVariableType]
    return " ".join(f"{_clean(c, digits):.{digits}f}" for c in numbers)


def _clean(value: float, digits: int = 4) -> float:
    """Rounded, with minus zero as zero."""
    return round(value, digits) + 0.0
