"""The scene of a session, drawn once more for a file, and then moved."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterable
from dataclasses import replace
from pathlib import Path
from typing import Any, cast

from sambot_viz.displays.robot_display import (
    ModelReader,
    ModelRequest,
    ModelResult,
)
from sambot_viz.displays.scene.lines import PathLine
from sambot_viz.export.tracks import Tracks
from sambot_viz.joints import JointState
from sambot_viz.server.server import prepare_scene
from sambot_viz.session import Session
from sambot_viz.session.clients.camera import ClientCamera
from sambot_viz.session.robot.drive import ODOM
from sambot_viz.session.robot.motion_recorder import MotionSample
from sambot_viz.session.session_copy import SessionCopy
from sambot_viz.session.worker import Action, Worker
from sambot_viz.views.camera import Camera
from sambot_viz.viser_private import Recorder

LONGEST_READ = 30.0
"""A robot of a display's own file gets this long to be read [s]."""


def recorded(
    scene: SessionCopy,
    camera: Camera,
    height: int,
    motion: Callable[[JointState], Iterable[MotionSample]],
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
    ClientCamera(cast(Any, recorder)).point(camera)
    first = recorder.bytes()
    duration = 0.0
    if session.robot.joints is not None:
        for step in motion(session.robot.joints):
            tracks.time = duration = step.time
            there = {f: T for f, T in step.frames.items() if f in session.frames.added}
            session.robot.move(step.positions, there)
            session.robot.draw_moved()
    session.close()
    return first, tracks, duration


def _drawn(scene: SessionCopy, recorder: Recorder) -> Session:
    models = None if scene.models is None else _Models(scene.models)
    worker, audience = _Nobody(cast(Any, None)), cast(Any, recorder)
    session = Session(audience, worker, scene.config, scene.meshes, models)
    session.trust(scene)
    session.document.show()
    if scene.robot is not None:
        session.show_robot(scene.robot)
    session.take(scene)
    session.robot.draw_moved()
    if models is not None:
        models.finish()
    if scene.trail:
        PathLine(recorder.scene).draw(
            session.scene.context.nodes.path(ODOM), scene.trail
        )
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
