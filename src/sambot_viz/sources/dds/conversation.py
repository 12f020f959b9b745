"""The protocol with the nodes of a robot over DDS.

Participants announce their readers and writers, each with its QoS and the hash of its
type; a separate topic says which node they belong to.
"""

from __future__ import annotations

from dataclasses import replace

from sambot_viz import limits
from sambot_viz.errors import SourceError
from sambot_viz.sources.dds import names
from sambot_viz.sources.dds.endpoints import DdsEndpoint, DdsPeer
from sambot_viz.sources.dds.participant import DdsParticipant, DdsPublisher
from sambot_viz.sources.dds.services import DdsServices
from sambot_viz.sources.dds.subscriptions import DdsSubscriptions
from sambot_viz.sources.live.conversation import Ends
from sambot_viz.sources.live.graph_conversation import GraphConversation
from sambot_viz.sources.live.outgoing_topic import OutgoingTopic
from sambot_viz.sources.qos import Qos
from sambot_viz.sources.ros_endpoint import RosEndpoint
from sambot_viz.sources.ros_graph import NO_HASH, UNNAMED, mangled

_PREFIX = 12
"""The first bytes of the id of an endpoint are those of its participant."""


class DdsConversation(GraphConversation):
    """What one participant hears, as long as there are others.

    Args:
        participant: of DDS.
        peers: the other participants; they come and go.
        ends: of the source.
    """

    protocol = "DDS"
    matches_qos = True

    def __init__(
        self, participant: DdsParticipant, peers: dict[bytes, DdsPeer], ends: Ends
    ) -> None:
        super().__init__(ends)
        self.session_id = min(peers).hex() if peers else None
        self._participant, self._peers = participant, peers
        self._hashes: dict[int, str] = {}
        self._endpoints: dict[bytes, RosEndpoint] = {}
        # The id of a participant → those of its endpoints → the node of each.
        self._nodes: dict[bytes, dict[bytes, str]] = {}
        self._has_node = False
        # Endpoints that are gone: all are, just before the last participant is.
        self._gone: dict[bytes, int] = {}
        self._services = DdsServices(participant, self.calls.take)
        self._subscriptions = DdsSubscriptions(
            self, participant, self._graph, self._types, self._hashes
        )

    def begin(self) -> None:
        """Ask for all nodes."""
        self._participant.watch_endpoints(self._take_endpoint)
        self._participant.subscribe(
            names.DISCOVERY,
            names.DISCOVERY_TYPE,
            Qos("reliable", "transient_local"),
            self._take_nodes,
            lambda size: None,
        )
        self.is_ready = True

    @property
    def is_closed(self) -> bool:
        """Whether the participant has ended."""
        return self._participant.is_closed

    def tick(self, now: float) -> None:
        """Remove readers and writers that are gone."""
        for identity, handle in self._gone.items():
            self._hashes.pop(handle, None)
            if (gone := self._endpoints.pop(identity, None)) is not None:
                self._graph.discard(identity.hex())
                self._note(gone)
        self._gone.clear()
        super().tick(now)

    def _nothing(self) -> str:
        if self._endpoints:
            return ""
        count = len(self._peers)
        there = "1 participant is" if count == 1 else f"{count} participants are"
        kinds = {one.discovery for one in self._peers.values()} - {"", "SIMPLE"}
        if kinds:
            return (
                f"{there} there and told nothing: they use a Discovery Server "
                "(`echo $ROS_DISCOVERY_SERVER` on the robot), which is not asked; "
                "start the nodes without it"
            )
        return (
            f"{there} there, no node has told of a topic: a firewall may let only "
            "part of UDP through (`sudo ufw status` on both computers)"
        )

    def _take_endpoint(self, seen: DdsEndpoint) -> None:
        """Take what has come, or is gone."""
        if not seen.is_there:
            self._gone[seen.id] = seen.handle
            return
        if len(self._endpoints) >= limits.ENDPOINTS.value:
            return
        self._hashes[seen.handle] = seen.type_hash
        if seen.topic == names.DISCOVERY and seen.type_hash != NO_HASH:
            self._say_node()
        found = names.named(seen.topic, seen.wire_type, seen.is_writer)
        if found is None:
            return
        node = self._nodes.get(seen.id[:_PREFIX], {}).get(seen.id, "")
        kind, name, type_name = found.kind, found.name, found.type_name
        made = RosEndpoint(kind, node, name, type_name, seen.type_hash, seen.qos)
        self._add(seen.id, made)

    def _add(self, identity: bytes, endpoint: RosEndpoint) -> None:
        if self._graph.add(identity.hex(), endpoint):
            self._endpoints[identity] = endpoint
            self._note(endpoint)

    def _say_node(self) -> None:
        """Say which node this is, to those who read it as it is written since Iron."""
        if not self._has_node:
            self._has_node = True
            self._participant.say_node()

    def _take_nodes(self, content: bytes, handle: int, stamp: int) -> None:
        """Accept a participant's message about its nodes."""
        del stamp
        is_old = self._hashes.get(handle) == NO_HASH
        size = names.OLD_ENDPOINT_ID if is_old else names.ENDPOINT_ID
        try:
            participant, nodes = names.nodes_of(content, size)
        except ValueError:
            self.unreadable += 1
            return
        if len(self._nodes) >= limits.ENDPOINTS.value:
            return
        self._nodes[participant[:_PREFIX]] = nodes
        for identity, node in nodes.items():
            known = self._endpoints.get(identity)
            if known is not None and known.node != node:
                self._add(identity, replace(known, node=node))

    def _publisher(self, outgoing: OutgoingTopic, type_hash: str) -> DdsPublisher:
        topic, kind = f"rt{outgoing.topic}", mangled(outgoing.type_name)
        return self._participant.publisher(topic, kind, type_hash)

    def _unheard(self, outgoing: OutgoingTopic) -> str:
        takers = self._graph.takers(outgoing.topic)
        if not takers or not all(
            one.qos and one.qos.is_any_transient_local for one in takers
        ):
            return ""
        return (
            f"{takers[0].node or UNNAMED} gets only from publishers that keep their "
            "messages (its QoS durability is transient local), and nothing is kept here"
        )

    def _call(self, number: int, service: str, request: bytes) -> None:
        if self.is_closed:
            raise SourceError("the connection was lost")
        found = self._service(service)
        vendor = next(id[:2] for id, one in self._endpoints.items() if one is found)
        self._services.call(number, found, vendor, request)
