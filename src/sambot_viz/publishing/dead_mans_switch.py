"""A robot moves only as long as a hand says so; this is what stops it.

The switch has its own thread and takes no lock but its own: neither a session that
hangs nor a page that floods delays it. A page that holds a key or the stick says so ten
times a second. When it does not for a moment, lets go, or is not to drive any longer,
the robot gets three zero velocities, and then nothing more.
"""

from __future__ import annotations

import math
import threading
import time
from collections.abc import Callable
from dataclasses import dataclass

from sambot_viz.errors import PublishError, SourceError

SILENCE = 0.3
"""A hand that has said nothing for so long has let go [s]."""
PERIOD = 0.05
"""Between two velocities [s]."""
ZEROS = 3
"""Number of zero velocities that end each motion: one could be lost."""
RAMP = 0.5
"""From rest to the highest speed takes so long [s]; stopping is not put off."""
LONGEST_STOP = 5.0
"""`close` waits this long for the zero velocities: on a busy machine they take long
[s]."""
_SILENT = "nothing was heard from the page that drove it"


@dataclass(frozen=True, slots=True)
class Hand:
    """Who drives.

    Attributes:
        client: the number of the page.
        press: which press of a key or the stick it is; each is a higher number.
    """

    client: int
    press: int


class DeadMansSwitch:
    """Sends the velocities of a hand to a robot, and stops it. Thread-safe.

    Args:
        send: sends a linear [m/s] and an angular velocity [rad/s]; called in the thread
            of the switch. It raises PublishError for a velocity that must not be sent,
            and SourceError if none can be sent.
        most: the highest linear [m/s] and angular speed [rad/s].
        changed: called when a hand begins or ends, with the hand or None, and the
            reason for which the last one was stopped ("" if it let go); it must only
            post.
        lost: called with the reason if the zero velocities that end a motion cannot be
            sent; it must only post.
    """

    def __init__(
        self,
        send: Callable[[float, float], object],
        most: tuple[float, float],
        changed: Callable[[Hand | None, str], object],
        lost: Callable[[str], object] = lambda why: None,
    ) -> None:
        self._send, self._most, self._changed = send, most, changed
        self._lost = lost
        self._wake = threading.Condition(threading.Lock())
        self._hand: Hand | None = None
        self._wanted = self._velocity = (0.0, 0.0)
        self._heard = 0.0
        self._zeros = 0
        self._is_closed = False
        # Of each page the last press that has ended: it does not begin again.
        self._ended: dict[int, int] = {}
        self._thread = threading.Thread(
            target=self._run, name="sambot-viz-drive", daemon=True
        )

    @property
    def hand(self) -> Hand | None:
        """Who drives now."""
        return self._hand

    def hold(self, hand: Hand, forwards: float, left: float) -> bool:
        """Drive on; called repeatedly while a key or the stick is held.

        Another hand stops the robot, and has to press again.

        Args:
            hand: the driving hand.
            forwards: part of the highest speed, -1 to 1; other values are clamped.
            left: the same for the angular speed.

        Returns:
            Whether the press counts: one that has ended does not begin again.
        """
        with self._wake:
            if self._is_closed or hand.press <= self._ended.get(hand.client, -1):
                return False
            if self._hand is not None and self._hand != hand:
                self._ended[hand.client] = hand.press
                self._end("two pages drove it at once")
                return False
            begins = self._hand is None
            self._hand, self._heard = hand, time.monotonic()
            self._wanted = (
                _part(forwards) * self._most[0],
                _part(left) * self._most[1],
            )
            if begins:
                self._velocity, self._zeros = (0.0, 0.0), 0
                self._changed(hand, "")
                self._begin()
            return True

    def release(self, client: int, press: int) -> None:
        """Let go of a press, which never counts again, even if it is repeated later."""
        with self._wake:
            self._ended[client] = max(press, self._ended.get(client, -1))
            if self._hand is not None and self._hand.client == client:
                self._end("")

    def leave(self, client: int) -> None:
        """A page has gone."""
        with self._wake:
            if self._hand is not None and self._hand.client == client:
                self._end("the page that drove it has gone")
            self._ended.pop(client, None)

    def stop(self, why: str, *, at_rest: bool = False) -> None:
        """End what any hand does.

        Args:
            why: the reason, for everyone.
            at_rest: whether to send zero velocities even when no hand drives.
        """
        with self._wake:
            if self._hand is not None:
                self._end(why)
            elif at_rest and not self._is_closed:
                self._zeros = ZEROS
                self._changed(None, why)
                self._begin()

    def close(self) -> None:
        """Stop the robot, and send nothing after that; waits until it is done."""
        with self._wake:
            if self._hand is not None:
                self._end("")
            self._is_closed = True
            self._wake.notify_all()
        if self._thread.is_alive() and threading.current_thread() is not self._thread:
            self._thread.join(LONGEST_STOP)

    def _begin(self) -> None:
        """Let the thread send what there is now; the lock is held."""
        if not self._thread.ident:
            self._thread.start()
        self._wake.notify_all()

    def _end(self, why: str) -> None:
        """End the present hand; the lock is held."""
        hand = self._hand
        assert hand is not None
        self._ended[hand.client] = max(hand.press, self._ended.get(hand.client, -1))
        self._hand, self._wanted = None, (0.0, 0.0)
        self._zeros = ZEROS
        self._changed(None, why)
        self._wake.notify_all()

    def _run(self) -> None:
        last = time.monotonic()
        while True:
            with self._wake:
                while self._hand is None and not self._zeros:
                    if self._is_closed:
                        return
                    self._wake.wait()
                    last = time.monotonic()
                now = time.monotonic()
                if self._hand is not None and now - self._heard > SILENCE:
                    self._end(_SILENT)
                hand = self._hand
                if hand is None:
                    self._zeros -= 1
                    self._velocity = (0.0, 0.0)
                else:
                    self._velocity = self._ramped(now - last)
                velocity, last = self._velocity, now
            try:
                self._send(*velocity)
            except PublishError as error:
                # The zeros are sent all the same: it may have been wrong.
                self.stop(str(error))
            except SourceError as error:
                self._give_up(str(error))
            with self._wake:
                # A hand that ends does not wait for the next period.
                left = self._heard + SILENCE - time.monotonic()
                wait = PERIOD if hand is None else max(0.0, min(PERIOD, left))
                self._wake.wait_for(lambda before=hand: self._hand != before, wait)

    def _give_up(self, why: str) -> None:
        """Nothing can be sent: not even that the robot is to stop."""
        with self._wake:
            if self._hand is not None:
                self._end("")
            self._zeros = 0
            self._lost(why)

    def _ramped(self, seconds: float) -> tuple[float, float]:
        linear, angular = (
            before + _within(wanted - before, most * seconds / RAMP)
            for before, wanted, most in zip(
                self._velocity, self._wanted, self._most, strict=True
            )
        )
        return linear, angular


def _part(value: float) -> float:
    return _within(value, 1.0) if math.isfinite(value) else 0.0


def _within(value: float, most: float) -> float:
    return min(most, max(-most, value))
