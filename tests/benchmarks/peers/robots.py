"""The robots that all viewers show, as plain URDF with its meshes beside it."""

from __future__ import annotations

import struct
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

import numpy as np

CYAN, MAGENTA = (0, 1, 1), (1, 0, 1)
INERTIAL = (
    '<inertial><mass value="1"/><inertia ixx="0.01" iyy="0.01" izz="0.01" '
    'ixy="0" ixz="0" iyz="0"/></inertial>'
)


@dataclass(frozen=True, slots=True)
class Model:
    """A robot.

    Attributes:
        name: for the table.
        path: of its URDF.
        colour: what most of it is painted with, each of red, green, blue 0 or 1.
        config: that it is shown with, in this program; None for its own.
    """

    name: str
    path: Path
    colour: tuple[int, int, int]
    config: Path | None = None


def write(folder: Path, repository: Path) -> dict[str, Model]:
    """Write all of them into `folder`; returns them by name."""
    made = [
        _sam_bot(folder, repository),
        *(tree(folder, f"tree{joints}", joints) for joints in (50, 300)),
        _meshes(folder),
    ]
    return {model.name: model for model in made}


def _sam_bot(folder: Path, repository: Path) -> Model:
    # The chapter with masses: two of the viewers refuse links that move without one.
    source = repository / "assets" / "sam_bot_collision.urdf.xacro"
    command = [sys.executable, "-m", "sambot_viz", "expand", str(source)]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    path = folder / "sam_bot" / "sam_bot.urdf"
    path.parent.mkdir()
    path.write_text(done.stdout, "utf-8")
    return Model("sam_bot", path, CYAN)


BOX = '<geometry><box size="0.1 0.1 0.1"/></geometry>'


def tree(folder: Path, name: str, joints: int) -> Model:
    """A tree of boxes, each the parent of three: it stays within a few metres."""
    return _tree(folder, name, joints, BOX)


def behind_one(folder: Path, links: int) -> Model:
    """So many links behind one joint that moves, all of them held by fixed joints."""
    return _tree(folder, f"behind{links}", links, BOX, moving=1)


def _meshes(folder: Path) -> Model:
    """Twelve links of 20,000 triangles each, in binary STL."""
    path = folder / "meshes12" / "knob.stl"
    path.parent.mkdir()
    path.write_bytes(_knob(100))
    shape = '<geometry><mesh filename="knob.stl"/></geometry>'
    return _tree(folder, "meshes12", 12, shape)


def _tree(
    folder: Path, name: str, joints: int, shape: str, moving: int = 10_000
) -> Model:
    paint = '<material name="paint"><color rgba="1 0 1 1"/></material>'
    links = "".join(
        f'<link name="l{i}"><visual>{shape}{paint}</visual>{INERTIAL}</link>\n'
        for i in range(joints + 1)
    )
    held = "".join(
        f'<joint name="j{i}" type="{"revolute" if i <= moving else "fixed"}">'
        f'<parent link="l{min(i - 1, 1) if moving == 1 else (i - 1) // 3}"/>'
        f'<child link="l{i}"/><origin xyz="0.2 {0.15 * ((i - 1) % 3 - 1)} 0.1" '
        'rpy="0.1 0 0"/><axis xyz="0 0 1"/>'
        '<limit lower="-3" upper="3" effort="1" velocity="1"/></joint>\n'
        for i in range(1, joints + 1)
    )
    path = folder / name / f"{name}.urdf"
    path.parent.mkdir(exist_ok=True)
    path.write_text(f'<robot name="{name}">\n{links}{held}</robot>\n', "utf-8")
    return Model(name, path, MAGENTA)


def _knob(cells: int) -> bytes:
    """A closed wavy surface of 2 * cells² triangles, as binary STL [m]."""
    u, v = np.meshgrid(
        np.linspace(0, 2 * np.pi, cells + 1), np.linspace(0, np.pi, cells + 1)
    )
    radius = 0.05 + 0.005 * np.sin(6 * u) * np.sin(5 * v)
    around = np.stack([np.cos(u) * np.sin(v), np.sin(u) * np.sin(v), np.cos(v)], -1)
    at = (radius[..., None] * around).astype(np.float32)
    a, b, c, d = at[:-1, :-1], at[1:, :-1], at[1:, 1:], at[:-1, 1:]
    corners = np.concatenate([np.stack([a, b, c], -2), np.stack([a, c, d], -2)])
    corners = corners.reshape(-1, 3, 3)
    kind = [("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("more", "<u2")]
    table = np.zeros(len(corners), np.dtype(kind))
    table["corners"] = corners
    return bytes(80) + struct.pack("<I", len(corners)) + table.tobytes()
