"""The services of a Foxglove server: which there are, and how they are called."""

from __future__ import annotations

from sambot_viz import limits
from sambot_viz.errors import SourceError
from sambot_viz.sources import foxglove_wire as wire
from sambot_viz.sources.live.conversation import Ends
from sambot_viz.sources.live.service_calls import ServiceCalls
from sambot_viz.text import text


class FoxgloveServices:
    """Knows the services of a server, and calls them.

    Args:
        ends: of the connection.

    Attributes:
        calls: those that wait for an answer.
        are_offered: whether the server calls services at all.
    """

    def __init__(self, ends: Ends) -> None:
        self.calls = ServiceCalls(self._send, "cdr")
        self.are_offered = False
        self._ends = ends
        self._ids: dict[str, int] = {}

    def take(self, said: wire.ServicesAdvertised | wire.ServicesUnadvertised) -> None:
        """Take services that are there, or are gone."""
        if isinstance(said, wire.ServicesUnadvertised):
            gone = set(said.service_ids)
            self._ids = {n: one for n, one in self._ids.items() if one not in gone}
            return
        for service in said.services:
            if service.name in self._ids or len(self._ids) < limits.TOPICS.value:
                self._ids[service.name] = service.id

    def answered(self, frame: wire.ServiceFrame | wire.ServiceFailure) -> None:
        """Accept an answer; drop it if no request waits for it."""
        if isinstance(frame, wire.ServiceFrame):
            self.calls.take(frame.call_id, frame.content)
        else:
            self.calls.fail(frame.call_id, text(frame.message, 400) or "it failed")

    def require(self, service: str) -> int:
        """Return the id of a service.

        Raises:
            SourceError: the server has no such service, or does not show it.
        """
        label, found = self._ends.address.label, self._ids.get(service)
        if not self.are_offered:
            raise SourceError(
                f"the server at {label} calls no services; with foxglove_bridge, add "
                "services to its parameter `capabilities`"
            )
        if found is None:
            is_hidden = "/_" in service
            remedy = (
                "hidden services are shown by foxglove_bridge that was started with "
                "include_hidden:=true"
            )
            why = f"the server at {label} has no service {text(service, 120)}"
            raise SourceError(f"{why}; {remedy}" if is_hidden else why)
        return found

    def _send(self, number: int, service: str, request: bytes) -> None:
        found = self.require(service)
        self._ends.send(wire.call_service(found, number, request))
