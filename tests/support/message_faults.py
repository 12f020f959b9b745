"""What in viser's messages would harm a browser, now or for all that come later.

assert faults(client.messages) == []
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import Any, cast

import numpy as np
from protocol_client import Received

ARRAYS = ("vertices", "points", "batched_positions", "batched_wxyzs", "batched_scales")
LARGEST = 3.4e38
"""Browsers compute with 32 bits."""


def faults(messages: Sequence[Received]) -> list[str]:
    """A line for every value that is not finite, no text, or out of its range."""
    found: list[str] = []
    for message in messages:
        for path, value in _walk(message.fields, message.type):
            fault = _fault(path, value)
            if fault:
                found.append(f"{path}: {fault}")
        if message.type == "GuiSliderMessage":
            props, value = message.fields["props"], message.fields["value"]
            if not props["min"] <= value <= props["max"] or props["step"] <= 0:
                found.append(f"slider {props['label']}: {value} of {props}")
    return found


def _walk(value: Any, path: str) -> Iterator[tuple[str, Any]]:
    yield path, value
    if isinstance(value, dict):
        for key, inner in cast(dict[str, Any], value).items():
            yield from _walk(inner, f"{path}.{key}")
    elif isinstance(value, list | tuple):
        for number, inner in enumerate(cast(list[Any], value)):
            yield from _walk(inner, f"{path}[{number}]")


def _fault(path: str, value: Any) -> str:
    name = path.rpartition(".")[2]
    if isinstance(value, float) and not -LARGEST < value < LARGEST:
        return f"{value} is not finite in a browser"
    if isinstance(value, str):
        return _fault_of_text(value)
    if isinstance(value, bytes) and name in ARRAYS:
        array = np.frombuffer(value, np.float32)
        return "" if np.isfinite(array).all() else "an array is not finite"
    if name == "options" and isinstance(value, list):
        options = cast(list[str], value)
        return "" if len(set(options)) == len(options) else "an option twice"
    if name == "wxyz" and isinstance(value, list | tuple):
        length = math.hypot(*cast(list[float], value))
        return "" if abs(length - 1) < 1e-3 else f"a quaternion of length {length}"
    return ""


def _fault_of_text(text: str) -> str:
    try:
        text.encode("utf-8")
    except UnicodeEncodeError:
        return "a lone surrogate"
    return ""
