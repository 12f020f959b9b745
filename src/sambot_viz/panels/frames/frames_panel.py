"""The Frames panel of one browser: look-ups, and the static transforms of all."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Sequence
from functools import partial
from typing import Any

from sambot_viz import limits
from sambot_viz.errors import UsageError, did_you_mean
from sambot_viz.frames import Transform
from sambot_viz.frames.hierarchy import plain_name
from sambot_viz.frames.robot_frames import Explanation, explain
from sambot_viz.frames.static_transform import StaticTransform, parse_static_transform
from sambot_viz.panels.command import FLAG, NUMBER, TEXT, Command, command
from sambot_viz.panels.frames.frame_answer import answer_rows
from sambot_viz.panels.panel import Panel
from sambot_viz.panels.rows.row import Data, Json, Level, Row
from sambot_viz.panels.unfolded import LazyRows
from sambot_viz.session.robot.robot_state import RobotState
from sambot_viz.session.robot.session_frames import Frames
from sambot_viz.session.robot.user_frames import UserFrame
from sambot_viz.session.room import require_room
from sambot_viz.session.scene.scene import Scene
from sambot_viz.session.signals import Signal

Say = Callable[[str, Level], None]
"""Shows a sentence to the browser."""

_PROGRAM = "static_transform_publisher"
ALL = "frames/all"
"""The list of all frames."""


class FramesPanel(Panel):
    """A look-up as tf2_echo makes it, and static transforms.

    Which two frames are asked for belongs to this browser; static transforms belong to
    everyone.

    Args:
        say: shows a sentence to the browser that asks.
        remake: called when there is another answer.
    """

    name = "frames"
    period = 0.2

    def __init__(
        self,
        frames: Frames,
        robot: RobotState,
        scene: Scene,
        say: Say,
        remake: Callable[[Panel], None],
    ) -> None:
        self.remade_by = (scene.frames, robot.changed)
        self._frames = frames
        self._robot = robot
        self._context = scene.context
        self._say = say
        self._remake = remake
        self._from = self._to = ""
        self._shown = False
        self._lazy = LazyRows("frames/unfold", lambda: remake(self))

    @property
    def moved_by(self) -> Sequence[Signal[Any]]:
        """The poses of the answer, while the panel is on the screen."""
        return (self._robot.positions,) if self._shown else ()

    def rows(self) -> Sequence[Row]:
        """Return the two frames, the answer, static transforms, and all frames."""
        return [
            *self._choice(),
            *answer_rows(self._answer()),
            *self._static(),
            *self._all(),
        ]

    def commands(self) -> list[Command]:
        """Return the declared commands, and the one to unfold the list of frames."""
        return [*super().commands(), self._lazy.command()]

    def data(self) -> Sequence[Data]:
        """Return whether the panel is known to be on the screen."""
        return [Data("frames/shown", self._shown)]

    def values(self) -> dict[str, Json]:
        """Return the answer; it follows motions while the panel is on the screen."""
        if not self._shown:
            return {}
        return {row.id: row.value for row in answer_rows(self._answer())}

    # The look-up

    @property
    def _asked(self) -> tuple[str, str]:
        """From and To; something that moves is a good first thing to look at."""
        context, tree = self._context, self._frames.tree
        link = next(iter(context.moving), None)
        # A robot with a name space or a prefix has it at a frame with that.
        named = (f for f in tree.frames if link in (f, f.rpartition("/")[2]))
        moving = next(named, link) or next(iter(tree.frames), "")
        return self._from or context.fixed_frame, self._to or moving

    def _answer(self) -> Explanation:
        source, target = self._asked
        return explain(self._frames.tree, source, target, self._robot.model)

    def _choice(self) -> Iterator[Row]:
        source, target = self._asked
        yield Row(
            "frames/from",
            "",
            "frame",
            "From",
            value=source,
            help="The frame to look from; parent of a static transform.",
            client_local=True,
            set=partial(self._choose, "_from"),
        )
        yield Row(
            "frames/to",
            "",
            "frame",
            "To",
            value=target,
            help="The frame to look at; child of a static transform.",
            client_local=True,
            set=partial(self._choose, "_to"),
        )

    def _choose(self, which: str, frame: str) -> None:
        setattr(self, which, plain_name(frame.strip()))
        self._remake(self)

    # The static transforms

    def _static(self) -> Iterator[Row]:
        added = {c: f for c, f in self._frames.added.items() if f.static}
        yield Row(
            "frames/static",
            "",
            "group",
            "Static transforms",
            help="Frames that users have added. Everyone sees them.",
            expanded=True,
        )
        if not added:
            yield Row("frames/none", "frames/static", "note", value=_NONE_ADDED)
        for child, frame in added.items():
            yield from self._added(child, frame)

    def _added(self, child: str, frame: UserFrame) -> Iterator[Row]:
        head, T = f"static/{child}", frame.transform
        yield Row(
            head,
            "frames/static",
            "readonly",
            child,
            value=f"in {frame.parent}",
            icon="frame",
            expanded=True,
            extra={"static": True},
        )
        yield Row(
            f"{head}/xyz",
            head,
            "vector",
            "Translation",
            value=T.translation.tolist(),
            unit="m",
            step=0.01,
            help=f"X, Y and Z of {child} in {frame.parent}.",
            extra={"parts": ["X", "Y", "Z"]},
            set=lambda xyz: self._move(child, xyz, None),
        )
        yield Row(
            f"{head}/rpy",
            head,
            "vector",
            "Rotation",
            value=list(T.rpy),
            unit="rad",
            step=0.01,
            help=f"Roll, pitch and yaw of {child} in {frame.parent}.",
            extra={"parts": ["Roll", "Pitch", "Yaw"]},
            set=lambda rpy: self._move(child, None, rpy),
        )

    def _move(
        self,
        child: str,
        xyz: Sequence[float] | None,
        rpy: Sequence[float] | None,
    ) -> None:
        added = self._frames.added[child]
        old = added.transform
        transform = Transform.from_xyz_rpy(
            old.translation.tolist() if xyz is None else xyz,
            old.rpy if rpy is None else rpy,
        )
        self._frames.add(added.parent, child, transform)

    # What the page can ask for

    @command("frames/show", FLAG, client_local=True)
    def _show(self, shown: bool) -> None:
        """Follow motions, or do not: the panel is on the screen, or is not."""
        if self._shown != shown:
            self._shown = shown
            self._remake(self)

    @command("frames/add", *[NUMBER] * 6, TEXT, TEXT, name="Add")
    def _add_fields(
        self,
        x: float,
        y: float,
        z: float,
        roll: float,
        pitch: float,
        yaw: float,
        parent: str,
        child: str,
    ) -> None:
        """Add what was typed into fields [m] and [rad]."""
        transform = Transform.from_xyz_rpy((x, y, z), (roll, pitch, yaw))
        parent, child = plain_name(parent.strip()), plain_name(child.strip())
        self._add(StaticTransform(parent, child, transform))

    @command("frames/paste", TEXT, name="Add")
    def _paste(self, pasted: str) -> None:
        self._add(parse_static_transform(pasted_arguments(pasted)))

    def _add(self, wanted: StaticTransform) -> None:
        parent, child = wanted.parent, wanted.child
        tree = self._frames.tree
        for name, what in ((parent, "parent"), (child, "child")):
            if not name:
                raise UsageError(f"name the {what} frame")
        if len(tree) and parent not in tree and child not in tree:
            hint = did_you_mean(parent, tree.frames)
            raise UsageError(
                f"neither '{parent}' nor '{child}' is a frame, so '{child}' would hang "
                f"in the air; {hint}"
            )
        self._check_parent(child)
        added = self._frames.added
        require_room(len({*added, child}), limits.SESSION_FRAMES.value, "added frames")
        self._frames.add(parent, child, wanted.transform)
        said = "; ".join((f"Added {child} (parent {parent})", *wanted.warnings))
        self._say(said, "warn" if wanted.warnings else "ok")

    def _check_parent(self, child: str) -> None:
        """Refuse a child that something else moves: in tf2 a frame has one parent."""
        added, robot = self._frames.added.get(child), self._robot.model
        if added is not None and not added.static:
            by, parent = "Drive", added.parent
        elif added is None and robot is not None:
            # ROS publishes nothing for a floating joint: that is left to others.
            holds = {
                plain_name(j.child): j
                for j in robot.joints.values()
                if j.type != "floating"
            }
            if child not in holds:
                return
            by, parent = f"joint '{holds[child].name}'", holds[child].parent
        else:
            return
        raise UsageError(
            f"{by} already holds '{child}' in '{parent}': in tf2 a frame has one parent"
        )

    @command("frames/remove", TEXT)
    def _remove(self, row_id: str) -> None:
        self._frames.remove(row_id.removeprefix("static/"))

    # All frames

    def _all(self) -> Iterator[Row]:
        """Yield the tree of all frames; a page asks for it when it is unfolded."""
        tree, unfolded = self._frames.tree, self._lazy.is_unfolded(ALL)
        yield Row(
            ALL,
            "",
            "group",
            f"All frames ({len(tree.frames)})",
            help="The tree of all frames; Enter or a double click asks for one.",
            extra={"lazy": bool(tree.frames) and not unfolded},
        )
        # A chain of frames may be longer than Python calls functions.
        waiting = [(root, ALL) for root in reversed(tree.roots)] if unfolded else []
        while waiting:
            frame, parent = waiting.pop()
            row_id = f"frame/{frame}"
            yield Row(row_id, parent, "group", frame, icon="frame", expanded=True)
            waiting += [(child, row_id) for child in reversed(tree.children(frame))]


def pasted_arguments(pasted: str) -> str:
    """Return static_transform_publisher's arguments from a command or a launch file.

    Args:
        pasted: "ros2 run tf2_ros static_transform_publisher 0 0 …", the arguments
            alone, or a list such as "arguments=['0', '0', …]".
    """
    arguments = pasted.rpartition(_PROGRAM)[2].partition("--ros-args")[0]
    listed = re.search(r"\[(.*?)\]", arguments, re.DOTALL)
    if listed is not None:
        return listed[1].replace(",", " ")
    return arguments


_NONE_ADDED = "None yet. Everyone sees a new one at once."
