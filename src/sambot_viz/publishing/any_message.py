"""A message of any type, as a program gives it."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, cast

from sambot_viz.errors import PublishError

_QUATERNION = set("xyzw")
_UNIT = 1e-3


@dataclass(frozen=True, slots=True)
class AnyMessage:
    """The fields of a message; those that are left out are zero.

    Attributes:
        type_name: of the message.
        content: the fields; a header without a stamp gets the time of the robot.

    Raises:
        PublishError: a number that is not finite, or a quaternion that is not one.
    """

    type_name: str
    content: dict[str, Any]

    def __post_init__(self) -> None:
        _check(self.content, self.type_name)

    def fields(self, stamp: object) -> dict[str, Any]:
        """Return the fields of the message.

        Args:
            stamp: its time, as the transport wants it (see `written.written`).
        """
        header = self.content.get("header")
        if not isinstance(header, Mapping):
            return self.content
        return {**self.content, "header": {"stamp": stamp, **header}}


def _check(value: object, place: str) -> None:
    """Refuse numbers that receivers cannot take."""
    if isinstance(value, float) and not math.isfinite(value):
        raise PublishError(f"{place} needs a finite number, not {value}")
    if isinstance(value, Mapping):
        fields = cast("Mapping[str, Any]", value)
        for name, one in fields.items():
            _check(one, f"{place}.{name}")
        numbers = [one for one in fields.values() if isinstance(one, int | float)]
        if set(fields) == _QUATERNION and len(numbers) == len(fields):
            norm = math.hypot(*numbers)
            if abs(norm - 1.0) > _UNIT:
                raise PublishError(
                    f"{place} needs a quaternion of length 1, not {norm:g}"
                )
    elif isinstance(value, Sequence) and not isinstance(value, str | bytes):
        for number, one in enumerate(cast("Sequence[object]", value)):
            _check(one, f"{place}[{number}]")
