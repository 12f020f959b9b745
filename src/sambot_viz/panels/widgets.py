"""Inputs of the panels, and what happens when a browser uses them.

The server's door drops what a browser may not send: here a value has its widget's type,
and the widget is visible and enabled. A value still goes through its property's own
rule before it is used, and a refused one is answered with the value that holds.

Callbacks are coroutines, because plain functions run unordered in viser's pool. They
only post what is to be done to the session's worker, so that the event loop never
waits for a session. An action that raises SambotVizError is answered in the Problems
panel.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from contextlib import suppress
from functools import partial
from typing import Any

import viser

from sambot_viz.errors import SambotVizError
from sambot_viz.rviz import (
    FIXED_FRAME,
    BoolProperty,
    ColorProperty,
    EnumProperty,
    FloatProperty,
    IntProperty,
    Property,
    TfFrameProperty,
    VectorProperty,
)
from sambot_viz.session import Session
from sambot_viz.text import text
from sambot_viz.viser_private import is_removed

Input = viser.GuiInputHandle[Any]
OnChange = Callable[[Any], None]


def watch(
    session: Session,
    handle: Input,
    coerce: Callable[[Any], Any],
    on_change: OnChange,
) -> None:
    """Call `on_change` with every good value a browser sets.

    Of values that come faster than they are taken, only the latest is.

    Args:
        session: in whose worker that happens.
        handle: the widget.
        coerce: the rule: returns the value to take, or raises SambotVizError,
            ValueError or TypeError for a value outside the rule.
        on_change: takes the value; it may raise SambotVizError to refuse it.
    """

    def use(value: Any) -> Any:
        value = coerce(value)
        on_change(value)
        return value

    _watch(session, handle, use)


def _watch(session: Session, handle: Input, use: Callable[[Any], Any]) -> None:
    """Call `use` with every value a browser sets; it returns the value that holds."""
    accepted = [handle.value]
    newest = taken = object()

    async def changed(event: viser.GuiEvent[Any]) -> None:
        nonlocal newest
        if event.client_id is None:
            # The program set the value itself; nothing is to be done for it.
            if newest is taken:
                accepted[0] = handle.value
            return
        newest = object()
        session.worker.post(partial(take, handle.value, newest), latest_of=handle)

    def take(value: Any, event: object) -> None:
        if is_removed(handle):
            return
        with suppress(SambotVizError, ValueError, TypeError, OverflowError):
            accepted[0] = use(value)
        session.worker.on_loop(partial(answer, event))

    def answer(event: object) -> None:
        nonlocal taken
        taken = event
        if event is newest and not is_removed(handle):
            # No newer value waits: show the one that holds.
            handle.value = accepted[0]

    handle.on_update(changed)


def show_values(session: Session, values: Sequence[tuple[Input, Any]]) -> None:
    """Show values that changed without a browser; what is the same is not sent."""

    def show() -> None:
        for handle, value in values:
            if not is_removed(handle):
                handle.value = value

    session.worker.on_loop(show)


def finite(value: Any) -> float:
    """A number that is one.

    Raises:
        ValueError: NaN or infinite.
    """
    number = float(value)
    if not math.isfinite(number):
        raise ValueError("not a finite number")
    return number


def add_property(
    session: Session,
    prop: Property,
    get: Callable[[], Any],
    on_change: OnChange,
    frames: Sequence[str] = (),
) -> Input:
    """The input that fits a property's type.

    Args:
        session: where to add it (to the current container of its GUI).
        prop: the declaration: name, type, range, options, help.
        get: gives the value that holds.
        on_change: called with what a browser sets; it sets the property, or raises
            SambotVizError for a value that the property cannot have.
        frames: the frames there are, for properties that name one.

    Returns:
        The widget's handle; set `.value` to show another value.
    """

    def use(value: Any) -> Any:
        on_change(value)
        return get()

    handle = _make(session.audience.gui, prop, get(), frames)
    _watch(session, handle, use)
    return handle


def _make(
    gui: viser.GuiApi, prop: Property, value: Any, frames: Sequence[str]
) -> Input:
    label, hint = prop.name, prop.help
    if isinstance(prop, BoolProperty):
        return gui.add_checkbox(label, bool(value), hint=hint)
    if isinstance(prop, EnumProperty):
        return gui.add_dropdown(
            label, options(prop.options, value), initial_value=text(value), hint=hint
        )
    if isinstance(prop, TfFrameProperty):
        offered = frame_choices(prop, frames, value)
        return gui.add_dropdown(label, offered, initial_value=text(value), hint=hint)
    if isinstance(prop, ColorProperty):
        return gui.add_rgb(label, value, hint=hint)
    if isinstance(prop, VectorProperty):
        return gui.add_vector3(label, value, step=0.1, hint=hint)
    if isinstance(prop, IntProperty):
        return gui.add_number(
            label, int(value), min=prop.minimum, max=prop.maximum, step=1, hint=hint
        )
    if isinstance(prop, FloatProperty):
        return _make_float(gui, prop, float(value))
    return gui.add_text(label, text(value), hint=hint)


def _make_float(gui: viser.GuiApi, prop: FloatProperty, value: float) -> Input:
    label = f"{prop.name} [{prop.unit}]" if prop.unit else prop.name
    if prop.minimum == 0.0 and prop.maximum == 1.0:
        return gui.add_slider(
            label, 0.0, 1.0, 0.01, min(1.0, max(0.0, value)), hint=prop.help
        )
    return gui.add_number(
        label, value, min=prop.minimum, max=prop.maximum, step=0.01, hint=prop.help
    )


def frame_choices(
    prop: TfFrameProperty, frames: Sequence[str], value: object
) -> tuple[str, ...]:
    """What a list of frames offers: the fixed frame where allowed, then all."""
    fixed = [FIXED_FRAME] if prop.offers_fixed_frame else []
    return options([*fixed, *frames], value)


def options(offered: Sequence[str], value: object) -> tuple[str, ...]:
    """Options for a dropdown: unique, or viser shows a white page; shown safely.

    The present value is always among them, as in RViz's editable lists.
    """
    unique = dict.fromkeys(text(option) for option in [*offered, value])
    return tuple(unique)


def on_click(
    session: Session, handle: viser.GuiButtonHandle, action: Callable[[], None]
) -> None:
    """Call `action` when a browser presses the button."""

    async def pressed(event: viser.GuiEvent[viser.GuiButtonHandle]) -> None:
        if event.client_id is not None:
            session.worker.post(action)

    handle.on_click(pressed)


HOLD_RATE = 10.0
"""How often a browser reports that a button is still held [1/s]."""


def on_hold(
    session: Session, handle: viser.GuiButtonHandle, action: Callable[[], None]
) -> None:
    """Call `action` ten times a second while a browser holds the button.

    Args:
        session: in whose worker that happens.
        handle: the button.
        action: may raise SambotVizError when it cannot do what is asked.
    """

    async def held(event: viser.GuiEvent[viser.GuiButtonHandle]) -> None:
        if event.client_id is not None:
            session.worker.post(tried, latest_of=handle)

    def tried() -> None:
        with suppress(SambotVizError):
            action()

    handle.on_hold(held, callback_hz=HOLD_RATE)  # pyright: ignore[reportUnknownMemberType]


OnPress = Callable[[viser.ClientHandle | None], None]
"""Takes the browser in which a button was pressed."""


def on_press(session: Session, handle: viser.GuiButtonHandle, action: OnPress) -> None:
    """Call `action` with the browser that presses the button."""

    async def pressed(event: viser.GuiEvent[viser.GuiButtonHandle]) -> None:
        if event.client_id is not None:
            session.worker.post(partial(action, event.client))

    handle.on_click(pressed)


def add_buttons(
    session: Session,
    labels: Sequence[str],
    action: Callable[[str, viser.ClientHandle | None], None],
) -> viser.GuiButtonGroupHandle:
    """A row of buttons; `action` takes the label that was pressed, and the browser."""
    handle = session.audience.gui.add_button_group("", labels)

    async def pressed(event: viser.GuiEvent[viser.GuiButtonGroupHandle]) -> None:
        if event.client_id is not None and handle.value in labels:
            session.worker.post(partial(action, handle.value, event.client))

    handle.on_click(pressed)
    return handle


def add_text(
    session: Session, label: str, value: str, on_change: OnChange, hint: str = ""
) -> Input:
    """A line of text."""
    handle = session.audience.gui.add_text(label, value, hint=hint)
    watch(session, handle, str, on_change)
    return handle
