"""The cameras that a page reports, and those that it is asked for.

`join_at` is viser's first report, which a page makes when it comes; `move` is what our
page reports afterwards, relative to the frame that its view follows.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from protocol_client import CAMERA_ASKED, ProtocolClient

from sambot_viz.geometry import Vector3, Wxyz, wxyz_from_matrix

FRESH: Vector3 = (3.0, 3.0, 3.0)
"""Where viser's camera is in a page that was just opened."""


def looking(position: Vector3, look_at: Vector3) -> Wxyz:
    """The orientation of a camera: its z is forward, its y is down in the picture."""
    forward = np.subtract(look_at, position) / np.linalg.norm(
        np.subtract(look_at, position)
    )
    right = np.cross(forward, (0.0, 0.0, 1.0))
    right /= np.linalg.norm(right)
    T = np.eye(4)
    T[:3, :3] = np.stack([right, np.cross(forward, right), forward], axis=1)
    return wxyz_from_matrix(T)


def report_to_viser(
    client: ProtocolClient,
    position: Vector3,
    look_at: Vector3 = (0.0, 0.0, 0.0),
    fov: float = math.pi / 4,
    size: tuple[int, int] = (640, 480),
) -> None:
    """Report a camera of the fixed frame, and the size of its picture, to viser."""
    client.send(
        "ViewerCameraMessage",
        wxyz=looking(position, look_at),
        position=position,
        fov=fov,
        near=0.01,
        far=1e5,
        image_height=size[1],
        image_width=size[0],
        look_at=look_at,
        up_direction=(0.0, 0.0, 1.0),
    )


def asked(client: ProtocolClient) -> list[dict[str, Any]]:
    """The cameras that a page was asked for, each with its number and its frame."""
    told = [m.fields for m in client.messages if m.type == CAMERA_ASKED]
    return [fields for fields in told if fields["camera"] is not None]


def positions(client: ProtocolClient) -> list[list[float]]:
    """Where they are, relative to that frame."""
    return [list(one["camera"]["position"]) for one in asked(client)]


def follows(client: ProtocolClient) -> dict[str, Any]:
    """The frame that the page is to follow."""
    told = [m.fields for m in client.messages if m.type == CAMERA_ASKED]
    return dict(told[-1]["follows"])


def number(client: ProtocolClient) -> int:
    """The number of the camera that the page was asked for last."""
    return int(
        [m.fields for m in client.messages if m.type == CAMERA_ASKED][-1]["number"]
    )


def move(
    client: ProtocolClient,
    position: Vector3,
    look_at: Vector3 = (0.0, 0.0, 0.0),
    *,
    up: Vector3 = (0.0, 0.0, 1.0),
    fov: float = math.pi / 4,
    scale: float | None = None,
    of: int | None = None,
) -> None:
    """Report a camera relative to the frame that the page follows.

    Args:
        client: the page.
        position: of the camera [m].
        look_at: in the middle of its picture [m].
        up: up there.
        fov: vertical field of view [rad].
        scale: pixels per metre of one from straight above.
        of: the number of the camera that the page shows; of the newest by default.
    """
    client.send_edit(
        {
            "camera": number(client) if of is None else of,
            "position": position,
            "look_at": look_at,
            "up": up,
            "fov": fov,
            "scale": scale,
        }
    )


def confirm(client: ProtocolClient) -> None:
    """Report the camera that was asked for last, as a page does that shows it."""
    newest = asked(client)[-1]["camera"]
    names = ("position", "look_at")
    at: list[Vector3] = [(v[0], v[1], v[2]) for v in map(newest.get, names)]
    move(
        client, at[0], at[1], up=newest["up"], fov=newest["fov"], scale=newest["scale"]
    )
