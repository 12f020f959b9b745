"""The counts of a server, in the format of Prometheus.

They contain no names of people and no tokens: a reader learns how busy a server is, not
who uses it. Problems are counted by code, sources by name.
"""

from __future__ import annotations

import asyncio
import http
from collections import Counter
from collections.abc import Callable, Iterable, Iterator
from typing import TYPE_CHECKING

from websockets.datastructures import Headers
from websockets.http11 import Request, Response

from sambot_viz._version import __version__
from sambot_viz.server.connections.traffic import Traffic
from sambot_viz.server.sessions import Sessions
from sambot_viz.sources.joined import JoinedSources
from sambot_viz.sources.source import Source, SourceStatus
from sambot_viz.topics.source_robot import SourceRobot

if TYPE_CHECKING:
    from prometheus_client.metrics_core import Metric

_OF_SOURCES: Iterable[tuple[str, str, bool, Callable[[SourceStatus], float | None]]] = (
    ("connected", "1 while messages can come.", False, lambda s: s.is_connected),
    (
        "messages",
        "Messages of topics that somebody looks at.",
        True,
        lambda s: s.received,
    ),
    (
        "dropped_messages",
        "Messages that were dropped because displays were too slow.",
        True,
        lambda s: s.dropped,
    ),
    (
        "unreadable_messages",
        "Frames of the robot that made no sense.",
        True,
        lambda s: s.unreadable,
    ),
    (
        "lag_seconds",
        "How much later than at best the newest messages came.",
        False,
        lambda s: s.lag_s,
    ),
)
"""Name, help, whether it only grows, and the value's source; None omits it."""


class Metrics:
    """Collects the counts of a server at each request.

    Args:
        sessions: sessions of the server.
        traffic: outgoing messages.
        moved_by: robot of the sources; None without sources.
    """

    def __init__(
        self, sessions: Sessions, traffic: Traffic, moved_by: SourceRobot | None
    ) -> None:
        from prometheus_client import CollectorRegistry, ProcessCollector

        self._sessions = sessions
        self._traffic = traffic
        self._moved_by = moved_by
        self._registry = CollectorRegistry()
        self._registry.register(self)
        ProcessCollector(registry=self._registry)

    async def answer(self, request: Request) -> Response:
        """Return the counts in the requested format."""
        from prometheus_client.exposition import choose_encoder

        accepted = ",".join(request.headers.get_all("Accept"))
        write, kind = choose_encoder(accepted)
        # A busy session holds its lock.
        content = await asyncio.to_thread(write, self._registry)
        headers = Headers({"Content-Type": kind, "Cache-Control": "no-store"})
        headers["Content-Length"] = str(len(content))
        return Response(http.HTTPStatus.OK, "OK", headers, content)

    def collect(self) -> Iterator[Metric]:
        """Yield all counts; the library calls this.

        Returns:
            One metric after the other.
        """
        from prometheus_client.core import (
            CounterMetricFamily,
            GaugeMetricFamily,
            InfoMetricFamily,
        )

        sessions, traffic = self._sessions.all(), self._traffic
        pages = sum(len(session.clients.all) for session in sessions)
        found = Counter(
            (problem.code, problem.severity)
            for session in sessions
            for problem in session.problems.shown.value.listed
        )
        version = {"version": __version__}
        yield InfoMetricFamily("sambot_viz", "The running program.", version)
        yield GaugeMetricFamily("sambot_viz_pages", "Pages that are open.", pages)
        yield GaugeMetricFamily(
            "sambot_viz_sessions",
            "Robots that pages have to themselves, and the shared one.",
            len(sessions),
        )
        yield GaugeMetricFamily(
            "sambot_viz_connections",
            "Connections; a page has two.",
            len(traffic.clients),
        )
        yield CounterMetricFamily(
            "sambot_viz_sent_bytes", "Bytes sent to pages.", traffic.sent
        )
        yield CounterMetricFamily(
            "sambot_viz_sent_frames",
            "Messages that were sent to pages.",
            traffic.frames,
        )
        yield GaugeMetricFamily(
            "sambot_viz_slowest_page_seconds",
            "For how long the slowest page has not taken a message.",
            traffic.slowest(),
        )
        problems = GaugeMetricFamily(
            "sambot_viz_problems",
            "Problems that pages show; those of all sessions together.",
            labels=("code", "severity"),
        )
        for labels, number in sorted(found.items()):
            problems.add_metric(labels, number)
        yield problems
        sources = [*_parts(self._moved_by)]
        for name, words, grows, value in _OF_SOURCES:
            family = CounterMetricFamily if grows else GaugeMetricFamily
            made = family(f"sambot_viz_source_{name}", words, labels=("source",))
            for uri, status in sources:
                if (now := value(status)) is not None:
                    made.add_metric((uri,), float(now))
            yield made


def _parts(moved_by: SourceRobot | None) -> Iterator[tuple[str, SourceStatus]]:
    """Yield the live sources, by name."""
    if moved_by is None:
        return
    source: Source = moved_by.source
    parts = source.parts if isinstance(source, JoinedSources) else (source,)
    for part in parts:
        if part.live is not None:
            yield part.uri, part.status
