"""A session as one HTML file that shows and plays it without a server.

Files that browsers ask for are made one after the other, beside all other work.
"""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Coroutine, Iterable, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from functools import partial
from typing import Any, Literal

from sambot_viz import limits, page
from sambot_viz.errors import Problem, SambotVizError, UsageError
from sambot_viz.export.recorded_scene import PERIOD, RelativeCamera, recorded
from sambot_viz.joints import JointState
from sambot_viz.joints.animation import sweep
from sambot_viz.server.connections.page_files import page_of_viser
from sambot_viz.session.clients.client import Client
from sambot_viz.session.clients.robot_framing import Size, window_of
from sambot_viz.session.document.document_view import (
    USUAL_SIZE,
    DocumentView,
    mouse_facts,
)
from sambot_viz.session.robot.motion_recorder import MotionSample, Past
from sambot_viz.session.session_copy import SessionCopy
from sambot_viz.text import text
from sambot_viz.views.camera import Camera
from sambot_viz.views.view import Target, View

Motion = Literal["sweep", "past", "none", "recording"]
REST = 0.5
"""Time for which the end of a motion is shown [s]."""
STEP = 90
"""Width decrement when searching for the narrowest view [pixels]."""
LONGEST_NAME = 200
"""Longest name of a robot as the title of a page [characters]."""
LONGEST_PAST = 60.0
"""Of a recording that is played, the last minute is taken [s]."""

_ONE = ThreadPoolExecutor(1, "sambot-viz-export")
"""One page is made at a time, so that many browsers take the memory of one."""


@dataclass(frozen=True, slots=True)
class ViewState:
    """The view of a page: camera, size and what the mouse needs.

    Attributes:
        camera: where from.
        size: width and height of the picture [pixels]; in a narrower one the camera
            is farther away.
        view: the type of view, and the frame that it follows.
        target: where that is.
    """

    camera: Camera
    size: Size
    view: View
    target: Target

    @classmethod
    def of(cls, client: Client) -> ViewState:
        """Return the view of a client now."""
        view, size = client.view, window_of(client.client)
        return cls(view.camera, size, view.view, view.target)

    @classmethod
    def at_first(cls, first: DocumentView, has_robot: bool) -> ViewState:
        """Return the view of a page that was just opened."""
        view, target = first.view, first.target
        if view.gives_nearness or not has_robot:
            return cls(first.camera, USUAL_SIZE, view, target)
        width, height = USUAL_SIZE
        camera = first.camera_on_robot(width, height)
        # How narrow a picture may be until the robot is cut at its sides.
        while width > height / 2:
            nearer = first.camera_on_robot(width - STEP, height)
            if nearer.distance > camera.distance + 1e-6:
                break
            width -= STEP
        return cls(camera, (width, height), view, target)


def page_file(
    scene: SessionCopy,
    view: ViewState,
    motion: Motion,
    past: Past | None = None,
    look: str = "rviz",
) -> bytes:
    """Return the HTML file.

    Args:
        scene: what is in it.
        view: how it is looked at first.
        motion: what moves: all joints one after the other, what has moved in the last
            minute, nothing, or what a recording moves from its present time on.
        past: how that was.
        look: how it is drawn (see `Options.look`).
    """
    steps: Callable[[JointState], Iterable[MotionSample]] = _nothing
    if motion == "sweep":
        steps = _sweep
    elif motion == "past" and past is not None:
        before, since = past
        scene, steps = scene.before(before), lambda joints: _with_rest(since)
    camera = RelativeCamera(view.camera, view.view, view.target)
    made = recorded(scene, camera, view.size[1], steps, _played(scene, motion))
    robot = "no robot" if scene.robot is None else scene.robot.name
    title = text(robot, LONGEST_NAME) or "robot"
    about = {
        "title": title,
        "duration": made.duration,
        "size": view.size,
        "view": mouse_facts(view.view),
        "camera": made.camera,
    }
    return page.standing_alone(
        page_of_viser(), title, made.first, about, made.tracks.packed(), look
    )


def _played(scene: SessionCopy, motion: Motion) -> tuple[int, int] | None:
    """Return the log times between which a recording is played; None without one."""
    recording = None if scene.recorded is None else scene.recorded.recording
    if recording is None or motion not in ("past", "recording"):
        return None
    now = scene.time_ns
    if motion == "past":
        return max(recording.start_ns or 0, now - round(LONGEST_PAST * 1e9)), now
    return now, min(
        recording.end_ns or 0, now + round(limits.EXPORTED_RECORDING.value * 1e9)
    )


def cut_short(scene: SessionCopy) -> list[Problem]:
    """Return what is said of a recording that a page plays only a part of."""
    played = _played(scene, "recording")
    if played is None or scene.recorded is None or scene.recorded.recording is None:
        return []
    recording = scene.recorded.recording
    end = recording.end_ns or 0
    if end <= played[1]:
        return []
    rest = round((end - played[0]) / 1e9)
    message = (
        f"the page plays {limits.EXPORTED_RECORDING.value} of {rest} seconds, and the "
        "rest is left out"
    )
    at = (played[1] - (recording.start_ns or 0)) / 1e9
    hint = f"for what follows, export another page with --at {at:.1f}"
    return [Problem("info", "export-cut-short", message, hint)]


def _sweep(joints: JointState) -> Iterable[MotionSample]:
    # The joints are about to be moved.
    steps = list(sweep(joints, PERIOD))
    return [MotionSample(time, positions, {}) for time, positions in steps]


def _with_rest(steps: Sequence[MotionSample]) -> Iterable[MotionSample]:
    """Yield the steps, and a moment in which the end can be seen."""
    yield from steps
    if steps:
        yield MotionSample(steps[-1].time + REST, {}, {})


def _nothing(joints: JointState) -> Iterable[MotionSample]:
    del joints
    return ()


class PageError(SambotVizError):
    """There is no page that could be sent."""


def ask_page(
    scene: SessionCopy, past: Past, client: Client, motion: str, look: str = "rviz"
) -> Callable[[], Coroutine[Any, Any, bytes]]:
    """Note what a browser sees now, for `panels.pictures`.

    Args:
        scene: what is shown.
        past: how it has moved.
        client: who looks at it.
        motion: what is to move (see `page_file`).
        look: how the browser draws.

    Returns:
        What makes the HTML file, while other work of the event loop goes on. It raises
        PageError when the file is too large to be sent.

    Raises:
        UsageError: there is no such motion, or nothing has moved.
    """
    if motion == "past" and not past[1]:
        raise UsageError("nothing has moved in the last minute")
    if motion not in ("sweep", "past", "none"):
        raise UsageError(f"there is no motion '{motion}'")
    if look not in ("rviz", "studio"):
        raise UsageError(f"there is no look '{look}'")
    view = ViewState.of(client)
    return partial(_made, partial(page_file, scene, view, motion, past, look))


async def _made(make: Callable[[], bytes]) -> bytes:
    page = await asyncio.get_running_loop().run_in_executor(_ONE, make)
    if len(page) > limits.EXPORTED_PAGE.value:
        raise PageError(
            f"the page would have {len(page) / 1e6:.0f} MB: `sambot-viz export` "
            "writes it on the computer of the program"
        )
    return page
