"""Messages as they are decoded, and what that takes."""

from __future__ import annotations

import sys
from collections.abc import Callable
from typing import Any

import numpy as np

from sambot_viz.messages import Decoder, MessageTypes, Rows, Schema


def decoder_of(store: Any, name: str, encoding: str = "cdr") -> Decoder:
    ros = 1 if encoding == "ros1" else 2
    text, _ = store.generate_msgdef(name, ros_version=ros)
    return MessageTypes().decoder(Schema(name, f"ros{ros}msg", text), encoding)


def values_of(message: Any) -> Any:
    """The fields of a message as lists and numbers."""
    if hasattr(message, "__dataclass_fields__"):
        names = [name for name in message.__dataclass_fields__ if name.islower()]
        plain = [name for name in names if not name.startswith("__")]
        return {name: values_of(getattr(message, name)) for name in plain}
    if isinstance(message, list | Rows):
        return [values_of(one) for one in message]
    return message.tolist() if isinstance(message, np.ndarray) else message


def calls_of(action: Callable[[], object]) -> int:
    """How many functions of Python are called."""
    count = 0

    def note(frame: object, event: str, argument: object) -> None:
        nonlocal count
        count += event == "call"

    sys.setprofile(note)
    try:
        action()
    finally:
        sys.setprofile(None)
    return count
