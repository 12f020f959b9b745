"""A copy of a session's state, for a browser that goes on by itself."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

from sambot_viz.joints.presets import Presets
from sambot_viz.rviz import RvizConfig
from sambot_viz.session.user_frames import UserFrame

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
    """

    config: RvizConfig
    positions: Mapping[str, float]
    frames: Mapping[str, UserFrame]
    poses: Presets

    @classmethod
    def of(cls, session: Session) -> SessionCopy:
        """Copy a session, which is locked."""
        joints = session.joints
        return cls(
            session.config.copy(),
            {} if joints is None else dict(joints.positions),
            dict(session.added.all),
            session.poses.in_memory(),
        )

    def give(self, session: Session) -> None:
        """Put joints and frames where they are in the copy."""
        for child, frame in self.frames.items():
            session.add_frame(frame.parent, child, frame.transform, static=frame.static)
        if session.joints is not None:
            known = session.joints.free
            session.move({n: q for n, q in self.positions.items() if n in known}, {})
