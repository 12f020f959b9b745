"""What moves by itself: wheels that turn, and a robot that is driven.

Steps are taken at the config's Frame Rate while something moves; when nothing does,
nothing runs and nothing is sent.
"""

from __future__ import annotations

import math
import time
from dataclasses import dataclass
from typing import TYPE_CHECKING

from sambot_viz.joints.animation import turn
from sambot_viz.session.robot.drive_control import DriveControl

if TYPE_CHECKING:
    from sambot_viz.session import Session

HOLD = 0.3
"""A held button counts as released this long after its last message [s]; viser sends
ten per second."""
LONGEST_STEP = 0.25
"""A busy machine makes the motion slower than real time, not jump [s]."""


@dataclass
class _Turning:
    rate: float
    left: float


class Motion:
    """The motion of one session.

    Args:
        session: whose joints and frames move.

    Attributes:
        drive: the robot on its two wheels.
    """

    def __init__(self, session: Session) -> None:
        self._session = session
        self._turning: dict[str, _Turning] = {}
        self._ticking = False
        self._closed = False
        self._last = 0.0
        self.drive = DriveControl(session, self.start)

    @property
    def moving(self) -> bool:
        """Whether something moves."""
        return bool(self._turning) or self.drive.moving

    def turn(self, joint: str, rate: float, seconds: float = math.inf) -> None:
        """Turn a joint at a rate, until the next call or the time is up.

        Args:
            joint: a free joint; one with limits stops there.
            rate: [rad/s or m/s]; 0 stops it.
            seconds: how long [s].

        Raises:
            JointError: an unknown joint, one that cannot be set, no finite number.
        """
        with self._session.lock:
            state = self._session.joints
            if state is None:
                return
            if state.checked(joint, rate) == 0:
                self._turning.pop(joint, None)
            else:
                self._turning[joint] = _Turning(rate, seconds)
            self._session.signals.motion.touch()
        self.start()

    def turns(self, joint: str) -> bool:
        """Whether a joint turns at the moment."""
        return joint in self._turning

    @property
    def turning(self) -> tuple[str, ...]:
        """The joints that turn at the moment."""
        return tuple(self._turning)

    def stop(self) -> None:
        """Stop all motion."""
        with self._session.lock:
            self._turning.clear()
            self.drive.stop()
            self._session.signals.motion.touch()

    def advance(self, dt: float) -> None:
        """Move on by a time [s]; this is what happens at every step."""
        session = self._session
        with session.lock:
            state = session.joints
            if state is None:
                return
            positions: dict[str, float] = {}
            before = self.turning
            for name, turning in list(self._turning.items()):
                if name not in state.free:
                    del self._turning[name]
                    continue
                step = min(dt, turning.left)
                positions |= turn(state, {name: turning.rate}, step, wrap=True)
                turning.left -= dt
                if turning.left <= 0:
                    del self._turning[name]
            driven, frames = self.drive.advance(dt)
            session.move({**positions, **driven}, frames)
            if before != self.turning:
                session.signals.motion.touch()

    def start(self) -> None:
        """Start the steps, if something moves and they do not run yet."""
        with self._session.lock:
            if self._ticking or self._closed or not self.moving:
                return
            self._ticking = True
            self._last = time.monotonic()
        self._wait()

    def close(self) -> None:
        """Stop the steps for good."""
        self._closed = True
        self.drive.close()

    def _wait(self) -> None:
        self._session.worker.post_later(self._session.period, self._step)

    def _step(self) -> None:
        """Take one step, in the session's worker; an error stops all motion."""
        now = time.monotonic()
        dt, self._last = min(now - self._last, LONGEST_STEP), now
        self._ticking = False
        if self._closed:
            return
        try:
            self.advance(dt)
        except Exception:
            self.stop()
            raise
        if self.moving:
            self._ticking = True
            self._wait()
