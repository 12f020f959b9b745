"""The viser messages that a client may send: their fields, types and limits.

The names are viser's. Messages that are not in this list are refused.
"""

from __future__ import annotations

import math
from typing import Annotated, Any, Literal

import msgspec

SHORTEST = 1e-6
"""Shortest distance from a camera to its target [m], and length of its up direction."""
_Number = Annotated[float, msgspec.Meta(ge=-1e9, le=1e9)]
_Vector = tuple[_Number, _Number, _Number]
_Pixels = Annotated[int, msgspec.Meta(ge=0, le=2**15)]
_Id = Annotated[str, msgspec.Meta(max_length=100)]


class _Message(msgspec.Struct, tag_field="type", forbid_unknown_fields=True):
    """A message that a client may send."""


class CameraMoved(_Message, tag="ViewerCameraMessage"):
    """The pose of a client's camera."""

    wxyz: tuple[_Number, _Number, _Number, _Number]
    position: _Vector
    fov: _Number
    near: _Number
    far: _Number
    image_height: _Pixels
    image_width: _Pixels
    look_at: _Vector
    up_direction: _Vector

    def shows_a_direction(self) -> bool:
        """Return whether a picture can be drawn; viser raises on other poses."""
        # The difference must survive a shift of both points by the same amount again.
        shortest = SHORTEST + max(map(abs, self.position)) * 1e-12
        away = math.dist(self.position, self.look_at)
        return away > shortest and math.hypot(*self.up_direction) > SHORTEST


class CameraReport(msgspec.Struct, forbid_unknown_fields=True):
    """The pose of a page's camera, relative to the frame that its view follows.

    It comes on the page's own channel, in JSON.

    Attributes:
        camera: number of the last camera that the server has requested.
        position: position of the camera [m].
        look_at: point in the middle of its picture [m].
        up: up direction of the picture.
        fov: vertical field of view [rad].
        scale: pixels per metre of a camera that looks straight down; None for others.
    """

    camera: int
    position: _Vector
    look_at: _Vector
    up: _Vector
    fov: Annotated[float, msgspec.Meta(gt=0.0, lt=math.pi)]
    scale: Annotated[float, msgspec.Meta(gt=0.0, le=1e9)] | None


class SetValue(_Message, tag="GuiUpdateMessage"):
    """A user has moved a widget, or pressed a button."""

    uuid: _Id
    updates: dict[str, Any]


class Point(_Message, tag="ScenePointerMessage"):
    """A click or a rectangle in the 3D view."""

    event_type: Literal["click", "rect-select"]
    ray_origin: _Vector | None
    ray_direction: _Vector | None
    screen_pos: Annotated[
        list[tuple[_Number, _Number]], msgspec.Meta(min_length=1, max_length=2)
    ]
    modifier: _Id | None


class PictureDrawn(_Message, tag="GetRenderResponseMessage"):
    """The picture that the server has requested from this client."""

    payload: bytes
    render_uuid: _Id


ClientMessage = CameraMoved | SetValue | Point | PictureDrawn
_DECODER = msgspec.msgpack.Decoder(ClientMessage)


def decode(raw: bytes) -> ClientMessage | None:
    """Decode the message in a websocket frame; None for messages not in this list."""
    try:
        return _DECODER.decode(raw)
    except (msgspec.MsgspecError, UnicodeDecodeError, RecursionError):
        return None
