"""A session of zenoh: the one place that knows its Python package.

zenoh calls back in its own threads, and everything is passed to the loop; messages wait
until the loop takes them.
"""

from __future__ import annotations

import json
import os
import time
from collections.abc import Callable, Mapping
from functools import partial
from itertools import count
from typing import Any, ClassVar, Protocol, TypeVar

from sambot_viz import limits
from sambot_viz.errors import SourceError
from sambot_viz.sources.live.address import Address
from sambot_viz.sources.ros_endpoint import RosEndpoint
from sambot_viz.sources.zenoh.names import attachment, endpoint_token
from sambot_viz.sources.zenoh.readings import (
    OnSample,
    ZenohReadings,
    at_once,
    content_of,
    in_a_thread,
    waiting_room,
)

LONGEST_OPENING = 10.0
"""A router that has not answered by then is given up [s]."""
_NO_TOKEN = "@ros2_lv/none"
_LONGEST_TELLING = 600.0
"""A router takes minutes for the tokens of ten thousand topics [s]."""
_CERTIFICATES = "SSL_CERT_FILE"

Post = Callable[[Callable[[], object]], object]


class ZenohDeclaration(Protocol):
    """What was declared to a router, until it is taken back."""

    def undeclare(self) -> object:
        """Take it back."""
        ...


class ZenohSession:
    """One connection of a client to a router.

    Args:
        session: of zenoh.
        post: has something done in the thread of the connection.
        on_lost: called there when the connection has ended.

    Attributes:
        name: of the session, as tokens say it.
        router: identifies what it is connected to; "" when that has ended already.
        settings: of zenoh, besides those of all sessions.
    """

    settings: ClassVar[Mapping[str, object]] = {}

    def __init__(self, session: Any, post: Post, on_lost: Callable[[], object]) -> None:
        from zenoh import SampleKind

        self._session = session
        self._post = post
        self._readings = ZenohReadings()
        self._numbers = count(1)
        self.name = str(session.zid())
        found = [*session.info.routers_zid(), *session.info.peers_zid()]
        self.router = str(found[0]) if found else ""

        def changed(event: Any) -> None:
            # zenoh would connect again by itself, and not say what was lost.
            if event.kind == SampleKind.DELETE:
                post(on_lost)

        session.info.declare_transport_events_listener(at_once(changed))

    def close(self) -> None:
        """End it."""
        self._readings.clear()
        self._session.close()

    @property
    def is_closed(self) -> bool:
        """Whether it was ended: nothing more can be asked of it."""
        return self._session.is_closed()

    def watch(
        self,
        key: str,
        told: Callable[[str, bool], object],
        all_told: Callable[[], object],
    ) -> None:
        """Tell of liveliness tokens, those that are there first.

        Args:
            key: of the tokens.
            told: called with the key of each and whether it is there.
            all_told: called when those that were there are told.
        """
        from zenoh import SampleKind

        def take(sample: Any) -> None:
            there = sample.kind == SampleKind.PUT
            name = str(sample.key_expr)
            self._post(lambda: told(name, there))

        liveliness = self._session.liveliness()
        liveliness.declare_subscriber(key, at_once(take), history=True)
        # A router answers one after the other: after those tokens that there are none.
        liveliness.get(
            _NO_TOKEN,
            in_a_thread(lambda: self._post(all_told)),
            timeout=_LONGEST_TELLING,
        )

    def declare_token(self, key: str) -> ZenohDeclaration:
        """Say that something is there."""
        return self._session.liveliness().declare_token(key)

    def declare(self, domain: int, endpoint: RosEndpoint) -> ZenohDeclaration:
        """Say that an endpoint is there."""
        number = next(self._numbers)
        return self.declare_token(endpoint_token(domain, self.name, number, endpoint))

    def subscribe(
        self, key: str, is_latched: bool, take: OnSample, on_large: Callable[[int], Any]
    ) -> ZenohDeclaration:
        """Subscribe to a key.

        Args:
            key: may have wildcards.
            is_latched: get what its publishers keep, too.
            take: gets the messages.
            on_large: gets the size of those that are too large [bytes].
        """
        if is_latched:
            import zenoh.ext

            extensions: Any = zenoh.ext
            history = extensions.HistoryConfig(
                detect_late_publishers=True, max_samples=limits.LATCHED_KEPT.value
            )
            subscriber = extensions.declare_advanced_subscriber(
                self._session, key, waiting_room(), history=history
            )
        else:
            subscriber = self._session.declare_subscriber(key, waiting_room())
        return self._readings.add(subscriber, take, on_large)

    def ask_kept(self, key: str, take: OnSample) -> None:
        """Ask the caches of older publishers for what they keep."""
        from zenoh import ConsolidationMode, QueryTarget, ReplyKeyExpr

        def answered(reply: Any) -> None:
            if reply.ok is not None and len(reply.ok.payload) <= limits.MESSAGE.value:
                self._post(partial(take, *content_of(reply.ok)))

        self._session.get(
            f"*/{key}",
            at_once(answered),
            target=QueryTarget.ALL,
            consolidation=ConsolidationMode.NONE,
            accept_replies=ReplyKeyExpr.ANY,
        )

    def call(
        self,
        key: str,
        number: int,
        request: bytes,
        timeout: float,
        answered: Callable[[bytes, str], object],
    ) -> None:
        """Ask a service.

        Args:
            key: of the service, without wildcards.
            number: of the call.
            request: CDR.
            timeout: how long an answer is waited for [s].
            answered: called with the response, or with why there is none.
        """
        from zenoh import ConsolidationMode, QueryTarget

        def take(reply: Any) -> None:
            said = reply.ok if reply.ok is not None else reply.err
            content = bytes(said.payload)
            is_answer = reply.ok is not None
            words = content.decode("utf-8", "replace") or "it failed"
            why = "" if is_answer else words
            self._post(lambda: answered(content if is_answer else b"", why))

        self._session.get(
            key,
            at_once(take),
            target=QueryTarget.ALL_COMPLETE,
            consolidation=ConsolidationMode.NONE,
            timeout=timeout,
            payload=request,
            attachment=attachment(number, time.time_ns(), os.urandom(16)),
        )

    def publisher(self, key: str) -> ZenohPublisher:
        """Begin to publish on a key."""
        return ZenohPublisher(self._session.declare_publisher(key))


S = TypeVar("S", bound=ZenohSession)


class ZenohPublisher:
    """Publishes on one key."""

    def __init__(self, publisher: Any) -> None:
        self._publisher = publisher
        self._source = os.urandom(16)
        self._count = 0

    def put(self, message: bytes) -> None:
        """Publish a message."""
        self._count += 1
        attached = attachment(self._count, time.time_ns(), self._source)
        self._publisher.put(message, attachment=attached)

    def undeclare(self) -> None:
        """Publish nothing more."""
        self._publisher.undeclare()


def open_session(
    address: Address,
    post: Post,
    on_lost: Callable[[], object],
    made: type[S] = ZenohSession,
) -> S:
    """Connect to a router, or to a node that listens; this takes its time.

    Args:
        address: of the router.
        post: as of `ZenohSession`.
        on_lost: as of `ZenohSession`.
        made: what is said over it.

    Raises:
        SourceError: the router does not speak zenoh, or not with TLS as asked.
    """
    import zenoh

    config: Any = zenoh.Config()
    for name, value in {**_settings(address), **made.settings}.items():
        config.insert_json5(name, json.dumps(value))
    try:
        return made(zenoh.open(config), post, on_lost)
    except zenoh.ZError as error:
        raise SourceError(_refused(address)) from error


def _settings(address: Address) -> dict[str, Any]:
    protocol = "tls" if address.is_secure else "tcp"
    settings: dict[str, Any] = {
        # Routers of rmw_zenoh forward nothing between peers.
        "mode": "client",
        "connect/endpoints": [f"{protocol}/{address.label}"],
        "scouting/multicast/enabled": False,
        "transport/unicast/open_timeout": int(LONGEST_OPENING * 1000),
    }
    if address.is_secure and (trusted := os.environ.get(_CERTIFICATES)):
        settings["transport/link/tls/root_ca_certificate"] = trusted
    return settings


def _refused(address: Address) -> str:
    place = address.label
    if address.is_secure:
        return (
            f"No TLS connection to the zenoh router at {place}: start sambot-viz with "
            f"{_CERTIFICATES}=FILE, the certificate of who has signed the router's; or "
            f"leave TLS out: {address.with_tls(False)}"
        )
    return (
        f"{place} does not speak zenoh: is {address.port} the port of its router? If "
        f"it speaks TLS, {address.with_tls(True)}"
    )
