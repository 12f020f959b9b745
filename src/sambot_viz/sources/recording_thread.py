"""The thread that writes one recording of a live source.

The thread of the source only leaves messages in a queue; this one writes them. A disk
that is too slow costs messages of the file, and nothing else.
"""

from __future__ import annotations

import threading
import time
from collections import deque
from collections.abc import Callable
from contextlib import closing
from dataclasses import dataclass

from sambot_viz import limits
from sambot_viz.files import reason_of
from sambot_viz.outlet import logger
from sambot_viz.sources.message import Recorded
from sambot_viz.sources.recording_file import RecordingTarget
from sambot_viz.sources.source import Source
from sambot_viz.text import text

PERIOD = 1.0
"""Time between reports, and between flushes at first [s]."""
_FIRST_WITHIN = 1.0
"""Latched messages from before the start wait so long for the first other one [s]."""
LONGEST_STOP = 10.0
"""`stop` waits this long for the disk [s]."""

_log = logger(__name__)


@dataclass(frozen=True, slots=True)
class RecordingStatus:
    """How a recording is.

    Attributes:
        name: of the file.
        is_running: messages are still written.
        seconds: since its start, or how long it was [s].
        size: of the file [bytes].
        messages: how many were written.
        dropped: how many were not, since the disk was too slow.
        lost: how many were not, since this computer was too slow to take them.
        unfit: how many were not, since the format has no place for them.
        trouble: why it ended before it was stopped; "" for none.
    """

    name: str
    is_running: bool = True
    seconds: float = 0.0
    size: int = 0
    messages: int = 0
    dropped: int = 0
    lost: int = 0
    unfit: int = 0
    trouble: str = ""

    @property
    def missing(self) -> str:
        """Say which messages are not in the file, and why; "" for none."""
        causes = (
            (self.dropped, "the disk is too slow"),
            (self.lost, "this computer is too slow"),
            (self.unfit, "MCAP has no place for their time, or for so many topics"),
        )
        return "; ".join(
            f"{count:,} {'message is' if count == 1 else 'messages are'} not in it: "
            f"{cause}"
            for count, cause in causes
            if count
        )


class RecordingThread:
    """Writes one recording until it is stopped.

    Args:
        source: the source to record.
        target: where the messages are written; it is closed at the end.
        on_change: called once in a period, in the thread; must only post.
        on_trouble: called in the thread with the reason if a recording ends before it
            was stopped.
        period: between reports [s].

    Attributes:
        status: the state of the recording.
    """

    def __init__(
        self,
        source: Source,
        target: RecordingTarget,
        on_change: Callable[[], object],
        on_trouble: Callable[[str], object],
        period: float = PERIOD,
    ) -> None:
        self._period = period
        self._source = source
        self._target = target
        self._on_change = on_change
        self._on_trouble = on_trouble
        self._thread = threading.Thread(
            target=self._run, name=f"sambot-viz {target.name}", daemon=True
        )
        # The thread of the source adds, that of the recording takes.
        self._changed = threading.Condition()
        self._queue: deque[tuple[Recorded, bool]] = deque()
        self._waiting = 0
        self._dropped = 0
        self._lost_before = source.status.dropped
        self._is_stopped = False
        self._subscribed: set[str] = set()
        # Of the recording's thread.
        self._begun = time.monotonic()
        self._messages = 0
        self._unfit = 0
        self._begin_ns: int | None = None
        self._held: list[Recorded] = []
        self.status = RecordingStatus(target.name)

    def start(self) -> None:
        """Begin to write, and subscribe."""
        self._thread.start()
        self.subscribe()

    def stop(self, wait: bool) -> None:
        """Take no more, and close the file; may be called twice.

        Args:
            wait: until the file is closed.
        """
        with self._changed:
            self._is_stopped = True
            self._changed.notify()
        if wait and threading.current_thread() is not self._thread:
            self._thread.join(LONGEST_STOP)

    def subscribe(self) -> None:
        """Ask for the topics that are new; those that are gone may come back."""
        readable = {
            name
            for name, topic in self._source.topics().items()
            if topic.reason is None
        }
        with self._changed:
            if self._is_stopped:
                return
            new = readable - self._subscribed
            self._subscribed |= new
        for name in new:
            self._source.subscribe(name, self._receive, self._receive_kept)
        if self._is_stopped:
            # It may have ended since, and unsubscribed before this.
            for name in new:
                self._source.unsubscribe(name, self._receive)

    def _receive(self, message: Recorded) -> None:
        self._put(message, False)

    def _receive_kept(self, message: Recorded) -> None:
        """Take a message from before the start, if late subscribers would get it."""
        if message.channel.is_latched or message.topic == "/map":
            self._put(message, True)

    def _put(self, message: Recorded, is_kept: bool) -> None:
        size = len(message.payload)
        with self._changed:
            if self._is_stopped:
                return
            too_many = len(self._queue) >= limits.RECORDING_MESSAGES.value
            if too_many or (
                self._queue and self._waiting + size > limits.RECORDING_WAITS.value
            ):
                self._dropped += 1
                return
            self._queue.append((message, is_kept))
            self._waiting += size

    # The recording's thread

    def _run(self) -> None:
        trouble = ""
        try:
            with closing(self._target):
                self._write_all()
        except OSError as error:
            trouble = f"Recording {text(self._target.name)} ended: {reason_of(error)}"
            self._messages = self._target.rescue()
        except Exception as error:
            _log.debug("recording", exc_info=error)
            trouble = (
                f"Recording {text(self._target.name)} ended: internal error {error}"
            )
        with self._changed:
            self._is_stopped = True
            self._queue.clear()
        for name in self._subscribed:
            self._source.unsubscribe(name, self._receive)
        if not self._messages:
            self._target.remove()
            trouble = trouble or "No message came, so there is no file"
        if trouble:
            self._on_trouble(trouble)
        self._tell(is_running=False, trouble=trouble)

    def _write_all(self) -> None:
        file = self._target
        file.begin()
        while True:
            taken, is_stopped = self._take()
            for message, is_kept in taken:
                self._write(file, message, is_kept)
            seconds = time.monotonic() - self._begun
            if is_stopped or seconds > _FIRST_WITHIN:
                self._write_held(file)
            if is_stopped:
                file.finish()
                return
            file.keep(seconds)
            if seconds - self.status.seconds >= self._period:
                self._tell()

    def _take(self) -> tuple[deque[tuple[Recorded, bool]], bool]:
        """Return what has come in a tenth of a second, and whether to stop."""
        with self._changed:
            if not self._is_stopped:
                # Only `stop` notifies: waking up for each message would cost more than
                # writing it.
                self._changed.wait(0.1)
            taken, self._queue = self._queue, deque()
            self._waiting = 0
            return taken, self._is_stopped

    def _write(self, file: RecordingTarget, message: Recorded, is_kept: bool) -> None:
        if is_kept and self._begin_ns is None:
            self._held.append(message)
            return
        if self._begin_ns is None:
            self._begin_ns = message.log_ns
            self._write_held(file)
        # Messages that were latched before are at the beginning of the file.
        log_ns = max(message.log_ns, self._begin_ns) if is_kept else message.log_ns
        self._count(file.write(message, log_ns))

    def _write_held(self, file: RecordingTarget) -> None:
        held, self._held = self._held, []
        if held and self._begin_ns is None:
            self._begin_ns = max(message.log_ns for message in held)
        for message in held:
            self._count(file.write(message, self._begin_ns or message.log_ns))

    def _count(self, is_written: bool) -> None:
        if is_written:
            self._messages += 1
        else:
            self._unfit += 1

    def _tell(self, is_running: bool = True, trouble: str = "") -> None:
        self.status = RecordingStatus(
            self._target.name,
            is_running,
            time.monotonic() - self._begun,
            self._target.size,
            self._messages,
            self._dropped,
            self._source.status.dropped - self._lost_before,
            self._unfit,
            trouble,
        )
        self._on_change()
