"""Ends a connection that floods the server below what is counted as messages.

The websockets library answers a ping as soon as it arrives, however many answers wait
to be read, and collects the parts of a message, however many of them are empty.
Browsers send neither pings nor messages in small parts.
"""

from __future__ import annotations

from websockets.asyncio.server import ServerConnection
from websockets.exceptions import ProtocolError
from websockets.frames import CTRL_OPCODES, Frame, Opcode

from sambot_viz.server.rate import Rate

SMALL = 1000
"""The size of larger parts is limited with that of their message [bytes]."""
PER_SECOND = 10.0
"""The answers to the pings of the server itself are three in a minute."""
BURST = 100.0


def limit_frames(connection: ServerConnection) -> None:
    """Close a connection when it sends too many pings, pongs or small parts."""
    protocol, rate = connection.protocol, Rate(PER_SECOND, BURST)
    take = protocol.recv_frame

    def recv_frame(frame: Frame) -> None:
        part = frame.opcode is Opcode.CONT or frame.opcode in CTRL_OPCODES
        if part and len(frame.data) < SMALL and rate.take() > 0.0:
            raise ProtocolError("too many small frames")
        take(frame)

    protocol.recv_frame = recv_frame  # type: ignore[method-assign]
