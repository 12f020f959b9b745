"""The one place that checks the messages of browsers: role, type and limits.

`panels.sent` reads the row or command that a message names.
"""

from __future__ import annotations

import math
import re
import reprlib
from collections.abc import Callable, Sequence
from functools import partial
from typing import Any, cast

from sambot_viz import limits
from sambot_viz.errors import UsageError
from sambot_viz.geometry import finite
from sambot_viz.panels.command import Argument, Command
from sambot_viz.panels.rows.row import Data, Json, Row
from sambot_viz.session.people.roles import VIEW_ONLY
from sambot_viz.text import text

_REPR = reprlib.Repr()
"""Of lists in lists only the outermost are written."""
_REPR.maxlevel = 3
_REPR.maxstring = 60


def accept(
    item: Row | Data | Command, value: Json, *, may_edit: bool
) -> Callable[[], object]:
    """Check a message of a browser, and return the call that executes it.

    Args:
        item: the row or command that it names.
        value: a row's new value, or a command's arguments.
        may_edit: whether the browser may change what everyone sees.

    Raises:
        UsageError: the user is a viewer and others would see it, or as for `validate`.
    """
    if isinstance(item, Data):
        raise UsageError("This cannot be changed")
    if not (item.client_local or may_edit):
        raise UsageError(VIEW_ONLY)
    if isinstance(item, Command):
        return partial(item.run, *arguments_of(item, value))
    valid = validate(item, value)
    assert item.set is not None
    return partial(item.set, valid)


def validate(row: Row, value: Json) -> Any:
    """Return a value that the row's `set` may be called with.

    Raises:
        UsageError: it has another type, is outside the limits or not offered, or the
            row cannot be set at present.
    """
    if row.set is None:
        raise UsageError(f"'{text(row.name)}' cannot be changed now")
    if row.kind in ("int", "float", "slider"):
        return _number(row, value)
    if row.kind in ("bool", "display") and isinstance(value, bool):
        return value
    if row.kind == "enum" and not row.editable:
        return _option(row, value)
    if row.kind in ("enum", "text", "frame", "file") and isinstance(value, str):
        return _short(text(row.name), value)
    if row.kind == "color":
        return _color(row, value)
    if row.kind == "vector":
        return _numbers(row, value, len(cast("list[Any]", row.value)))
    raise UsageError(f"'{text(row.name)}' does not take {_shown(value)}")


def _number(row: Row, value: Json) -> float:
    number = None if isinstance(value, bool) else finite(value)
    if number is None:
        raise UsageError(f"'{text(row.name)}' needs a number, not {_shown(value)}")
    if abs(number) > limits.PAGE_NUMBER.value:
        raise UsageError(f"'{text(row.name)}' {_too_large(number)}")
    low = -math.inf if row.least is None else row.least
    high = math.inf if row.most is None else row.most
    if not low <= number <= high:
        span = f"{low:.6g} … {high:.6g} {row.unit}".strip()
        numbers = f"{number:.6g}: its limits are {span}".replace("inf", "∞")
        # The sign that the page writes in its own sentences too.
        signed = numbers.replace("-", "−")
        raise UsageError(f"'{text(row.name)}' cannot be {signed}")
    if row.kind == "int" and number != int(number):
        raise UsageError(f"'{text(row.name)}' needs a whole number")
    return int(number) if row.kind == "int" else number


def _too_large(number: float) -> str:
    return f"cannot be {number:g}: numbers up to {limits.PAGE_NUMBER.value:,} are taken"


def _option(row: Row, value: Json) -> str:
    # The page has the options in a safe form; two of them may look the same there.
    for option in row.options:
        if value == text(option, 200):
            return option
    raise UsageError(f"'{text(row.name)}' does not offer {_shown(value)}")


def _short(name: str, value: str) -> str:
    if len(value) > limits.PAGE_TEXT.value:
        raise UsageError(f"'{name}' takes at most {limits.PAGE_TEXT.value} characters")
    # What cannot be encoded must never reach viser's buffer.
    shown = re.sub(r"[\t\r\n]", " ", value)
    if text(shown, limits.PAGE_TEXT.value) != shown:
        raise UsageError(f"'{name}' contains an invisible character")
    return value


def _piece(name: str, value: str, longest: int) -> str:
    """Check a piece of a file, which no one line of the page shows."""
    if len(value) > longest:
        raise UsageError(f"'{name}' takes at most {longest:,} characters at once")
    try:
        value.encode()
    except UnicodeEncodeError:
        raise UsageError(f"'{name}' has half a character") from None
    return value


def _numbers(row: Row, value: Json, count: int) -> tuple[float, ...]:
    parts = cast("Sequence[object]", value) if isinstance(value, list) else ()
    numbers = [None if isinstance(part, bool) else finite(part) for part in parts]
    known = tuple(n for n in numbers if n is not None)
    if len(known) != count or len(numbers) != count:
        raise UsageError(f"'{text(row.name)}' needs {count} numbers")
    largest = max(known, key=abs, default=0.0)
    if abs(largest) > limits.PAGE_NUMBER.value:
        raise UsageError(f"'{text(row.name)}' {_too_large(largest)}")
    return known


def _color(row: Row, value: Json) -> str | tuple[float, ...]:
    """Names and "#" forms are read where the colour is set; three numbers are checked.

    In a file RViz lowers 300 to 255; a user who types it hears of it.
    """
    if isinstance(value, str):
        parts = [part.strip() for part in _short(text(row.name), value).split(";")]
        numbers = [int(part) for part in parts if re.fullmatch(r"[+-]?\d{1,12}", part)]
        fits = len(parts) == 1 or len(parts) == len(numbers) == 3
    else:
        numbers, fits = _numbers(row, value, 3), True
    if not fits or not all(0 <= number <= 255 for number in numbers):
        raise UsageError(
            f"'{text(row.name)}' cannot be {_shown(value)}: a colour is three whole "
            "numbers from 0 to 255, such as '255; 128; 0'"
        )
    return value if isinstance(value, str) else tuple(numbers)


def arguments_of(command: Command, value: Json) -> tuple[Any, ...]:
    """Return the arguments that a command may be called with.

    Raises:
        UsageError: there are more or fewer, or one has another type or is outside its
            limits.
    """
    name = text(command.name or command.id)
    parts = cast("list[Any]", value) if isinstance(value, list) else []
    fits = value is None or isinstance(value, list)
    if not fits or len(parts) != len(command.arguments):
        raise UsageError(f"'{name}' does not take {_shown(value)}")
    return tuple(
        _argument(name, argument, part)
        for argument, part in zip(command.arguments, parts, strict=True)
    )


def _argument(name: str, argument: Argument, part: Json) -> Any:
    if part is None and argument.optional:
        return None
    kinds = (int, float) if argument.type is float else argument.type
    if not isinstance(part, kinds) or (
        isinstance(part, bool) and argument.type is not bool
    ):
        raise UsageError(f"'{name}' does not take {_shown(part)}")
    if isinstance(part, str) and argument.longest is not None:
        return _piece(name, part, argument.longest)
    if not isinstance(part, list):
        return _scalar(name, part, argument.least, argument.most)
    listed = cast("list[Any]", part)
    most = limits.PAGE_LIST.value
    if len(listed) > most:
        raise UsageError(f"'{name}' takes a list of {most:,} at most")
    if any(not isinstance(p, str | int | float | None) for p in listed):
        raise UsageError(f"'{name}' does not take such a list")
    return [_scalar(name, p, argument.least, argument.most) for p in listed]


def _scalar(name: str, part: Json, least: float, most: float) -> Any:
    if isinstance(part, str):
        return _short(name, part)
    if isinstance(part, int | float) and not isinstance(part, bool):
        number = finite(part)
        if number is not None and abs(number) > limits.PAGE_NUMBER.value:
            raise UsageError(f"'{name}' {_too_large(number)}")
        if number is None or not least <= number <= most:
            raise UsageError(f"'{name}' needs a number, not {_shown(part)}")
    return part


def _shown(value: Json) -> str:
    return text(_REPR.repr(value), 60)
