"""Messages with random values, of any type that rosbags knows."""

from __future__ import annotations

import random
from typing import Any

import numpy as np


def random_message(store: Any, name: str, seed: int) -> Any:
    """Return a message of a type of a store, the same one for the same seed."""
    return _message(store, name, random.Random(seed))


def _message(store: Any, name: str, chance: random.Random) -> Any:
    fields = store.fielddefs[name][1]
    return store.types[name](*(_value(store, desc, chance) for _, desc in fields))


def _value(store: Any, desc: Any, chance: random.Random) -> Any:
    kind, what = int(desc[0]), desc[1]
    if kind == 1:
        return _scalar(what[0], chance)
    if kind == 2:
        return _message(store, what, chance)
    (inner, of), count = what
    if kind == 4:
        count = chance.choice([0, 1, 2, 5] if not count else [0, min(count, 2)])
    if int(inner) == 2:
        return [_message(store, of, chance) for _ in range(count)]
    values = [_scalar(of[0], chance) for _ in range(count)]
    if of[0] == "string":
        return values
    names = {"bool": "bool_", "byte": "int8", "char": "uint8"}
    return np.array(values, dtype=names.get(of[0], of[0]))


def _scalar(name: str, chance: random.Random) -> Any:
    if name == "string":
        return "".join(chance.choice("abcé_ ") for _ in range(chance.randrange(7)))
    if name == "bool":
        return chance.random() < 0.5
    if name.startswith("float"):
        return float(np.float32(chance.uniform(-9, 9)))
    return chance.randrange(100) - (50 if name.startswith("int") else 0)
