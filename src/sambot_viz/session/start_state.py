"""What a session begins with beside the robot and the config."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from sambot_viz import bundled
from sambot_viz.frames.static_transform import StaticTransform, parse_static_transform
from sambot_viz.joints.presets import Presets
from sambot_viz.joints.start import StartPose
from sambot_viz.joints.values import load_joint_state
from sambot_viz.session import Session
from sambot_viz.session.drive_control import WheelOptions


@dataclass(frozen=True, slots=True)
class SessionSetup:
    """The same for every session of a server.

    Attributes:
        start: how the robot stands.
        static_transforms: frames that are added to the robot's.
        wheels: what is said about the wheels it drives with.
        poses: the named poses, shared by all sessions.
    """

    start: StartPose = field(default_factory=StartPose)
    static_transforms: Sequence[StaticTransform] = ()
    wheels: WheelOptions = field(default_factory=WheelOptions)
    poses: Presets = field(default_factory=Presets)

    def apply(self, session: Session) -> None:
        """Give it to a session that has no robot yet.

        Raises:
            FrameError: transforms that would form a ring.
        """
        session.start = self.start
        session.poses = self.poses
        session.motion.drive.options = self.wheels
        for added in self.static_transforms:
            session.set_static_transform(added.parent, added.child, added.transform)


def make_setup(
    *,
    zeros: Mapping[str, float] | None = None,
    joint_positions: Mapping[str, float] | None = None,
    joint_state: Path | str | None = None,
    static_transforms: Sequence[StaticTransform | str] = (),
    wheels: WheelOptions | None = None,
    poses: Path | None = None,
) -> SessionSetup:
    """A setup from what the caller of `Visualizer` gives; the arguments are its.

    Raises:
        JointError: a file that cannot be read.
        StaticTransformError: a text that static_transform_publisher would refuse.
    """
    recorded = load_joint_state(Path(joint_state)) if joint_state else {}
    return SessionSetup(
        StartPose(dict(zeros or {}), recorded, dict(joint_positions or {})),
        [
            parse_static_transform(given) if isinstance(given, str) else given
            for given in static_transforms
        ],
        wheels or WheelOptions(),
        Presets(poses),
    )


def poses_beside(model: Path) -> Path | None:
    """Where the poses of a model are kept: robot.urdf.xacro has robot.poses.yaml.

    The bundled robot's are kept in memory, for its folder belongs to the package.
    """
    if model.resolve() == bundled.model_path().resolve():
        return None
    stem = model.name
    for ending in (".xacro", ".urdf"):
        stem = stem.removesuffix(ending)
    return model.with_name(f"{stem}.poses.yaml")
