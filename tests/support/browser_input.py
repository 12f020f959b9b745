"""Mouse, keyboard and touch of a page, as the browser's own input events."""

from __future__ import annotations

import time
from typing import Literal, Protocol

from sambot_viz.errors import did_you_mean
from sambot_viz.export.devtools import Fields

Point = tuple[float, float]
_REST = 0.1
"""How long fingers rest before they are lifted [s]."""
Button = Literal["left", "middle", "right"]
_BUTTON_BITS: dict[Button, int] = {"left": 1, "right": 2, "middle": 4}
_MODIFIER_BITS = {"Alt": 1, "Control": 2, "Meta": 4, "Shift": 8}

# Key → the code that Windows gives it, which browsers expect for keys without text.
_KEY_CODES = {
    "Backspace": 8,
    "Tab": 9,
    "Enter": 13,
    "Shift": 16,
    "Control": 17,
    "Alt": 18,
    "Escape": 27,
    " ": 32,
    "PageUp": 33,
    "PageDown": 34,
    "End": 35,
    "Home": 36,
    "ArrowLeft": 37,
    "ArrowUp": 38,
    "ArrowRight": 39,
    "ArrowDown": 40,
    "Delete": 46,
    "Meta": 91,
    **{f"F{n}": 111 + n for n in range(1, 13)},
}

# Character → key of a US keyboard, its code there, and whether Shift is needed.
_PUNCTUATION = {
    ";:": ("Semicolon", 186),
    "=+": ("Equal", 187),
    ",<": ("Comma", 188),
    "-_": ("Minus", 189),
    ".>": ("Period", 190),
    "/?": ("Slash", 191),
    "`~": ("Backquote", 192),
    "[{": ("BracketLeft", 219),
    "\\|": ("Backslash", 220),
    "]}": ("BracketRight", 221),
    "'\"": ("Quote", 222),
    **{f"{n}{mark}": (f"Digit{n}", 48 + n) for n, mark in enumerate(")!@#$%^&*(")},
}
_MARKS = {
    mark: (code, number, shifted == 1)
    for pair, (code, number) in _PUNCTUATION.items()
    for shifted, mark in enumerate(pair)
}

# What a browser does by itself when these keys are pressed with Control.
_COMMANDS = {"a": "selectAll", "c": "copy", "v": "paste", "x": "cut"}


class Caller(Protocol):
    """What the devices below need of a page."""

    def call(
        self, method: str, params: Fields | None = None, timeout: float | None = None
    ) -> Fields:
        """Ask the page for something and wait for the answer, so long at most [s]."""
        ...


def _modifier_bits(names: tuple[str, ...]) -> int:
    for name in names:
        if name not in _MODIFIER_BITS:
            raise ValueError(
                f"no modifier '{name}'; {did_you_mean(name, _MODIFIER_BITS)}"
            )
    return sum(_MODIFIER_BITS[name] for name in set(names))


class Mouse:
    """The page's mouse; positions in CSS pixels from the page's upper left corner.

    Attributes:
        turns: how often its wheel was turned.
    """

    def __init__(self, page: Caller) -> None:
        self._page = page
        self._at: Point = (0.0, 0.0)
        self._pressed: Button | None = None
        self.turns = 0

    @property
    def at(self) -> Point:
        """Where it is."""
        return self._at

    def move(self, x: float, y: float, *modifiers: str) -> None:
        """Move to (x, y), dragging when a button is held."""
        self._at = (x, y)
        self._event("mouseMoved", self._pressed, modifiers)

    def press(self, button: Button = "left", *modifiers: str, clicks: int = 1) -> None:
        """Press a button where the mouse is and keep it down."""
        self._pressed = button
        self._event("mousePressed", button, modifiers, clicks)

    def release(self, *modifiers: str, clicks: int = 1) -> None:
        """Release the button that is down."""
        button, self._pressed = self._pressed, None
        if button is not None:
            self._event("mouseReleased", button, modifiers, clicks, held=0)

    def click(
        self, x: float, y: float, button: Button = "left", *modifiers: str
    ) -> None:
        """Move to (x, y), press and release."""
        self.move(x, y, *modifiers)
        self.press(button, *modifiers)
        self.release(*modifiers)

    def double_click(self, x: float, y: float) -> None:
        """Click twice at (x, y), as one double click."""
        self.click(x, y)
        self.press(clicks=2)
        self.release(clicks=2)

    def drag(
        self,
        start: Point,
        end: Point,
        *modifiers: str,
        button: Button = "left",
        steps: int = 10,
    ) -> None:
        """Press at `start`, move to `end` in equal steps, release."""
        self.move(*start, *modifiers)
        self.press(button, *modifiers)
        for step in range(1, steps + 1):
            part = step / steps
            x, y = (a + part * (b - a) for a, b in zip(start, end, strict=True))
            self.move(x, y, *modifiers)
        self.release(*modifiers)

    def wheel(self, x: float, y: float, dy: float, dx: float = 0.0) -> None:
        """Turn the wheel over (x, y) by `dy` [CSS pixels]; positive scrolls down."""
        self._at = (x, y)
        self.turns += 1
        self._event("mouseWheel", None, (), extra={"deltaX": dx, "deltaY": dy})

    def _event(
        self,
        kind: str,
        button: Button | None,
        modifiers: tuple[str, ...],
        clicks: int = 0,
        *,
        held: int | None = None,
        extra: Fields | None = None,
    ) -> None:
        bits = _BUTTON_BITS[button] if button is not None else 0
        self._page.call(
            "Input.dispatchMouseEvent",
            {
                "type": kind,
                "x": self._at[0],
                "y": self._at[1],
                "button": button or "none",
                "buttons": bits if held is None else held,
                "clickCount": clicks,
                "modifiers": _modifier_bits(modifiers),
                **(extra or {}),
            },
        )


class Keyboard:
    """The page's keyboard; what has the focus gets the keys."""

    def __init__(self, page: Caller) -> None:
        self._page = page

    def press(self, key: str, *modifiers: str, at: float = 0.0) -> None:
        """Press and release a key, named as in JavaScript ("ArrowLeft", "a", "Home").

        Args:
            key: the key.
            modifiers: those that are held.
            at: when the browser is to believe that it was (`time.time`) [s].

        Raises:
            ValueError: no such key or modifier.
        """
        self.hold(key, *modifiers, at=at)
        self.release(key, *modifiers)

    def hold(self, key: str, *modifiers: str, at: float = 0.0) -> None:
        """Press a key and keep it down; again while it is down, it repeats."""
        fields = self._fields(key, modifiers)
        if at:
            fields["timestamp"] = at
        if "Control" in modifiers and key.lower() in _COMMANDS:
            fields["commands"] = [_COMMANDS[key.lower()]]
        self._page.call("Input.dispatchKeyEvent", {"type": "keyDown", **fields})

    def release(self, key: str, *modifiers: str) -> None:
        """Let a key go."""
        fields = self._fields(key, modifiers)
        fields.pop("text", None)
        self._page.call("Input.dispatchKeyEvent", {"type": "keyUp", **fields})

    def type(self, text: str) -> None:
        """Press the key of each character, one after the other."""
        for character in text:
            self.press(character)

    def type_quickly(self, text: str) -> None:
        """The same as a quick hand, however slow this machine is.

        A list takes letters for the beginning of a name only in quick succession.
        """
        start = time.time()
        for number, character in enumerate(text):
            self.press(character, at=start + 0.01 * number)

    def insert(self, text: str) -> None:
        """Put `text` in as a whole, as an input method does."""
        self._page.call("Input.insertText", {"text": text})

    def _fields(self, key: str, modifiers: tuple[str, ...]) -> Fields:
        bits = _modifier_bits(modifiers)
        if key in _KEY_CODES:
            code = "Space" if key == " " else key
            fields: Fields = {"windowsVirtualKeyCode": _KEY_CODES[key], "code": code}
            text = {"Enter": "\r", " ": " "}.get(key, "")
        elif key in _MARKS:
            code, number, shifted = _MARKS[key]
            bits |= _MODIFIER_BITS["Shift"] if shifted else 0
            fields, text = {"windowsVirtualKeyCode": number, "code": code}, key
        elif len(key) == 1 and key.isascii():
            upper = key.upper()
            bits |= _MODIFIER_BITS["Shift"] if key != key.lower() else 0
            fields = {"windowsVirtualKeyCode": ord(upper), "code": f"Key{upper}"}
            text = key
        elif len(key) == 1:
            # On another keyboard than the US one; which key it is there, is not known.
            fields, text = {"windowsVirtualKeyCode": 0, "code": ""}, key
        else:
            raise ValueError(f"no key '{key}'; {did_you_mean(key, _KEY_CODES)}")
        # With Control, Alt or Meta a key is a command and writes nothing.
        if text and not bits & ~_MODIFIER_BITS["Shift"]:
            fields["text"] = text
        return {"key": key, "modifiers": bits, **fields}


class Touch:
    """Fingers on the page; positions in CSS pixels."""

    def __init__(self, page: Caller) -> None:
        self._page = page
        self._at = 0.0
        self._moves = False

    def start(self, *fingers: Point) -> None:
        """Put fingers on the page."""
        self._event("touchStart", fingers)

    def move(self, *fingers: Point) -> None:
        """Move the fingers, in the order they were put down."""
        self._event("touchMove", fingers)
        self._moves = True

    def end(self) -> None:
        """Lift all fingers. What they have moved rests before, and is not thrown."""
        # A browser takes a tap for the end of a throw, and the page gets no click.
        self._event("touchEnd", (), _REST if self._moves else 0.0)
        self._moves = False

    def tap(self, x: float, y: float) -> None:
        """Put one finger down and lift it."""
        self.start((x, y))
        self.end()

    def _event(self, kind: str, fingers: tuple[Point, ...], later: float = 0.0) -> None:
        points = [{"x": x, "y": y, "id": i} for i, (x, y) in enumerate(fingers)]
        self._at = max(time.time(), self._at + later)
        self._page.call(
            "Input.dispatchTouchEvent",
            {"type": kind, "touchPoints": points, "timestamp": self._at},
        )
