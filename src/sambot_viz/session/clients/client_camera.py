"""The camera of one client, as its page and the server agree on it.

The page owns the camera: the user moves it, and it moves by itself with the frame that
the view follows. Both sides therefore give it relative to that frame, so that the
frame's motion changes no number. The server names the frame, and requests a camera for
a view, a typed value, an undo, a presenter who leads, or a program. Each request has a
number, which the page's reports carry from then on; a report with an earlier number is
about a camera that has been replaced.
"""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from sambot_viz.session.document.document_view import has_target
from sambot_viz.session.scene.scene import Scene
from sambot_viz.views.camera import (
    FIELD_OF_VIEW,
    ORTHO_FIELD_OF_VIEW,
    ORTHO_HEIGHT,
    UP,
    Camera,
    Vector,
    components,
    length,
)
from sambot_viz.views.view import Target, View

POLE = 1e-5
"""A camera that looks down leans by this angle, which defines "up" in its picture
[rad]."""


@dataclass(frozen=True, slots=True)
class Followed:
    """The frame that a page's camera moves with.

    Attributes:
        node: the name of its node; "" for a frame that does not move, or has no place.
        has_place: whether it has one; else the page leaves it where it was.
        turns: whether the camera turns with it about the vertical.
        at: x, y and z of its origin in the fixed frame [m], and how far it is turned
            about the vertical [rad], for a page that does not know it better.
    """

    node: str
    has_place: bool
    turns: bool
    at: tuple[float, float, float, float]

    def is_as(self, other: Followed) -> bool:
        """Return whether both are the same frame; where it is, the page knows."""
        return self == replace(other, at=self.at)


def followed_of(scene: Scene, view: View, target: Target) -> Followed:
    """Return the frame that the camera of a page moves with.

    Args:
        scene: has the nodes.
        view: whose target frame it is.
        target: where that is now.
    """
    at = (*components(target.position), target.yaw)
    if not has_target(scene, view):
        return Followed("", True, view.follows_yaw, at)
    name, nodes = (
        scene.context.frame(view.config.get("Target Frame")),
        scene.context.nodes,
    )
    node = (nodes.path(name) or "") if nodes.connected(name) else ""
    return Followed(node, bool(node), view.follows_yaw, at)


class ClientCamera:
    """Hold the camera that a client's page last reported, and the one requested of it.

    One of the `Versioned` parts of a page: a page with an older version gets the
    newest.

    Args:
        camera: the page's first camera, relative to `followed`.
        followed: the frame that the view follows.

    Attributes:
        camera: relative to the followed frame; replaced by another object when another
            camera is requested, or the user has moved it.
        number: number of the last request; 0 before the first.
        confirmed: whether the page has shown the requested camera.
        version: counts the changes to send.
        listeners: called when there is something to send.
    """

    def __init__(self, camera: Camera, followed: Followed) -> None:
        self.camera = camera
        self.number = 0
        self.confirmed = False
        self.version = 0
        self.listeners: list[Callable[[], object]] = []
        self._followed = followed
        self._asked: Camera | None = None
        # Of its version; it is read on the event loop, which takes no lock.
        self._message = (0, "")
        self._tell()

    def ask(self, camera: Camera, followed: Followed) -> None:
        """Have the page show a camera.

        Args:
            camera: relative to the followed frame.
            followed: that frame.
        """
        self.camera = self._asked = camera
        self._followed = followed
        self.number += 1
        self.confirmed = False
        self._tell()

    def follow(self, followed: Followed) -> None:
        """Have the page's camera keep its place relative to another frame, or node."""
        if not followed.is_as(self._followed):
            self._followed = followed
            self._tell()

    def take(self, number: int, camera: Camera) -> bool:
        """Accept a report of the page.

        Args:
            number: the newest request that the page knew when it showed this camera.
            camera: relative to the followed frame.

        Returns:
            Whether the user has moved the camera there. False for the requested camera,
            and for one that has been replaced.
        """
        if number != self.number:
            return False
        self.confirmed = True
        if same_picture(camera, self.camera):
            return False
        self.camera = camera
        return True

    def since(self, version: int) -> tuple[int, str | None]:
        """Return the present version, and the message for a page with another one."""
        now, message = self._message
        return now, None if version == now else message

    def _tell(self) -> None:
        self.version += 1
        message = camera_message(self.number, self._followed, self._asked)
        self._message = self.version, json.dumps(message)
        for listener in tuple(self.listeners):
            listener()


def camera_message(
    number: int, followed: Followed, asked: Camera | None
) -> dict[str, object]:
    """Return the message about its camera for a page (page/view/camera.js).

    Args:
        number: number of the last request.
        followed: the frame that the camera moves with.
        asked: the requested camera, relative to the frame; None before the first.
    """
    return {
        "of": "camera",
        "number": number,
        "follows": {
            "node": followed.node,
            "place": followed.has_place,
            "turns": followed.turns,
            "at": followed.at,
        },
        "camera": None if asked is None else _as_sent(asked),
    }


def _as_sent(camera: Camera) -> dict[str, object]:
    """Return a camera as a page gets it, which knows how high its picture is."""
    drawn = leaning(camera) if camera.orthographic else camera
    return {
        "position": components(drawn.position),
        "look_at": components(drawn.look_at),
        "up": components(drawn.up),
        "fov": ORTHO_FIELD_OF_VIEW if camera.orthographic else drawn.fov,
        "near": drawn.near,
        "far": drawn.far,
        "scale": drawn.scale,
    }


def leaning(camera: Camera) -> Camera:
    """Return a camera that looks down with "up" in its picture, for viser's page.

    There, the vertical is always up.
    """
    lean = POLE * camera.distance * camera.image_up
    return camera.placed(camera.position - lean, camera.look_at, UP)


def reported(
    position: Vector, look_at: Vector, up: Vector, fov: float, scale: float | None
) -> Camera | None:
    """Return a camera from the numbers of a page's report.

    Args:
        position: relative to the followed frame, as the others are [m].
        look_at: the point in the middle of the picture [m].
        up: up in the picture.
        fov: vertical field of view [rad].
        scale: pixels per metre of an orthographic camera that looks straight down.

    Returns:
        None for numbers that make no valid camera.
    """
    away = length(look_at - position)
    if away < 1e-9 or length(np.cross(look_at - position, up)) < 1e-9 * away:
        return None
    if scale is None:
        return Camera(position, look_at, up, fov=fov)
    above = look_at + ORTHO_HEIGHT * UP
    return Camera(above, look_at, up, fov=FIELD_OF_VIEW, scale=scale)


def same_picture(one: Camera, two: Camera) -> bool:
    """Whether two cameras show the same, to a fraction of a pixel."""
    if (one.scale is None) != (two.scale is None):
        return False
    if one.scale is None and one.is_parallel != two.is_parallel:
        return False
    if one.scale is not None and two.scale is not None:
        pixel = 0.5 / two.scale
        near = abs(one.scale / two.scale - 1.0) < 1e-4
    else:
        near = length(one.position - two.position) < 2e-5 * two.distance + 1e-6
        pixel = 2e-5 * two.with_fov(FIELD_OF_VIEW).distance + 1e-6
    looking = one.look_at - two.look_at
    return near and length(looking) < pixel and length(one.right - two.right) < 1e-3
