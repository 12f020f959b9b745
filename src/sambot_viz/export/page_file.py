"""A session as one HTML file that shows and plays it without a server."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Literal

from sambot_viz import page
from sambot_viz.export.recorded_scene import Shown, recorded
from sambot_viz.joints import JointState
from sambot_viz.joints.sweep import sweep
from sambot_viz.server.page_files import page_of_viser
from sambot_viz.session import Session
from sambot_viz.session.browser.browser import Browser
from sambot_viz.session.browser.robot_framing import Size, window_of
from sambot_viz.session.document.document_view import mouse_facts, view_of
from sambot_viz.session.robot.past_motion import Moved
from sambot_viz.text import text
from sambot_viz.views.camera import Camera

Motion = Literal["sweep", "past", "none"]
Past = tuple[Moved, Sequence[Moved]]
"""The first values of everything, and the steps from there."""
PERIOD = 1.0 / 30.0
"""Time between two steps of a motion [s]."""
REST = 0.5
"""Time for which the end of a motion is shown [s]."""
USUAL_SIZE = (1280, 720)
"""Size of a page that no browser shows yet [pixels]."""
STEP = 90
"""In which it becomes narrower [pixels]."""
LONGEST_NAME = 200
"""Of a robot, as the title of a page [characters]."""


@dataclass(frozen=True, slots=True)
class Looking:
    """How somebody looks at a session.

    Attributes:
        camera: where from.
        size: width and height of the picture [pixels]; in a narrower one the camera
            is farther away.
        mouse: what the page has to know of the view (see `mouse_facts`).
    """

    camera: Camera
    size: Size
    mouse: Mapping[str, Any]

    @classmethod
    def of(cls, browser: Browser) -> Looking:
        """As a browser does now."""
        view, size = browser.view, window_of(browser.client)
        return cls(view.camera, size, mouse_facts(view.view))

    @classmethod
    def at_first(cls, session: Session) -> Looking:
        """As a page does that was just opened."""
        view = view_of(session.config.detached_view())
        if view.gives_nearness or session.robot is None:
            return cls(session.camera, USUAL_SIZE, mouse_facts(view))
        width, height = USUAL_SIZE
        camera = session.camera_on_robot(width, height)
        # How narrow a picture may be until the robot is cut at its sides.
        while width > height / 2:
            nearer = session.camera_on_robot(width - STEP, height)
            if nearer.distance > camera.distance + 1e-6:
                break
            width -= STEP
        return cls(camera, (width, height), mouse_facts(view))


def page_file(
    shown: Shown, looking: Looking, motion: Motion, past: Past | None = None
) -> bytes:
    """Return the HTML file.

    Args:
        shown: what is in it.
        looking: how it is looked at first.
        motion: what moves: all joints one after the other, what has moved in the last
            minute, or nothing.
        past: how that was.
    """
    steps: Callable[[JointState], Iterable[Moved]] = _nothing
    if motion == "sweep":
        steps = _sweep
    elif motion == "past" and past is not None:
        before, since = past
        shown, steps = shown.before(before), lambda joints: _with_rest(since)
    scene, tracks, duration = recorded(shown, looking.camera, looking.size[1], steps)
    robot = "no robot" if shown.robot is None else shown.robot.name
    title = text(robot, LONGEST_NAME) or "robot"
    about = {
        "title": title,
        "duration": duration,
        "size": looking.size,
        "view": dict(looking.mouse),
    }
    return page.standing_alone(page_of_viser(), title, scene, about, tracks.packed())


def _sweep(joints: JointState) -> Iterable[Moved]:
    # The joints are about to be moved.
    steps = list(sweep(joints, PERIOD))
    return [Moved(time, positions, {}) for time, positions in steps]


def _with_rest(steps: Sequence[Moved]) -> Iterable[Moved]:
    """Steps, and a moment in which the end can be seen."""
    yield from steps
    if steps:
        yield Moved(steps[-1].time + REST, {}, {})


def _nothing(joints: JointState) -> Iterable[Moved]:
    del joints
    return ()
