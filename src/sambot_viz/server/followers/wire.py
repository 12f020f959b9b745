"""Messages from a server that broadcasts to its followers.

The origin publishes each packed frame of the scene, and each message of the rows, under
consecutive numbers. A follower that lacks a number asks for a snapshot: the content
that a newly opened page gets, with the number of the last frame in it.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal

import msgspec
import viser

from sambot_viz._version import __version__

VERSION = f"{__version__}-viser{viser.__version__}"
"""Both ends need the same version, as rows and scene may differ between versions."""
Part = Literal["scene", "rows"]


class Label(msgspec.Struct, array_like=True, frozen=True):
    """Describes a published frame.

    Attributes:
        origin: identifies the publisher; it changes with each start.
        number: the last frame's number plus one.
        part: part of the content that the frame belongs to.
    """

    origin: str
    number: int
    part: Part

    def packed(self) -> bytes:
        """Encode the label for its frame."""
        return msgspec.msgpack.encode(self)


class Snapshot(msgspec.Struct, array_like=True, frozen=True):
    """The content that a newly opened page gets.

    Attributes:
        origin: identifies the publisher.
        number: number of the last frame in it.
        url: address of the origin's page, without secrets.
        scene: packed frames.
        rows: messages of the page's own channel, each JSON or packed.
    """

    origin: str
    number: int
    url: str
    scene: Sequence[bytes]
    rows: Sequence[bytes]

    def packed(self) -> bytes:
        """Encode the snapshot for sending."""
        return msgspec.msgpack.encode(self)


class OriginPage(msgspec.Struct, frozen=True):
    """Describes the page of an origin, for an index of robots.

    Attributes:
        url: address of the page, without secrets; "" for none.
        state: state of the server.
    """

    url: str
    state: Literal["waiting", "ready", "stopping"]

    def packed(self) -> bytes:
        """Encode the description for sending."""
        return msgspec.msgpack.encode(self)


_LABELS = msgspec.msgpack.Decoder(Label)
_SNAPSHOTS = msgspec.msgpack.Decoder(Snapshot)
_PAGES = msgspec.msgpack.Decoder(OriginPage)


def label_of(attached: bytes) -> Label | None:
    """Decode the label of a frame; None for one from an unknown publisher."""
    try:
        return _LABELS.decode(attached)
    except msgspec.DecodeError:
        return None


def snapshot_of(content: bytes) -> Snapshot | None:
    """Decode a snapshot; None for one from an unknown publisher."""
    try:
        return _SNAPSHOTS.decode(content)
    except msgspec.DecodeError:
        return None


def page_of(content: bytes) -> OriginPage | None:
    """Decode the description of a page; None for one from an unknown publisher."""
    try:
        return _PAGES.decode(content)
    except msgspec.DecodeError:
        return None
