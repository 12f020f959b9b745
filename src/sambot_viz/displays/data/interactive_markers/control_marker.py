"""One marker of a control: as it came, completed, or a handle made here."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

from sambot_viz.frames.hierarchy import plain_name
from sambot_viz.geometry import IDENTITY, Wxyz
from sambot_viz.topics.decoding import frame_and_stamp


class Xyz(NamedTuple):
    """A geometry_msgs/Point or Vector3."""

    x: float = 0.0
    y: float = 0.0
    z: float = 0.0


class Turn(NamedTuple):
    """A geometry_msgs/Quaternion."""

    x: float = 0.0
    y: float = 0.0
    z: float = 0.0
    w: float = 1.0


class Pose(NamedTuple):
    """A geometry_msgs/Pose."""

    position: Any = Xyz()
    orientation: Any = Turn()


class Color(NamedTuple):
    """A std_msgs/ColorRGBA."""

    r: float = 1.0
    g: float = 1.0
    b: float = 1.0
    a: float = 1.0


_POSE, _SIZE, _WHITE = Pose(), Xyz(1.0, 1.0, 1.0), Color()


@dataclass(frozen=True, slots=True)
class ControlMarker:
    """The drawn fields of a visualization_msgs/Marker in a control.

    Attributes:
        type: as in the message; so are the other fields of the same name.
        pose: pose in the interactive marker, or in the frame.
        scale: size [m].
        color: colour of the whole marker.
        points: positions [m].
        colors: colours of the points.
        text: the text of a text marker.
        mesh_resource: the file of a mesh.
        mesh_use_embedded_materials: whether a mesh has the colours of its file.
        texture_resource: the texture of triangles, as the two others.
        frame: the frame that it is placed in once; empty for the interactive marker.
        stamp_ns: the time of the look-up of that frame [ns]; None for the latest.
    """

    type: int
    pose: Any = _POSE
    scale: Any = _SIZE
    color: Any = _WHITE
    points: Sequence[Any] = ()
    colors: Sequence[Any] = ()
    text: str = ""
    mesh_resource: str = ""
    mesh_use_embedded_materials: bool = False
    texture_resource: str = ""
    texture: Any = None
    uv_coordinates: Sequence[Any] = ()
    frame: str = ""
    stamp_ns: int | None = None


def control_marker(marker: Any) -> ControlMarker:
    """Return the drawn fields of a message; a scale of 0 counts as 1."""
    scale = marker.scale
    _, stamp_ns = frame_and_stamp(marker)
    return ControlMarker(
        int(marker.type),
        marker.pose,
        Xyz(*(float(v) or 1.0 for v in (scale.x, scale.y, scale.z))),
        marker.color,
        marker.points,
        marker.colors,
        str(marker.text),
        str(marker.mesh_resource),
        bool(marker.mesh_use_embedded_materials),
        str(getattr(marker, "texture_resource", "")),
        getattr(marker, "texture", None),
        getattr(marker, "uv_coordinates", ()),
        plain_name(str(marker.header.frame_id)),
        stamp_ns,
    )


def opaque(marker: ControlMarker) -> ControlMarker:
    """Return a marker without its transparency, if it can be seen at all."""
    color = marker.color
    if not color.a > 0.0:
        return marker
    return replace(marker, color=Color(color.r, color.g, color.b, 1.0))


def turn_of(wxyz: Wxyz = IDENTITY) -> Turn:
    """Return a rotation as a message has it."""
    w, x, y, z = wxyz
    return Turn(x, y, z, w)
