"""What moves by itself: wheels that turn, and a robot that is driven.

Steps are taken at the config's Frame Rate while something moves; when nothing does,
nothing runs and nothing is sent.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from sambot_viz.joints.animation import eased, turn
from sambot_viz.joints.state import JointState
from sambot_viz.session.robot.robot_drive import Drive
from sambot_viz.session.robot.robot_state import RobotState
from sambot_viz.session.signals import Change, Signal, connect
from sambot_viz.session.worker import Worker

LONGEST_STEP = 0.25
"""A busy machine makes the motion slower than real time, not jump [s]."""


@dataclass
class _Turning:
    rate: float
    left: float


@dataclass
class _Glide:
    """A motion to a pose.

    Attributes:
        ways: joint → where it was, and where it goes [rad or m].
        reached: joint → where it was put last.
        seconds: how long it takes.
        time: since it has begun [s].
    """

    ways: dict[str, tuple[float, float]]
    reached: dict[str, float]
    seconds: float
    time: float = 0.0


class Motion:
    """Moves joints and the driven robot, step by step.

    Args:
        robot: the robot whose joints and frames move.
        drive: the differential drive.
        change: sends the list of turning joints.
        worker: takes the steps; its clock measures the time between two.

    Attributes:
        turning: the joints that turn now.
        period: time between two steps [s].
    """

    def __init__(
        self,
        robot: RobotState,
        drive: Drive,
        change: Change,
        worker: Worker,
    ) -> None:
        self.turning: Signal[tuple[str, ...]] = Signal(change, ())
        self.period = 0.0
        self._robot = robot
        self._drive = drive
        self._change = change
        self._worker = worker
        self._turning: dict[str, _Turning] = {}
        self._glide: _Glide | None = None
        self._ticking = False
        self._closed = False
        self._last = 0.0
        connect([drive.velocity], self.start)
        connect([robot.followed], self._leave_to_messages)

    @property
    def moving(self) -> bool:
        """Whether something moves."""
        return bool(self._turning or self._glide) or self._drive.moving

    def turn(self, joint: str, rate: float, seconds: float = math.inf) -> None:
        """Turn a joint at a rate, until the next call or the time is up.

        Args:
            joint: a free joint; one with limits stops there.
            rate: the velocity [rad/s or m/s]; 0 stops it.
            seconds: the duration [s].

        Raises:
            JointError: the joint is unknown or cannot be set, or a number not finite.
        """
        with self._change.lock:
            state = self._robot.joints
            if state is None:
                return
            self._robot.require_free()
            if state.checked(joint, rate) == 0:
                self._turning.pop(joint, None)
            else:
                self._turning[joint] = _Turning(rate, seconds)
            self._tell()
        self.start()

    def stop_turning(self, joints: Iterable[str]) -> None:
        """Let some joints turn no more: they are moved to where they shall stay."""
        with self._change.lock:
            for name in joints:
                self._turning.pop(name, None)
            self._tell()

    def glide(self, positions: Mapping[str, float], seconds: float) -> None:
        """Move joints to a pose; a joint that a user moves meanwhile is left alone.

        Args:
            positions: free joint → position [rad or m].
            seconds: the duration, whatever the distance [s].
        """
        with self._change.lock:
            state = self._robot.joints
            if state is None:
                return
            self.stop_turning(positions)
            now = {name: state.positions[name] for name in positions}
            ways = {name: (now[name], goal) for name, goal in positions.items()}
            self._glide = _Glide(ways, now, seconds)
        self.start()

    def turns(self, joint: str) -> bool:
        """Whether a joint turns at the moment."""
        return joint in self._turning

    def stop(self) -> None:
        """Stop all motion."""
        with self._change.lock:
            self._turning.clear()
            self._glide = None
            self._drive.stop()
            self._tell()

    def _leave_to_messages(self) -> None:
        if self._robot.followed.value:
            self.stop()

    def advance(self, dt: float) -> None:
        """Move on by a time [s]; this is what happens at every step."""
        with self._change.lock:
            state = self._robot.joints
            if state is None:
                return
            positions = self._glided(state, dt)
            for name, turning in list(self._turning.items()):
                if name not in state.free:
                    del self._turning[name]
                    continue
                step = min(dt, turning.left)
                positions |= turn(state, {name: turning.rate}, step, wrap=True)
                turning.left -= dt
                if turning.left <= 0:
                    del self._turning[name]
            driven, frames = self._drive.advance(dt)
            self._robot.move({**positions, **driven}, frames)
            self._tell()

    def _glided(self, state: JointState, dt: float) -> dict[str, float]:
        """Return where the joints of a motion to a pose are after a time [s]."""
        glide = self._glide
        if glide is None:
            return {}
        glide.time += dt
        part = min(1.0, glide.time / glide.seconds)
        positions = {
            name: goal if part == 1.0 else begin + (goal - begin) * eased(part)
            for name, (begin, goal) in glide.ways.items()
            # Who moves a joint meanwhile, or undoes the pose, has it.
            if state.positions.get(name) == glide.reached.get(name)
        }
        glide.reached = positions
        if part == 1.0 or not positions:
            self._glide = None
        return positions

    def start(self) -> None:
        """Start the steps, if something moves and they do not run yet."""
        with self._change.lock:
            if self._ticking or self._closed or not self.moving:
                return
            self._ticking = True
            self._last = self._worker.clock.now()
        self._wait()

    def close(self) -> None:
        """Stop the steps for good."""
        self._closed = True

    def _tell(self) -> None:
        self.turning.set(tuple(self._turning))

    def _wait(self) -> None:
        self._worker.post_later(self.period, self._step)

    def _step(self) -> None:
        """Take one step, in the session's worker; an error stops all motion."""
        now = self._worker.clock.now()
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
