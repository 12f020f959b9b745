"""The scene of a session, drawn once more for a file, and then moved.

The motion is, for each node, its values over time. A page can go to any time at once:
it takes from each track the last value before it.
"""

from __future__ import annotations

import base64
import gzip
import json
import threading
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, cast

from sambot_viz.displays.robot_display import ModelReader, ModelRequest, ModelResult
from sambot_viz.displays.scene.lines import PathLine
from sambot_viz.joints import JointState
from sambot_viz.server.server import prepare_scene
from sambot_viz.session import Session
from sambot_viz.session.clients import viser_camera
from sambot_viz.session.clients.client_camera import camera_message, followed_of
from sambot_viz.session.document.document_view import target_of
from sambot_viz.session.robot.motion_recorder import MotionSample
from sambot_viz.session.robot.robot_drive import ODOM
from sambot_viz.session.session_copy import SessionCopy
from sambot_viz.session.worker import Action, Worker
from sambot_viz.views.camera import Camera
from sambot_viz.views.view import Target, View
from sambot_viz.viser_private import Recorder

PERIOD = 1.0 / 30.0
"""Time between two steps of a motion [s]."""
LONGEST_READ = 30.0
"""A robot of a display's own file gets this long to be read [s]."""


@dataclass(frozen=True, slots=True)
class MadeScene:
    """A first picture, and what changes afterwards.

    Attributes:
        first: the first picture as viser's page reads it.
        tracks: all that changes.
        duration: how long the motion is [s].
        camera: what a page of a server is told of its camera.
    """

    first: bytes
    tracks: Tracks
    duration: float
    camera: Mapping[str, object]


@dataclass(frozen=True, slots=True)
class RelativeCamera:
    """A camera beside the frame that its view follows.

    Attributes:
        camera: in the fixed frame.
        view: the type of view, and the frame that it follows.
        target: where that was for the camera.
    """

    camera: Camera
    view: View
    target: Target

    def told(self, session: Session) -> tuple[Camera, Mapping[str, object]]:
        """Return the camera beside the frame now, and what a page is told of it."""
        target = target_of(session.scene, self.view, self.target)
        beside = self.view.in_target(self.camera, self.target)
        followed = followed_of(session.scene, self.view, target)
        message = camera_message(1, followed, beside)
        return self.view.in_fixed(beside, target), message


def recorded(
    scene: SessionCopy,
    camera: RelativeCamera,
    height: int,
    motion: Callable[[JointState], Iterable[MotionSample]],
    played: tuple[int, int] | None = None,
) -> MadeScene:
    """Draw what was shown, then move it.

    Args:
        scene: what to draw.
        camera: where to look from.
        height: of the picture that the camera was meant for [pixels].
        motion: what is to move, given the joints where they are.
        played: the log times of a recording between which it moves the robot [ns],
            instead of the motion.
    """
    recorder, tracks = Recorder(height), Tracks()
    recorder.listen(tracks.take)
    prepare_scene(recorder.scene)
    session = _drawn(scene, recorder)
    player = None if session.data is None else session.data.player
    if played is not None and player is not None:
        player.jump(played[0])
    at_first, told = camera.told(session)
    viser_camera.point(cast(Any, recorder), at_first)
    first = recorder.bytes()
    duration = 0.0
    if played is not None and player is not None:
        while player.time_ns < played[1]:
            left = (played[1] - player.time_ns) * 1e-9
            tracks.time = duration = duration + min(PERIOD, left)
            player.advance(min(PERIOD, left))
    elif session.robot.joints is not None:
        if session.data is not None:
            session.data.follow(False)
        for step in motion(session.robot.joints):
            tracks.time = duration = step.time
            there = {f: T for f, T in step.frames.items() if f in session.frames.added}
            session.robot.move(step.positions, there)
            session.robot.draw_moved()
    session.close()
    return MadeScene(first, tracks, duration, told)


def _drawn(scene: SessionCopy, recorder: Recorder) -> Session:
    models = None if scene.models is None else _Models(scene.models)
    worker, audience = _Nobody(cast(Any, None)), cast(Any, recorder)
    session = Session(
        audience,
        worker,
        scene.config,
        scene.meshes,
        models,
        moved_by=scene.recorded,
    )
    session.prepare(scene)
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

    def post(
        self, action: Action, latest_of: object = None, *, client: int | None = None
    ) -> None:
        del action, latest_of, client

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


Json = dict[str, Any]

_VALUES = {
    "SetPositionMessage": "position",
    "SetOrientationMessage": "wxyz",
    "SetSceneNodeVisibilityMessage": "visible",
}
"""Type of a message → the field with what it sets."""
_FIRST = {"position": (0.0, 0.0, 0.0), "wxyz": (1.0, 0.0, 0.0, 0.0), "visible": True}
"""The values of a node before anything is set."""
_UPDATE, _REMOVE = "SceneNodeUpdateMessage", "RemoveSceneNodeMessage"
_DIGITS = 6
"""Decimals of a number: micrometres, and as fine a part of a turn."""

Key = tuple[str, str, str]
"""Type of message, name of node, and the property that is set."""


class Tracks:
    """Collects messages of viser; those of the first picture give the first values.

    Attributes:
        time: of the messages that come now [s]; None while the first picture is drawn.
    """

    def __init__(self) -> None:
        self.time: float | None = None
        self._first: dict[Key, Any] = {}
        self._created: dict[str, tuple[Json, Sequence[memoryview]]] = {}
        self._tracks: dict[Key, tuple[list[int], list[Any]]] = {}

    def take(self, message: Json, arrays: Sequence[memoryview]) -> None:
        """Take a message; what is in no scene is left out."""
        kind, name = str(message["type"]), str(message.get("name", ""))
        if kind in _VALUES:
            field = _VALUES[kind]
            self._add((kind, name, field), _value(message[field], arrays))
        elif kind == _UPDATE:
            for prop, value in message["updates"].items():
                self._add((kind, name, prop), _value(value, arrays))
        elif kind == _REMOVE:
            self._add(("", name, ""), None)
        elif "props" in message and name:
            if self.time is None:
                self._created[name] = (message, arrays)
            else:
                self._add(("", name, ""), _value(message, arrays))

    def packed(self) -> str:
        """Return all tracks, as base64 of gzipped JSON."""
        found = [self._track(key, *track) for key, track in self._tracks.items()]
        data = json.dumps(found, separators=(",", ":"), ensure_ascii=True)
        return base64.b64encode(gzip.compress(data.encode(), 9, mtime=0)).decode()

    def _add(self, key: Key, value: Any) -> None:
        if self.time is None:
            self._first[key] = value
            return
        times, values = self._tracks.setdefault(key, ([], []))
        now = round(self.time * 1000.0)
        if times and times[-1] == now:
            times.pop()
            values.pop()
        times.append(now)
        values.append(value)

    def _track(self, key: Key, times: list[int], values: list[Any]) -> Json:
        kind, name, prop = key
        first = self._before(key)
        since = [b - a for a, b in zip([0, *times], times, strict=False)]
        made = {"name": name, "first": first, "since": since, "values": values}
        return {"type": kind, "prop": prop, **made}

    def _before(self, key: Key) -> Any:
        kind, name, prop = key
        if key in self._first:
            return self._first[key]
        created = self._created.get(name)
        if not kind:
            return None if created is None else _value(*created)
        if kind == _UPDATE and created is not None:
            message, arrays = created
            return _value(message["props"].get(prop), arrays)
        return _FIRST.get(prop)


def _value(value: Any, arrays: Sequence[memoryview]) -> Any:
    """Return a value for JSON: short numbers, and arrays as base64."""
    if isinstance(value, float):
        return round(value, _DIGITS)
    if isinstance(value, list | tuple):
        return [_value(part, arrays) for part in cast("Sequence[Any]", value)]
    if isinstance(value, bytes):
        return {"dtype": "|u1", "base64": base64.b64encode(value).decode()}
    if isinstance(value, dict):
        parts = cast(Json, value)
        if "__binary_index" in parts:
            array: memoryview = arrays[int(parts["__binary_index"])]
            packed = base64.b64encode(array).decode()
            return {"dtype": parts["dtype"], "base64": packed}
        return {key: _value(part, arrays) for key, part in parts.items()}
    return value
