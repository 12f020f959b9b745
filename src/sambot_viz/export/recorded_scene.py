"""The scene of a session, drawn once more for a file, and then moved."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, cast

from sambot_viz.displays.robot_display import (
    ModelReader,
    ModelRequest,
    ModelResult,
)
from sambot_viz.displays.scene.ribbons import PathLine
from sambot_viz.export.tracks import Tracks
from sambot_viz.frames import Transform
from sambot_viz.joints import JointState
from sambot_viz.meshes.cache import MeshCache
from sambot_viz.robot.model import Robot
from sambot_viz.server.server import prepare_scene
from sambot_viz.session import Session
from sambot_viz.session.browser.camera import BrowserCamera
from sambot_viz.session.robot.drive_control import ODOM
from sambot_viz.session.robot.past_motion import Moved
from sambot_viz.session.session_copy import SessionCopy
from sambot_viz.session.worker import Action, Worker
from sambot_viz.views.camera import Camera
from sambot_viz.viser_private import Recorder

LONGEST_READ = 30.0
"""A robot of a display's own file gets this long to be read [s]."""


@dataclass(frozen=True, slots=True)
class SceneSnapshot:
    """All that a session shows, for another thread; used once.

    Attributes:
        robot: the robot, if there is one.
        copy: the document, the joints and the added frames.
        trail: where the robot was driven, x, y [m] in odom.
        models: reads further models.
        meshes: mesh files that are read already.
    """

    robot: Robot | None
    copy: SessionCopy
    trail: tuple[tuple[float, float], ...]
    models: ModelReader | None
    meshes: MeshCache

    @classmethod
    def by(cls, session: Session) -> SceneSnapshot:
        """Take what a session shows now."""
        with session.lock:
            return cls(
                session.robot,
                SessionCopy.of(session),
                session.motion.drive.trail,
                session.context.models,
                session.context.assets.cache,
            )

    def before(self, moved: Moved) -> SceneSnapshot:
        """Return the same, with joints and frames where they were."""
        frames = {
            child: replace(frame, transform=Transform.trusted(moved.frames[child]))
            if child in moved.frames
            else frame
            for child, frame in self.copy.frames.items()
        }
        copy = replace(self.copy, positions=moved.positions, frames=frames)
        return replace(self, copy=copy)


def recorded(
    scene: SceneSnapshot,
    camera: Camera,
    height: int,
    motion: Callable[[JointState], Iterable[Moved]],
) -> tuple[bytes, Tracks, float]:
    """Draw what was shown, then move it.

    Args:
        scene: what to draw.
        camera: where to look from.
        height: of the picture that the camera was meant for [pixels].
        motion: what is to move, given the joints where they are.

    Returns:
        The first picture as viser's page reads it, all that changes afterwards, and
        how long the motion is [s].
    """
    recorder, tracks = Recorder(height), Tracks()
    recorder.listen(tracks.take)
    prepare_scene(recorder.scene)
    session = _drawn(scene, recorder)
    BrowserCamera(cast(Any, recorder)).point(camera)
    first = recorder.bytes()
    duration = 0.0
    if session.joints is not None:
        for step in motion(session.joints):
            tracks.time = duration = step.time
            there = {f: T for f, T in step.frames.items() if f in session.added}
            session.move(step.positions, there)
            session.draw_moved()
    session.close()
    return first, tracks, duration


def _drawn(scene: SceneSnapshot, recorder: Recorder) -> Session:
    models = None if scene.models is None else _Models(scene.models)
    worker, audience = _Nobody(cast(Any, None)), cast(Any, recorder)
    session = Session(audience, worker, scene.copy.config, scene.meshes, models)
    scene.copy.trust(session)
    session.show_config()
    if scene.robot is not None:
        session.show_robot(scene.robot)
    scene.copy.give(session)
    session.draw_moved()
    if models is not None:
        models.finish()
    if scene.trail:
        PathLine(recorder.scene).draw(session.context.nodes.path(ODOM), scene.trail)
    return session


class _Nobody(Worker):
    """The worker of a session that no browser sees: nothing is to be done later."""

    def post(self, action: Action, latest_of: object = None) -> None:
        del action, latest_of

    def post_later(self, delay: float, action: Action) -> None:
        del delay, action


class _Models:
    """Reads further models, and gives them out when it is asked to."""

    def __init__(self, models: ModelReader) -> None:
        self._models = models
        self._changed = threading.Condition()
        self._asked: dict[object, Callable[[ModelResult], None]] = {}
        self._read: dict[object, ModelResult] = {}

    @property
    def package_path(self) -> tuple[Path | str, ...]:
        return self._models.package_path

    def read(self, request: ModelRequest) -> None:
        self._asked[request.owner] = request.done

        def take(result: ModelResult) -> None:
            with self._changed:
                self._read[request.owner] = result
                self._changed.notify_all()

        self._models.read(replace(request, done=take))

    def finish(self) -> None:
        """Wait for what was asked for, and give it to the displays."""
        for owner, done in list(self._asked.items()):
            with self._changed:
                there = self._changed.wait_for(
                    lambda owner=owner: owner in self._read, LONGEST_READ
                )
            if there:
                done(self._read[owner])
