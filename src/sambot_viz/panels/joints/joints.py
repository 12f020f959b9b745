"""The Joints panel: a slider and a number for every joint that can be set."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from functools import partial
from typing import Any

from sambot_viz.errors import UsageError
from sambot_viz.joints import JointState
from sambot_viz.joints.values import (
    as_arguments,
    as_launch_parameters,
    as_topic_pub,
    as_yaml,
)
from sambot_viz.panels.joints.joint_groups import joint_groups
from sambot_viz.panels.panel import Panel
from sambot_viz.panels.row import Answer, Row, own
from sambot_viz.robot.joint import Joint
from sambot_viz.session import Session
from sambot_viz.session.robot.joint_arrow import JointArrow

STEP_ANGLE, STEP_LENGTH = 0.01, 0.001
"""What an arrow key adds [rad] and [m]."""
FEWEST_STEPS = 20
"""A joint with a short range has smaller steps, at least so many."""
FASTEST = 100.0
"""Of a wheel that keeps turning [rad/s]."""
FOLLOWERS, SKIPPED = "joints/followers", "joints/skipped"
_FEW = 12
_TOOLS, _PREFIX = "joints/tools", "j/"

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
    """What joint_state_publisher_gui shows, and more.

    Unlike there, typed values are exact, joints that mimic others and joints over a
    limit are shown, and wheels can keep turning.

    Args:
        session: whose joints these are.
        remake: called when rows other than the positions have changed.
    """

    name = "joints"

    def __init__(self, session: Session, remake: Callable[[Panel], None]) -> None:
        signals = session.signals
        self.remade_by = (signals.robot,)
        self.moved_by = (signals.joints, signals.motion)
        self._session = session
        self._remake = remake
        self._rate = 1.0
        self._arrow = JointArrow(session)

    def rows(self) -> Sequence[Row]:
        """The joints, in groups if they are many, and what can be done with them."""
        joints = self._session.joints
        if joints is None or not joints.sliders:
            why = _NO_ROBOT if self._session.robot is None else _NOTHING_TO_MOVE
            return [Row("joints/none", "", "note", value=why)]
        values = self.values()
        rows = [
            *self._free(joints),
            *_followers(joints),
            *_skipped(joints),
            Row("joints/over", "", "names", value=values["joints/over"]),
            Row("joints/turning", "", "names", value=values["joints/turning"]),
        ]
        return [*rows, *self._tools(joints), *self._actions()]

    def values(self) -> dict[str, Any]:
        """The positions, the joints over a limit, and the joints that keep turning."""
        joints = self._session.joints
        if joints is None:
            return {}
        values: dict[str, Any] = {
            joint_id(name): position
            for name, position in joints.all_positions().items()
        }
        values["joints/over"] = list(joints.over_limit())
        values["joints/turning"] = [joint_id(n) for n in self._session.motion.turning]
        return values

    # The joints

    def _free(self, joints: JointState) -> Iterator[Row]:
        for group in joint_groups(joints.sliders):
            above = ""
            if group.label:
                above = f"joints/group/{group.names[0]}"
                label = f"{group.label} ({len(group.names)})"
                yield Row(above, "", "group", label, expanded=True)
            for name in group.names:
                yield self._slider(joints.joints[name], joints.positions[name], above)

    def _slider(self, joint: Joint, position: float, above: str) -> Row:
        lower, upper = sorted(joint.range)
        return Row(
            joint_id(joint.name),
            above,
            "slider",
            joint.name,
            value=position,
            unit=_unit(joint),
            least=lower,
            most=upper,
            step=_step(joint),
            help=_help(joint),
            extra={"wheel": True} if joint.type == "continuous" else None,
            set=partial(self._move, joint),
        )

    def _move(self, joint: Joint, value: float) -> None:
        self._session.set_joint_positions({joint.name: value})
        self._arrow.moved(joint)

    # What can be done

    def _tools(self, joints: JointState) -> Iterator[Row]:
        """The turn rate, below a row that no tree shows."""
        if any(joints.joints[name].type == "continuous" for name in joints.sliders):
            yield Row(_TOOLS, "", "names")
            yield Row(
                "joints/rate",
                _TOOLS,
                "float",
                "Turn rate",
                value=self._rate,
                unit="rad/s",
                least=-FASTEST,
                most=FASTEST,
                step=0.1,
                help="How fast wheels turn by themselves; a negative rate turns back.",
                set=self._set_rate,
            )

    def _actions(self) -> Iterator[Row]:
        session = self._session
        yield _action("joints/center", lambda _: session.center_joints())
        yield _action("joints/randomize", lambda _: session.randomize_joints())
        yield _action("joints/turn", self._turn, str)
        yield from own([_action("joints/copy", self._copy, str)])

    def _set_rate(self, rate: float) -> None:
        before = self._rate
        self._take_rate(rate)
        self._session.edits.record(
            "Turn rate",
            partial(self._take_rate, before),
            partial(self._take_rate, rate),
            "turn rate",
            of_document=False,
        )

    def _take_rate(self, rate: float) -> None:
        self._rate = rate
        for name in self._session.motion.turning:
            self._session.motion.turn(name, rate)
        self._remake(self)

    def _turn(self, arguments: tuple[str]) -> None:
        """Start the wheel of a row, or stop it."""
        name, motion = arguments[0].removeprefix(_PREFIX), self._session.motion
        if motion.turns(name):
            motion.turn(name, 0.0)
        elif self._rate == 0:
            raise UsageError("nothing turns at a turn rate of 0; set another one")
        else:
            self._start(name)

    def _start(self, name: str) -> None:
        """Let a wheel turn; undo stops it, and puts it where it stood before."""
        session = self._session
        session.motion.turn(name, self._rate)
        before = reached = self._position(name)

        def put_back() -> None:
            nonlocal reached
            reached = self._position(name)
            session.motion.turn(name, 0.0)
            session.move({name: before}, {})

        session.edits.record(
            f"Turn {name}",
            put_back,
            lambda: session.move({name: reached}, {}),
            of_document=False,
        )

    def _position(self, name: str) -> float:
        joints = self._session.joints
        if joints is None or name not in joints.positions:
            raise UsageError(f"there is no joint '{name}' that can be set")
        return joints.positions[name]

    def _copy(self, arguments: tuple[str]) -> Answer:
        joints = self._session.joints
        if joints is None or arguments[0] not in _FORMS:
            raise UsageError(f"there is no form '{arguments[0]}' to copy joints in")
        what, write = _FORMS[arguments[0]]
        # A joint that follows takes its position from its leader.
        only_free = arguments[0] in ("launch", "arguments")
        values = dict(joints.positions) if only_free else joints.all_positions()
        count = f"{len(values)} joint value{'s' if len(values) != 1 else ''}"
        return Answer(f"{count} as {what}", write(values))


def _followers(joints: JointState) -> Iterator[Row]:
    """The joints that follow others; they can only be read."""
    followers = joints.followers
    if not followers:
        return
    positions = joints.all_positions()
    name = f"Follow other joints ({len(followers)})"
    yield Row(FOLLOWERS, "", "group", name, expanded=len(followers) <= _FEW)
    for name, follower in followers.items():
        joint, mimic = joints.joints[name], follower.mimic
        lower, upper = sorted(joint.range) if joint.limit is not None else (None, None)
        yield Row(
            joint_id(name),
            FOLLOWERS,
            "slider",
            name,
            value=positions[name],
            unit=_unit(joint),
            least=lower,
            most=upper,
            help=_help(joint),
            extra={
                "follows": joint_id(mimic.joint),
                "times": mimic.multiplier,
                "plus": mimic.offset,
            },
        )


def _skipped(joints: JointState) -> Iterator[Row]:
    """The joints without a position that a user may look for, and why."""
    skipped = {
        n: why for n, why in joints.skipped.items() if not why.startswith("fixed")
    }
    if not skipped:
        return
    name = f"Without a position ({len(skipped)})"
    yield Row(SKIPPED, "", "group", name, expanded=len(skipped) <= _FEW)
    for name, why in skipped.items():
        yield Row(f"joints/skipped/{name}", SKIPPED, "fact", name, why)


def _action(row_id: str, act: Callable[[Any], object], *takes: type) -> Row:
    return Row(row_id, "", "action", takes=takes, set=act)


def joint_id(name: str) -> str:
    """The id of a joint's row."""
    return f"{_PREFIX}{name}"


def _unit(joint: Joint) -> str:
    return "m" if joint.type == "prismatic" else "rad"


def _step(joint: Joint) -> float:
    """A round step: 0.01 rad, 1 mm, or less for a joint with a short range."""
    lower, upper = sorted(joint.range)
    step = STEP_LENGTH if joint.type == "prismatic" else STEP_ANGLE
    while upper - lower < FEWEST_STEPS * step and step > 1e-6:
        step /= 10
    return step


def _help(joint: Joint) -> str:
    return f"{joint.type} joint, {joint.parent} → {joint.child}"


_NO_ROBOT = "There is no robot yet; Problems says why, if its file has a mistake."
_NOTHING_TO_MOVE = (
    "This robot has no joint to move: all its joints are fixed, or follow others."
)
