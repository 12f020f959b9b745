"""One reading per file."""

from __future__ import annotations

import os
import threading
from collections.abc import Callable
from pathlib import Path

import pytest

from sambot_viz.meshes.cache import MeshStore
from sambot_viz.meshes.mesh import Mesh, MeshError

Write = Callable[..., Path]

OBJ = "mtllib a.mtl\nusemtl a\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nf 1/1 2/1 3/1\n"


def later(path: Path) -> None:
    """Pretend that the file was saved a second after it was."""
    stat = path.stat()
    os.utime(path, ns=(stat.st_atime_ns, stat.st_mtime_ns + 10**9))


def test_a_file_is_read_once(write: Write) -> None:
    write("a.mtl", "newmtl a\nKd 1 0 0\n")
    path = write("a.obj", OBJ)
    store = MeshStore()
    assert store.get(path) is store.get(path)


def test_a_saved_file_and_a_saved_material_are_read_again(write: Write) -> None:
    library = write("a.mtl", "newmtl a\nKd 1 0 0\n")
    path = write("a.obj", OBJ)
    store = MeshStore()
    first = store.get(path)
    write("a.mtl", "newmtl a\nKd 0 1 0\n")
    later(library)
    second = store.get(path)
    assert second.parts[0].rgba == (0, 1, 0, 1)
    later(path)
    assert store.get(path) is not second and first is not second


def test_a_broken_file_is_tried_again_only_when_it_changes(write: Write) -> None:
    path = write("a.stl", b"broken")
    store = MeshStore()
    for _ in range(2):
        with pytest.raises(MeshError, match="only 6 bytes"):
            store.get(path)
    path.unlink()
    with pytest.raises(MeshError, match="no such file"):
        store.get(path)
    write("a.mtl", "")
    path.write_text("")
    with pytest.raises(MeshError, match="the file is empty"):
        store.get(path)


def test_an_image_is_shared_among_meshes(
    write: Write, png: Callable[..., bytes]
) -> None:
    write("a.png", png())
    write("a.mtl", "newmtl a\nmap_Kd a.png\n")
    store = MeshStore()
    first = store.get(write("a.obj", OBJ)).parts[0].texture
    second = store.get(write("b.obj", OBJ)).parts[0].texture
    assert first is not None and first is second
    assert store.texture(write("c.png", png())) is first


def test_threads_that_want_the_same_file_get_the_same_mesh(write: Write) -> None:
    write("a.mtl", "newmtl a\nKd 1 0 0\n")
    path = write("a.obj", OBJ)
    store = MeshStore()
    found: list[Mesh] = []
    threads = [
        threading.Thread(target=lambda: found.append(store.get(path))) for _ in range(8)
    ]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(found) == 8 and len({id(mesh) for mesh in found}) == 1


def test_the_limits_of_a_store_count(write: Write, png: Callable[..., bytes]) -> None:
    store = MeshStore(longest_side=2, largest=10)
    assert store.texture(write("a.png", png())).width == 2
    with pytest.raises(MeshError, match="more than"):
        store.get(write("a.obj", OBJ))
