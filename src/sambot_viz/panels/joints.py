"""The Joints panel: a slider and a number for every joint that can be set."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import partial
from typing import Any

from sambot_viz.joints import JointState
from sambot_viz.panels.panel import Panel
from sambot_viz.panels.row import Row
from sambot_viz.robot.joint import Joint
from sambot_viz.session import Session

STEP = 0.01
"""What an arrow key adds [rad or m]."""


class JointsPanel(Panel):
    """What joint_state_publisher_gui shows.

    Args:
        session: whose joints these are.
    """

    name = "joints"
    remade_by = frozenset({"robot"})
    moved_by = frozenset({"joints"})

    def __init__(self, session: Session) -> None:
        self._session = session

    def rows(self) -> Sequence[Row]:
        """One row per joint, then what can be done with all of them."""
        joints = self._session.joints
        if joints is None or not joints.sliders:
            return [Row("joints/none", "", "note", value=_NOTHING_TO_MOVE)]
        return [*self._sliders(joints), *self._actions()]

    def values(self) -> dict[str, Any]:
        """The positions."""
        joints = self._session.joints
        if joints is None:
            return {}
        return {f"j/{name}": joints.positions[name] for name in joints.sliders}

    def _sliders(self, joints: JointState) -> Iterator[Row]:
        for name in joints.sliders:
            joint = joints.joints[name]
            lower, upper = sorted(joint.range)
            yield Row(
                f"j/{name}",
                "",
                "slider",
                name,
                value=joints.positions[name],
                unit="m" if joint.type == "prismatic" else "rad",
                least=lower,
                most=upper,
                step=STEP,
                help=_help(joint),
                extra={"wheel": True} if joint.type == "continuous" else None,
                set=partial(self._move, name),
            )

    def _move(self, name: str, value: float) -> None:
        self._session.set_joint_positions({name: value})

    def _actions(self) -> Iterator[Row]:
        session = self._session
        yield Row("joints/center", "", "action", set=lambda _: session.center_joints())
        yield Row(
            "joints/randomize", "", "action", set=lambda _: session.randomize_joints()
        )


def _help(joint: Joint) -> str:
    return f"{joint.type} joint, {joint.parent} → {joint.child}"


_NOTHING_TO_MOVE = (
    "This robot has no joint to move: all its joints are fixed, or follow others."
)
