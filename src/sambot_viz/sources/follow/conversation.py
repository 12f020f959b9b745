"""The state of following one recording: topics, what holds, and how far behind."""

from __future__ import annotations

from dataclasses import replace

from sambot_viz import limits
from sambot_viz.errors import SourceError
from sambot_viz.sources.bag.bag import Bag
from sambot_viz.sources.latched_state import LatchedState
from sambot_viz.sources.live.conversation import Conversation, Ends
from sambot_viz.sources.live.outgoing_topic import OutgoingTopic
from sambot_viz.sources.live.service_calls import ServiceCalls
from sambot_viz.sources.message import Recorded, SourceTopic
from sambot_viz.sources.source import Capability, Encoding, OutgoingAction, Source

_ONLY_READ = (
    "a recording is followed, and nothing can be sent to it: name the robot itself "
    "with --source"
)
SILENCE = 10.0
"""Without a new file for longer than this and two files, the status says so [s]."""


class FollowConversation(Conversation):
    """What has come of a recording that is followed.

    Args:
        first: the name of its first file, which tells it from another recording.
        ends: of the source.

    Attributes:
        missing: number of files that the server did not have, or that cannot be read.
        trouble: why the server gives nothing now; "" when it does.
        has_ended: whether the last file was played.
    """

    publishes: Encoding = "cdr"

    def __init__(self, first: str, ends: Ends) -> None:
        super().__init__(ends)
        self.calls = ServiceCalls(self._refuse_call, self.publishes)
        self.session_id = first
        self.missing = 0
        self.trouble = ""
        self.has_ended = False
        self._topics: dict[str, SourceTopic] = {}
        self._held = LatchedState()
        self._subscribed = frozenset[str]()
        self._behind_s: float | None = None
        self._part_s = 0.0
        self._silent_s = 0.0
        self._came_at: float | None = None

    def begin(self) -> None:
        """Be ready: the list has come."""
        self.is_ready = True

    def take_part(self, bag: Bag, waited_s: float) -> None:
        """Take the topics of a file that is played from now on.

        Args:
            bag: the file.
            waited_s: time since its name was in the list [s].
        """
        length = ((bag.end_ns or 0) - (bag.start_ns or 0)) * 1e-9
        self._part_s = max(self._part_s, length)
        self._behind_s = length + waited_s
        self._came_at = None
        for name, topic in bag.topics.items():
            if name not in self._topics and len(self._topics) < limits.TOPICS.value:
                self._topics[name] = replace(topic, count=None)
                self.topics_changed = True

    def hand_on(self, message: Recorded) -> None:
        """Deliver a message; each file begins with the latched ones of before."""
        if self._held.take(message):
            self.ends.clock.note_message(message.log_ns)
            self.ends.put(message)

    def update(self, wanted: frozenset[str]) -> None:
        """Give new subscribers what holds."""
        new, self._subscribed = wanted - self._subscribed, wanted
        for message in self._held.without() if new else ():
            if message.topic in new:
                self.ends.put(message)
        self.ends.assets.refuse_all(
            "a recording has no files",
            "give the folder of the package with --package-path",
        )

    def tick(self, now: float) -> None:
        """Note for how long nothing new has come."""
        if self._came_at is None:
            self._came_at = now
        self._silent_s = now - self._came_at

    def sentence(self, dropped: int = 0, lag_s: float | None = None) -> str:
        """Return how far behind the recorder the page is."""
        del lag_s
        parts = ["Following the recording"]
        if self._behind_s is not None and not self.has_ended:
            parts = [f"About {self._behind_s:.0f} s behind the recorder"]
        if dropped:
            parts.append(f"{dropped} messages were dropped, displays were too slow")
        return "; ".join([*parts, *self.notes()])

    def notes(self) -> list[str]:
        """Return the end, a silence, and files that are missing."""
        notes: list[str] = []
        if self.trouble:
            notes.append(self.trouble)
        if self.has_ended:
            notes.append(
                "the recording has ended, and this is its last picture: go through it "
                "with --source bag:ADDRESS"
            )
        elif self._silent_s > SILENCE + 2 * self._part_s:
            notes.append(
                f"nothing new for {self._silent_s:.0f} s: the recorder was ended "
                "without a word, nothing is published, or its files no longer reach "
                "the server"
            )
        if self.missing:
            are = "file is" if self.missing == 1 else "files are"
            notes.append(f"{self.missing} {are} missing or cannot be read")
        return notes

    def topics(self) -> dict[str, SourceTopic]:
        """Return the topics of the files so far."""
        return dict(self._topics)

    @property
    def offers(self) -> frozenset[Capability]:
        """Nothing beside what each live source can do."""
        return frozenset()

    @property
    def unpublishable(self) -> str:
        """Why nothing can be sent."""
        return _ONLY_READ

    def action(self, name: str, type_name: str, source: Source) -> OutgoingAction:
        """Refuse: see `unpublishable`."""
        raise SourceError(_ONLY_READ)

    def _refuse_call(self, number: int, service: str, request: bytes) -> None:
        raise SourceError(_ONLY_READ)

    def advertise(self, outgoing: OutgoingTopic) -> None:
        """Do nothing: nothing is sent."""

    def publish(self, outgoing: OutgoingTopic, message: bytes) -> None:
        """Do nothing: nothing is sent."""

    def unadvertise(self, outgoing: OutgoingTopic) -> None:
        """Do nothing: nothing is sent."""

    def receive(self, frame: str | bytes) -> None:
        """Take nothing: files have no frames."""

    def topic_of(self, head: bytes) -> str:
        """Return nothing: files are read by their index."""
        return ""

    def silence(self) -> str:
        """Return nothing: it is ready when the list has come."""
        return ""
