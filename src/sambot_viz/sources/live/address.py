"""Where a live source is: the address that a user writes, and that of its websocket.

A router of zenoh is written in the same way, and has none.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from urllib.parse import SplitResult, parse_qsl, urlsplit

from sambot_viz.errors import UsageError
from sambot_viz.text import text

PORTS = {"foxglove": 8765, "rosbridge": 9090, "zenoh": 7447}
"""Protocol → the port on which its server listens when nothing else is said."""
_SECURE_PORT = 443
_TLS = {"foxglove": "wss", "rosbridge": "wss", "zenoh": "tls"}
_PLAIN = {"foxglove": "ws", "rosbridge": "ws", "zenoh": "tcp"}
"""Protocol → what is written after it, with TLS and without."""
_HIGHEST_DOMAIN = 232
"""Of ROS 2."""


@dataclass(frozen=True, slots=True)
class Address:
    """The address of a server.

    Attributes:
        protocol: "foxglove", "rosbridge" or "zenoh".
        host: name or number of the machine.
        port: TCP port.
        is_secure: spoken through TLS.
        websocket: "ws://robot:8765/path?token=…"; may hold a password. "" of zenoh.
        domain: ROS's domain id, where the address says it.
    """

    protocol: str
    host: str
    port: int
    is_secure: bool
    websocket: str
    domain: int = 0

    @property
    def label(self) -> str:
        """The place without anything secret, for people: "robot:8765"."""
        host = f"[{self.host}]" if ":" in self.host else self.host
        return text(f"{host}:{self.port}", 100)

    def with_protocol(self, protocol: str) -> str:
        """Return what to write for the same place and another protocol."""
        tls = f"+{_TLS[protocol]}" if self.is_secure else ""
        return f"{protocol}{tls}://{self.label}"

    def with_tls(self, is_secure: bool) -> str:
        """Return what to write for the same place with TLS, or without."""
        return replace(self, is_secure=is_secure).with_protocol(self.protocol)


def parse_address(uri: str) -> Address:
    """Read an address such as foxglove://robot:8765/path or zenoh://lab?domain=7.

    ws:// and wss:// stand for Foxglove's protocol.

    Raises:
        UsageError: it names no host, or a port that cannot be.
    """
    scheme, _, _ = uri.partition(":")
    protocol, _, transport = scheme.lower().partition("+")
    if protocol in ("ws", "wss"):
        protocol, transport = "foxglove", protocol
    if protocol not in PORTS or transport not in (
        "",
        _PLAIN[protocol],
        _TLS[protocol],
    ):
        raise UsageError(f"{text(uri)}: unknown kind of source '{text(scheme)}'")
    is_secure = transport == _TLS[protocol]
    has_websocket = protocol != "zenoh"
    usual = _SECURE_PORT if is_secure and has_websocket else PORTS[protocol]
    example = f"write {scheme}://HOST:{usual}"
    try:
        parts = urlsplit(uri)
        host, port = parts.hostname or "", parts.port or usual
    except ValueError as error:
        why = "this is no host and port from 1 to 65535"
        raise UsageError(f"{text(uri)}: {why}; {example}") from error
    if not host or not parts.netloc or not _is_plain(parts.path + parts.query):
        raise UsageError(f"{text(uri)}: no host is named; {example}")
    if not has_websocket:
        return Address(protocol, host, port, is_secure, "", _domain(uri, parts.query))
    websocket = _websocket(parts, is_secure, host, port)
    return Address(protocol, host, port, is_secure, websocket)


def _domain(uri: str, query: str) -> int:
    """Return the domain id in the part behind the question mark."""
    said = dict(parse_qsl(query, keep_blank_values=True))
    written = said.pop("domain", "0")
    if said:
        raise UsageError(f"{text(uri)}: unknown '{text(next(iter(said)))}'; ?domain=0")
    if not written.isdecimal() or int(written[:9]) > _HIGHEST_DOMAIN:
        why = f"a domain id is a number from 0 to {_HIGHEST_DOMAIN}"
        raise UsageError(f"{text(uri)}: {why}")
    return int(written)


def _is_plain(rest: str) -> bool:
    return rest.isascii() and rest.isprintable() and " " not in rest


def _websocket(parts: SplitResult, is_secure: bool, host: str, port: int) -> str:
    user, at, _ = parts.netloc.rpartition("@")
    place = f"{user}{at}{f'[{host}]' if ':' in host else host}:{port}"
    query = f"?{parts.query}" if parts.query else ""
    return f"{'wss' if is_secure else 'ws'}://{place}{parts.path or '/'}{query}"
