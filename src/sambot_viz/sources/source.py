"""What every source is, a recording or a robot on the network.

A source hands on messages as bytes; it neither decodes nor draws. Callbacks of a robot
run in one thread of its source, one after the other, and must only post; those of a
recording run in the thread that moves its time.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from concurrent.futures import Future
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Literal, Protocol

from sambot_viz.errors import Problem, SourceError
from sambot_viz.sources.message import Recorded, SourceTopic

if TYPE_CHECKING:
    from sambot_viz.sources.bag.bag import Bag
    from sambot_viz.sources.subscriber import Subscriber

OnMessage = Callable[[Recorded], object]
Asset = Future[bytes]
"""A file that was asked for."""


@dataclass(frozen=True, slots=True)
class Receivers:
    """The receivers of a topic at the peer.

    Attributes:
        names: names of the subscribed nodes; None where the peer reports none.
        type_name: the message type that they expect; "" if unknown.
    """

    names: tuple[str, ...] | None = None
    type_name: str = ""


@dataclass(frozen=True, slots=True)
class Reply:
    """The answer of a service.

    Attributes:
        content: the response.
        is_json: whether that is JSON; else it is CDR.
        refusal: why there is none, in the peer's own words where it has said some.
    """

    content: bytes
    is_json: bool = False
    refusal: str = ""


Encoding = Literal["cdr", "json"]
"""How something is written for a peer."""
OnReply = Callable[[Reply], object]


@dataclass(frozen=True, slots=True)
class GoalReport:
    """A robot's report about a goal that was sent to one of its actions.

    Attributes:
        status: as in action_msgs/msg/GoalStatus; 0 if unknown.
        feedback: a message of the action's feedback topic.
        result: at the end, the response of the action's service get_result.
        refusal: a phrase with the reason why no more reports come: the goal was
            rejected, or the connection was lost.
    """

    status: int = 0
    feedback: Recorded | None = None
    result: Reply | None = None
    refusal: str = ""

    @property
    def is_last(self) -> bool:
        """Whether this is the last report about the goal."""
        return bool(self.refusal) or self.status in GOAL_ENDS


SUCCEEDED, CANCELED, ABORTED = 4, 5, 6
GOAL_ENDS = (SUCCEEDED, CANCELED, ABORTED)
"""Numbers of action_msgs/msg/GoalStatus."""
OnReport = Callable[[GoalReport], object]
CancelGoal = Callable[[], object]
"""Asks a robot to cancel one goal; what becomes of it is reported."""


class OutgoingAction(Protocol):
    """An action to which goals are sent, as long as the connection lasts.

    Attributes:
        name: of the action.
        type_name: such as nav2_msgs/action/NavigateToPose.
        encoding: how goals are to be written.
        frame_prefix: as of `Outgoing`.
    """

    name: str
    type_name: str
    encoding: Encoding
    frame_prefix: str

    def send(self, goal: bytes, told: OnReport) -> CancelGoal:
        """Send a goal once.

        Args:
            goal: the fields of the action's goal.
            told: called with each report, the last of which says so; it must only post.

        Raises:
            SourceError: the connection has ended; nothing was sent.
        """
        ...


class Outgoing(Protocol):
    """A topic that is published to a robot, as long as the connection lasts.

    Nothing of it is kept or sent again: what cannot be sent now is refused.

    Attributes:
        topic: its name.
        type_name: of its messages, as ROS 2 writes it.
        encoding: how messages are to be written.
        refused: the peer's own words when it has refused the topic or a message.
        receivers: who gets the messages, as far as the peer has said it.
        frame_prefix: what the names of frames have here, and at the robot have not.
    """

    topic: str
    type_name: str
    encoding: Encoding
    refused: str
    receivers: Receivers
    frame_prefix: str

    @property
    def is_over(self) -> bool:
        """Whether its connection has ended; there may be another one by now."""
        ...

    def send(self, message: bytes) -> None:
        """Publish a message.

        Raises:
            SourceError: the connection, or the topic, has ended.
        """
        ...

    def close(self) -> None:
        """Publish the topic no longer; a second call does nothing."""
        ...


@dataclass(frozen=True, slots=True)
class SourceStatus:
    """The status of a source.

    Attributes:
        is_connected: whether messages can come.
        sentence: for the page: the state, what is missing, and the remedy.
        retry_s: length of the pause before the next attempt [s]; None without one.
        lag_s: delay of the newest messages, compared with the fastest [s]; None if
            unknown.
        dropped: number of messages dropped because callbacks were too slow.
        unreadable: number of malformed frames of the peer.
        session: grows when the peer starts again; earlier messages are of another run.
        is_whole: whether, of several sources, each one is connected.
        received: number of received messages of subscribed topics; its changes are not
            reported.
    """

    is_connected: bool = False
    sentence: str = ""
    retry_s: float | None = None
    lag_s: float | None = None
    dropped: int = 0
    unreadable: int = 0
    session: int = 0
    is_whole: bool = True
    received: int = field(default=0, compare=False)


Capability = Literal[
    "topics",
    "subscribe",
    "latched",
    "seek",
    "clock",
    "graph",
    "files",
    "parameters",
    "publish",
    "call",
]
"""A word for something that a source can do.

topics: list them. subscribe: deliver their messages. latched: late subscribers get the
messages that still hold. seek: its time can be moved, see `playback`. clock: its time
goes on by itself. files: serve the files of a robot. publish: publish topics to the
robot. graph: list the subscribers of a topic. No source has the others yet: parameters
of nodes; call, for services.
"""


class Source(Protocol):
    """A recording, or a connection to a robot that is made again when it is lost.

    Attributes:
        uri: what the user calls it: its name, or as it was written.
        on_topics: called when `topics` has changed.
        on_status: called when `status` has changed; counters at most twice a second.
    """

    uri: str
    on_topics: Callable[[], object]
    on_status: Callable[[], object]

    def open(self) -> None:
        """Begin to connect; returns at once."""
        ...

    def close(self) -> None:
        """End it, with its threads; may be called twice, also by a callback."""
        ...

    def of_session(self) -> Source:
        """Return it as one session sees it.

        A connection is the same for all; of a recording each session has its time.
        """
        ...

    @property
    def status(self) -> SourceStatus:
        """How the source is now."""
        ...

    @property
    def capabilities(self) -> frozenset[Capability]:
        """What it can do; files only once the peer has said so."""
        ...

    @property
    def playback(self) -> Playback | None:
        """Its time, with the capability seek; None without."""
        ...

    @property
    def hidden(self) -> tuple[Problem, ...]:
        """Which topics are not handed on, as another part of it has the same."""
        ...

    @property
    def live(self) -> Source | None:
        """What has a clock, with the capability clock; None without."""
        ...

    def topics(self) -> Mapping[str, SourceTopic]:
        """Return the topics by name; those of the last connection if there is none."""
        ...

    def subscribe(
        self, topic: str, callback: OnMessage, on_kept: OnMessage | None = None
    ) -> None:
        """Call back with each message of a topic, which need not exist yet.

        The same pair a second time changes nothing. The messages for a late subscriber
        come first: all of latched topics, and the last one of others; of a live source
        only those that came during an earlier subscription.

        Args:
            topic: its name.
            callback: called with the messages.
            on_kept: called with those that came before; by default the callback is.
        """
        ...

    def unsubscribe(self, topic: str, callback: OnMessage) -> None:
        """No longer call back; a call that has begun goes on."""
        ...

    @property
    def has_clock(self) -> bool:
        """Whether the peer has told its time, as that of a simulation."""
        ...

    def clock_ns(self) -> int:
        """Return the time of the source [ns]: simulated where it says so."""
        ...

    def fetch_asset(self, uri: str) -> Asset:
        """Ask for a file, such as package://sam_bot/meshes/a.stl.

        The result raises `SourceError` with the peer's own text when it is refused, and
        without the capability files.
        """
        ...

    def advertise(self, topic: str, type_name: str) -> Outgoing:
        """Begin to publish a topic; its receivers may need a moment to find it.

        Args:
            topic: its name.
            type_name: the type of its messages, such as geometry_msgs/msg/PoseStamped.

        Raises:
            SourceError: there is no connection, or it lacks the capability publish; the
                message says how to turn that on.
        """
        ...

    def call(
        self, service: str, write: Callable[[Encoding], bytes], answered: OnReply
    ) -> None:
        """Call a service once; it is not called again after a lost connection.

        Args:
            service: its name.
            write: returns the request in the encoding of the peer.
            answered: called once with the answer, or the reason why there is none; it
                must only post.

        Raises:
            SourceError: there is no connection, or nothing can be called.
        """
        ...

    def action(self, name: str, type_name: str) -> OutgoingAction:
        """Return an action that accepts goals now; nothing is sent to it yet.

        Whether the robot has it is known a moment after the first subscription to the
        topic of its status (`action_names.status_topic`).

        Args:
            name: the name of the action, such as /navigate_to_pose.
            type_name: its type, such as nav2_msgs/action/NavigateToPose.

        Raises:
            SourceError: there is no connection, or the peer does not expose the action;
                the message says how to expose it.
        """
        ...


class Playback(Source, Protocol):
    """A source with the capability seek: a recording, at a time that its owner moves.

    Callbacks are called in the thread that moves the time, or subscribes.
    """

    @property
    def recording(self) -> Bag:
        """The messages."""
        ...

    @property
    def start_ns(self) -> int:
        """The log time of the first message [ns]."""
        ...

    @property
    def end_ns(self) -> int:
        """The log time of the last message [ns]."""
        ...

    @property
    def time_ns(self) -> int:
        """The log time up to which messages were handed on [ns]."""
        ...

    def of_session(self) -> Playback:
        """Return the same recording with an independent time."""
        ...

    def add(self, subscriber: Subscriber) -> None:
        """Give one more the messages, and at once those of the present time."""
        ...

    def remove(self, subscriber: Subscriber) -> None:
        """Remove a subscriber."""
        ...

    def seek(self, time_ns: int) -> None:
        """Go to the time of the recording nearest to a log time [ns].

        Subscribers get what holds there, as if it had been played to that time.
        """
        ...

    def advance(self, until_ns: int) -> None:
        """Hand on the messages up to a log time [ns], at most the end."""
        ...

    def neighbour(self, topic: str | None, *, back: bool = False) -> int | None:
        """Return the log time of the next message of a topic, or of the last [ns].

        Args:
            topic: its name; None for any subscribed topic.
            back: whether to look before the present time, not after it.
        """
        ...


def no_file(why: str) -> Asset:
    """Return the refusal of a source without files."""
    refused: Asset = Future()
    refused.set_exception(SourceError(why))
    return refused
