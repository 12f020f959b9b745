"""The Frames panel of one browser: look-ups, and the static transforms of all."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterator, Sequence
from functools import partial

from sambot_viz.errors import UsageError, did_you_mean
from sambot_viz.frames import Transform
from sambot_viz.frames.explain import Explanation, explain
from sambot_viz.frames.hierarchy import plain_name
from sambot_viz.frames.static_transform import StaticTransform, parse_static_transform
from sambot_viz.panels.numbers_text import plain_numbers, shown_numbers
from sambot_viz.panels.panel import Panel
from sambot_viz.panels.row import Json, Level, Row
from sambot_viz.session import Session
from sambot_viz.session.browser import Browser
from sambot_viz.session.user_frames import UserFrame

Say = Callable[[str, Level], None]
"""Shows a sentence to the browser."""

_NUMBER = (float, int)
_PROGRAM = "static_transform_publisher"


class FramesPanel(Panel):
    """A look-up as tf2_echo makes it, and static transforms.

    Which two frames are asked for belongs to this browser; static transforms belong to
    everyone.

    Args:
        session: whose frames these are.
        browser: who asks.
        say: shows a sentence to the browser.
    """

    name = "frames"
    remade_by = frozenset({"frames", "robot", "config"})
    moved_by = frozenset({"joints"})
    period = 0.2

    def __init__(self, session: Session, browser: Browser, say: Say) -> None:
        self._session = session
        self._browser = browser
        self._say = say
        self._from = self._to = ""
        self._shown = False

    def rows(self) -> Sequence[Row]:
        """The two frames, the answer, the static transforms, and what can be done."""
        return [
            *self._choice(),
            *answer_rows(self._answer()),
            *self._static(),
            *self._actions(),
        ]

    def values(self) -> dict[str, Json]:
        """The answer, which follows motions while the panel is on the screen."""
        if not self._shown:
            return {}
        return {row.id: row.value for row in answer_rows(self._answer())}

    # The look-up

    @property
    def _frames(self) -> tuple[str, str]:
        """From and To; something that moves is a good first thing to look at."""
        context, tree = self._session.context, self._session.tree
        moving = next(iter(context.moving), None) or next(iter(tree.frames), "")
        return self._from or context.fixed_frame, self._to or moving

    def _answer(self) -> Explanation:
        source, target = self._frames
        return explain(self._session.tree, source, target, self._session.robot)

    def _choice(self) -> Iterator[Row]:
        source, target = self._frames
        yield Row(
            "frames/from",
            "",
            "frame",
            "From",
            value=source,
            help="The frame to look from; parent of a static transform.",
            set=partial(self._choose, "_from"),
        )
        yield Row(
            "frames/to",
            "",
            "frame",
            "To",
            value=target,
            help="The frame to look at; child of a static transform.",
            set=partial(self._choose, "_to"),
        )

    def _choose(self, which: str, frame: str) -> None:
        with self._browser.change("frames"):
            setattr(self, which, plain_name(frame.strip()))

    # The static transforms

    def _static(self) -> Iterator[Row]:
        added = {c: f for c, f in self._session.added.all.items() if f.static}
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
            "fact",
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
            help=f"x, y and z of {child} in {frame.parent}",
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
            help=f"roll, pitch and yaw of {child} in {frame.parent}",
            extra={"parts": ["Roll", "Pitch", "Yaw"]},
            set=lambda rpy: self._move(child, None, rpy),
        )

    def _move(
        self,
        child: str,
        xyz: Sequence[float] | None,
        rpy: Sequence[float] | None,
    ) -> None:
        added = self._session.added[child]
        old = added.transform
        transform = Transform.from_xyz_rpy(
            old.translation.tolist() if xyz is None else xyz,
            old.rpy if rpy is None else rpy,
        )
        self._session.add_frame(added.parent, child, transform)

    # What the page can ask for

    def _actions(self) -> Iterator[Row]:
        yield Row(
            "frames/shown",
            "",
            "action",
            value=self._shown,
            takes=(bool,),
            set=self._show,
        )
        yield Row(
            "frames/add",
            "",
            "action",
            takes=(*[_NUMBER] * 6, str, str),
            set=self._add_fields,
        )
        yield Row("frames/paste", "", "action", takes=(str,), set=self._paste)
        yield Row("frames/remove", "", "action", takes=(str,), set=self._remove)

    def _show(self, arguments: tuple[bool]) -> None:
        if self._shown != arguments[0]:
            with self._browser.change("frames"):
                (self._shown,) = arguments

    def _add_fields(self, arguments: tuple[float | str, ...]) -> None:
        """Add what was typed into fields: x, y, z, roll, pitch, yaw, parent, child."""
        numbers = [float(value) for value in arguments[:6]]
        parent, child = (plain_name(str(name).strip()) for name in arguments[6:])
        transform = Transform.from_xyz_rpy(numbers[:3], numbers[3:])
        self._add(StaticTransform(parent, child, transform))

    def _paste(self, arguments: tuple[str]) -> None:
        self._add(parse_static_transform(pasted_arguments(arguments[0])))

    def _add(self, wanted: StaticTransform) -> None:
        parent, child = wanted.parent, wanted.child
        tree = self._session.tree
        for name, what in ((parent, "parent"), (child, "child")):
            if not name:
                raise UsageError(f"name the {what} frame")
        if len(tree) and parent not in tree and child not in tree:
            hint = did_you_mean(parent, tree.frames)
            raise UsageError(
                f"neither '{parent}' nor '{child}' is a frame, so '{child}' would hang "
                f"in the air; {hint}"
            )
        self._session.add_frame(parent, child, wanted.transform)
        said = "; ".join((f"{child} is set in {parent}", *wanted.warnings))
        self._say(said, "warn" if wanted.warnings else "ok")

    def _remove(self, arguments: tuple[str]) -> None:
        child = arguments[0].removeprefix("static/")
        self._session.remove_frame(child)


def pasted_arguments(pasted: str) -> str:
    """The arguments of static_transform_publisher out of a command or a launch file.

    Args:
        pasted: "ros2 run tf2_ros static_transform_publisher 0 0 …", the arguments
            alone, or a list such as "arguments=['0', '0', …]".
    """
    arguments = pasted.rpartition(_PROGRAM)[2].partition("--ros-args")[0]
    listed = re.search(r"\[(.*?)\]", arguments, re.DOTALL)
    if listed is not None:
        return listed[1].replace(",", " ")
    return arguments


def answer_rows(found: Explanation) -> Iterator[Row]:
    """The pose in four forms, texts to copy, and the way step by step; or why not."""
    T = found.transform
    if T is None:
        yield Row("frames/why", "", "note", value=found.reason, level="error")
        if found.refused is not None:
            said = f"tf2 says: {found.refused.tf2_text}"
            yield Row("frames/tf2", "", "note", value=said)
        return
    xyz, rpy = T.translation.tolist(), T.rpy
    degrees = [math.degrees(angle) for angle in rpy]
    quaternion = T.rotation_xyzw.tolist()
    yield _copied("xyz", "Position x y z [m]", " ".join(plain_numbers(xyz)))
    yield _copied("rpy", "Roll pitch yaw [rad]", " ".join(plain_numbers(rpy)))
    yield _copied("deg", "Roll pitch yaw [°]", " ".join(plain_numbers(degrees, 3)))
    yield _copied("xyzw", "Quaternion x y z w", " ".join(plain_numbers(quaternion)))
    yield Row("frames/matrix", "", "group", "Matrix 4×4", expanded=True)
    yield _copied("matrix/rows", "Matrix 4×4", matrix_text(T), "frames/matrix", "lines")
    yield Row("frames/copy", "", "group", "To copy", expanded=True)
    for key, name, value in copies(found.target, found.source, T):
        yield _copied(f"copy/{key}", name, value, "frames/copy")
    yield from _chain(found)


def _copied(
    key: str, name: str, value: str, above: str = "", kind: str = "fact"
) -> Row:
    return Row(
        f"frames/{key}",
        above,
        "lines" if kind == "lines" else "fact",
        name,
        value,
        extra={"copy": True},
    )


def copies(parent: str, child: str, T: Transform) -> Iterator[tuple[str, str, str]]:
    """A pose as other programs want it: key, name, text."""
    x, y, z = plain_numbers(T.translation.tolist())
    roll, pitch, yaw = plain_numbers(T.rpy)
    flags = (
        *("--x", x, "--y", y, "--z", z),
        *("--roll", roll, "--pitch", pitch, "--yaw", yaw),
        *("--frame-id", parent, "--child-frame-id", child),
    )
    listed = ", ".join(f'"{word}"' for word in flags)
    yield "launch", "Launch file", f"arguments=[{listed}]"
    yield "flags", "Command line", " ".join(flags)
    eight = (x, y, z, yaw, pitch, roll, parent, child)
    yield "eight", "x y z yaw pitch roll …", " ".join(eight)
    yield (
        "urdf",
        "URDF origin",
        f'<origin xyz="{x} {y} {z}" rpy="{roll} {pitch} {yaw}"/>',
    )


def matrix_text(T: Transform) -> str:
    """Four lines of four numbers."""
    rows = [plain_numbers(row) for row in T.matrix.tolist()]
    widths = [max(len(row[i]) for row in rows) for i in range(4)]
    lines = (
        "  ".join(cell.rjust(width) for cell, width in zip(row, widths, strict=True))
        for row in rows
    )
    return "\n".join(lines)


def _chain(found: Explanation) -> Iterator[Row]:
    count = len(found.hops)
    steps = "the same frame" if not count else f"{count} step{'s' * (count != 1)}"
    yield Row(
        "frames/chain",
        "",
        "group",
        f"Way from {found.source} to {found.target}: {steps}",
    )
    for number, hop in enumerate(found.hops):
        xyz = shown_numbers(hop.step.translation.tolist())
        pose = f"xyz {xyz} m, rpy {shown_numbers(hop.step.rpy)} rad"
        yield Row(
            f"frames/chain/{number}",
            "frames/chain",
            "note",
            value=f"{hop.words}: {pose}",
        )


_NONE_ADDED = "None. Add one below: it is shown at once, and everyone sees it."
