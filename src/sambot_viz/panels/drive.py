"""The Drive panel: velocities, buttons to hold, keys, and the pose in odom.

Keys are those of a number pad, because viser's camera has WASD, QE and the arrows:
8 and 2 change the linear velocity, 4 and 6 the angular one, 5 stops.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from contextlib import suppress
from functools import partial

import viser

from sambot_viz.errors import FrameError
from sambot_viz.panels.widgets import (
    Input,
    finite,
    on_click,
    on_hold,
    show_values,
    watch,
)
from sambot_viz.session import Event, Session
from sambot_viz.session.drive_control import ODOM
from sambot_viz.session.motion import HOLD
from sambot_viz.session.throttle import Throttle
from sambot_viz.text import html_text

MOST_LINEAR, MOST_ANGULAR = 1.0, 2.0
"""Ends of the sliders [m/s] and [rad/s]."""
KEY_LINEAR, KEY_ANGULAR = 0.1, 0.25
"""What one press of a key adds [m/s] and [rad/s]."""
SHOW_PERIOD = 0.2

Vw = tuple[float, float]


class DrivePanel:
    """Drives the robot of a session with sliders, buttons and keys.

    Args:
        session: whose robot is driven.
        container: the tab to fill.
    """

    def __init__(self, session: Session, container: viser.GuiTabHandle) -> None:
        self._session = session
        self._drive = session.motion.drive
        self._gui = session.audience.gui
        self._commands: list[viser.CommandHandle] = []
        self._show = Throttle(session.worker, SHOW_PERIOD, self._show_state)
        with container:
            self._content = self._gui.add_folder(None)
        with self._content:
            self._linear, self._angular = self._add_sliders()
            self._add_stick()
            self._pose = self._gui.add_html("")
            self._add_buttons()
        self._add_keys()
        session.listeners.append(self._hear)
        self._show_state()

    def close(self) -> None:
        """Stop listening to the session and remove the keys."""
        self._session.listeners.remove(self._hear)
        self._show.close()
        for command in self._commands:
            command.remove()

    def _hear(self, event: Event) -> None:
        if event in ("joints", "frames", "robot"):
            self._show.request()

    def _add_sliders(self) -> tuple[Input, Input]:
        gui, drive = self._gui, self._drive
        linear = gui.add_slider(
            "Linear [m/s]", -MOST_LINEAR, MOST_LINEAR, 0.01, 0.0, hint="Forwards (x)."
        )
        angular = gui.add_slider(
            "Angular [rad/s]",
            -MOST_ANGULAR,
            MOST_ANGULAR,
            0.01,
            0.0,
            hint="To the left (about z).",
        )
        watch(
            self._session,
            linear,
            partial(_within, MOST_LINEAR),
            lambda v: self._set((v, drive.w)),
        )
        watch(
            self._session,
            angular,
            partial(_within, MOST_ANGULAR),
            lambda w: self._set((drive.v, w)),
        )
        return linear, angular

    def _add_stick(self) -> None:
        """Add buttons that drive while they are held, for tablets."""
        gui = self._gui
        for label, direction in (
            ("▲ forwards", (0.5, 0.0)),
            ("◀ left", (0.0, 1.0)),
            ("▶ right", (0.0, -1.0)),
            ("▼ back", (-0.5, 0.0)),
        ):
            button = gui.add_button(label, hint="Drives while it is held.")
            on_hold(self._session, button, partial(self._set, direction, HOLD))

    def _add_buttons(self) -> None:
        stop = self._gui.add_button("Stop", color="red", hint="Key 5.")
        on_click(self._session, stop, self._stop)
        reset = self._gui.add_button(
            "Reset", hint="Back to the start, without the trail."
        )
        on_click(self._session, reset, self._reset)
        self._in_odom = self._gui.add_button(
            f"Fixed frame {ODOM}", hint="The robot moves, the grid stays where it is."
        )
        on_click(self._session, self._in_odom, self._fix_odom)

    def _add_keys(self) -> None:
        for key, label, change in (
            ("8", "Drive: faster forwards", (KEY_LINEAR, 0.0)),
            ("2", "Drive: slower, backwards", (-KEY_LINEAR, 0.0)),
            ("4", "Drive: more to the left", (0.0, KEY_ANGULAR)),
            ("6", "Drive: more to the right", (0.0, -KEY_ANGULAR)),
        ):
            self._add_key(key, label, partial(self._change, change))
        self._add_key("5", "Drive: stop", self._stop)

    def _add_key(self, key: str, label: str, action: Callable[[], None]) -> None:
        command = self._gui.add_command(label, hotkey=key)  # pyright: ignore[reportArgumentType]

        async def triggered(event: viser.CommandEvent) -> None:
            if event.client_id is not None:
                self._session.worker.post(action)

        command.on_trigger(triggered)
        self._commands.append(command)

    def _set(self, velocity: Vw, seconds: float = math.inf) -> None:
        """Drive; a robot that is attached to another frame is refused with a note."""
        try:
            self._drive.set_velocity(*velocity, seconds)
        except FrameError as error:
            self._refuse(error)
            raise
        self._show.request()

    def _refuse(self, error: FrameError) -> None:
        note = f'<p class="sambot-note sambot-warn">{html_text(error)}</p>'
        self._pose.content = note

    def _change(self, change: Vw) -> None:
        v = _clamp(MOST_LINEAR, round(self._drive.v + change[0], 6))
        w = _clamp(MOST_ANGULAR, round(self._drive.w + change[1], 6))
        with suppress(FrameError):
            self._set((v, w))

    def _stop(self) -> None:
        self._drive.stop()
        self._show.request()

    def _reset(self) -> None:
        self._drive.reset()
        self._show.request()

    def _fix_odom(self) -> None:
        try:
            self._drive.enter_odom()
        except FrameError as error:
            self._refuse(error)
            return
        self._session.set_global("Fixed Frame", ODOM)

    def _show_state(self) -> None:
        """Update the numbers; what is the same is not sent."""
        with self._session.lock:
            drive = self._drive
            if drive.wheels is None:
                return
            speeds = [(self._linear, drive.v), (self._angular, drive.w)]
            if any(slider.value != value for slider, value in speeds):
                show_values(self._session, speeds)
            content = self._state_html()
            if self._pose.content != content:
                self._pose.content = content
            fixed = self._session.context.fixed_frame == ODOM
            if self._in_odom.disabled != fixed:
                self._in_odom.disabled = fixed
            self._session.audience.flush()

    def _state_html(self) -> str:
        pose, wheels = self._drive.pose, self._drive.wheels
        yaw = math.degrees(math.remainder(pose.yaw, 2 * math.pi))
        root = html_text(self._session.robot.root) if self._session.robot else ""
        lines = [
            f"{ODOM} → {root}: x {pose.x + 0.0:.3f} m, y {pose.y + 0.0:.3f} m, "
            f"yaw {yaw + 0.0:.1f}°"
        ]
        if wheels is not None:
            lines.append(
                f"wheels: radius {wheels.radius:.4g} m, "
                f"{wheels.separation:.4g} m apart; keys 8 2 4 6, 5 stops"
            )
        if self._session.context.fixed_frame != ODOM:
            lines.append(f"with the fixed frame {ODOM} it moves on the grid")
        return f'<p class="sambot-note">{"<br>".join(lines)}</p>'


def _within(most: float, value: object) -> float:
    return _clamp(most, finite(value))


def _clamp(most: float, value: float) -> float:
    return min(most, max(-most, value))
