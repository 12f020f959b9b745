"""Explain why there is no connection, in one sentence with the remedy."""

from __future__ import annotations

import errno
import re
import socket
import ssl

from websockets.exceptions import (
    ConnectionClosed,
    InvalidHandshake,
    InvalidMessage,
    InvalidStatus,
)

from sambot_viz import limits
from sambot_viz.sources.live.address import PORTS, Address
from sambot_viz.text import text

START = {
    "foxglove": "`ros2 launch foxglove_bridge foxglove_bridge_launch.xml`",
    "rosbridge": "`ros2 launch rosbridge_server rosbridge_websocket_launch.xml`",
    "zenoh": "`ros2 run rmw_zenoh_cpp rmw_zenohd`",
}
"""Protocol → the command that starts its server on the robot."""
_ROUTER = "`zenohd`"
"""The command that starts a router for broadcasts, which needs no ROS."""
_WHAT = {"foxglove": "bridge", "rosbridge": "bridge", "zenoh": "router"}

_NO_WAY = {errno.EHOSTUNREACH, errno.ENETUNREACH, errno.EHOSTDOWN, errno.ENETDOWN}
_TOO_BIG = 1009


class WrongServer(Exception):
    """The connection is there, but the server speaks another protocol."""


class NewSession(Exception):
    """The server has started again on the same connection."""


def explain(error: BaseException, address: Address) -> str:
    """Return the sentence for an error, without a full stop."""
    place = address.label
    if isinstance(error, WrongServer | NewSession):
        return str(error)
    if isinstance(error, InvalidStatus):
        return _refused(error, address)
    if isinstance(error, ConnectionClosed):
        return _lost(error, place)
    if isinstance(error, ssl.SSLError | ssl.CertificateError):
        return _tls(error, address)
    if isinstance(error, socket.gaierror | UnicodeError):
        return (
            f"The name {text(address.host, 80)} is not known here: write the robot's "
            "number instead, such as 192.168.1.5, or add the name to /etc/hosts"
        )
    if isinstance(error, InvalidMessage | EOFError):
        return _not_a_websocket(address)
    if isinstance(error, InvalidHandshake):
        return f"{place} is not usable: {text(error, 200)}"
    if isinstance(error, OSError):
        return _unreachable(error, address)
    return f"{place} is not usable: {text(error or type(error).__name__, 200)}"


def other_protocol(address: Address) -> str:
    """Return the address to write when the server speaks the other protocol."""
    other = next(name for name in PORTS if name != address.protocol)
    return f"--source {address.with_protocol(other)}"


def _refused(error: InvalidStatus, address: Address) -> str:
    place, code = address.label, error.response.status_code
    if code in (401, 403, 407):
        return (
            f"{place} asks who you are ({code}): put the token or the password into "
            f"the address, {address.protocol}://HOST/?token=… or "
            f"{address.protocol}://USER:PASSWORD@HOST"
        )
    if code == 404:
        return (
            f"{place} has no websocket at this path (404): write the path that its "
            f"proxy forwards, such as {address.with_protocol(address.protocol)}/PATH"
        )
    if code in (400, 426) and address.protocol == "rosbridge":
        return (
            f"{place} refuses rosbridge's protocol ({code}): if foxglove_bridge runs "
            f"there, {other_protocol(address)}"
        )
    if code in (400, 426):
        return (
            f"{place} refuses Foxglove's protocol ({code}): if rosbridge runs there, "
            f"{other_protocol(address)}; else update foxglove_bridge"
        )
    if code in (502, 503, 504):
        return (
            f"The proxy at {place} reaches no server ({code}): start the one behind it "
            f"with {START[address.protocol]}"
        )
    return (
        f"{place} answers, but not as a websocket ({code}): "
        f"is {address.port} the port of {address.protocol}?"
    )


def _lost(error: ConnectionClosed, place: str) -> str:
    ours, theirs = error.sent, error.rcvd
    if ours is not None and ours.code == _TOO_BIG:
        # "frame with 300000000 bytes exceeds limit of …", when it says its size.
        size = re.search(r"with (\d+) bytes", ours.reason)
        said = limits.MESSAGE.said(int(size[1])) if size else "too many bytes"
        return f"{place} sent a message of {said}"
    if theirs is None and ours is not None:
        what = text(ours.reason, 120) or "it no longer answers"
        return f"{place} was left: {what}"
    if theirs is None:
        return f"{place} is gone, in the middle of the connection"
    reason = text(theirs.reason, 120)
    return f"{place} has ended the connection" + (f": {reason}" if reason else "")


_WITH_TLS = {
    "foxglove": "tls:=true certfile:=FILE keyfile:=FILE",
    "rosbridge": "ssl:=true certfile:=FILE keyfile:=FILE",
}
"""The arguments of the launch files with which bridges speak TLS."""


def _tls(error: Exception, address: Address) -> str:
    place, words = address.label, str(error)
    if isinstance(error, ssl.SSLCertVerificationError):
        reason = text(error.verify_message or words, 120)
        return (
            f"The certificate of {place} is not trusted ({reason}): start sambot-viz "
            "with SSL_CERT_FILE=FILE, the certificate of who has signed it"
        )
    if "WRONG_VERSION" in words or "UNEXPECTED_EOF" in words or "RECORD" in words:
        return f"{place} does not speak TLS: {address.with_tls(False)}"
    return f"No TLS connection to {place}: {text(words, 160)}"


def _not_a_websocket(address: Address) -> str:
    place = address.label
    tls = (
        ""
        if address.is_secure
        else f"; if it does so with TLS, {address.with_tls(True)}"
    )
    return (
        f"{place} does not speak websocket: "
        f"is {address.port} the port of {address.protocol}{tls}"
    )


def _unreachable(error: OSError, address: Address) -> str:
    place = address.label
    start = _ROUTER if address.name else START[address.protocol]
    what = _WHAT[address.protocol]
    # When a name has several addresses, asyncio joins their errors to a text.
    codes = {int(code) for code in re.findall(r"\[Errno (\d+)\]", str(error))}
    codes.add(error.errno or 0)
    if isinstance(error, ConnectionRefusedError) or errno.ECONNREFUSED in codes:
        return f"Nothing listens at {place}: start the {what} there with {start}"
    if codes & _NO_WAY:
        return (
            f"There is no way to {place}: is this computer in the robot's network, "
            "and is the number right?"
        )
    if isinstance(error, ConnectionResetError | BrokenPipeError):
        if address.is_secure:
            return (
                f"{place} breaks off while it connects: does it speak TLS? Start the "
                f"bridge with {_WITH_TLS[address.protocol]}, or leave TLS out: "
                f"{address.with_tls(False)}"
            )
        return f"{place} breaks off while it connects: is {start} still running there?"
    if isinstance(error, TimeoutError) or errno.ETIMEDOUT in codes:
        return (
            f"{place} does not answer: is the robot switched on, and does its firewall "
            f"let port {address.port} through?"
        )
    return f"{place} cannot be reached: {text(error, 160)}"
