"""A file is read once, and again when it was saved."""

from __future__ import annotations

import gc
import os
import threading
from collections.abc import Callable
from pathlib import Path

import pytest

from sambot_viz.errors import Problem
from sambot_viz.meshes import cache as cache_module
from sambot_viz.meshes.asset import Asset
from sambot_viz.meshes.cache import Content, MeshCache
from sambot_viz.meshes.mesh import Mesh, Texture

Write = Callable[..., Path]

OBJ = "mtllib a.mtl\nusemtl a\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nf 1/1 2/1 3/1\n"
STL = (
    "solid s\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\n"
    "vertex 0 1 0\nendloop\nendfacet\nendsolid s\n"
)


def later(path: Path) -> None:
    """Pretend that the file was saved a second after it was."""
    stat = path.stat()
    os.utime(path, ns=(stat.st_atime_ns, stat.st_mtime_ns + 10**9))


def message(content: Content | None) -> str:
    """What is said about a file that cannot be drawn."""
    assert isinstance(content, Problem)
    return content.message


def texture_of(content: Content) -> Texture:
    """The texture of the first part of a mesh."""
    assert isinstance(content, Mesh) and content.parts[0].texture is not None
    return content.parts[0].texture


def test_a_file_is_read_once(write: Write) -> None:
    write("a.mtl", "newmtl a\nKd 1 0 0\n")
    cache, asset = MeshCache(), Asset("mesh", write("a.obj", OBJ))
    assert cache.known(asset) is None
    first = cache.read(asset)
    cache.forget_changed()
    assert cache.read(asset) is first and cache.known(asset) is first


def test_a_saved_file_and_a_saved_material_are_read_again(write: Write) -> None:
    library = write("a.mtl", "newmtl a\nKd 1 0 0\n")
    cache, asset = MeshCache(), Asset("mesh", write("a.obj", OBJ))
    first = cache.read(asset)
    write("a.mtl", "newmtl a\nKd 0 1 0\n")
    later(library)
    cache.forget_changed()
    assert cache.known(asset) is None
    second = cache.read(asset)
    assert isinstance(second, Mesh) and second.parts[0].rgba == (0, 1, 0, 1)
    later(asset.path)
    cache.forget_changed()
    assert cache.read(asset) is not second and first is not second


@pytest.mark.parametrize("kind", ["mesh", "texture"])
def test_a_file_that_is_missing_is_read_when_it_appears(
    write: Write, tmp_path: Path, png: Callable[..., bytes], kind: str
) -> None:
    asset = Asset("mesh" if kind == "mesh" else "texture", tmp_path / "a.stl")
    cache = MeshCache()
    assert "no such file" in message(cache.read(asset))
    cache.forget_changed()
    assert cache.known(asset) is not None
    write("a.stl", STL if kind == "mesh" else png())
    cache.forget_changed()
    assert isinstance(cache.read(asset), Mesh if kind == "mesh" else Texture)


def test_an_image_is_shared_among_meshes(
    write: Write, png: Callable[..., bytes]
) -> None:
    write("a.png", png())
    write("a.mtl", "newmtl a\nmap_Kd a.png\n")
    cache = MeshCache()
    first = cache.read(Asset("mesh", write("a.obj", OBJ)))
    second = cache.read(Asset("mesh", write("b.obj", OBJ)))
    assert texture_of(first) is texture_of(second)
    copy = Asset("texture", write("c.png", png()))
    assert cache.read(copy) is texture_of(first)


def test_what_no_shape_uses_is_forgotten_with_its_images(
    write: Write, png: Callable[..., bytes]
) -> None:
    write("a.png", png())
    write("a.mtl", "newmtl a\nmap_Kd a.png\n")
    cache, gone = MeshCache(), Asset("mesh", write("a.obj", OBJ))
    kept = Asset("mesh", write("b.stl", STL))
    mesh = cache.read(kept)
    cache.read(gone)
    gc.collect()
    before = sum(isinstance(thing, Texture) for thing in gc.get_objects())
    cache.keep_only([kept])
    gc.collect()
    after = sum(isinstance(thing, Texture) for thing in gc.get_objects())
    assert cache.known(gone) is None and cache.known(kept) is mesh
    assert after == before - 1


def test_threads_that_want_the_same_file_get_the_same_mesh(write: Write) -> None:
    write("a.mtl", "newmtl a\nKd 1 0 0\n")
    cache, asset = MeshCache(), Asset("mesh", write("a.obj", OBJ))
    found: list[Content] = []
    threads = [
        threading.Thread(target=lambda: found.append(cache.read(asset)))
        for _ in range(8)
    ]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(found) == 8 and len({id(mesh) for mesh in found}) == 1


def test_the_limits_of_a_cache_count(write: Write, png: Callable[..., bytes]) -> None:
    cache = MeshCache(longest_side=2, largest=10)
    texture = cache.read(Asset("texture", write("a.png", png())))
    assert isinstance(texture, Texture) and texture.width == 2
    assert "more than" in message(cache.read(Asset("mesh", write("a.obj", OBJ))))


def test_a_mesh_names_the_files_it_was_read_from(write: Write) -> None:
    library = write("a.mtl", "newmtl a\nKd 1 0 0\n")
    cache, asset = MeshCache(), Asset("mesh", write("a.obj", OBJ))
    assert cache.files(asset) == (asset.path,)
    cache.read(asset)
    assert set(cache.files(asset)) == {asset.path, library}


@pytest.mark.parametrize("name", ["read_mesh", "TextureStore"])
def test_an_internal_error_is_a_problem_of_that_file_only(
    write: Write, monkeypatch: pytest.MonkeyPatch, name: str
) -> None:
    def fail(*arguments: object, **options: object) -> None:
        raise ZeroDivisionError("it happens")

    if name == "read_mesh":
        monkeypatch.setattr(cache_module, name, fail)
    else:
        monkeypatch.setattr(cache_module.TextureStore, "from_file", fail)
    kind = "mesh" if name == "read_mesh" else "texture"
    said = message(MeshCache().read(Asset(kind, write("part.stl", STL))))
    assert "internal error while reading the file: ZeroDivisionError: it ha" in said


def test_a_texture_outside_the_folders_of_an_untrusted_model_is_not_read(
    write: Write, tmp_path: Path, png: Callable[..., bytes]
) -> None:
    (tmp_path / "robot").mkdir()
    asset = Asset("texture", write("a.png", png()), (tmp_path / "robot",))
    assert "outside the model's folder" in message(MeshCache().read(asset))
