"""A robot with 50 MB of meshes, and a server of viser alone with as much."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import numpy as np

MESHES = 10
TRIANGLES = 100_000
"""Of each mesh; 50 bytes for each in an STL file."""


def write_robot(folder: Path) -> Path:
    """Write a robot of ten links with a mesh of 5 MB each; returns its file."""
    links: list[str] = []
    for number in range(MESHES):
        (folder / f"part_{number}.stl").write_bytes(stl(number))
        links.append(
            f'<link name="part_{number}"><visual><geometry>'
            f'<mesh filename="part_{number}.stl"/></geometry></visual></link>'
        )
        if number:
            links.append(
                f'<joint name="joint_{number}" type="continuous">'
                f'<parent link="part_0"/><child link="part_{number}"/>'
                '<axis xyz="0 1 0"/></joint>'
            )
    path = folder / "large.urdf"
    path.write_text(f'<robot name="large">{"".join(links)}</robot>', "utf-8")
    return path


def stl(seed: int) -> bytes:
    """A binary STL file of triangles anywhere."""
    kind = [("normal", "<f4", 3), ("corners", "<f4", 9), ("attribute", "<u2")]
    facets = np.zeros(TRIANGLES, np.dtype(kind))
    facets["normal"][:, 2] = 1.0
    facets["corners"] = np.random.default_rng(seed).random((TRIANGLES, 9))
    return bytes(80) + TRIANGLES.to_bytes(4, "little") + facets.tobytes()


def serve_viser() -> None:
    """Show as much as the robot has with viser alone, and print the address."""
    import rich
    import viser

    rich.get_console().quiet = True
    server = viser.ViserServer(host="127.0.0.1", port=0, verbose=False)
    for number in range(MESHES):
        corners = np.random.default_rng(number).random((TRIANGLES * 3, 3), np.float32)
        faces: Any = np.arange(TRIANGLES * 3, dtype=np.uint32)
        server.scene.add_mesh_simple(f"/part_{number}", corners, faces.reshape(-1, 3))
    print(f"http://127.0.0.1:{server.get_port()}", flush=True)
    sys.stdin.read()


if __name__ == "__main__":
    serve_viser()
