"""Robots for tests of the page, as URDF."""

from __future__ import annotations

import struct
from collections.abc import Iterator
from itertools import pairwise, product
from pathlib import Path

HUMANOID_JOINTS = 32
_SIDE = (
    "shoulder_pitch",
    "shoulder_roll",
    "shoulder_yaw",
    "elbow",
    "wrist_yaw",
    "wrist_pitch",
    "wrist_roll",
    "gripper",
    "hip_yaw",
    "hip_roll",
    "hip_pitch",
    "knee",
    "ankle_pitch",
    "ankle_roll",
)
ARM_LINKS = ("foot", "upper", "lower", "hand", "tip")
"""From below, each 0.3 m above the one before, while all joints are at zero."""
LONG_NAME = "upper_left_arm_to_lower_left_arm_elbow_flexion_joint_two"
"""56 letters."""
SLIDE = "gantry_slide"


def humanoid() -> str:
    """Two arms and two legs, 32 movable joints, boxes in place of meshes."""
    return _robot("humanoid", "pelvis", [*_humanoid()])


def chain(count: int = 300) -> str:
    """Joints joint_1, joint_2, … one behind the other, each 2 cm from the last."""
    axes = ("0 0 1", "0 1 0", "1 0 0")
    parts = [
        _joint(f"joint_{n}", f"link_{n - 1}", f"link_{n}", "0.02 0 0", axes[n % 3])
        for n in range(1, count + 1)
    ]
    return _robot("chain", "link_0", parts, size="0.015 0.01 0.01")


def long_names() -> str:
    """A joint with a name of 56 letters, and a sliding joint."""
    slide = _joint(SLIDE, "base", "carriage", "0 0 0.1", "1 0 0", "prismatic", 0.0, 0.5)
    turn = _joint(LONG_NAME, "carriage", "arm", "0 0 0.1", "0 1 0")
    return _robot("gantry", "base", [slide, turn])


def arm(folder: Path) -> str:
    """Four turning joints one above the other; each link is a mesh, a cube."""
    mesh = folder / "cube.stl"
    mesh.write_bytes(_cube(0.1))
    pairs = pairwise(ARM_LINKS)
    parts = [_joint(f"{b}_joint", a, b, "0 0 0.3", "0 1 0") for a, b in pairs]
    shape = f'<mesh filename="file://{mesh}"/>'
    return _robot("arm", ARM_LINKS[0], parts, shape=shape)


def _cube(edge: float) -> bytes:
    """A cube about the origin, as a binary STL file."""
    triangles: list[bytes] = []
    for axis, sign in product(range(3), (-1, 1)):
        for turn in (0, 2):
            corners = [(-1, -1), (1, -1), (1, 1), (-1, 1)]
            flat = [corners[0], corners[1 + turn // 2], corners[2 + turn // 2]]
            points = [[0.0] * 3 for _ in flat]
            for point, (u, v) in zip(points, flat[::sign], strict=True):
                point[axis] = sign * edge / 2
                point[(axis + 1) % 3], point[(axis + 2) % 3] = (
                    u * edge / 2,
                    v * edge / 2,
                )
            numbers = [0.0] * 3 + [value for point in points for value in point]
            triangles.append(struct.pack("<12fH", *numbers, 0))
    return bytes(80) + struct.pack("<I", len(triangles)) + b"".join(triangles)


def _humanoid() -> Iterator[tuple[str, str]]:
    spine = ("torso_yaw", "torso_pitch", "head_yaw", "head_pitch")
    above = "pelvis"
    for name in spine:
        yield _joint(f"{name}_joint", above, name, "0 0 0.15", "0 0 1")
        above = name
    for side, y in (("left", 0.2), ("right", -0.2)):
        for at, name in enumerate(_SIDE):
            first = name in ("shoulder_pitch", "hip_yaw")
            if first:
                above = "torso_pitch" if at == 0 else "pelvis"
            kind = "prismatic" if name == "gripper" else "revolute"
            place = f"0 {y} 0" if first else "0 0 -0.1"
            least, most = (0.0, 0.05) if kind == "prismatic" else (-1.5, 1.5)
            link = f"{side}_{name}"
            yield _joint(
                f"{link}_joint", above, link, place, "0 1 0", kind, least, most
            )
            above = link


def _joint(
    name: str,
    parent: str,
    child: str,
    xyz: str,
    axis: str,
    kind: str = "revolute",
    least: float = -1.5,
    most: float = 1.5,
) -> tuple[str, str]:
    """The name of the child, and the joint."""
    return child, (
        f'<joint name="{name}" type="{kind}"><parent link="{parent}"/>'
        f'<child link="{child}"/><origin xyz="{xyz}"/><axis xyz="{axis}"/>'
        f'<limit lower="{least}" upper="{most}" effort="1" velocity="1"/></joint>'
    )


def _robot(
    name: str,
    root: str,
    parts: list[tuple[str, str]],
    size: str = "0.06 0.06 0.08",
    shape: str = "",
) -> str:
    links = [root, *(child for child, _ in parts)]
    shape = shape or f'<box size="{size}"/>'
    visual = f"<visual><geometry>{shape}</geometry></visual>"
    return (
        f'<robot name="{name}">'
        + "".join(f'<link name="{link}">{visual}</link>' for link in links)
        + "".join(joint for _, joint in parts)
        + "</robot>"
    )
