"""The network settings of cyclonedds: XML, without environment variables."""

from __future__ import annotations

from xml.sax.saxutils import quoteattr

from sambot_viz import limits
from sambot_viz.sources.live.address import Address

_MOST_PARTICIPANTS = 99
"""On one computer; each has a port, and those of peers are all tried."""
_WITHOUT_TYPES = "1.15,1.16"
"""Vendors whose descriptions of types are not compared with ours, which say nothing:
Fast DDS, which since ROS 2 Kilted sends some that Cyclone DDS cannot read, and Cyclone
itself."""


def settings(address: Address) -> str:
    """Return the configuration of a participant.

    Args:
        address: with peers, those are asked, each by itself; without, all of the
            network by multicast.
    """
    interfaces = peers = ""
    if address.interface:
        name = quoteattr(address.interface)
        interfaces = f"<Interfaces><NetworkInterface name={name}/></Interfaces>"
    if address.peers:
        found = (f"<Peer Address={quoteattr(one)}/>" for one in address.peers)
        peers = f"<Peers>{''.join(found)}</Peers>"
    multicast = "false" if address.peers else "default"
    return (
        '<CycloneDDS><Domain Id="any">'
        f"<General>{interfaces}<AllowMulticast>{multicast}</AllowMulticast></General>"
        f"<Compatibility><IgnoreTypeInformation>{_WITHOUT_TYPES}"
        "</IgnoreTypeInformation></Compatibility>"
        f"<Discovery><ExternalDomainId>{address.domain}</ExternalDomainId>"
        "<ParticipantIndex>auto</ParticipantIndex>"
        f"<MaxAutoParticipantIndex>{_MOST_PARTICIPANTS}</MaxAutoParticipantIndex>"
        f"{peers}</Discovery>"
        # A peer that announces a false length of a message gets no memory for it.
        f"<Internal><MaxSampleSize>{2 * limits.MESSAGE.value}B</MaxSampleSize>"
        "</Internal></Domain></CycloneDDS>"
    )
