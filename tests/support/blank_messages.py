"""Messages whose fields are all 0 or empty, of any type that rosbags knows."""

from __future__ import annotations

from typing import Any

import numpy as np


def blank_message(store: Any, name: str) -> Any:
    """Return a message of a type of a store; rotations turn nothing."""
    fields = store.fielddefs[name][1]
    made = store.types[name](*(_blank(store, desc) for _, desc in fields))
    if name == "geometry_msgs/msg/Quaternion":
        made.w = 1.0
    return made


def _blank(store: Any, desc: Any) -> Any:
    kind, what = int(desc[0]), desc[1]
    if kind == 1:
        zeros = {"string": "", "bool": False, "float32": 0.0, "float64": 0.0}
        return zeros.get(what[0], 0)
    if kind == 2:
        return blank_message(store, what)
    (inner, of), count = what
    count = count if kind == 3 else 0
    if int(inner) == 2:
        return [blank_message(store, of) for _ in range(count)]
    if of[0] == "string":
        return [""] * count
    names = {"bool": "bool_", "byte": "int8", "char": "uint8"}
    return np.zeros(count, dtype=names.get(of[0], of[0]))
