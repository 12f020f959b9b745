"""A copy of a session's state, for a private copy or for a file."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path

from sambot_viz.displays.robot_display import ModelReader
from sambot_viz.frames import Transform
from sambot_viz.joints.presets import Presets
from sambot_viz.meshes.cache import MeshCache
from sambot_viz.robot.model import Robot
from sambot_viz.rviz import RvizConfig
from sambot_viz.session.comparison import ComparisonChoice
from sambot_viz.session.robot.motion_recorder import MotionSample
from sambot_viz.session.robot.user_frames import UserFrame
from sambot_viz.topics.source_robot import Lease, SourceRobot


@dataclass(frozen=True, slots=True)
class SessionCopy:
    """The state of a session at one moment; meshes and the robot are not copied.

    Attributes:
        config: the .rviz document, with the edits that are not saved.
        positions: joint → position [rad or m], without those that follow others.
        frames: child → frame that was added.
        poses: the named poses, in memory only.
        config_file: the .rviz file that the command line opened, or None.
        trusted_files: the models that it named before a client could change it.
        robot: the robot, if there is one.
        own_model: whether it is the session's own, and not the server's.
        link_colors: link → the colour that a program has given it, 0 to 255.
        highlighted: the links that a program highlights.
        trail: where the robot was driven, x, y [m] in odom.
        models: reads further models.
        meshes: mesh files that are read already.
        moved_by: the recording or the live robot that moves it; None without one.
        lease: keeps the source open.
        time_ns: the shown log time of the recording [ns].
        follows: whether its messages move the joints.
        texts: unsaved texts of the model's files; see `Checks`.
        comparison: the choice of what the robot is compared with.
        moved: numbers of the model that were changed but not written.
    """

    config: RvizConfig
    positions: Mapping[str, float]
    frames: Mapping[str, UserFrame]
    poses: Presets
    config_file: Path | None
    trusted_files: frozenset[str]
    robot: Robot | None
    own_model: bool
    link_colors: Mapping[str, tuple[int, int, int]]
    highlighted: frozenset[str]
    trail: tuple[tuple[float, float], ...]
    models: ModelReader | None
    meshes: MeshCache
    moved_by: SourceRobot | None = None
    lease: Lease | None = None
    time_ns: int = 0
    follows: bool = True
    texts: Mapping[str, str] = field(default_factory=dict[str, str])
    comparison: ComparisonChoice = field(default_factory=ComparisonChoice)
    moved: Mapping[str, float] = field(default_factory=dict[str, float])

    @property
    def recorded(self) -> SourceRobot | None:
        """The recording that moves the robot; None without one."""
        moved_by = self.moved_by
        return moved_by if moved_by is not None and moved_by.can("seek") else None

    def before(self, sample: MotionSample) -> SessionCopy:
        """Return the same, with joints and frames where they were."""
        frames = {
            child: replace(frame, transform=Transform.trusted(sample.frames[child]))
            if child in sample.frames
            else frame
            for child, frame in self.frames.items()
        }
        return replace(self, positions=sample.positions, frames=frames)
