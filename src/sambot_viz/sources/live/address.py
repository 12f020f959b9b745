"""Where a live source is: the address that a user writes, and that of its websocket.

A router of zenoh is written in the same way, and has none. DDS has no server at all,
but a domain with participants.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, replace
from urllib.parse import SplitResult, parse_qsl, urlsplit

from sambot_viz.errors import UsageError
from sambot_viz.files import is_web_folder
from sambot_viz.text import text

PORTS = {"foxglove": 8765, "rosbridge": 9090, "zenoh": 7447}
"""Protocol → the default port of its server."""
_SECURE_PORT = 443
_TLS = {"foxglove": "wss", "rosbridge": "wss", "zenoh": "tls"}
_PLAIN = {"foxglove": "ws", "rosbridge": "ws", "zenoh": "tcp"}
"""Protocol → the scheme of its connection, with TLS and without."""
_HIGHEST_DOMAIN = 232
"""Of ROS 2."""
_DDS_EXAMPLE = "dds:?domain=0&interface=eth0&peer=HOST,HOST"
_PLACE = re.compile(r"[\w.:\[\]-]+", re.ASCII)
"""A network interface, or a host with or without a port."""


@dataclass(frozen=True, slots=True)
class Address:
    """The address of a server.

    Attributes:
        protocol: "foxglove", "rosbridge", "zenoh", "dds", or "http" of a folder.
        host: name or number of the machine; "" of DDS.
        port: TCP port; 0 of DDS.
        is_secure: spoken through TLS.
        websocket: "ws://robot:8765/path?token=…", or the address of a folder; may hold
            a password. "" of others.
        domain: ROS's domain id, where the address says it.
        interface: of the network, for DDS; "" for the usual one.
        peers: machines with participants of DDS; none for all that multicast reaches.
        flag: option that the address was written for; messages name it.
        name: name of a broadcast, which follows the place; "" of others.
    """

    protocol: str
    host: str
    port: int
    is_secure: bool
    websocket: str
    domain: int = 0
    interface: str = ""
    peers: tuple[str, ...] = ()
    flag: str = "--source"
    name: str = ""

    @property
    def label(self) -> str:
        """The place without anything secret, for people: "robot:8765"."""
        if self.protocol == "dds":
            at = ", ".join(self.peers) or self.interface
            at = f" at {at}" if at else ""
            return text(f"DDS domain {self.domain}{at}", 100)
        host = f"[{self.host}]" if ":" in self.host else self.host
        return text(f"{host}:{self.port}", 100)

    def with_protocol(self, protocol: str) -> str:
        """Return what to write for the same place and another protocol."""
        tls = f"+{_TLS[protocol]}" if self.is_secure else ""
        return f"{protocol}{tls}://{self.label}{f'/{self.name}' if self.name else ''}"

    def with_tls(self, is_secure: bool) -> str:
        """Return the option for the same place with TLS, or without."""
        other = replace(self, is_secure=is_secure)
        return f"{self.flag} {other.with_protocol(self.protocol)}"


def without_secrets(uri: str) -> str:
    """Return the address of a source as others may see it: without user and query.

    The query of zenoh and DDS is kept: it contains no secret.

    Args:
        uri: the address as it was written; other texts are returned unchanged.
    """
    try:
        address = parse_address(uri)
    except UsageError:
        return uri
    if not address.websocket:
        return uri
    parts = urlsplit(uri)
    return parts._replace(netloc=parts.netloc.rpartition("@")[2], query="").geturl()


def parse_address(uri: str) -> Address:
    """Read an address such as foxglove://robot:8765/path or zenoh://lab?domain=7.

    ws:// and wss:// stand for Foxglove's protocol.

    Raises:
        UsageError: it names no host, or a port that cannot be.
    """
    scheme, _, rest = uri.partition(":")
    if scheme.lower() == "dds":
        return _dds(uri, rest)
    if is_web_folder(uri):
        return _folder(uri)
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
        domain = _domain(uri, _said(uri, parts.query, "?domain=0", "domain"))
        return Address(protocol, host, port, is_secure, "", domain)
    websocket = _websocket(parts, is_secure, host, port)
    return Address(protocol, host, port, is_secure, websocket)


def _folder(uri: str) -> Address:
    """Read the address of a folder on a web server."""
    try:
        parts = urlsplit(uri)
        host, port = parts.hostname or "", parts.port
    except ValueError as error:
        raise UsageError(f"{text(uri)}: this is no host and port") from error
    if not host:
        raise UsageError(f"{text(uri)}: no host is named; write http://HOST/NAME/")
    is_secure = parts.scheme.lower() == "https"
    return Address("http", host, port or (443 if is_secure else 80), is_secure, uri)


def _dds(uri: str, rest: str) -> Address:
    """Read what follows dds: — a host is a peer, too."""
    host, _, query = rest.removeprefix("//").rstrip("/").partition("?")
    said = _said(uri, query, _DDS_EXAMPLE, "domain", "interface", "peer")
    interface = said.get("interface", "")
    peers = [*filter(None, (host.rstrip("/"), *said.get("peer", "").split(",")))]
    for word in (*peers, interface):
        if word and not _PLACE.fullmatch(word):
            why = f"'{text(word)}' is no host and no interface"
            raise UsageError(f"{text(uri)}: {why}; write {_DDS_EXAMPLE}")
    domain = _domain(uri, said)
    return Address("dds", "", 0, False, "", domain, interface, tuple(peers))


def _said(uri: str, query: str, example: str, *known: str) -> dict[str, str]:
    """Return the parameters of the query."""
    said = dict(parse_qsl(query, keep_blank_values=True))
    for name in said:
        if name not in known:
            raise UsageError(f"{text(uri)}: unknown '{text(name)}'; {example}")
    return said


def _domain(uri: str, said: dict[str, str]) -> int:
    """Return the domain id."""
    written = said.get("domain", "0")
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
