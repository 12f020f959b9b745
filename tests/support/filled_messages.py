"""Messages of any type, with the fields that a test gives; all others are zero."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import cache
from typing import Any

import numpy as np
from data_loads import UPDATE

MAP_UPDATE = "map_msgs/msg/OccupancyGridUpdate"
DEFINITIONS = {MAP_UPDATE: UPDATE}
"""Of the types that rosbags lacks."""
Make = Callable[[Any], tuple[str, str, object]]


@cache
def _store() -> Any:
    from rosbags.typesys import Stores, get_types_from_msg, get_typestore

    store = get_typestore(Stores.ROS2_JAZZY)
    store.register(get_types_from_msg(UPDATE, MAP_UPDATE))
    return store


def filled(name: str, /, **fields: Any) -> Any:
    """Return a message; a field that is a message is given as a dictionary."""
    made: list[Any] = []
    for field, (kind, what) in _store().fielddefs[name][1]:
        given = fields.get(field)
        if kind == 1:
            made.append(_scalar(what[0]) if given is None else given)
        elif kind == 2:
            made.append(filled(what, **(given or {})))
        else:
            (inner, of), count = what
            values: Sequence[Any] = [] if given is None else given
            if int(inner) == 2:
                made.append([filled(of, **one) for one in values])
            elif of[0] == "string":
                made.append(list(values))
            else:
                # Those of a fixed length are all zero without.
                blank = [0] * (count if kind == 3 else 0)
                dtype = {"bool": "bool_", "byte": "int8", "char": "uint8"}.get(of[0])
                numbers = values if given is not None else blank
                made.append(np.array(numbers, dtype or of[0]))
    return _store().types[name](*made)


def _scalar(name: str) -> Any:
    return "" if name == "string" else False if name == "bool" else 0


def on_topic(name: str, topic: str = "/a", frame: str = "map", **fields: Any) -> Make:
    """Return what the fixture `messages` opens: a message of a frame on a topic."""

    def make(types: Any) -> tuple[str, str, object]:
        del types
        return topic, name, filled(name, header={"frame_id": frame}, **fields)

    return make


def xyz(x: float, y: float = 0.0, z: float = 0.0) -> Mapping[str, float]:
    """Return a geometry_msgs/Point or Vector3."""
    return {"x": float(x), "y": float(y), "z": float(z)}


def pose(x: float, y: float = 0.0, z: float = 0.0) -> Mapping[str, Any]:
    """Return a geometry_msgs/Pose that is not turned."""
    return {"position": xyz(x, y, z), "orientation": {"w": 1.0}}


def cloud2(points: Any, frame: str = "map", **fields: Any) -> Make:
    """Return a sensor_msgs/PointCloud2 with some fields beside x, y and z."""
    columns = {axis: np.asarray(points)[:, i] for i, axis in enumerate("xyz")}
    columns = {n: np.asarray(v, np.float32) for n, v in columns.items()} | fields
    rows = np.rec.fromarrays(list(columns.values()), names=list(columns))
    kinds = {"int8": 1, "uint8": 2, "int16": 3, "uint16": 4, "int32": 5, "uint32": 6}
    kinds |= {"float32": 7, "float64": 8}
    described = [
        {
            "name": name,
            "offset": rows.dtype.fields[name][1],
            "datatype": kinds[str(values.dtype)],
            "count": 1,
        }
        for name, values in columns.items()
    ]
    return on_topic(
        "sensor_msgs/msg/PointCloud2",
        frame=frame,
        height=1,
        width=len(rows),
        fields=described,
        point_step=rows.dtype.itemsize,
        row_step=rows.nbytes,
        data=np.frombuffer(rows.tobytes(), np.uint8),
        is_dense=True,
    )
