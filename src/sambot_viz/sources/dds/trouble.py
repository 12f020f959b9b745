"""Explain from this computer's state why no participant of DDS answers."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from sambot_viz.sources.live.address import Address

_SOCKETS = ("/proc/net/udp", "/proc/net/udp6")
"""What Linux lists of them: the ports on which programs of this computer listen."""
_FIRST_PORT, _PORTS = 7400, 250
"""Of the domain 0, and how many each domain has."""
_HIGHEST, _PARTICIPANTS = 100, 20
"""Ports of higher domains may be of anything, and so may those of more participants."""
_DISCOVERY_SERVER = 11811


def nothing(address: Address, ports: Iterable[int] | None = None) -> str:
    """Return why no participant answers, how to find out more, and what helps.

    Args:
        address: the address that does not answer.
        ports: open UDP ports of this computer; by default the real ones.
    """
    listened = set(_listened() if ports is None else ports)
    where = f"domain {address.domain}"
    if address.peers:
        where = f"domain {address.domain} at {', '.join(address.peers)}"
    head = f"No participant of DDS answers in {where}"
    others = sorted(_domains(listened - {_DISCOVERY_SERVER}) - {address.domain})
    if others:
        return (
            f"{head}; on this computer there are some of domain {others[0]}: "
            f"--source '{_with_domain(address, others[0])}' (`echo $ROS_DOMAIN_ID` "
            "where the robot runs)"
        )
    if _DISCOVERY_SERVER in listened:
        return (
            f"{head}; a Discovery Server listens on this computer, and nodes that know "
            "one tell only that of themselves: start them without "
            "ROS_DISCOVERY_SERVER"
        )
    return f"{head}: {_advice(address)}"


def _advice(address: Address) -> str:
    if address.peers:
        return (
            "`ping` it; is its firewall open for UDP from port "
            f"{_FIRST_PORT + _PORTS * address.domain} on, and do its nodes run "
            "(`ros2 doctor --report` there) without "
            "ROS_AUTOMATIC_DISCOVERY_RANGE=LOCALHOST?"
        )
    domain = f"domain={address.domain}&" if address.domain else ""
    return (
        "are the nodes started (`ros2 doctor --report` names their middleware: "
        "rmw_zenoh_cpp needs --source zenoh://HOST:7447)? On this computer with "
        f"localhost only: --source 'dds:?{domain}interface=lo&peer=127.0.0.1'; in a "
        f"network without multicast: --source 'dds:?{domain}peer=HOST'"
    )


def _with_domain(address: Address, domain: int) -> str:
    more = f"&interface={address.interface}" if address.interface else ""
    more += f"&peer={','.join(address.peers)}" if address.peers else ""
    return f"dds:?domain={domain}{more}"


def _domains(ports: set[int]) -> set[int]:
    """Return the domains of participants by the ports on which they listen.

    The first port of a domain is for multicast, and from the tenth on each participant
    has two.
    """
    found: set[int] = set()
    for domain in range(_HIGHEST + 1):
        first = _FIRST_PORT + _PORTS * domain
        pairs = range(first + 10, first + 10 + 2 * _PARTICIPANTS, 2)
        if first in ports or any({one, one + 1} <= ports for one in pairs):
            found.add(domain)
    return found


def _listened() -> set[int]:
    found: set[int] = set()
    for name in _SOCKETS:
        try:
            lines = Path(name).read_text("ascii", "replace").splitlines()[1:]
        except OSError:
            # Only Linux lists them there.
            continue
        for line in lines:
            port = line.split()[1].rpartition(":")[2]
            found.add(int(port, 16))
    return found
