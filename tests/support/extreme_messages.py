"""Messages with values that nobody should send, of any type that rosbags knows."""

from __future__ import annotations

import random
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np

_DOUBLES = (float("nan"), float("inf"), -float("inf"), 1e300, -1e300, 5e-324, 0.0, -1.0)
_SINGLES = (float("nan"), float("inf"), -float("inf"), 3.4e38, -3.4e38, 1e-45, 0.0, -1)
_TEXTS = (
    "",
    "map",
    "/",
    "a" * 1_000_000,
    "\0",
    "a\nb\x1b[31m\x7f\u202e",
    "../../../etc/passwd",
    "file:///etc/passwd",
    "package://../../etc/passwd",
    "http://127.0.0.1:9/a.dae",
    "<script>alert(1)</script>",
    "%n%s{0}",
)
_LENGTHS = (0, 1, 2, 3, 1000)
Place = tuple[Callable[[Any], None], Any]
"""What sets a field, and its type."""


def extreme_message(store: Any, good: Any, seed: int) -> Any:
    """Return a message with some of its fields set to extremes.

    Args:
        store: of rosbags.
        good: a message, which is changed.
        seed: for the same one, the same fields.
    """
    chance = random.Random(seed)
    places = list(_places(store, good))
    for _ in range(chance.choice([1, 1, 1, 2, 3, 8])):
        put, desc = chance.choice(places)
        put(_value(store, desc, chance))
    return good


def _places(store: Any, message: Any) -> Iterator[Place]:
    """Yield the fields of a message, and those of what it contains."""
    for name, desc in store.fielddefs[message.__msgtype__][1]:
        inside = getattr(message, name)
        if int(desc[0]) == 2:
            yield from _places(store, inside)
            continue
        yield _setter(message, name), desc
        if isinstance(inside, list):
            for one in inside[:4]:
                if hasattr(one, "__msgtype__"):
                    yield from _places(store, one)


def _setter(message: Any, name: str) -> Callable[[Any], None]:
    return lambda value: setattr(message, name, value)


def _value(store: Any, desc: Any, chance: random.Random) -> Any:
    kind, what = int(desc[0]), desc[1]
    if kind == 1:
        return _scalar(what[0], chance)
    if kind == 2:
        fields = store.fielddefs[what][1]
        return store.types[what](*(_value(store, one, chance) for _, one in fields))
    (inner, of), count = what
    if kind == 4:
        count = chance.choice(_LENGTHS)
        count = min(count, 3) if int(inner) == 2 else count
    if int(inner) == 2:
        return [_value(store, (2, of), chance) for _ in range(count)]
    if of[0] == "string":
        return [_scalar("string", chance)[:100] for _ in range(count)]
    names = {"bool": "bool_", "byte": "int8", "char": "uint8"}
    values = [_scalar(of[0], chance) for _ in range(count)]
    return np.array(values, dtype=names.get(of[0], of[0]))


def _scalar(name: str, chance: random.Random) -> Any:
    if name == "string":
        return chance.choice(_TEXTS)
    if name == "bool":
        return chance.random() < 0.5
    if name.startswith("float"):
        return float(chance.choice(_DOUBLES if name == "float64" else _SINGLES))
    info = np.iinfo({"byte": "int8", "char": "uint8"}.get(name, name))
    return chance.choice([int(info.min), int(info.max), 0, 1, int(info.max) // 2])
