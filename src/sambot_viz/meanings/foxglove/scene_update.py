"""A foxglove.SceneUpdate as markers: an entity is a namespace with its primitives."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence, Sized
from typing import Any

import numpy as np

from sambot_viz.errors import DecodeError
from sambot_viz.meanings.foxglove.common_parts import (
    color_of,
    header_of,
    part,
    parts,
    pose_of,
    time_of,
)
from sambot_viz.meanings.schema_row import Fields
from sambot_viz.messages.shape import real_number, whole_number

_ARROW, _CUBE, _SPHERE, _CYLINDER, _LINE_STRIP, _LINE_LIST = range(6)
_TEXT, _MESH, _TRIANGLES = range(9, 12)
_DELETE_ALL = 3
"""Types and actions of a visualization_msgs/Marker."""
_ALL = 1
"""The deletion of all entities."""
_LINE_LOOP, _PAIRS = 1, 2
"""Types of lines that are not strips."""
_NAMELESS = "(no id)"
"""The namespace of entities with an empty id: none would mean all of them."""
_PIXEL = 0.005
"""Size in metres drawn for each pixel, because markers have no pixels."""
_SIDES = 24


def markers(fields: Fields) -> Fields:
    """Return a foxglove.SceneUpdate as a visualization_msgs/MarkerArray."""
    found = [_deletion(one) for one in parts(fields, "deletions")]
    for entity in parts(fields, "entities"):
        found += _markers_of(entity)
    return {"markers": found}


def _deletion(fields: Fields) -> Fields:
    is_all = whole_number(fields.get("type")) == _ALL
    return {"action": _DELETE_ALL, "ns": "" if is_all else _name(fields)}


def _name(fields: Fields) -> Any:
    return fields.get("id") or _NAMELESS


def _markers_of(entity: Fields) -> Iterator[Fields]:
    """Yield what takes the place of all that an entity had before."""
    common = {
        "header": header_of(entity),
        "ns": _name(entity),
        "lifetime": time_of(entity.get("lifetime")),
        "frame_locked": entity.get("frame_locked"),
    }
    yield {**common, "action": _DELETE_ALL}
    number = 0
    for name, look in _PRIMITIVES.items():
        for primitive in parts(entity, name):
            pose, color = part(primitive, "pose"), part(primitive, "color")
            marker = {"pose": pose_of(pose), "color": color_of(color)}
            yield {**common, "id": number, **marker, **look(primitive)}
            number += 1


def _arrow(fields: Fields) -> Fields:
    shaft, head = (real_number(fields.get(f"{n}_length")) for n in ("shaft", "head"))
    return {
        "type": _ARROW,
        "points": [{}, {"x": shaft + head}],
        "scale": {
            "x": fields.get("shaft_diameter"),
            "y": fields.get("head_diameter"),
            "z": head,
        },
    }


def _cube(fields: Fields) -> Fields:
    return {"type": _CUBE, "scale": part(fields, "size")}


def _sphere(fields: Fields) -> Fields:
    return {"type": _SPHERE, "scale": part(fields, "size")}


def _cylinder(fields: Fields) -> Fields:
    ends = [real_number(fields.get(f"{end}_scale")) for end in ("bottom", "top")]
    size = part(fields, "size")
    if ends[0] == ends[1]:
        return {"type": _CYLINDER, "scale": size}
    return {
        "type": _TRIANGLES,
        "scale": {"x": 1, "y": 1, "z": 1},
        "points": _cone(size or {}, *ends),
    }


def _cone(size: Fields, bottom: float, top: float) -> list[Fields]:
    """Return the corners of the triangles of a cone, or of a part of one [m]."""
    around = np.linspace(0, 2 * np.pi, _SIDES + 1)
    x, y, z = (real_number(size.get(axis)) / 2 for axis in "xyz")
    ring = np.stack([x * np.cos(around), y * np.sin(around)], axis=1)
    found: list[Fields] = []

    def corner(number: int, scale: float, height: float) -> Fields:
        at = ring[number] * scale
        return {"x": float(at[0]), "y": float(at[1]), "z": height}

    for one in range(_SIDES):
        low = [corner(one, bottom, -z), corner(one + 1, bottom, -z)]
        high = [corner(one, top, z), corner(one + 1, top, z)]
        found += [low[0], low[1], high[1], low[0], high[1], high[0]]
        found += [low[1], low[0], {"z": -z}, high[0], high[1], {"z": z}]
    return found


def _line(fields: Fields) -> Fields:
    kind = whole_number(fields.get("type"))
    points, colors = _by_index(fields)
    if kind == _LINE_LOOP:
        points, colors = [*points, *points[:1]], [*colors, *colors[:1]]
    return {
        "type": _LINE_LIST if kind == _PAIRS else _LINE_STRIP,
        "scale": {"x": _size(fields, "thickness")},
        "points": points,
        "colors": colors,
    }


def _triangles(fields: Fields) -> Fields:
    points, colors = _by_index(fields)
    scale = {"x": 1, "y": 1, "z": 1}
    return {"type": _TRIANGLES, "scale": scale, "points": points, "colors": colors}


def _by_index(fields: Fields) -> tuple[Sequence[Fields], Sequence[Fields]]:
    """Return points and colours in the order in which they are used.

    Raises:
        DecodeError: an index is out of range.
    """
    points, colors = parts(fields, "points"), parts(fields, "colors")
    indices = fields.get("indices")
    if not isinstance(indices, Sized) or not len(indices):
        return points, colors
    used = [whole_number(one) for one in _listed(indices)]
    if min(used) < 0 or max(used) >= len(points):
        raise DecodeError(f"indices: there are {len(points)} points")
    if colors and len(colors) != len(points):
        raise DecodeError(f"{len(colors)} colors for {len(points)} points")
    return [points[one] for one in used], [colors[one] for one in used if colors]


def _listed(indices: Any) -> Sequence[Any]:
    return indices.tolist() if isinstance(indices, np.ndarray) else indices


def _size(fields: Fields, name: str) -> float:
    """Return a size [m], which may be given in pixels."""
    size = real_number(fields.get(name))
    return size * _PIXEL if fields.get("scale_invariant") else size


def _text(fields: Fields) -> Fields:
    size = {"z": _size(fields, "font_size")}
    return {"type": _TEXT, "scale": size, "text": fields.get("text")}


def _model(fields: Fields) -> Fields:
    keeps = not fields.get("override_color")
    found: dict[str, Any] = {
        "type": _MESH,
        "scale": part(fields, "scale") or {"x": 1, "y": 1, "z": 1},
        "mesh_resource": fields.get("url"),
        "mesh_use_embedded_materials": keeps,
    }
    return {**found, "color": {"r": 0, "g": 0, "b": 0, "a": 0}} if keeps else found


_PRIMITIVES: Mapping[str, Callable[[Fields], Fields]] = {
    "arrows": _arrow,
    "cubes": _cube,
    "spheres": _sphere,
    "cylinders": _cylinder,
    "lines": _line,
    "triangles": _triangles,
    "texts": _text,
    "models": _model,
}
"""The primitives of an entity, in the order of their numbers."""
