"""The Joints panel: a slider for every joint that can be set."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial
from itertools import zip_longest
from typing import Any

from sambot_viz.errors import UsageError
from sambot_viz.joints import JointState
from sambot_viz.joints.value_texts import (
    as_arguments,
    as_launch_parameters,
    as_topic_pub,
    as_yaml,
)
from sambot_viz.panels.command import LIST, TEXT, command
from sambot_viz.panels.joints.joint_rows import ID_PREFIX, joint_id, joint_rows
from sambot_viz.panels.panel import Panel
from sambot_viz.panels.rows.row import Answer, Data, Json, Row
from sambot_viz.panels.validation import validate
from sambot_viz.robot.parts import Joint
from sambot_viz.session.data.robot_data import RobotData
from sambot_viz.session.data.session_sources import SessionSources
from sambot_viz.session.robot.joints_out import JointsOut
from sambot_viz.session.robot.motion import Motion
from sambot_viz.session.robot.robot_state import RobotState
from sambot_viz.session.scene.joint_arrow import JointArrow
from sambot_viz.session.signals import Signal
from sambot_viz.session.undo import History
from sambot_viz.topics.robot_topics import STAND_IN_NAME

FASTEST = 100.0
"""Of a wheel that keeps turning [rad/s]."""

_FORMS: dict[str, tuple[str, Callable[[dict[str, float]], str]]] = {
    "yaml": ("yaml of a sensor_msgs/JointState", as_yaml),
    "command": ("a ros2 topic pub command", as_topic_pub),
    "launch": (
        "parameters of joint_state_publisher for a launch file",
        as_launch_parameters,
    ),
    "arguments": ("arguments of sambot-viz", as_arguments),
}


class JointsPanel(Panel):
    """Shows what joint_state_publisher_gui shows, and more.

    Unlike there, typed values are exact, joints that mimic others and joints over a
    limit are shown, and wheels can keep turning.

    Args:
        arrow: shows which way a joint moves.
        sources: have the recording that moves the joints, if there is one.
        joints_out: publishes them to a live robot.
        remake: called when rows other than the positions have changed.
    """

    name = "joints"
    period = 0.1

    def __init__(
        self,
        robot: RobotState,
        motion: Motion,
        history: History,
        arrow: JointArrow,
        sources: SessionSources,
        joints_out: JointsOut,
        remake: Callable[[Panel], None],
    ) -> None:
        self.remade_by = (robot.changed, robot.followed, joints_out.said)
        self._out = joints_out
        self._robot = robot
        self._motion = motion
        self._history = history
        self._arrow = arrow
        self._sources = sources
        self._remake = remake
        self._rate = 1.0
        # Up to which move of which joints the page has been told.
        self._told: tuple[JointState | None, int] = (None, 0)

    @property
    def moved_by(self) -> Sequence[Signal[Any]]:
        """The positions, and which wheels turn."""
        return (self._robot.positions, self._motion.turning)

    def rows(self) -> Sequence[Row]:
        """Return the joints, in groups if they are many, and the turn rate."""
        joints = self._sliders()
        if joints is None:
            return [Row("joints/none", "", "note", value=self._why_none())]
        rows = [*joint_rows(joints, self._move), *self._rate_row(joints)]
        recording = self._sources.data
        if recording is None:
            return rows
        follows = bool(self._robot.followed.value)
        if follows:
            rows = [replace(row, set=None) for row in rows]
        return [_follow_row(follows, recording), *rows]

    def _why_none(self) -> str:
        """Return a sentence that explains why there is no joint."""
        model, data = self._robot.model, self._sources.data
        if model is None:
            return _NO_ROBOT
        if data is None or model.name != STAND_IN_NAME:
            return _NOTHING_TO_MOVE
        return _NOT_HERE_YET if data.moved_by.can("clock") else _NOT_RECORDED

    def data(self) -> Sequence[Data]:
        """Return the joints over a limit, the turning ones, and all start positions.

        The receivers of the joints are data and no row: a row would come later, and
        move the sliders.
        """
        if self._robot.joints is None:
            return ()
        first = {joint_id(n): q for n, q in self._robot.first.items() if q != 0}
        data = self._sources.data
        # Sliders that are published move the robot, too.
        is_free = self._sliders() is not None and not self._out.publishes
        is_apart = is_free and data is not None and data.is_unfollowed
        return [
            *([Data("joints/unfollowed", True)] if is_apart else []),
            *([Data("joints/out", said)] if (said := self._out.said.value) else []),
            *(Data(key, value) for key, value in self._states().items()),
            Data("joints/first", first),
            Data("joints/links", self._links(self._robot.joints)),
        ]

    def _links(self, joints: JointState) -> dict[str, Json]:
        """Return by row where in the scene its joint is, for pages to show it."""
        named = (*joints.sliders, *joints.followers)
        return {joint_id(n): self._arrow.place(joints.joints[n]) for n in named}

    def values(self) -> dict[str, Any]:
        """Return the positions of what has moved, and what else a motion changes."""
        joints = self._robot.joints
        if joints is None:
            return {}
        last = self._told[1] if self._told[0] is joints else 0
        self._told = (joints, joints.moves)
        moved = joints.moved_since(last).items()
        return {joint_id(name): q for name, q in moved} | self._states()

    def offers(self, command_id: str) -> bool:
        """Return whether there are joints to move."""
        free = command_id == "joints/copy" or not self._robot.followed.value
        return free and self._sliders() is not None

    def _sliders(self) -> JointState | None:
        joints = self._robot.joints
        return joints if joints is not None and joints.sliders else None

    def _states(self) -> dict[str, Any]:
        joints, turning = self._robot.joints, self._motion.turning.value
        return {
            "joints/over": [] if joints is None else list(joints.over_limit()),
            "joints/turning": [joint_id(name) for name in turning],
            "joints/untouched": not self._robot.moved,
        }

    # Positions

    def _move(self, joint: Joint, value: float) -> None:
        self._motion.stop_turning((joint.name,))
        self._robot.set_positions({joint.name: value})
        self._arrow.moved(joint)

    @command("joints/center")
    def _center(self) -> None:
        self._motion.stop_turning(self._motion.turning.value)
        self._robot.center()

    @command("joints/randomize")
    def _randomize(self) -> None:
        self._motion.stop_turning(self._motion.turning.value)
        self._robot.randomize()

    @command("joints/restore", LIST, LIST)
    def _restore(self, row_ids: list[Any], positions: list[Any]) -> Answer | None:
        """Move the joints to where a page that comes back had them.

        Only as long as nothing has moved: so a user of now is never disturbed, and of
        two pages that come back the first one restores the joints.
        """
        joints = self._sliders()
        if self._robot.moved or joints is None:
            return None
        rows = {row.id: row for row in joint_rows(joints, self._move)}
        wanted: dict[str, float] = {}
        for row_id, position in zip_longest(row_ids, positions):
            row = rows.get(row_id)
            if row is None or row.kind != "slider":
                raise UsageError("this robot does not have these joints")
            wanted[row.name] = validate(row, position)
        self._robot.set_positions(wanted, "Restore joints")
        return Answer("Joint positions restored; Undo resets them")

    @command("joints/copy", TEXT, client_local=True)
    def _copy(self, form: str) -> Answer:
        joints = self._robot.joints
        if joints is None or form not in _FORMS:
            raise UsageError(f"there is no form '{form}' to copy joints in")
        what, write = _FORMS[form]
        # A joint that follows takes its position from its leader.
        only_free = form in ("launch", "arguments")
        values = dict(joints.positions) if only_free else joints.all_positions()
        count = f"{len(values)} joint value{'s' if len(values) != 1 else ''}"
        return Answer(f"{count} as {what}", write(values))

    # Wheels that keep turning

    def _rate_row(self, joints: JointState) -> Sequence[Row]:
        if not any(joints.joints[name].endless for name in joints.sliders):
            return ()
        return [
            Row(
                "joints/rate",
                "",
                "float",
                "Turn rate",
                value=self._rate,
                unit="rad/s",
                least=-FASTEST,
                most=FASTEST,
                step=0.1,
                help="Speed of joints that keep turning; negative is backwards.",
                # The tree does not show it: it is among the buttons.
                extra={"apart": True},
                set=self._set_rate,
            )
        ]

    def _set_rate(self, rate: float) -> None:
        before = self._rate
        self._take_rate(rate)
        self._history.record(
            "Turn rate",
            partial(self._take_rate, before),
            partial(self._take_rate, rate),
            "turn rate",
            of_document=False,
        )

    def _take_rate(self, rate: float) -> None:
        self._rate = rate
        for name in self._motion.turning.value:
            self._motion.turn(name, rate)
        self._remake(self)

    @command("joints/turn", TEXT)
    def _turn(self, row_id: str) -> None:
        """Start the wheel of a row, or stop it."""
        name, motion = row_id.removeprefix(ID_PREFIX), self._motion
        if motion.turns(name):
            motion.turn(name, 0.0)
        elif self._rate == 0:
            raise UsageError("nothing turns at a turn rate of 0; set another one")
        else:
            self._start(name)

    def _start(self, name: str) -> None:
        """Let a wheel turn; undo stops it, and puts it where it stood before."""
        robot, motion = self._robot, self._motion
        motion.turn(name, self._rate)
        before = reached = self._position(name)

        def put_back() -> None:
            nonlocal reached
            reached = self._position(name)
            robot.move_again({name: before})
            motion.turn(name, 0.0)

        self._history.record(
            f"Turn {name}",
            put_back,
            lambda: robot.move_again({name: reached}),
            of_document=False,
        )

    def _position(self, name: str) -> float:
        joints = self._robot.joints
        if joints is None or name not in joints.positions:
            raise UsageError(f"there is no joint '{name}' that can be set")
        return joints.positions[name]


def _follow_row(follows: bool, recording: RobotData) -> Row:
    return Row(
        "joints/follow",
        "",
        "bool",
        f"Follow {recording.name}",
        value=follows,
        help="The joints are where its messages say; else where the sliders are.",
        set=recording.follow,
    )


_NO_ROBOT = "No robot loaded. If its file has an error, Problems shows it."
_NOT_HERE_YET = (
    "No robot has come yet: the line below the view says what is waited for."
)
_NOT_RECORDED = (
    "This recording has no robot model. To add one: --model ROBOT.urdf.xacro"
)
_NOTHING_TO_MOVE = (
    "This robot has no joint to move: all its joints are fixed, or follow others."
)
