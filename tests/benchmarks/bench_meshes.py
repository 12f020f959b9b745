"""How long meshes take, against trimesh alone and against the path of ViserUrdf.

Run with ``pytest -s tests/benchmarks/bench_meshes.py``; times are CPU time.
"""

from __future__ import annotations

import io
import subprocess
import sys
import time
import warnings
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from sambot_viz.meshes.asset import Asset
from sambot_viz.meshes.cache import MeshCache
from sambot_viz.meshes.glb import to_glb
from sambot_viz.meshes.mesh import Mesh
from sambot_viz.meshes.read_mesh import read_mesh

pytestmark = pytest.mark.benchmark

ENDINGS = {".stl", ".dae", ".obj", ".glb", ".gltf", ".ply"}


def seconds(run: Callable[[], object], rounds: int = 3) -> float:
    """The best CPU time of a few rounds [s]."""
    best = float("inf")
    for _ in range(rounds):
        start = time.process_time()
        run()
        best = min(best, time.process_time() - start)
    return best


@pytest.mark.filterwarnings("ignore")
def test_real_meshes_are_read_in_1_3_times_the_time_of_trimesh_alone(
    shared: Path,
) -> None:
    import trimesh

    ours: dict[str, float] = {}
    theirs: dict[str, float] = {}
    for path in sorted((shared / "data" / "robots").rglob("*")):
        kind = path.suffix.lower()
        if kind not in ENDINGS:
            continue
        try:
            reference = seconds(lambda path=path: trimesh.load_scene(path))
        except Exception:  # What trimesh cannot read gives no figure to compare.
            continue
        theirs[kind] = theirs.get(kind, 0) + reference
        ours[kind] = ours.get(kind, 0) + seconds(lambda path=path: read_mesh(path))
    for kind, time_of_trimesh in theirs.items():
        ratio = ours[kind] / time_of_trimesh
        print(
            f"{kind}: {ours[kind]:.3f} s, trimesh {time_of_trimesh:.3f} s, {ratio:.2f}"
        )
    assert sum(ours.values()) < 1.3 * sum(theirs.values())


@pytest.fixture
def textured_robot(tmp_path: Path) -> list[Path]:
    """Six OBJ meshes that share three photographs of 2048 x 2048 pixels."""
    import trimesh
    from PIL import Image

    noise = np.random.default_rng(1)
    for number in range(3):
        coarse = noise.integers(0, 256, (256, 256, 3), dtype=np.uint8)
        image = Image.fromarray(coarse).resize((2048, 2048), Image.Resampling.BICUBIC)
        image.save(tmp_path / f"skin{number}.png")
        (tmp_path / f"skin{number}.mtl").write_text(
            f"newmtl m\nKd 1 1 1\nmap_Kd skin{number}.png\n"
        )
    ball = trimesh.creation.icosphere(subdivisions=4)
    lines = [f"v {x} {y} {z}" for x, y, z in ball.vertices]
    lines += [f"vt {0.5 + x / 2} {0.5 + y / 2}" for x, y, _ in ball.vertices]
    lines += [f"f {a}/{a} {b}/{b} {c}/{c}" for a, b, c in ball.faces + 1]
    paths: list[Path] = []
    for number in range(6):
        path = tmp_path / f"link{number}.obj"
        head = f"mtllib skin{number % 3}.mtl\nusemtl m\n"
        path.write_text(head + "\n".join(lines) + "\n")
        paths.append(path)
    return paths


def test_textured_robots_are_ready_three_times_sooner_than_with_viserurdf(
    textured_robot: list[Path],
) -> None:
    import trimesh

    def with_viserurdf() -> int:
        size = 0
        for path in textured_robot:
            for mesh in trimesh.load_scene(path).geometry.values():
                out = io.BytesIO()
                mesh.export(out, file_type="glb")
                size += len(out.getvalue())
        return size

    def ours() -> int:
        cache = MeshCache()
        meshes = [cache.read(Asset("mesh", path)) for path in textured_robot]
        parts = (p for mesh in meshes if isinstance(mesh, Mesh) for p in mesh.parts)
        return sum(len(to_glb(part)) for part in parts)

    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        theirs_s = seconds(with_viserurdf, 1)
        ours_s = seconds(ours, 2)
        print(
            f"textured robot: {ours_s:.2f} s, {ours() / 2**20:.1f} MB; as ViserUrdf: "
            f"{theirs_s:.2f} s, {with_viserurdf() / 2**20:.1f} MB"
        )
    assert 3 * ours_s < theirs_s


def test_a_large_stl_takes_less_than_half_a_second(tmp_path: Path) -> None:
    count = 200_000
    facets = np.zeros(count, dtype=[("n", "<f4", 3), ("v", "<f4", 9), ("a", "<u2")])
    facets["v"] = np.random.default_rng(1).random((count, 9))
    path = tmp_path / "large.stl"
    path.write_bytes(b"\0" * 80 + np.uint32(count).tobytes() + facets.tobytes())
    taken = seconds(lambda: read_mesh(path))
    print(f"binary STL of {count} triangles: {taken:.3f} s")
    assert taken < 0.5


def test_the_first_stl_costs_a_tenth_of_what_importing_trimesh_costs(
    tmp_path: Path,
) -> None:
    path = tmp_path / "a.stl"
    path.write_bytes(b"\0" * 80 + np.uint32(1).tobytes() + b"\0" * 50)
    work = {
        "a first STL": f"read_mesh(Path({str(path)!r}))",
        "import trimesh": "import trimesh; from trimesh.exchange import stl",
    }
    cpu: dict[str, float] = {}
    for name, line in work.items():
        code = (
            "import time; from pathlib import Path\n"
            "from sambot_viz.meshes.read_mesh import read_mesh\n"
            "status = Path('/proc/self/statm')\n"
            "size = lambda: int(status.read_text().split()[1]) / 256\n"
            f"start, before = time.process_time(), size()\ntry: {line}\n"
            "except Exception: pass\n"
            "print(time.process_time() - start, size() - before)"
        )
        run = subprocess.run(
            [sys.executable, "-c", code], capture_output=True, text=True, check=True
        )
        taken, megabytes = map(float, run.stdout.split())
        cpu[name] = taken
        print(f"{name}: {taken:.3f} s, {megabytes:.1f} MB")
    assert 10 * cpu["a first STL"] < cpu["import trimesh"]


def test_a_mesh_asked_for_again_costs_next_to_nothing(tmp_path: Path) -> None:
    path = tmp_path / "a.obj"
    path.write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    cache, asset = MeshCache(), Asset("mesh", path)
    cache.read(asset)
    taken = seconds(lambda: [cache.read(asset) for _ in range(1000)]) / 1000
    print(f"a known mesh: {taken * 1e6:.0f} µs")
    assert taken < 1e-4
