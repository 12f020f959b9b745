"""Drives the live robot of a session by hand: where, in which type, and who does."""

from __future__ import annotations

import threading
from collections.abc import Callable
from dataclasses import dataclass

from sambot_viz.errors import PublishError, SourceError
from sambot_viz.publishing.dead_mans_switch import DeadMansSwitch, Hand
from sambot_viz.publishing.protection import Protection
from sambot_viz.publishing.takers import who_takes
from sambot_viz.publishing.velocity import VELOCITY_TYPES, Velocity
from sambot_viz.publishing.written import written
from sambot_viz.sources.source import Outgoing
from sambot_viz.text import text
from sambot_viz.topics.source_robot import SourceRobot

NOT_REACHED = (
    "STOP did not reach the robot: the connection is lost; it may keep its last speed"
)


@dataclass(frozen=True, slots=True)
class Driving:
    """The driving hand, and why the last one was stopped.

    Attributes:
        hand: the hand; None when no one drives.
        why: the reason of the last stop; "" if the hand let go.
        stops: number of stops with a reason.
        failure: a sentence if no zero velocity was sent; "" if it was.
    """

    hand: Hand | None = None
    why: str = ""
    stops: int = 0
    failure: str = ""


class Driver:
    """Sends velocities to one robot; all but `choose` may be called in any thread.

    Args:
        robot: a live robot.
        now_ns: returns its time [ns]; takes no lock.
        topic: the topic of velocities.
        most: the highest linear [m/s] and angular speed [rad/s].
        told: called when a user begins or ends to drive, and when the state changes; in
            any thread, must only post.
        sent: called with each new velocity that was sent, and the page, or the name of
            the one who stopped the robot; in any thread, must only post.
    """

    def __init__(
        self,
        robot: SourceRobot,
        now_ns: Callable[[], int],
        topic: str,
        most: tuple[float, float],
        told: Callable[[], object],
        sent: Callable[[Velocity, int | str], object],
    ) -> None:
        self.topic, self.most = topic, most
        self.driving = Driving()
        self._robot, self._now_ns = robot, now_ns
        self._told, self._sent = told, sent
        self._chosen = ""
        self._lock = threading.Lock()
        self._outgoing: Outgoing | None = None
        self._last: tuple[Velocity, int | str] | None = None
        self._client, self._stopper = -1, ""
        self._protection = Protection(robot, told)
        self._switch = DeadMansSwitch(self._send, most, self._change, self._lose)

    @property
    def type_name(self) -> str:
        """The type of the velocities: the robot's own, else the chosen one, else ""."""
        known = self._robot.source.topics().get(self.topic)
        name = "" if known is None else known.schema.name
        return name if name in VELOCITY_TYPES else self._chosen

    @property
    def is_asked(self) -> bool:
        """Whether a user has to say which type the robot takes."""
        known = self._robot.source.topics().get(self.topic)
        return known is None or known.schema.name not in VELOCITY_TYPES

    def choose(self, type_name: str) -> None:
        """Take another type, for a robot that does not say which it takes."""
        self._switch.stop("the type of the velocities was changed")
        self._chosen = type_name
        self._told()

    @property
    def protection(self) -> str:
        """What stops the robot when the connection to it is lost, in words."""
        with self._lock:
            receivers = None if self._outgoing is None else self._outgoing.receivers
        return self._protection.words(receivers)

    def hold(self, hand: Hand, forwards: float, left: float) -> None:
        """Drive on; called repeatedly while a key or the stick is held.

        Args:
            hand: the driving hand.
            forwards: part of the highest speed, -1 to 1.
            left: the same for the angular speed.

        Raises:
            PublishError: no node reads velocities, or their type is unknown.
            SourceError: the robot accepts no messages, or has left.
        """
        if self._switch.hand != hand:
            self._prepare()
            self._client, self._stopper = hand.client, ""
        self._switch.hold(hand, forwards, left)

    def release(self, client: int, press: int) -> None:
        """Let go of a press: the robot is stopped."""
        self._switch.release(client, press)

    def leave(self, client: int) -> None:
        """A page has gone."""
        self._switch.leave(client)

    def stop(self, why: str, *, who: str = "", at_rest: bool = False) -> str:
        """Stop the robot, whichever hand drives.

        Args:
            why: the reason, for everyone.
            who: the one who stops it, for the log; "" for the driver.
            at_rest: whether to stop it also when no page drives, if the type of its
                velocities is known.

        Returns:
            A sentence if no velocity is sent; "" if it is.
        """
        failure, self._stopper = "", who
        if at_rest:
            try:
                # Whoever seems to take it or not: a bridge may be wrong.
                self._prepare(is_stop=True)
            except PublishError as error:
                failure = f"STOP sent no velocity: {error}"
            except SourceError:
                failure = NOT_REACHED
        if failure:
            # A hand ends all the same.
            self._switch.stop("")
            self._fail(why, failure)
        else:
            self._switch.stop(why, at_rest=at_rest)
        return failure

    def close(self) -> None:
        """Stop the robot, and send nothing after that."""
        self._switch.close()
        with self._lock:
            if self._outgoing is not None:
                self._outgoing.close()
                self._outgoing = None

    def _prepare(self, *, is_stop: bool = False) -> None:
        """Announce the topic, and require a reader unless the robot is to stop."""
        type_name = self.type_name
        if not type_name:
            raise PublishError(
                f"choose the type that the robot takes on {text(self.topic, 80)} first"
            )
        with self._lock:
            one = self._outgoing
            if one is not None and (
                one.type_name != type_name or one.refused or one.is_over
            ):
                # What was refused is tried again; what was lost may be back.
                one.close()
                one = self._outgoing = None
            if one is not None and not is_stop:
                who_takes(one, "drive")
            elif one is None:
                # Who takes it is known soon, and asked with each velocity.
                one = self._robot.source.advertise(self.topic, type_name)
            self._outgoing = one

    def _send(self, linear: float, angular: float) -> None:
        """Send a velocity; in the thread of the switch, without a session's lock."""
        with self._lock:
            outgoing = self._outgoing
        if outgoing is None:
            raise SourceError("the robot has left")
        velocity = Velocity(outgoing.type_name, linear, angular)
        if linear or angular:
            self._require_taken(outgoing)
        types = self._robot.decoding.types
        try:
            outgoing.send(written(outgoing, velocity, self._now_ns(), types))
        except SourceError as error:
            with self._lock:
                is_replaced = self._outgoing not in (None, outgoing)
                if not is_replaced:
                    self._outgoing = None
            if is_replaced:
                # STOP has found another connection: its zeros are not given up.
                raise PublishError(str(error)) from error
            raise
        is_zero = not linear and not angular
        who = self._stopper if is_zero and self._stopper else self._client
        if (velocity, who) != self._last:
            self._last = velocity, who
            self._sent(velocity, who)

    def _require_taken(self, outgoing: Outgoing) -> None:
        """Raise PublishError where a velocity would be refused, or have no effect."""
        if outgoing.refused:
            raise PublishError(f"the robot refuses it: {text(outgoing.refused, 400)}")
        who_takes(outgoing, "drive")

    def _change(self, hand: Hand | None, why: str) -> None:
        outgoing = self._outgoing
        if why and (outgoing is None or outgoing.is_over):
            self._fail(why, NOT_REACHED)
            return
        self.driving = Driving(hand, why, self.driving.stops + bool(why))
        self._told()

    def _lose(self, why: str) -> None:
        """Take that the zero velocities of a stop could not be sent."""
        self._fail(self.driving.why or why, NOT_REACHED)

    def _fail(self, why: str, failure: str) -> None:
        """Say that the robot was not stopped."""
        self.driving = Driving(None, why, self.driving.stops + 1, failure)
        self._told()
