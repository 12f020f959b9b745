"""A session as one HTML file that shows and plays it without a server."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

from sambot_viz import page
from sambot_viz.export.recorded_scene import Shown, Step, recorded
from sambot_viz.joints import JointState
from sambot_viz.joints.sweep import sweep
from sambot_viz.server.page_files import page_of_viser
from sambot_viz.session import Session
from sambot_viz.session.document_view import mouse_facts, view_of
from sambot_viz.text import text
from sambot_viz.views.camera import Camera

PERIOD = 1.0 / 30.0
"""Time between two steps of a motion [s]."""
USUAL_SIZE = (1280, 720)
"""What a page is made for when nobody looks at it yet [pixels]."""
LONGEST_NAME = 200
"""Of a robot, as the title of a page [characters]."""


@dataclass(frozen=True, slots=True)
class Looking:
    """How somebody looks at a session.

    Attributes:
        camera: where from.
        height: of the picture [pixels].
        mouse: what the page has to know of the view (see `mouse_facts`).
    """

    camera: Camera
    height: int
    mouse: Mapping[str, Any]

    @classmethod
    def at_first(cls, session: Session) -> Looking:
        """As a page does that was just opened."""
        view = view_of(session.config.detached_view())
        fits = not view.gives_nearness and session.robot is not None
        width, height = USUAL_SIZE
        camera = session.camera_on_robot(width, height) if fits else session.camera
        return cls(camera, height, mouse_facts(view))


def page_file(shown: Shown, looking: Looking, *, moving: bool) -> bytes:
    """The HTML file.

    Args:
        shown: what is in it.
        looking: how it is looked at first.
        moving: whether all joints move, one after the other.
    """
    motion = _sweep if moving else _nothing
    scene, tracks, duration = recorded(shown, looking.camera, looking.height, motion)
    robot = "no robot" if shown.robot is None else shown.robot.name
    title = text(robot, LONGEST_NAME) or "robot"
    about = {
        "title": title,
        "duration": duration,
        "height": looking.height,
        "view": dict(looking.mouse),
    }
    return page.standing_alone(page_of_viser(), title, scene, about, tracks.packed())


def _sweep(joints: JointState) -> Iterable[Step]:
    steps = list(sweep(joints, PERIOD))
    return [Step(time, positions, {}) for time, positions in steps]


def _nothing(joints: JointState) -> Iterable[Step]:
    del joints
    return ()
