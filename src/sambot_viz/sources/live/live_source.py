"""A live source over any transport: a thread that connects, and connects again.

Two threads serve one source. The first runs an event loop with the connection and reads
without pause; it never calls anybody back. The second (`Delivery`) calls all callbacks.
"""

from __future__ import annotations

import asyncio
import random
import threading
from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping
from concurrent.futures import Future
from contextlib import suppress
from dataclasses import replace
from functools import partial
from types import MappingProxyType
from typing import Any

from sambot_viz.errors import Problem, SourceError
from sambot_viz.outlet import logger
from sambot_viz.sources.live.address import Address
from sambot_viz.sources.live.assets import AssetStore
from sambot_viz.sources.live.clock import SourceClock
from sambot_viz.sources.live.clock_topic import CLOCK, is_clock, told_time
from sambot_viz.sources.live.conversation import Conversation, Ends
from sambot_viz.sources.live.delivery import Delivery
from sambot_viz.sources.live.event_loop import SourceLoop
from sambot_viz.sources.live.outgoing_topic import OutgoingTopic
from sambot_viz.sources.message import Recorded, SourceTopic
from sambot_viz.sources.source import (
    Capability,
    Encoding,
    OnMessage,
    OnReply,
    OutgoingAction,
    Source,
    SourceStatus,
)

FIRST_PAUSE, LONGEST_PAUSE, GROWTH = 0.5, 15.0, 1.7
"""Before the second attempt and at most [s], and how much each pause is longer."""
TICK = 0.5
"""Period of the periodic work [s]."""
STEADY = 10.0
"""A connection that lasted so long [s] was a good one: pauses begin again."""
LONGEST_STOP = 5.0
"""`close` waits this long for the thread [s]."""
_TOPICS_PAUSE = 0.05
"""Topics that are advertised one by one are told together [s]."""

_ALWAYS = frozenset[Capability](("topics", "subscribe", "latched", "clock"))

_log = logger(__name__)


class LiveSource(ABC):
    """Implements `Source` for a transport, which says how to connect.

    Args:
        uri: as the user wrote it.
        address: where it is.
    """

    def __init__(self, uri: str, address: Address) -> None:
        self.uri = uri
        self.on_topics: Callable[[], object] = _nothing
        self.on_status: Callable[[], object] = _nothing
        self._address = address
        self._delivery = Delivery(f"sambot-viz callbacks of {address.label}")
        self._clock = SourceClock()
        self._assets = AssetStore()
        self._status = SourceStatus(sentence=f"Connecting to {address.label}")
        self._topics: Mapping[str, SourceTopic] = MappingProxyType({})
        self._capabilities: frozenset[str] = frozenset()
        self._offers = frozenset[Capability]()
        self._session_id: str | None = None
        self._lock = threading.Lock()
        self._thread: threading.Thread | None = None
        self._loop: SourceLoop | None = None
        self._task: asyncio.Task[None] | None = None
        self._is_closed = False
        # Of the connection; touched in the loop's thread only.
        self._conversation: Conversation | None = None
        self._is_told = True
        self._unreadable = 0

    def open(self) -> None:
        """Begin to connect; returns at once."""
        with self._lock:
            if self._thread is not None or self._is_closed:
                return
            self._loop = SourceLoop()
            self._task = self._loop.create_task(self._connect_forever())
            self._thread = threading.Thread(
                target=self._serve,
                name=f"sambot-viz {self._address.label}",
                daemon=True,
            )
            self._delivery.start()
            self._thread.start()

    def close(self) -> None:
        """End the connection and both threads; may be called twice."""
        with self._lock:
            self._is_closed = True
            thread, loop, task = self._thread, self._loop, self._task
        if loop is not None and task is not None:
            # The loop may have ended already.
            with suppress(RuntimeError):
                loop.call_soon_threadsafe(task.cancel)
        if thread is not None and thread is not threading.current_thread():
            thread.join(LONGEST_STOP)
        self._delivery.stop()
        self._assets.refuse_all("the source is closed")
        label = self._address.label
        self._status = SourceStatus(sentence=f"{label} is closed")

    @property
    def status(self) -> SourceStatus:
        """How the source is now."""
        return replace(self._status, received=self._delivery.received)

    def of_session(self) -> Source:
        """Return it: one connection serves all sessions."""
        return self

    @property
    def capabilities(self) -> frozenset[Capability]:
        """What it can do, as the server has said when it was connected last."""
        return _ALWAYS | self._offers

    @property
    def hidden(self) -> tuple[Problem, ...]:
        """Nothing: it is one."""
        return ()

    @property
    def live(self) -> Source:
        """Itself."""
        return self

    @property
    def playback(self) -> None:
        """Nothing: the time of a robot goes on by itself."""
        return None

    def topics(self) -> Mapping[str, SourceTopic]:
        """Return the topics by name; the last known ones if there is no connection."""
        return self._topics

    def subscribe(
        self, topic: str, callback: OnMessage, on_kept: OnMessage | None = None
    ) -> None:
        """Call back with each message of a topic, which need not exist yet."""
        self._delivery.subscribe(topic, callback, on_kept)
        self._post(self._update)

    def unsubscribe(self, topic: str, callback: OnMessage) -> None:
        """No longer call back; a call that has begun goes on."""
        self._delivery.unsubscribe(topic, callback)
        self._post(self._update)

    @property
    def has_clock(self) -> bool:
        """Whether the server has told its time, as that of a simulation."""
        return self._clock.is_told

    def clock_ns(self) -> int:
        """Return the time at the server [ns]."""
        return self._clock.now_ns()

    def fetch_asset(self, uri: str) -> Future[bytes]:
        """Ask for a file; the result raises `SourceError` when it is refused."""
        future = self._assets.fetch(uri)
        if self._is_closed:
            self._assets.refuse_all("the source is closed")
        self._post(self._update)
        return future

    def advertise(self, topic: str, type_name: str) -> OutgoingTopic:
        """Begin to publish a topic over the present connection.

        Raises:
            SourceError: there is none, or the server takes nothing.
        """
        conversation = self._ready()
        if why := conversation.unpublishable:
            raise SourceError(f"nothing can be sent: {why}")
        return OutgoingTopic(topic, type_name, conversation, self._post)

    def call(
        self, service: str, write: Callable[[Encoding], bytes], answered: OnReply
    ) -> None:
        """Call a service over the present connection; see `Source.call`."""
        conversation = self._ready()
        request = write(conversation.publishes)
        self._post(partial(conversation.calls.call, service, request, answered))

    def action(self, name: str, type_name: str) -> OutgoingAction:
        """Return an action over the present connection; see `Source.action`."""
        return self._ready().action(name, type_name, self)

    def _ready(self) -> Conversation:
        """Return the conversation of the present connection."""
        conversation = self._conversation
        if conversation is None or not conversation.is_ready:
            raise SourceError(f"nothing can be sent: {self._status.sentence}")
        return conversation

    def _post(self, action: Callable[[], object]) -> None:
        loop = self._loop
        if loop is not None:
            # A loop that has stopped already has no server.
            with suppress(RuntimeError):
                loop.call_soon_threadsafe(action)

    def _serve(self) -> None:
        loop, task = self._loop, self._task
        assert loop is not None and task is not None
        try:
            with suppress(asyncio.CancelledError):
                loop.run_until_complete(task)
            loop.run_until_complete(_end_others())
        finally:
            loop.close()

    async def _connect_forever(self) -> None:
        attempt = 0
        while True:
            begun = asyncio.get_running_loop().time()
            try:
                await self._connect()
                sentence = f"{self._address.label} has ended the connection"
            except Exception as error:
                sentence = self._explain(error)
                _log.debug("%s: %s", self._address.label, sentence, exc_info=error)
            finally:
                self._tell_topics()
                if self._conversation is not None:
                    self._conversation.end()
                self._conversation = None
            lasted = asyncio.get_running_loop().time() - begun
            attempt = 0 if lasted > STEADY else attempt
            pause = next_pause(attempt)
            attempt += 1
            self._say(is_connected=False, sentence=sentence, retry_s=pause, lag_s=None)
            self._assets.ask_again()
            self._assets.expire("there is no connection to the server")
            await asyncio.sleep(pause)

    @abstractmethod
    async def _connect(self) -> None:
        """Connect and speak until one side ends; raises what has ended it."""

    @abstractmethod
    def _explain(self, error: BaseException) -> str:
        """Return the sentence for what has ended a connection, without a full stop."""

    def _converse(
        self,
        begin: Callable[[Ends], Conversation],
        send: Callable[[str | bytes], None] = lambda frame: None,
    ) -> Conversation:
        """Begin the conversation of a new connection.

        Args:
            begin: makes the conversation.
            send: queues a frame for the peer, where the transport has frames.
        """
        ends = Ends(
            self._address,
            send,
            self._put,
            self._clock,
            self._assets,
            self._post,
            self._session_id,
        )
        conversation = self._conversation = begin(ends)
        self._delivery.forget()
        self._clock.reset()
        conversation.begin()
        conversation.update(self._wanted())
        return conversation

    async def _hold(
        self, begin: Callable[[Ends], Conversation], lost: asyncio.Event
    ) -> None:
        """Speak until a connection is lost that has no frames to read."""
        conversation = self._converse(begin)
        self._follow()
        gone = asyncio.ensure_future(lost.wait())
        try:
            while not gone.done():
                await asyncio.wait((gone,), timeout=TICK)
                if not gone.done():
                    conversation.tick(asyncio.get_running_loop().time())
                    self._follow()
                    self._tell_health()
        finally:
            gone.cancel()

    def _follow(self) -> None:
        conversation = self._conversation
        if conversation is None:
            return
        if conversation.is_ready and not self._status.is_connected:
            self._welcome(conversation)
        self._plan_topics(conversation)

    def _plan_topics(self, conversation: Conversation) -> None:
        if conversation.topics_changed and self._is_told:
            self._is_told = False
            asyncio.get_running_loop().call_later(_TOPICS_PAUSE, self._tell_topics)

    def _welcome(self, conversation: Conversation) -> None:
        session = self._status.session
        if not session or conversation.session_id != self._session_id:
            session += 1
        self._session_id = conversation.session_id
        self._capabilities = conversation.capabilities
        self._offers = conversation.offers
        conversation.topics_changed = True
        self._say(
            is_connected=True,
            sentence=conversation.sentence(),
            retry_s=None,
            session=session,
        )

    def _tell_health(self) -> None:
        conversation = self._conversation
        if conversation is None:
            return
        # Subscriptions that a server has refused are tried again.
        self._update()
        self._assets.expire("the server has not sent it in time")
        dropped, lag = self._delivery.dropped, self._clock.lag_s()
        self._say(
            sentence=conversation.sentence(dropped, lag),
            dropped=dropped,
            unreadable=conversation.unreadable,
            # Streams differ by milliseconds all the time.
            lag_s=None if lag is None else round(lag, 1),
        )

    def _update(self) -> None:
        """Subscribe to the wanted topics, unless listeners do not know new ones yet.

        A recorder subscribes when it learns of a topic. A message that a display
        received before that would be missing in its file.
        """
        if self._conversation is not None and self._is_told:
            self._conversation.update(self._wanted())

    def _put(self, message: Recorded) -> None:
        if message.topic == CLOCK and (told := told_time(message)) is not None:
            self._clock.note_time(told)
        self._delivery.put(message)

    def _wanted(self) -> frozenset[str]:
        """Return the wanted topics, and with them that of the simulated time."""
        wanted = self._delivery.wanted()
        has_time = "time" in self._capabilities or not is_clock(self._topics.get(CLOCK))
        return wanted if has_time or not wanted else wanted | {CLOCK}

    def _tell_topics(self) -> None:
        conversation = self._conversation
        if conversation is None or not conversation.topics_changed:
            self._has_told()
            return
        conversation.topics_changed = False
        self._topics = MappingProxyType(conversation.topics())
        self._delivery.post(self._call_on_topics)

    def _has_told(self) -> None:
        self._is_told = True
        self._update()
        if self._conversation is not None:
            self._plan_topics(self._conversation)

    def _say(self, **changes: Any) -> None:
        status = replace(self._status, **changes)
        if status != self._status:
            self._status = status
            self._delivery.post(self._call_on_status)

    # Who owns the source may set these at any time.
    def _call_on_topics(self) -> None:
        try:
            self.on_topics()
        finally:
            self._post(self._has_told)

    def _call_on_status(self) -> None:
        self.on_status()


def next_pause(attempt: int) -> float:
    """Return the pause before the next attempt [s], after a number of failed ones."""
    grown = FIRST_PAUSE * GROWTH ** min(attempt, 20)
    return min(LONGEST_PAUSE, grown * random.uniform(1.0, 1.5))


async def _end_others() -> None:
    """Wait until the connections of goals, which are told to end, have done so."""
    if left := asyncio.all_tasks() - {asyncio.current_task()}:
        await asyncio.wait(left, timeout=LONGEST_STOP / 2.0)


def _nothing() -> None:
    return None
