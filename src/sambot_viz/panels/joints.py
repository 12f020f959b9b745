"""The Joints panel: what joint_state_publisher_gui shows.

Unlike there, typed values are exact, and a note names joints that mimic others, are
over a limit or have no position.
"""

from __future__ import annotations

import math
from functools import partial

import viser

from sambot_viz.panels.joint_notes import as_text, factor_of, notes_html, unit_of
from sambot_viz.panels.pose_folder import PoseFolder
from sambot_viz.panels.widgets import (
    Input,
    add_text,
    finite,
    on_click,
    on_hold,
    show_values,
    watch,
)
from sambot_viz.robot.joint import Joint
from sambot_viz.session import Event, Session
from sambot_viz.session.joint_arrow import JointArrow
from sambot_viz.session.motion import HOLD
from sambot_viz.session.throttle import Throttle
from sambot_viz.text import text

MIRROR_PERIOD = 0.2
"""Sliders follow positions set by a program this often [s]: moving fifty sliders
thirty times a second uses all of a browser thread."""
SEARCH_PAST = 12
MOST_ROWS = 40
"""More sliders than this make the page slow; the search finds the others."""
EXACT = 12
"""Decimals of a typed value."""
SAME = 1e-9
"""What differs less on screen is not sent."""


class JointsPanel:
    """A slider and a number for every free joint, Center, Randomize, poses, text.

    Args:
        session: whose joints these are.
        container: the tab to fill.
    """

    def __init__(self, session: Session, container: viser.GuiTabHandle) -> None:
        self._session = session
        self._gui = session.audience.gui
        self._container = container
        self._sliders: dict[str, Input] = {}
        self._built: tuple[object, ...] = ()
        self._content: viser.GuiFolderHandle | None = None
        self._rows: viser.GuiFolderHandle | None = None
        self._notes: viser.GuiHtmlHandle | None = None
        self._degrees = False
        self._search = ""
        self._seed = ""
        self._rate = 1.0
        self._keep = False
        self._arrow = JointArrow(session)
        self._mirror = Throttle(session.worker, MIRROR_PERIOD, self._show_positions)
        session.listeners.append(self._hear)
        self._build()

    def close(self) -> None:
        """Stop listening to the session."""
        self._session.listeners.remove(self._hear)
        self._mirror.close()

    def _hear(self, event: Event) -> None:
        if event == "robot":
            self._build()
        elif event == "joints":
            self._mirror.request()

    def _build(self) -> None:
        """Make the widgets; those of an unchanged set of joints stay as they are."""
        joints = self._session.joints
        names = joints.sliders if joints is not None else ()
        wanted = tuple((n, joints.joints[n].range) for n in names if joints)
        if self._content is not None and wanted == self._built:
            self._show_positions()
            return
        if self._content is not None:
            self._content.remove()
        self._sliders.clear()
        self._built = wanted
        with self._container:
            self._content = self._gui.add_folder(None)
        with self._content:
            if joints is None or not names:
                self._gui.add_html(_NOTHING_TO_MOVE)
                return
            self._add_buttons()
            if len(names) > SEARCH_PAST:
                add_text(
                    self._session,
                    "Search",
                    self._search,
                    self._look_for,
                    hint="Part of the joints' names.",
                )
            self._rows_folder = self._gui.add_folder(None)
            self._notes = self._gui.add_html("")
            self._add_options()
            PoseFolder(self._session)
            self._add_text()
        self._rows = None
        self._add_rows()

    def _add_buttons(self) -> None:
        gui = self._gui
        center = gui.add_button("Center", hint="All joints to their start values.")
        on_click(self._session, center, self._session.center_joints)
        randomize = gui.add_button(
            "Randomize", hint="All joints to random values of their ranges."
        )
        on_click(self._session, randomize, self._randomize)

    def _randomize(self) -> None:
        seed = self._seed.strip()
        self._session.randomize_joints(int(seed) if seed else None)

    def _add_options(self) -> None:
        gui = self._gui
        with gui.add_folder("Options", expand_by_default=False):
            degrees = gui.add_checkbox("Degrees", self._degrees)
            watch(self._session, degrees, bool, self._set_degrees)
            seed = gui.add_text(
                "Seed", self._seed, hint="The same whole number gives the same pose."
            )
            watch(self._session, seed, _seed, partial(setattr, self, "_seed"))
            rate = gui.add_number(
                "Turn rate [rad/s]", self._rate, step=0.1, hint="Negative turns back."
            )
            watch(self._session, rate, finite, partial(setattr, self, "_rate"))
            keep = gui.add_checkbox(
                "Keep turning", self._keep, hint="A press starts a wheel or stops it."
            )
            watch(self._session, keep, bool, partial(setattr, self, "_keep"))

    def _add_text(self) -> None:
        gui = self._gui
        with gui.add_folder("Copy", expand_by_default=False):
            yaml = gui.add_button("As yaml", hint="A sensor_msgs/JointState.")
            command = gui.add_button("As a ros2 topic pub command")
            shown = gui.add_text("Text", "", multiline=True)

            def show(kind: str) -> None:
                with self._session.lock:
                    if self._session.joints is not None:
                        shown.value = as_text(self._session.joints, kind)

            on_click(self._session, yaml, partial(show, "yaml"))
            on_click(self._session, command, partial(show, "command"))

    def _set_degrees(self, degrees: bool) -> None:
        self._degrees = degrees
        self._add_rows()

    def _look_for(self, typed: str) -> None:
        self._search = typed
        self._add_rows()

    def _add_rows(self) -> None:
        """The sliders of the joints that the search finds."""
        joints = self._session.joints
        if joints is None or not joints.sliders:
            return
        if self._rows is not None:
            self._rows.remove()
        self._sliders.clear()
        wanted = self._search.strip().lower()
        found = [name for name in joints.sliders if wanted in name.lower()]
        with self._rows_folder:
            self._rows = self._gui.add_folder(None)
        with self._rows:
            for name in found[:MOST_ROWS]:
                self._add_slider(joints.joints[name], joints.positions[name])
            if len(found) > MOST_ROWS:
                more = len(found) - MOST_ROWS
                self._gui.add_html(
                    f'<p class="sambot-note">and {more} more: search for them</p>'
                )
        self._show_positions()

    def _add_slider(self, joint: Joint, position: float) -> None:
        factor = factor_of(joint, self._degrees)
        lower, upper = (end * factor for end in sorted(joint.range))
        step = slider_step(lower, upper)
        unit = unit_of(joint, self._degrees)
        slider = self._gui.add_slider(
            text(joint.name, 60),
            lower,
            upper,
            step,
            min(upper, max(lower, position * factor)),
            hint=text(f"{joint.type} joint, {lower:.4g} … {upper:.4g} {unit}"),
            marks=((lower, _mark(lower)), (upper, _mark(upper))),
        )
        # The number box cuts what is typed to so many decimals.
        slider.precision = EXACT

        def clamp(value: float) -> float:
            return min(upper, max(lower, finite(value)))

        def move(value: float) -> None:
            # At an end of the slider the joint is exactly at its limit.
            ends = dict(zip((lower, upper), sorted(joint.range), strict=True))
            exact = ends.get(value, value / factor)
            self._session.set_joint_positions({joint.name: exact})
            self._arrow.moved(joint)

        watch(self._session, slider, clamp, move)
        self._sliders[joint.name] = slider
        if joint.type == "continuous":
            turn = self._gui.add_button(
                f"↻ {text(joint.name, 40)}",
                hint="Turns while it is held, at the rate of the options.",
                color="gray",
            )
            on_hold(self._session, turn, partial(self._hold, joint.name))
            on_click(self._session, turn, partial(self._press, joint.name))

    def _hold(self, name: str) -> None:
        if not self._keep:
            self._session.motion.turn(name, self._rate, HOLD)

    def _press(self, name: str) -> None:
        if self._keep:
            motion = self._session.motion
            motion.turn(name, 0.0 if motion.turns(name) else self._rate)

    def _show_positions(self) -> None:
        """Show the positions of the joints on the sliders."""
        with self._session.lock:
            joints = self._session.joints
            if joints is None:
                return
            values: list[tuple[Input, float]] = []
            for name, slider in self._sliders.items():
                joint = joints.joints.get(name)
                if joint is None:
                    continue
                factor = factor_of(joint, self._degrees)
                lower, upper = (end * factor for end in sorted(joint.range))
                value = min(upper, max(lower, joints.positions[name] * factor))
                if abs(slider.value - value) > SAME:
                    values.append((slider, value))
            if values:
                show_values(self._session, values)
            notes = notes_html(joints, self._degrees)
            if self._notes is not None and self._notes.content != notes:
                self._notes.content = notes


def slider_step(lower: float, upper: float) -> float:
    """Near a power of ten, a few thousand of which make the range: 0.001 for ±π.

    Steps are counted from the lower end, so the step is made a little smaller where
    0 would otherwise lie between two of them.
    """
    step = 10.0 ** (math.floor(math.log10(max(upper - lower, 1e-9))) - 3)
    if not (lower <= -step and upper > 0):
        return step
    return -lower / math.ceil(-lower / step - 1e-9)


def _seed(value: object) -> str:
    """A text that is empty or a whole number.

    Raises:
        ValueError: it is neither.
    """
    typed = str(value).strip()
    return str(int(typed)) if typed else ""


def _mark(value: float) -> str:
    """The text below an end of a slider: π instead of 3.14."""
    if math.isclose(abs(value), math.pi):
        return "π" if value > 0 else "−π"
    return f"{value:.3g}".replace("-", "−")


_NOTHING_TO_MOVE = (
    '<p class="sambot-note">This robot has no joint to move: all its joints are '
    "fixed, or follow others.</p>"
)
