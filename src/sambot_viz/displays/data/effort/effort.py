"""Effort: how hard each joint turns, as a circle about its axis."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

from sambot_viz import limits
from sambot_viz.displays.data.display_node import DisplayNode
from sambot_viz.displays.data.effort.effort_joints import (
    JOINTS,
    EffortJoints,
    JointEffort,
    max_effort,
    placed_ring,
)
from sambot_viz.displays.data.kept import Taken
from sambot_viz.displays.data.message_filter import TRANSFORM, MessageFilterDisplay
from sambot_viz.displays.data.refused_messages import MessageRefused
from sambot_viz.displays.data.topic_display import TOPIC, topic_property
from sambot_viz.displays.display import DisplayContext, EntryList, Status
from sambot_viz.displays.robot_display import Repair, WantedQos
from sambot_viz.displays.robot_model.described_robot import DescribedRobot
from sambot_viz.displays.scene.glb_node import single
from sambot_viz.displays.scene.rings import RingsNode
from sambot_viz.frames import LookupRefused, Transform
from sambot_viz.geometry import Matrix
from sambot_viz.meanings import Meaning
from sambot_viz.robot.model import Robot
from sambot_viz.robot.parts import Joint
from sambot_viz.rviz import (
    DisplayConfig,
    FloatProperty,
    GroupProperty,
    IntProperty,
    StringProperty,
)
from sambot_viz.topics.decoding import frame_and_stamp

ROBOT = "Robot Description"
PREFIX = "TF Prefix"
LOADING = "Process message"
URDF = "URDF"
EFFORTS = "Efforts"
_LATCHED = WantedQos("Reliable", "Transient Local")
_LENGTHS = "Received a joint state msg with different joint names and efforts size!"
_NO_JOINT = (
    "The newest message names no joint that can be shown: a revolute joint of the "
    "robot with a <limit>"
)


class EffortDisplay(MessageFilterDisplay[Sequence[JointEffort]]):
    """The efforts of sensor_msgs/JointState; those of revolute joints, as RViz.

    A message needs no frame: each circle is where the child link of its joint was.
    """

    kind = "rviz_default_plugins/Effort"
    meanings = frozenset({Meaning.JOINTS})
    length = "History Length"
    properties = (
        topic_property(),
        FloatProperty(
            "Alpha",
            default=1.0,
            help="How opaque the circles would be.",
            support="kept",
            note="it has no effect in RViz",
        ),
        FloatProperty(
            "Width", default=0.02, unit="m", help="The width of the circles' lines."
        ),
        FloatProperty(
            "Scale",
            default=1.0,
            unit="m",
            help="The diameter that the limit of an effort adds.",
        ),
        IntProperty(
            length,
            default=1,
            minimum=1,
            maximum=100_000,
            acts_up_to=limits.EFFORT_CIRCLES.value,
            help="Number of newest messages to show, up to "
            f"{limits.EFFORT_CIRCLES.value} circles in all.",
        ),
        StringProperty(
            ROBOT,
            default="/robot_description",
            help="The topic that describes the robot.",
        ),
        StringProperty(
            PREFIX,
            help="The frame of a link is <prefix>/<link> when this is not empty.",
        ),
        GroupProperty(
            JOINTS,
            help="The joints that turn and have a limit, each with a box.",
            open_keys=True,
        ),
    )
    _node = DisplayNode(RingsNode, "")

    def __init__(self, context: DisplayContext, config: DisplayConfig, key: str):
        """Make the display; nothing is drawn before `draw`."""
        super().__init__(context, config, key)
        self._source = DescribedRobot(context, self._named_topic, self._model_read)
        self._robot: Robot | None = None
        self._joints: EffortJoints | None = None

    # The robot

    def draw(self) -> None:
        """Take the robot, listen to the topic, and draw what has come."""
        self._source.choose()
        robot = self._source.robot
        if robot is not self._robot:
            self._robot = robot
            self._joints = None if robot is None else EffortJoints(self.config, robot)
            # What was taken is of another robot: it is taken again.
            self.clear()
        super().draw()
        self._report_robot()

    def property_changed(self, path: str) -> None:
        """A property has a new value; messages are placed again for some."""
        if self.shown and path in (PREFIX, ROBOT):
            self.clear()
        super().property_changed(path)

    def _named_topic(self) -> tuple[str, WantedQos]:
        return str(self.config.get(ROBOT)), _LATCHED

    def _model_read(self) -> None:
        if self.shown:
            self.draw()

    def _report_robot(self) -> None:
        described, status = self._source.described, self._source.status
        if described is not None:
            self.status.set(ROBOT, described.level, described.sentence)
        if status is None and self._robot is not None:
            status = Status("Ok", "Robot model parsed Ok")
        if status is None:
            self.status.remove(URDF)
        else:
            self.status.set(URDF, status.level, status.text)

    # Messages

    @property
    def most(self) -> int:
        """Number of messages shown: the drawing is sent again with each one."""
        count = 0 if self._joints is None else len(self._joints.joints)
        return min(super().most, max(1, limits.EFFORT_CIRCLES.value // max(1, count)))

    def place(self, message: Any) -> Transform:
        """Return nothing to place: efforts are at their joints, whatever the header."""
        return Transform.identity()

    def say_placed(self) -> None:
        """Say nothing of a place: the statuses of the joints do."""

    def read(self, message: Any) -> Sequence[JointEffort]:
        """Return the efforts of a message that have a place and a number."""
        joints = self._joints
        if joints is None:
            raise MessageRefused("Robot model might not be loaded yet", LOADING)
        if len(message.name) != len(message.effort):
            raise MessageRefused(_LENGTHS, TOPIC)
        named = zip(map(str, message.name), map(float, message.effort), strict=True)
        efforts = {name: value for name, value in named if name in joints.joints}
        turning = [
            joint
            for name, joint in joints.joints.items()
            if name in efforts and joint.type == "revolute"
        ]
        joints.efforts |= efforts
        found = [
            JointEffort(joint.name, efforts[joint.name], max_effort(joint), T)
            for joint, T in self._placed(turning, frame_and_stamp(message)[1])
        ]
        self.status.remove(TRANSFORM)
        self._report_joints(len(turning))
        return [one for one in found if self._is_number(one)]

    def _placed(
        self, joints: Sequence[Joint], stamp_ns: int | None
    ) -> list[tuple[Joint, Matrix]]:
        """Return the joints that had a place at a time, with T_fixed_ring, (4, 4).

        Raises:
            LookupRefused: none had one; the message waits if one may get it.
        """
        tree, fixed = self.context.tree, self.context.fixed_frame
        prefix = str(self.config.get(PREFIX))
        found: list[tuple[Joint, Matrix]] = []
        refused: dict[str, LookupRefused] = {}
        for joint in joints:
            frame = self._source.frame_of(joint.child, prefix)
            try:
                T = tree.lookup(fixed, frame, stamp_ns).matrix
            except LookupRefused as why:
                refused[joint.name] = why
            else:
                found.append((joint, placed_ring(joint, T)))
        if refused and not found:
            raise next(iter(refused.values()))
        for name, why in refused.items():
            text = f"Error transforming from frame '{why.source}' to frame '{fixed}'"
            self.status.set(name, "Error", text)
        return found

    def _is_number(self, one: JointEffort) -> bool:
        if math.isfinite(single(one.effort)):
            self.status.set(one.joint, "Ok", "OK")
            return True
        self.status.set(one.joint, "Error", f"Invalid effort: {one.effort:g}")
        return False

    def _report_joints(self, turning: int) -> None:
        if turning:
            self.status.remove(EFFORTS)
        else:
            self.status.set(EFFORTS, "Warn", _NO_JOINT)

    # The scene

    def draw_kept(self, kept: Sequence[Taken[Sequence[JointEffort]]]) -> None:
        """Draw the circles of the joints whose box is ticked."""
        joints = self._joints
        width = float(self.config.get("Width"))
        if joints is None or width <= 0.0:
            self._node.remove()
            return
        scale = float(self.config.get("Scale"))
        efforts = (one for some in kept for one in some.read if joints.is_on(one.joint))
        self._node.draw([one.ring(scale, width) for one in efforts], width)

    def drop(self) -> None:
        """Take all circles out of the scene, and forget what was said of joints."""
        super().drop()
        for key in self.status.rows.keys() - {TOPIC, ROBOT, URDF}:
            self.status.remove(key)

    # What the page shows

    def entries(self) -> tuple[EntryList, ...]:
        """Return the joints."""
        return () if self._joints is None else (self._joints.entries(),)

    def options(self) -> Mapping[str, Sequence[str]]:
        """Return the topics of messages, and those that describe robots."""
        descriptions = self.context.descriptions
        more = {} if descriptions is None else {ROBOT: descriptions.topics()}
        return {**super().options(), **more}

    def repairs(self) -> Mapping[str, Repair]:
        """Return buttons for the topics that were meant."""
        described = self._source.described
        if described is None or not described.instead:
            return super().repairs()
        instead = described.instead
        return {**super().repairs(), ROBOT: Repair(f"Use {instead}", ROBOT, instead)}
