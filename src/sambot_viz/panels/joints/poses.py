"""The named poses of the Joints panel."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from typing import Any

from sambot_viz import limits
from sambot_viz.displays.scene.frame_nodes import position_of
from sambot_viz.errors import UsageError
from sambot_viz.frames.hierarchy import plain_name
from sambot_viz.geometry import wxyz_from_matrix
from sambot_viz.joints.presets import Presets
from sambot_viz.panels.command import TEXT, command
from sambot_viz.panels.panel import Panel
from sambot_viz.panels.rows.row import Answer, Data, Json
from sambot_viz.session.people.roles import Roles
from sambot_viz.session.robot.motion import Motion
from sambot_viz.session.robot.robot_state import RobotState
from sambot_viz.session.room import require_room
from sambot_viz.session.scene.scene import Scene
from sambot_viz.session.signals import Signal
from sambot_viz.session.undo import History

MOVE_TIME = 0.3
"""A motion to a pose takes so long [s]."""


class PosesPanel(Panel):
    """The named poses, and their file.

    Args:
        robot: the robot that takes the poses.
        motion: moves its joints there.
        history: records the removal of a pose.
        roles: knows whether there are viewers, who see no folder of the server.
        remake: called when the poses have changed.
    """

    name = "poses"

    def __init__(
        self,
        poses: Presets,
        robot: RobotState,
        motion: Motion,
        history: History,
        roles: Roles,
        remake: Callable[[Panel], None],
    ) -> None:
        self.remade_by = (robot.changed,)
        self._roles = roles
        self._poses = poses
        self._robot = robot
        self._motion = motion
        self._history = history
        self._remake = remake

    def data(self) -> Sequence[Data]:
        """Return the names of the poses, and where they are kept."""
        if not self.offers("poses/use"):
            return ()
        names = list(self._poses.names)
        return [
            Data("poses/names", names),
            Data("poses/place", f"Saved {self._place()}."),
        ]

    def _place(self) -> str:
        path = self._poses.path
        if path is None:
            return "in memory only"
        return f"in {path.name if self._roles.presented else path.absolute()}"

    def offers(self, command_id: str) -> bool:
        """Return whether there are joints to pose."""
        joints = self._robot.joints
        return joints is not None and bool(joints.sliders)

    @command("poses/use", TEXT)
    def _use(self, name: str) -> Answer | None:
        """Put the joints into a pose at once."""
        return self._without(self._robot.take_pose(name, self._poses.get(name)))

    @command("poses/move", TEXT)
    def _move(self, name: str) -> Answer | None:
        """Move the joints to a pose, so that one sees how they go there."""
        glide = partial(self._motion.glide, seconds=MOVE_TIME)
        return self._without(self._robot.take_pose(name, self._poses.get(name), glide))

    def _without(self, left_out: Sequence[str]) -> Answer | None:
        if left_out:
            return Answer(f"Without {', '.join(left_out)}, which cannot be set")
        return None

    @command("poses/save", TEXT)
    def _save(self, name: str) -> Answer:
        name, joints = name.strip(), self._robot.joints
        if joints is None:
            raise UsageError("there is no robot to save a pose of")
        if len(name) > limits.POSE_NAME.value:
            raise UsageError(
                f"a pose's name has at most {limits.POSE_NAME.value} characters"
            )
        poses = self._poses
        require_room(
            len({*poses.names, name}), limits.SESSION_POSES.value, "named poses"
        )
        poses.save(name, joints.positions)
        self._remake(self)
        return Answer(f"Saved pose '{name}' {self._place()}")

    @command("poses/remove", TEXT)
    def _delete(self, name: str) -> Answer:
        poses = self._poses
        pose = poses.get(name)

        def change(action: Callable[[], None]) -> None:
            action()
            self._remake(self)

        save = partial(change, partial(poses.save, name, pose))
        remove = partial(change, partial(poses.remove, name))
        remove()
        label = f"Remove pose {name}"
        self._history.record(label, save, remove, of_document=False)
        return Answer(f"Removed pose '{name}'; Undo brings it back")


class GhostPanel(Panel):
    """The pose that one client sees as a ghost, in addition to the robot.

    The page draws it with copies of its meshes: it needs only the poses of the links.

    Args:
        remake: called when another pose was chosen.
    """

    name = "ghost"

    def __init__(
        self,
        poses: Presets,
        robot: RobotState,
        scene: Scene,
        remake: Callable[[Panel], None],
    ) -> None:
        self.remade_by: Sequence[Signal[Any]] = (robot.changed,)
        self._poses = poses
        self._robot = robot
        self._nodes = scene.context.nodes
        self._remake = remake
        self._name = ""

    def data(self) -> Sequence[Data]:
        """Return the name of the pose, and where its links are in the root link."""
        return [Data("poses/ghost", self._shown())]

    def _shown(self) -> Json:
        robot, joints = self._robot.model, self._robot.joints
        if robot is None or joints is None or self._name not in self._poses.names:
            return None
        pose = self._poses.get(self._name)
        known = {n: q for n, q in pose.items() if n in joints.free}
        links = joints.kinematics.forward({**joints.positions, **known})
        return {
            "name": self._name,
            "root": self._node(robot.root),
            "links": {
                self._node(link): [*position_of(T), *wxyz_from_matrix(T)]
                for link, T in links.items()
                if robot.links[link].visuals
            },
        }

    def _node(self, link: str) -> str:
        path = self._nodes.path(plain_name(link))
        return (path or "").rpartition("/")[2]

    @command("poses/show", TEXT, client_local=True)
    def _show(self, name: str) -> None:
        """Show a pose as a ghost; an empty name ends that."""
        if name:
            self._poses.get(name)
        self._name = name
        self._remake(self)
