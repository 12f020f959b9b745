"""Poses of a robot: the one it begins with, and named ones in a yaml file beside it.

It begins with start values, a recorded joint state and single joints.
"""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import cast

import yaml

from sambot_viz import limits
from sambot_viz.errors import JointError, did_you_mean
from sambot_viz.files import write_atomically
from sambot_viz.geometry import finite
from sambot_viz.joints.state import JointState
from sambot_viz.joints.value_texts import first_document
from sambot_viz.robot.model import Robot

Pose = dict[str, float]
"""Joint → position [rad or m]."""


class Presets:
    """Named poses, and the file they are saved in.

    Args:
        path: the yaml file; it need not exist yet. None keeps the poses in memory.

    Raises:
        JointError: the file exists and holds something else than poses.
    """

    def __init__(self, path: Path | None = None) -> None:
        self.path = path
        self._poses: dict[str, Pose] = {}
        if path is not None and os.path.exists(path):
            self._poses = _load(path)

    def in_memory(self) -> Presets:
        """Make a copy that writes no file, for clients who may not change it."""
        copy = Presets()
        copy._poses = dict(self._poses)
        return copy

    @property
    def names(self) -> tuple[str, ...]:
        """The names of the poses in the order in which they were saved."""
        return tuple(self._poses)

    def get(self, name: str) -> Pose:
        """Return a copy of one pose.

        Raises:
            JointError: an unknown pose.
        """
        if name not in self._poses:
            raise JointError(f"no pose '{name}'; {did_you_mean(name, self._poses)}")
        return dict(self._poses[name])

    def save(self, name: str, positions: Mapping[str, float]) -> None:
        """Keep a pose under a name, in place of an older one, and write the file.

        Raises:
            JointError: an empty name, a value that is not finite, or a file that
                cannot be written (then nothing changes).
        """
        name = name.strip()
        if not name:
            raise JointError("a pose needs a name")
        for joint, value in positions.items():
            if finite(value) is None:
                raise JointError(f"joint '{joint}' has {value!r}: not a finite number")
        self._replace({**self._poses, name: dict(positions)})

    def remove(self, name: str) -> None:
        """Forget a pose and write the file.

        Raises:
            JointError: an unknown pose, or the file cannot be written.
        """
        self.get(name)
        self._replace({n: pose for n, pose in self._poses.items() if n != name})

    def _replace(self, poses: dict[str, Pose]) -> None:
        if self.path is not None:
            _write(self.path, poses)
        self._poses = poses


def _load(path: Path) -> dict[str, Pose]:
    document = first_document(path, "the poses in ", limits.POSES_FILE.value)
    if document is None:
        return {}
    if not isinstance(document, dict):
        raise JointError(f"{path} has no poses: expected 'pose: {{joint: value}}'")
    poses = cast("dict[object, object]", document)
    return {str(name): _pose(str(name), pose, path) for name, pose in poses.items()}


def _pose(name: str, pose: object, path: Path) -> Pose:
    if not isinstance(pose, dict):
        raise JointError(f"{path}: pose '{name}' is not a list of 'joint: value'")
    values: Pose = {}
    for joint, value in cast("dict[object, object]", pose).items():
        number = finite(value)
        if number is None:
            raise JointError(
                f"{path}: pose '{name}' has {value!r} for joint '{joint}', which is "
                "not a finite number"
            )
        values[str(joint)] = number
    return values


def _write(path: Path, poses: dict[str, Pose]) -> None:
    """Write beside the file and swap, so that a crash leaves the old or the new one."""
    text = yaml.safe_dump(poses, sort_keys=False, allow_unicode=True)
    try:
        write_atomically(path, text.encode("utf-8"))
    except OSError as error:
        raise JointError(f"cannot save the poses in {path}: {error}") from error


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
            JointError: `zeros` or `positions` name a joint that does not exist or
                cannot be set.
        """
        state = JointState(robot, zeros=self.zeros)
        state.set_all({n: v for n, v in self.recorded.items() if n in state.free})
        following = {n: v for n, v in self.positions.items() if n in state.followers}
        state.set_all({n: v for n, v in self.positions.items() if n not in following})
        recorded = {n: v for n, v in self.recorded.items() if n in state.followers}
        state.compare_followers(recorded | following)
        return state

    def known_in(self, robot: Robot) -> StartPose:
        """Return the part of it that a robot has joints for."""
        maps = (self.zeros, self.recorded, self.positions)
        return StartPose(
            *({n: q for n, q in one.items() if n in robot.joints} for one in maps)
        )

    def passed_over(self, state: JointState) -> tuple[str, ...]:
        """Return the names of the recorded message that the robot does not know."""
        known = {*state.joints, *state.skipped}
        return tuple(name for name in self.recorded if name not in known)
