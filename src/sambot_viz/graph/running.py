"""The graph of what does run, as far as a source says who publishes and who reads.

Foxglove's bridges say it by themselves. Over rosbridge, rosapi is asked for each node.
"""

from __future__ import annotations

import json
import threading
from collections.abc import Callable, Iterator, Sequence
from functools import partial
from typing import Any, cast

from sambot_viz import limits
from sambot_viz.errors import SourceError
from sambot_viz.graph.node_graph import (
    Direction,
    GraphEdge,
    GraphTopic,
    NodeGraph,
    node_graph,
)
from sambot_viz.sources.message import SourceTopic
from sambot_viz.sources.source import Reply, Source

_NODES, _DETAILS = "/rosapi/nodes", "/rosapi/node_details"
_LISTS: dict[str, Direction] = {"publishing": "publishes", "subscribing": "subscribes"}
_Nodes = dict[str, tuple[GraphEdge, ...]]


class RunningNodes:
    """The nodes that a source reports.

    Args:
        source: a recording, or a robot.
        changed: called when rosapi has answered for all nodes, in the thread of the
            source: it must only post.
    """

    def __init__(self, source: Source, changed: Callable[[], object]) -> None:
        self._source = source
        self._changed = changed
        self._lock = threading.Lock()
        self._answered: _Nodes | None = None
        self._refusal = ""
        self._is_asking = False

    @property
    def is_known(self) -> bool:
        """Whether the readers of topics are known, or were refused."""
        return (
            (
                "graph" not in self._source.capabilities
                and self._source.status.is_connected
            )
            or self._said_by_itself()
            or self._answered is not None
            or bool(self._refusal)
        )

    def ask(self) -> None:
        """Ask for the nodes, where the source does not say them by itself."""
        if "graph" not in self._source.capabilities or self._says_by_itself():
            return
        with self._lock:
            if self._is_asking:
                return
            self._is_asking = True
        self._call(_NODES, {}, self._take_nodes)

    def graph(self) -> NodeGraph:
        """Return what runs, as far as it is known by now."""
        topics = self._source.topics()
        edges = [edge for topic in topics.values() for edge in _edges_of(topic)]
        nodes = self._answered or {}
        edges += [edge for of_node in nodes.values() for edge in of_node]
        return node_graph(
            (),
            [_topic(topic) for topic in topics.values()],
            edges,
            self._notes(),
            is_whole=self._said_by_itself() or self._answered is not None,
        ).without_hidden()

    def _says_by_itself(self) -> bool:
        """Return whether the source has said it, or endpoints whose nodes follow."""
        topics = self._source.topics().values()
        return any(one.endpoints is not None for one in topics) or (
            self._said_by_itself()
        )

    def _said_by_itself(self) -> bool:
        topics = self._source.topics().values()
        return any(topic.subscribers is not None for topic in topics)

    def _notes(self) -> Iterator[str]:
        if self._refusal:
            yield f"who publishes and reads is not known: {self._refusal}"
        elif not self.is_known or "graph" not in self._source.capabilities:
            what = "a recording" if self._source.live is None else "this source"
            yield f"{what} does not say who publishes and reads its topics"

    def _call(
        self, service: str, request: object, then: Callable[[Any], object]
    ) -> None:
        def answered(reply: Reply) -> None:
            if reply.refusal or not reply.is_json:
                self._end(None, reply.refusal or f"{service} is not answered in JSON")
                return
            try:
                then(json.loads(reply.content))
            except ValueError:
                self._end(None, f"the answer of {service} makes no sense")

        try:
            self._source.call(
                service, lambda encoding: json.dumps(request).encode(), answered
            )
        except SourceError as error:
            self._end(None, str(error))

    def _take_nodes(self, values: Any) -> None:
        names = _texts(values, "nodes")[: limits.GRAPH_PARTS.value]
        self._ask_next(names, {})

    def _ask_next(self, names: Sequence[str], known: _Nodes) -> None:
        """Ask for one node after the other, so that others may ask too."""
        if not names:
            self._end(known, "")
            return
        take = partial(self._take_details, names, known)
        self._call(_DETAILS, {"node": names[0]}, take)

    def _take_details(self, names: Sequence[str], known: _Nodes, values: Any) -> None:
        known[names[0]] = tuple(
            GraphEdge(names[0], topic, direction, "running")
            for field, direction in _LISTS.items()
            for topic in _texts(values, field)
        )
        self._ask_next(names[1:], known)

    def _end(self, known: _Nodes | None, refusal: str) -> None:
        with self._lock:
            self._is_asking = False
            self._answered = known if known is not None else self._answered
            self._refusal = refusal
        self._changed()


def _topic(topic: SourceTopic) -> GraphTopic:
    types = (topic.schema.name,) if topic.schema.name else ()
    return GraphTopic(topic.name, "running", types)


def _edges_of(topic: SourceTopic) -> Iterator[GraphEdge]:
    if isinstance(topic.publishers, tuple) and topic.subscribers is not None:
        for node in topic.publishers:
            yield GraphEdge(node, topic.name, "publishes", "running")
    for node in topic.subscribers or ():
        yield GraphEdge(node, topic.name, "subscribes", "running")


def _texts(values: Any, field: str) -> list[str]:
    """Return a list of texts of an answer, without elements that are no texts."""
    if not isinstance(values, dict):
        raise ValueError("not an object")
    found = cast("dict[str, object]", values).get(field)
    if not isinstance(found, list):
        return []
    return [one for one in cast("list[object]", found) if isinstance(one, str)]
