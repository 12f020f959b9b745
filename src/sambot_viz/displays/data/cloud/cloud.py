"""Points with their fields, out of the messages that bring them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import numpy.typing as npt

from sambot_viz.displays.data.refused_messages import MessageRefused
from sambot_viz.displays.picking.rays import Indices
from sambot_viz.topics.contents.clouds import (
    POINT_TYPES,
    channels_fault,
    cloud_fault,
)
from sambot_viz.topics.decoding import numbers_of

Points = npt.NDArray[np.float32]
Values = npt.NDArray[Any]


@dataclass(frozen=True, slots=True)
class Cloud:
    """Points, each with a value of every field; none is infinite or NaN.

    Attributes:
        points: (N, 3) float32 [m], in the frame of the message.
        fields: name → (N,) values, x, y and z left out.
        names: of all fields, in the order of the message; x, y and z first without.
        kept: (N,), the numbers of the points in the message; None for all of it.
    """

    points: Points
    fields: Mapping[str, Values] = field(default_factory=dict[str, Values])
    names: Sequence[str] = ()
    kept: Indices | None = None

    @property
    def numbers(self) -> Indices:
        """The numbers of the points in the message, (N,)."""
        return np.arange(len(self.points)) if self.kept is None else self.kept

    def rows_of(self, numbers: Indices) -> Indices:
        """Return where points are here, from their numbers in the message."""
        return numbers if self.kept is None else np.searchsorted(self.kept, numbers)

    def number_of(self, name: str) -> int:
        """Return the number of a field in the message."""
        return [*(self.names or (*"xyz", *self.fields))].index(name)


def finite_cloud(
    points: Points, fields: Mapping[str, Values], names: Sequence[str] = ()
) -> Cloud:
    """Return a cloud without the points that are nowhere.

    Args:
        points: (N, 3) float32 [m].
        fields: name → (N,) values.
        names: as of `Cloud`.
    """
    if np.isfinite(points).all():
        return Cloud(points, fields, names)
    kept = np.isfinite(points).all(axis=1)
    some = {name: values[kept] for name, values in fields.items()}
    return Cloud(points[kept], some, names, np.flatnonzero(kept))


def cloud_of_cloud2(message: Any) -> Cloud:
    """Return the points of a sensor_msgs/PointCloud2, as RViz reads them.

    The length of a row is not looked at. RViz does not look at the byte order either.

    Raises:
        MessageRefused: its data has another size than it says, or x, y and z are no
            32-bit floats.
    """
    if fault := cloud_fault(message):
        raise MessageRefused(fault)
    step, count = int(message.point_step), int(message.width) * int(message.height)
    data, order = np.frombuffer(message.data, np.uint8), "<>"[message.is_bigendian]
    rows: npt.NDArray[np.uint8] = np.reshape(data, (count, step))
    found: dict[str, Values] = {}
    for one in message.fields:
        kind, offset = POINT_TYPES.get(int(one.datatype)), int(one.offset)
        if kind is not None and 0 <= offset <= step - np.dtype(kind).itemsize:
            found[str(one.name)] = _column(rows, offset, order + kind)
    points = np.stack([found.pop(axis) for axis in "xyz"], axis=1)
    names = [str(one.name) for one in message.fields]
    return finite_cloud(points.astype(np.float32, copy=False), found, names)


def _column(rows: npt.NDArray[np.uint8], offset: int, kind: str) -> Values:
    """Return the values of a field, (N,): a view of the rows."""
    count, step = rows.shape
    shape: Any = {
        "names": ["value"],
        "formats": [kind],
        "offsets": [offset],
        "itemsize": step,
    }
    return np.ndarray((count,), np.dtype(shape), rows)["value"]


def cloud_of_cloud(message: Any) -> Cloud:
    """Return the points of a sensor_msgs/PointCloud, the older kind of message.

    Raises:
        MessageRefused: a channel has not a value for each point.
    """
    if fault := channels_fault(message):
        raise MessageRefused(fault)
    with np.errstate(over="ignore"):
        points = numbers_of(message.points, "x", "y", "z").astype(np.float32)
    fields: dict[str, Values] = {}
    for channel in message.channels:
        fields[str(channel.name)] = np.asarray(channel.values, np.float32)
    return finite_cloud(points, fields)
