"""The controls of an interactive marker, with what RViz completes in them."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from sambot_viz import limits
from sambot_viz.displays.data.interactive_markers.control_marker import (
    ControlMarker,
    control_marker,
    opaque,
)
from sambot_viz.displays.data.interactive_markers.dragging import MENU, NONE
from sambot_viz.displays.data.interactive_markers.handles import handles, title
from sambot_viz.displays.data.message_numbers import coordinates_of
from sambot_viz.displays.data.refused_messages import MessageRefused
from sambot_viz.geometry import IDENTITY, Wxyz, unit_wxyz

INHERIT, FIXED, VIEW_FACING = range(3)
"""How a control is turned: with its marker, with the frame, or to the view."""
LARGEST = 1e6
"""A marker with a larger scale is not drawn [m]."""


class Group(NamedTuple):
    """Controls that are turned and hidden together.

    Attributes:
        turning: `INHERIT`, `FIXED` or `VIEW_FACING`.
        is_always: they are visible whatever the tool.
    """

    turning: int
    is_always: bool


TITLES = Group(VIEW_FACING, True)


@dataclass(frozen=True, slots=True)
class ShowOptions:
    """What the properties of the display say.

    Attributes:
        descriptions: whether descriptions are shown.
        axes: whether axes are.
        transparency: whether handles keep their alpha.
    """

    descriptions: bool = True
    axes: bool = False
    transparency: bool = True


@dataclass(frozen=True, slots=True)
class Control:
    """One control.

    Attributes:
        name: the name, unique in the marker.
        group: the controls that are turned and hidden together.
        wxyz: its rotation; x is the axis along or about which it moves.
        markers: its drawn markers.
        mode: the interaction mode.
        turning: the orientation mode of its message: the frame in which it moves.
    """

    name: str
    group: Group
    wxyz: Wxyz
    markers: Sequence[ControlMarker]
    mode: int = NONE
    turning: int = INHERIT


def require_valid(message: Any) -> None:
    """Refuse an interactive marker with numbers that cannot be drawn.

    Raises:
        MessageRefused: with RViz's sentence, where it has one.
    """
    controls = message.controls
    shapes = sum(len(control.markers) for control in controls)
    if len(controls) > limits.CONTROLS.value or shapes > limits.CONTROL_MARKERS.value:
        raise MessageRefused(
            f"It has {len(controls):,} controls with {shapes:,} markers: at most "
            f"{limits.CONTROLS.value:,} with {limits.CONTROL_MARKERS.value:,} are drawn"
        )
    if not all(map(math.isfinite, _numbers(message))) or not all(
        np.isfinite(coordinates_of(marker.points)).all()
        for control in controls
        for marker in control.markers
    ):
        raise MessageRefused("Marker contains invalid floats!")
    if abs(message.scale) > LARGEST:
        text = f"Its scale is {message.scale:g} m: at most {LARGEST:g} m is drawn"
        raise MessageRefused(text)


def _numbers(message: Any) -> Iterator[float]:
    yield from _of_pose(message.pose)
    yield message.scale
    for control in message.controls:
        yield from _of_turn(control.orientation)
        for marker in control.markers:
            yield from _of_pose(marker.pose)
            scale, color = marker.scale, marker.color
            yield from (scale.x, scale.y, scale.z)
            yield from (color.r, color.g, color.b, color.a)


def _of_pose(pose: Any) -> Iterator[float]:
    yield from (pose.position.x, pose.position.y, pose.position.z)
    yield from _of_turn(pose.orientation)


def _of_turn(turn: Any) -> tuple[float, float, float, float]:
    return (turn.w, turn.x, turn.y, turn.z)


def scale_of(message: Any) -> float:
    """Return the scale of an interactive marker [m]; 1 where it has none."""
    return float(message.scale) or 1.0


def controls_of(message: Any, *, is_transparent: bool) -> Sequence[Control]:
    """Return the controls of a visualization_msgs/InteractiveMarker.

    Args:
        message: valid (see `require_valid`).
        is_transparent: whether markers keep their alpha.
    """
    made: list[Control] = []
    names: set[str] = set()
    number = 0
    for control in message.controls:
        name = str(control.name)
        while name in names:
            name = f"{name}_u{number}"
            number += 1
        names.add(name)
        made.append(_control(name, control, scale_of(message), is_transparent))
    return made


def _control(name: str, control: Any, scale: float, is_transparent: bool) -> Control:
    mode, wxyz = int(control.interaction_mode), unit_wxyz(_of_turn(control.orientation))
    moves_in = turning = int(control.orientation_mode)
    markers: Sequence[ControlMarker] = [control_marker(m) for m in control.markers]
    if not markers:
        markers = handles(mode, scale, wxyz, str(control.description))
    if not control.markers and mode == MENU:
        turning = VIEW_FACING
    elif turning == VIEW_FACING and control.independent_marker_orientation:
        turning = INHERIT
    if turning not in (INHERIT, VIEW_FACING):
        turning = FIXED
    if not is_transparent:
        markers = [opaque(marker) for marker in markers]
    group = Group(turning, bool(control.always_visible))
    return Control(name, group, wxyz, markers, mode, moves_in)


def title_of(message: Any) -> Control | None:
    """Return the description of an interactive marker; None where it has none."""
    description = str(message.description)
    if not description.strip():
        return None
    return Control("", TITLES, IDENTITY, [title(description, scale_of(message))])
