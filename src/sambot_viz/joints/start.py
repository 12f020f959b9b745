"""The pose a robot begins with: start values, a recorded joint state, single joints."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from sambot_viz.joints.state import JointState
from sambot_viz.robot.model import Robot


@dataclass(frozen=True, slots=True)
class StartPose:
    """The pose that ``--zeros``, ``--joint-state`` and ``--joint`` give, in this order.

    Attributes:
        zeros: joint → start value [rad or m], which Center goes back to.
        recorded: joint → position of a recorded message. As joint_state_publisher
            does, joints that are not there are passed over.
        positions: joint → position; every one must be there and able to move.

    Real messages contain the joints that mimic others too. These follow what they
    mimic; a position that disagrees with that is a warning.
    """

    zeros: Mapping[str, float] = field(default_factory=dict[str, float])
    recorded: Mapping[str, float] = field(default_factory=dict[str, float])
    positions: Mapping[str, float] = field(default_factory=dict[str, float])

    def state(self, robot: Robot) -> JointState:
        """Make the joint state of a robot in this pose.

        Raises:
            JointError: `zeros` or `positions` name a joint that is not there or
                cannot be set.
        """
        state = JointState(robot, zeros=self.zeros)
        state.set_all({n: v for n, v in self.recorded.items() if n in state.free})
        following = {n: v for n, v in self.positions.items() if n in state.followers}
        state.set_all({n: v for n, v in self.positions.items() if n not in following})
        recorded = {n: v for n, v in self.recorded.items() if n in state.followers}
        state.compare_followers(recorded | following)
        return state

    def passed_over(self, state: JointState) -> tuple[str, ...]:
        """Return the names of the recorded message that the robot does not know."""
        known = {*state.joints, *state.skipped}
        return tuple(name for name in self.recorded if name not in known)
