"""Definitions of types where none comes with the topics: ROS's own, or a node's.

The hash of a type says which definition a node has. Where no distribution of ROS has
that, the node itself is asked: since ROS 2 Iron each has a service for it.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache, partial

from sambot_viz import limits
from sambot_viz.errors import DecodeError
from sambot_viz.messages import MessageTypes, Schema, standard_definition
from sambot_viz.sources.live.service_calls import ServiceCalls
from sambot_viz.sources.ros_graph import NO_HASH
from sambot_viz.sources.source import Reply

_ASKED = "string type_name\nstring type_hash\nbool include_type_sources"
_ANSWER = Schema(
    "sambot_viz/GetTypeDescription_Response",
    "ros2msg",
    "bool successful\nstring failure_reason\n"
    "type_description_interfaces/TypeDescription type_description\n"
    "type_description_interfaces/TypeSource[] type_sources",
)


@cache
def _types() -> MessageTypes:
    return MessageTypes()


class TypeDescriptions:
    """Knows definitions by the name of a type and its hash.

    Args:
        calls: of services of the nodes.
    """

    def __init__(self, calls: ServiceCalls) -> None:
        self._calls = calls
        self._told: dict[tuple[str, str], str] = {}
        self._asked: set[tuple[str, str]] = set()

    def schema(self, type_name: str, type_hash: str) -> Schema:
        """Return the definition of a type; without a text where it is not known."""
        exact = "" if type_hash == NO_HASH else type_hash
        words = standard_definition(type_name, exact)
        words = words or self._told.get((type_name, type_hash), "")
        return Schema(type_name, "ros2msg" if words else "", words)

    def ask(
        self, node: str, type_name: str, type_hash: str, then: Callable[[], object]
    ) -> None:
        """Ask a node once for a definition that is not known.

        Args:
            node: its full name; its service must be there.
            type_name: of the type.
            type_hash: the same.
            then: called when the definition is known.
        """
        key = type_name, type_hash
        if key in self._asked or len(self._asked) >= limits.TOPICS.value:
            return
        self._asked.add(key)
        fields = {
            "type_name": type_name,
            "type_hash": type_hash,
            "include_type_sources": True,
        }
        shape = _types().shape("sambot_viz/GetTypeDescription_Request", _ASKED)
        answered = partial(self._answered, key, then)
        self._calls.call(service_of(node), shape.as_cdr(fields), answered)

    def _answered(
        self, key: tuple[str, str], then: Callable[[], object], reply: Reply
    ) -> None:
        if reply.refusal:
            return
        try:
            told = _types().decoder(_ANSWER, "cdr").decode(reply.content)
        except DecodeError:
            return
        texts = {
            str(one.type_name): str(one.raw_file_contents)
            for one in told.type_sources
            if one.encoding == "msg"
        }
        if key[0] not in texts:
            return
        parts = [texts.pop(key[0])]
        for name, words in texts.items():
            parts.append(f"{'=' * 80}\nMSG: {name}\n{words}")
        whole = "\n".join(parts)
        if len(whole) <= limits.DEFINITION.value:
            self._told[key] = whole
            then()


def service_of(node: str) -> str:
    """Return the service of a node that describes types."""
    return f"{node}/get_type_description"
