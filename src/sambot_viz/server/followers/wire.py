"""What goes from a server that broadcasts to those that follow it.

The origin publishes each packed frame of the scene, and each message of the rows, with
a number that is one more than the last. A follower that lacks one asks for a snapshot:
what a page gets that is opened now, and the number up to which it holds.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal

import msgspec
import viser

from sambot_viz._version import __version__

VERSION = f"{__version__}-viser{viser.__version__}"
"""Both have the same, as the rows and the scene of another version may be others."""
Part = Literal["scene", "rows"]


class Label(msgspec.Struct, array_like=True, frozen=True):
    """Says what a published frame is.

    Attributes:
        origin: who has published it; another one after each start.
        number: one more than that of the last frame.
        part: what it is of.
    """

    origin: str
    number: int
    part: Part

    def packed(self) -> bytes:
        """Return it as it is attached."""
        return msgspec.msgpack.encode(self)


class Snapshot(msgspec.Struct, array_like=True, frozen=True):
    """What a page gets that is opened now.

    Attributes:
        origin: whose it is.
        number: of the last frame that it holds.
        url: where the page of the origin is, without anything secret.
        scene: packed frames.
        rows: messages of the page's own channel, each JSON or packed.
    """

    origin: str
    number: int
    url: str
    scene: Sequence[bytes]
    rows: Sequence[bytes]

    def packed(self) -> bytes:
        """Return it as it is sent."""
        return msgspec.msgpack.encode(self)


_LABELS = msgspec.msgpack.Decoder(Label)
_SNAPSHOTS = msgspec.msgpack.Decoder(Snapshot)


def label_of(attached: bytes) -> Label | None:
    """Return what is said of a frame; None for what a stranger has published."""
    try:
        return _LABELS.decode(attached)
    except msgspec.DecodeError:
        return None


def snapshot_of(content: bytes) -> Snapshot | None:
    """Return a snapshot; None for what a stranger has answered."""
    try:
        return _SNAPSHOTS.decode(content)
    except msgspec.DecodeError:
        return None
