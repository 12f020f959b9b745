"""Reading long lists of numbers quickly, as (rows, width) tables."""

from __future__ import annotations

from typing import TypeVar

import numpy as np
import numpy.typing as npt

_Number = TypeVar("_Number", bound=np.generic)
_BLANK = b" \t\r\n\f\v"
_WHOLE = b"0123456789+-" + _BLANK
_DECIMAL = _WHOLE + b".eE"


def parse_floats(text: bytes) -> npt.NDArray[np.float32] | None:
    """Read numbers separated by blanks; None when something else is among them."""
    try:
        # Numpy's own reader is quicker, but older releases only warn about what
        # they do not understand ("nan" included).
        if text.translate(None, _DECIMAL):
            return np.fromiter(map(float, text.split()), dtype=np.float32)
        return _numpy_reader(text, np.float32)
    except ValueError:
        return None


def parse_ints(text: bytes) -> npt.NDArray[np.int64] | None:
    """Read whole numbers separated by blanks; None when others are among them."""
    if text.translate(None, _WHOLE):
        return None
    try:
        return _numpy_reader(text, np.int64)
    except ValueError:
        return None


def _numpy_reader(text: bytes, dtype: type[_Number]) -> npt.NDArray[_Number]:
    if not text.strip():
        return np.empty(0, dtype=dtype)
    return np.fromstring(text, dtype=dtype, sep=" ")


def triples(count: int) -> npt.NDArray[np.int64]:
    """Return the numbers 0 1 2, 3 4 5, … as (count, 3)."""
    return np.reshape(np.arange(3 * count, dtype=np.int64), (count, 3))


def table_of(values: npt.NDArray[_Number], width: int) -> npt.NDArray[_Number]:
    """Return the values as (rows, width); an incomplete last row is dropped."""
    rows = len(values) // width
    return np.reshape(values[: rows * width], (rows, width))
