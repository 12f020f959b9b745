"""Mimic chains: the joints that a mimic joint follows, one after the other."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal

from sambot_viz.robot.joint import Joint


@dataclass(frozen=True, slots=True)
class MimicChain:
    """A joint, the joint it mimics, the joint that one mimics, and so on.

    Attributes:
        joints: the joint itself first, each joint once.
        end: how the chain ends: with a joint that mimics none ("free"), with one that
            mimics a joint that does not exist ("unknown"), or with one that mimics a
            joint of the chain ("ring").
    """

    joints: tuple[Joint, ...]
    end: Literal["free", "unknown", "ring"]

    @property
    def ring(self) -> tuple[Joint, ...]:
        """The joints that mimic each other in a ring; empty for other ends."""
        mimic = self.joints[-1].mimic
        if self.end != "ring" or mimic is None:
            return ()
        names = [joint.name for joint in self.joints]
        return self.joints[names.index(mimic.joint) :]


def mimic_chain(joint: Joint, joints: Mapping[str, Joint]) -> MimicChain:
    """Follow a joint's mimic elements to the end.

    Args:
        joint: where the chain begins.
        joints: all joints of the robot, by name.
    """
    chain = {joint.name: joint}
    last = joint
    while last.mimic is not None:
        name = last.mimic.joint
        if name in chain:
            return MimicChain(tuple(chain.values()), "ring")
        if name not in joints:
            return MimicChain(tuple(chain.values()), "unknown")
        last = chain[name] = joints[name]
    return MimicChain(tuple(chain.values()), "free")
