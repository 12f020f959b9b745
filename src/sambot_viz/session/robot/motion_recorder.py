"""Records how joints and driven frames move; the last minute is kept.

A record is added at every step of a motion, so it is only an array of numbers: one step
of 300 joints takes 2.4 kB, and names are stored once while they stay the same.
"""

from __future__ import annotations

from array import array
from collections import deque
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass

from sambot_viz.geometry import Matrix
from sambot_viz.session.worker import Clock

LONGEST = 60.0
"""Length of the kept motion [s]."""
PERIOD = 0.025
"""Steps that follow faster are one [s]; those of the usual 30 Hz do not."""
MOST_NUMBERS = 300_000
"""Positions that are kept: 2.4 MB. Of more joints, less than a minute is kept."""


@dataclass(slots=True)
class _Note:
    time: float
    joints: tuple[str, ...]
    positions: array[float]
    frames: dict[str, Matrix] | None


@dataclass(frozen=True, slots=True)
class MotionSample:
    """Where joints and frames that moved are from a time on.

    Attributes:
        time: from the first of them [s].
        positions: joint → position [rad or m].
        frames: added frame → (4, 4) T_parent_child.
    """

    time: float
    positions: Mapping[str, float]
    frames: Mapping[str, Matrix]


Past = tuple[MotionSample, Sequence[MotionSample]]
"""The first values of everything, and the steps from there."""


class MotionRecorder:
    """Keeps the last minute; not thread-safe, the session holds the lock.

    Args:
        clock: gives the time of a step.
    """

    def __init__(self, clock: Clock) -> None:
        self._clock = clock
        self._notes: deque[_Note] = deque()
        self._numbers = 0
        self._before: dict[str, float] = {}
        self._frames_before: dict[str, Matrix] = {}

    def clear(self, positions: Mapping[str, float]) -> None:
        """Begin with the positions of all joints that can be set."""
        self._notes.clear()
        self._numbers = 0
        self._before = dict(positions)
        self._frames_before = {}

    def note(
        self,
        joints: Iterable[str],
        positions: Mapping[str, float],
        frames: Mapping[str, Matrix],
    ) -> None:
        """These joints and frames have moved.

        Args:
            joints: the joints, followers too, which are left out.
            positions: free joint → position [rad or m].
            frames: added frame → (4, 4) T_parent_child; kept, not copied.
        """
        now = self._clock.now()
        names = tuple([name for name in joints if name in positions])
        numbers = array("d", [positions[name] for name in names])
        last = self._notes[-1] if self._notes else None
        if last is not None and now - last.time < PERIOD:
            self._merge(last, names, numbers, frames)
            return
        if last is not None and last.joints == names:
            names = last.joints
        self._notes.append(_Note(now, names, numbers, dict(frames) or None))
        self._numbers += len(numbers)
        self._forget(now - LONGEST)

    def begin(self, frame: str, T: Matrix) -> None:
        """A frame is about to move from here, T_parent_child (4, 4)."""
        self._frames_before.setdefault(frame, T)

    def last_minute(self) -> Past:
        """Where everything was before, and the steps since; none when nothing moved."""
        self._forget(self._clock.now() - LONGEST)
        notes = self._notes
        # The first step comes after a moment of rest.
        begin = notes[0].time - PERIOD if notes else 0.0
        return MotionSample(0.0, dict(self._before), dict(self._frames_before)), list(
            self._moved(begin)
        )

    def _moved(self, begin: float) -> Iterator[MotionSample]:
        for note in self._notes:
            positions = dict(zip(note.joints, note.positions, strict=True))
            yield MotionSample(note.time - begin, positions, dict(note.frames or {}))

    def _merge(
        self,
        last: _Note,
        names: tuple[str, ...],
        numbers: array[float],
        frames: Mapping[str, Matrix],
    ) -> None:
        if names == last.joints:
            last.positions = numbers
        else:
            both = dict(zip(last.joints, last.positions, strict=True))
            both |= zip(names, numbers, strict=True)
            self._numbers += len(both) - len(last.joints)
            last.joints, last.positions = tuple(both), array("d", both.values())
        if frames:
            last.frames = {**(last.frames or {}), **frames}

    def _forget(self, before: float) -> None:
        """Merge the records before the kept time into the poses at its start."""
        notes = self._notes
        while notes and (notes[0].time < before or self._numbers > MOST_NUMBERS):
            old = notes.popleft()
            self._numbers -= len(old.joints)
            self._before.update(zip(old.joints, old.positions, strict=True))
            self._frames_before.update(old.frames or {})
