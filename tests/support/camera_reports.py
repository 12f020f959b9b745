"""The cameras that a browser reports, and those that it is sent."""

from __future__ import annotations

import numpy as np
from protocol_client import ProtocolClient

from sambot_viz.geometry import Vector3, Wxyz, wxyz_from_matrix


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


def report(
    client: ProtocolClient,
    position: Vector3,
    look_at: Vector3 = (0.0, 0.0, 0.0),
    target: Vector3 | None = None,
    fov: float = 0.7853981633974483,
    size: tuple[int, int] = (640, 480),
) -> None:
    """Report a camera, as a page does; one that moves may have another target."""
    client.send(
        "ViewerCameraMessage",
        wxyz=looking(position, look_at),
        position=position,
        fov=fov,
        near=0.01,
        far=1e5,
        image_height=size[1],
        image_width=size[0],
        look_at=look_at if target is None else target,
        up_direction=(0.0, 0.0, 1.0),
    )


def told(client: ProtocolClient, kind: str = "Position") -> list[list[float]]:
    """The cameras that a browser was sent."""
    field = {"Position": "position", "LookAt": "look_at"}[kind]
    name = f"SetCamera{kind}Message"
    return [list(m.fields[field]) for m in client.messages if m.type == name]


def vector3(values: list[float]) -> Vector3:
    """Three numbers of a message."""
    x, y, z = values
    return (x, y, z)
