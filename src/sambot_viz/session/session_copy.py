"""A copy of a session's state, for a browser that goes on by itself."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from sambot_viz.joints.presets import Presets
from sambot_viz.rviz import RvizConfig
from sambot_viz.session.robot.user_frames import UserFrame

if TYPE_CHECKING:
    from sambot_viz.session import Session


@dataclass(frozen=True, slots=True)
class SessionCopy:
    """What a session shows at one moment; meshes and the robot are not copied.

    Attributes:
        config: the .rviz document, with the edits that are not saved.
        positions: joint → position [rad or m], without those that follow others.
        frames: child → frame that was added.
        poses: the named poses, in memory only.
        config_file: the .rviz file that the command line opened, or None.
        trusted_files: the models that it named before a browser could change it.
    """

    config: RvizConfig
    positions: Mapping[str, float]
    frames: Mapping[str, UserFrame]
    poses: Presets
    config_file: Path | None
    trusted_files: frozenset[str]

    @classmethod
    def of(cls, session: Session) -> SessionCopy:
        """Copy a session, which is locked."""
        joints = session.joints
        return cls(
            session.config.copy(),
            {} if joints is None else dict(joints.positions),
            dict(session.added.all),
            session.poses.in_memory(),
            session.context.config_file,
            session.context.trusted_files,
        )

    def trust(self, session: Session) -> None:
        """Let a session, before it draws, trust the models that the first one trusts.

        Its document may name others, which a browser has chosen.
        """
        session.context.config_file = self.config_file
        session.context.trusted_files = self.trusted_files

    def give(self, session: Session) -> None:
        """Put joints and frames where they are in the copy."""
        for child, frame in self.frames.items():
            session.add_frame(frame.parent, child, frame.transform, static=frame.static)
        if session.joints is not None:
            known = session.joints.free
            session.move({n: q for n, q in self.positions.items() if n in known}, {})
