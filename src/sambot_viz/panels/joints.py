"""The Joints panel: what joint_state_publisher_gui shows (spec/ros-nodes.md §2)."""

from __future__ import annotations

import math

import viser

from sambot_viz.pacer import Pacer
from sambot_viz.panels.widgets import Input, finite, on_click, watch
from sambot_viz.robot.model import Joint
from sambot_viz.session import Event, Session
from sambot_viz.text import text

MIRROR_PERIOD = 0.2
"""Sliders follow positions set by a program this often [s]: moving fifty sliders
thirty times a second keeps a browser busy to the full (spec/viser.md §3c)."""


class JointsPanel:
    """A slider and a number for every free joint, Center and Randomize.

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
        self._mirror = Pacer(session.loop, MIRROR_PERIOD, self._show_positions)
        session.listeners.append(self._hear)
        self._build()

    def close(self) -> None:
        """Follow the session no longer."""
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
        gui = self._gui
        with self._container:
            self._content = gui.add_folder(None)
        with self._content:
            if joints is None or not names:
                gui.add_html(_NOTHING_TO_MOVE)
                return
            center = gui.add_button("Center", hint="All joints to their start values.")
            on_click(center, self._session.center_joints)
            randomize = gui.add_button(
                "Randomize", hint="All joints to random values of their ranges."
            )
            on_click(randomize, self._session.randomize_joints)
            for name in names:
                self._add_slider(joints.joints[name], joints.positions[name])

    def _add_slider(self, joint: Joint, position: float) -> None:
        lower, upper = sorted(joint.range)
        step = slider_step(lower, upper)
        unit = "m" if joint.type == "prismatic" else "rad"
        slider = self._gui.add_slider(
            text(joint.name, 60),
            lower,
            upper,
            step,
            min(upper, max(lower, position)),
            hint=text(f"{joint.type} joint, {lower:.4g} … {upper:.4g} {unit}"),
            marks=((lower, _mark(lower)), (upper, _mark(upper))),
        )
        slider.precision = max(0, -math.floor(math.log10(step) + 1e-9))

        def clamp(value: float) -> float:
            return min(upper, max(lower, finite(value)))

        def move(value: float) -> None:
            self._session.set_joint_positions({joint.name: value})

        watch(slider, clamp, move)
        self._sliders[joint.name] = slider

    def _show_positions(self) -> None:
        """Bring the sliders in line with the positions."""
        with self._session.lock:
            joints = self._session.joints
            if joints is None:
                return
            for name, slider in self._sliders.items():
                lower, upper = sorted(joints.joints[name].range)
                slider.value = min(upper, max(lower, joints.positions[name]))


def slider_step(lower: float, upper: float) -> float:
    """A power of ten, a few thousand of which make the range: 0.001 for ±π."""
    return 10.0 ** (math.floor(math.log10(max(upper - lower, 1e-9))) - 3)


def _mark(value: float) -> str:
    """The text below an end of a slider: multiples of π as such."""
    if math.isclose(abs(value), math.pi):
        return "π" if value > 0 else "−π"
    return f"{value:.3g}".replace("-", "−")


_NOTHING_TO_MOVE = (
    '<p class="sambot-note">This robot has no joint to move: all its joints are '
    "fixed, or follow others.</p>"
)
