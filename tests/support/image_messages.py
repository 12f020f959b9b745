"""Messages with pictures, for `messages` of tests of displays."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import numpy.typing as npt

Make = Callable[[Any], tuple[str, str, object]]


def octets(*values: int) -> npt.NDArray[np.uint8]:
    return np.array(values, np.uint8)


def raw(
    encoding: str,
    data: npt.NDArray[Any],
    width: int = 2,
    height: int = 1,
    step: int = 0,
    big: bool = False,
) -> Make:
    """Make a sensor_msgs/Image on /a."""

    def make(types: Any) -> tuple[str, str, object]:
        name = "sensor_msgs/msg/Image"
        sent = np.frombuffer(data.tobytes(), np.uint8)
        size = (height, width, encoding, int(big), step)
        return "/a", name, types[name](_header(types), *size, sent)

    return make


def file_message(data: bytes, of: str = "jpeg") -> Make:
    """Make a sensor_msgs/CompressedImage on /a."""

    def make(types: Any) -> tuple[str, str, object]:
        name = "sensor_msgs/msg/CompressedImage"
        sent = np.frombuffer(data, np.uint8)
        return "/a", name, types[name](_header(types), of, sent)

    return make


def _header(types: Any) -> object:
    stamp = types["builtin_interfaces/msg/Time"](0, 0)
    return types["std_msgs/msg/Header"](stamp, "camera")
