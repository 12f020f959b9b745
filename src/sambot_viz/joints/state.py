"""The positions of a robot's joints, as joint_state_publisher keeps them.

Where that node has faults, this has none: values are exact (not one of 10000 steps), a
reload keeps them, and a mimic joint that cannot follow stops nothing.
"""

from __future__ import annotations

import random
from collections.abc import Iterable, Mapping
from types import MappingProxyType

from sambot_viz import limits
from sambot_viz.errors import JointError, Problem, did_you_mean
from sambot_viz.geometry import Matrix, finite
from sambot_viz.joints.mimic import Follower, find_followers
from sambot_viz.robot.joint_tree import mimicked
from sambot_viz.robot.kinematics import Kinematics
from sambot_viz.robot.model import Robot
from sambot_viz.robot.parts import Joint

AGREES = 1e-3
"""Positions that differ less are the same: messages are rounded [rad or m]."""


class JointState:
    """The free joints of a robot, their positions, and those of joints that follow.

    Positions are in radians (revolute, continuous) or metres (prismatic). Not
    thread-safe: the session that owns it holds the lock.

    Args:
        robot: the robot whose joints these are.
        zeros: joint → start value, also outside the limits (``--zeros``).

    Attributes:
        kinematics: the kinematics of the robot.
        moves: the number of the last move.

    Raises:
        JointError: `zeros` name a joint that does not exist, or hold a number that is
            not finite.
    """

    kinematics: Kinematics

    def __init__(
        self, robot: Robot, *, zeros: Mapping[str, float] | None = None
    ) -> None:
        self._zeros: dict[str, float] = {}
        self._positions: dict[str, float] = {}
        self.moves = 0
        self._take(robot)
        for name, value in (zeros or {}).items():
            self._zeros[name] = self.checked(name, value)
        self._positions = {name: self.start(name) for name in self._free}
        self._place_all()

    # Which joints there are

    @property
    def joints(self) -> Mapping[str, Joint]:
        """The joints that have a position, in document order."""
        return MappingProxyType(self._joints)

    @property
    def free(self) -> tuple[str, ...]:
        """The joints that take a value, in document order."""
        return tuple(self._free)

    @property
    def sliders(self) -> tuple[str, ...]:
        """The free joints that get a slider: not those with a range of one point."""
        return tuple(n for n, j in self._free.items() if j.range[0] != j.range[1])

    @property
    def followers(self) -> Mapping[str, Follower]:
        """The mimic joints and how they follow, in document order; read-only."""
        return MappingProxyType(self._followers)

    @property
    def skipped(self) -> Mapping[str, str]:
        """The joints without a position: name → why, for a panel to show."""
        return MappingProxyType(self._skipped)

    @property
    def problems(self) -> tuple[Problem, ...]:
        """The mimic joints that cannot follow, or disagree with what was given.

        What the reader of the model has found is left out: one cause, one problem.
        """
        return self._problems

    # Their positions

    @property
    def positions(self) -> Mapping[str, float]:
        """Free joint → position [rad or m], exactly as it was set."""
        return MappingProxyType(self._positions)

    def all_positions(self) -> dict[str, float]:
        """Joint → position [rad or m] in document order, followers included.

        These are the names and positions of joint_state_publisher's message.
        """
        return dict(self._all)

    def moved_since(self, move: int) -> dict[str, float]:
        """Joint → position [rad or m] of those that have moved later, followers too.

        Args:
            move: a number that `moves` had; 0 for all joints.
        """
        moved: dict[str, float] = {}
        for name in reversed(self._moved_at):
            if self._moved_at[name] <= move:
                break
            moved[name] = self._all[name]
        return moved

    def transforms(self, names: Iterable[str]) -> dict[str, Matrix]:
        """Joint → (4, 4) T_parent_child at its position, of some joints."""
        return self.kinematics.joint_transforms(names, self._all)

    def set(self, name: str, value: float) -> bool:
        """Set one free joint; values outside its range pass (see `over_limit`).

        Args:
            name: the joint.
            value: position [rad or m].

        Returns:
            Whether the position changed.

        Raises:
            JointError: an unknown joint, one that cannot be set, no finite number.
        """
        return bool(self.set_all({name: value}))

    def set_all(self, values: Mapping[str, float]) -> tuple[str, ...]:
        """Set several free joints at once: all of them or, after an error, none.

        Returns:
            The names of all joints that moved, followers included.

        Raises:
            JointError: an unknown joint, one that cannot be set, no finite number.
        """
        free, most = self._free, limits.NUMBER.value
        numbers = {
            # Invalid values are checked again one by one, for the message.
            name: v
            if type(v) is float and -most <= v <= most and name in free
            else self.checked(name, v)
            for name, v in values.items()
        }
        changed = [n for n, v in numbers.items() if v != self._positions[n]]
        self._positions.update(numbers)
        return self._moved(changed)

    def checked(self, name: str, value: float) -> float:
        """Return a value as a number, if it is finite and the joint can be set.

        Raises:
            JointError: an unknown joint, one that cannot be set, no finite number.
        """
        self._require(name, self._free)
        return _number(name, value)

    def start(self, name: str) -> float:
        """Return the start value [rad or m]: `zeros`, else 0, else mid-range.

        Raises:
            JointError: an unknown joint.
        """
        self._require(name, self._joints)
        return self._zeros.get(name, self._joints[name].start)

    def center(self) -> tuple[str, ...]:
        """Set every free joint to its start value, as the button Center does.

        Returns:
            The names of all joints that moved, followers included.
        """
        return self.set_all({name: self.start(name) for name in self._free})

    def randomize(self, seed: int | None = None) -> tuple[str, ...]:
        """Set every free joint to a random value of its range, evenly distributed.

        Args:
            seed: the same seed gives the same positions for the same robot.

        Returns:
            The names of all joints that moved, followers included.
        """
        # Not for secrets: a seed has to give the same pose again.
        source = random.Random(seed)
        return self.set_all(
            {n: source.uniform(*j.range) for n, j in self._free.items()}
        )

    def compare_followers(self, given: Mapping[str, float]) -> None:
        """Add a warning for each mimic joint that was given another position.

        Args:
            given: mimic joint → position [rad or m], from a message or an argument.
        """
        found = [
            Problem(
                "warning",
                "mimic-joint-disagrees",
                f"joint '{name}' was given {value:g}, but it mimics "
                f"'{self._followers[name].leader}' and so is at {self._all[name]:g}",
                f"set '{self._followers[name].leader}' instead",
            )
            for name, value in given.items()
            if not abs(value - self._all[name]) <= AGREES
        ]
        self._problems = (*self._problems, *found)

    def over_limit(self) -> tuple[str, ...]:
        """Return the joints whose position is outside their range, with followers.

        A joint without an end has no limit (its range is the slider's), and neither
        has a mimic joint whose file gives none.
        """
        return tuple(sorted(self._over, key=self._order.__getitem__))

    def reload(self, robot: Robot) -> tuple[str, ...]:
        """Switch to another robot, or to the same after an edit.

        A joint that still exists with the same type keeps its value; one that was at
        its start value goes to the new start value.

        Returns:
            The names of all joints whose position is new or has changed.
        """
        former, types = self.all_positions(), self._joints
        at_start = {n for n, v in self._positions.items() if v == self.start(n)}
        old = dict(self._positions)
        self._take(robot)
        self._positions = {
            name: old[name]
            if name in old and types[name].type == j.type and name not in at_start
            else self.start(name)
            for name, j in self._free.items()
        }
        self._place_all()
        return tuple(n for n, v in self._all.items() if former.get(n) != v)

    # Inside

    def _take(self, robot: Robot) -> None:
        self.kinematics = robot.kinematics
        self._joints = {n: j for n, j in robot.joints.items() if j.movable}
        self._followers, found = find_followers(robot.joints)
        known = {problem.code for problem in robot.problems}
        self._problems = tuple(one for one in found if one.code not in known)
        self._free = {n: j for n, j in self._joints.items() if j.mimic is None}
        self._skipped = {
            n: f"{j.type}: has no position in ROS"
            for n, j in robot.joints.items()
            if not j.movable
        }
        self._order = {name: place for place, name in enumerate(self._joints)}
        self._led: dict[str, list[str]] = {}
        for name in sorted(self._followers, key=self._chain_length):
            self._led.setdefault(self._followers[name].leader, []).append(name)
        self._limits = {
            name: sorted(joint.range)
            for name, joint in self._joints.items()
            if not (joint.endless or joint.limit is None or None in joint.limit.ends)
        }

    def _chain_length(self, name: str) -> int:
        """Return how many joints a mimic joint follows, one through the other."""
        length = 0
        while name in self._followers:
            name, length = self._followers[name].mimic.joint, length + 1
        return length

    def _place_all(self) -> None:
        """Work out all positions from those of the free joints."""
        positions = self.kinematics.positions(self._positions)
        self._all = {name: positions[name] for name in self._joints}
        self._over: set[str] = set()
        self._moved_at: dict[str, int] = {}
        self._note_moved(self._joints)

    def _require(self, name: str, among: Iterable[str]) -> None:
        if name in among:
            return
        if name in self._followers:
            leader = self._followers[name].leader
            raise JointError(
                f"joint '{name}' mimics '{leader}' and cannot be set; set '{leader}'"
            )
        if name in self._skipped:
            raise JointError(f"joint '{name}' cannot be set; {self._skipped[name]}")
        if name in self._joints:
            mimic = self._joints[name].mimic
            raise JointError(
                f"joint '{name}' cannot be set, because it mimics "
                f"'{mimic.joint if mimic else ''}', which it cannot follow"
            )
        raise JointError(f"no joint '{name}'; {did_you_mean(name, among)}")

    def _moved(self, changed: Iterable[str]) -> tuple[str, ...]:
        moved: list[str] = []
        for name in changed:
            moved.append(name)
            moved.extend(self._led.get(name, ()))
            self._all[name] = self._positions[name]
            for led in self._led.get(name, ()):
                mimic = self._followers[led].mimic
                leader = self._all[mimic.joint]
                self._all[led] = mimicked(leader, mimic.multiplier, mimic.offset)
        self._note_moved(moved)
        return tuple(moved)

    def _note_moved(self, joints: Iterable[str]) -> None:
        """Note what has moved, and which of it is over its limits."""
        self.moves += 1
        for name in joints:
            # The one that has moved last is the last one.
            self._moved_at.pop(name, None)
            self._moved_at[name] = self.moves
            if name in self._limits:
                lower, upper = self._limits[name]
                is_within = lower <= self._all[name] <= upper
                (self._over.discard if is_within else self._over.add)(name)


def _number(name: str, value: float) -> float:
    number = finite(value)
    if number is None:
        raise JointError(
            f"joint '{name}' cannot be set to {value!r}: it is not a finite number"
        )
    if abs(number) > limits.NUMBER.value:
        raise JointError(
            f"joint '{name}' cannot be set to {value!r}: more than "
            f"{limits.NUMBER.value:g}"
        )
    return number
