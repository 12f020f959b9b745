"""One door to every mesh format."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np

from sambot_viz.files import is_lfs_pointer
from sambot_viz.meshes.assembly.assemble import MeshFindings, Submesh, assemble
from sambot_viz.meshes.mesh import Mesh, mesh_error
from sambot_viz.meshes.textures import TextureStore

LARGEST = 500 * 1024 * 1024
"""Files above this size [bytes] are refused unless somebody asks for more."""

_Reader = Callable[[bytes, MeshFindings, TextureStore], list[Submesh]]


def read_mesh(
    path: Path, *, images: TextureStore | None = None, largest: int = LARGEST
) -> Mesh:
    """Read a mesh file: STL, COLLADA, OBJ, glTF, GLB or PLY.

    Args:
        path: the file; its ending tells the format, as in RViz.
        images: where textures are kept; give the same one for meshes that may share
            them.
        largest: refuse files above this size [bytes].

    Raises:
        MeshError: missing, broken, empty, a git-LFS pointer, an unknown format, …;
            its one problem is a sentence that says so.
    """
    data = _read_bytes(path, largest)
    reader = _reader(path)
    findings = MeshFindings(path)
    try:
        # What is no number, or too large for one, is dealt with in `assemble`.
        with np.errstate(all="ignore"):
            pieces = reader(data, findings, images or TextureStore())
            return assemble(pieces, findings)
    except (MemoryError, RecursionError) as error:
        raise mesh_error(
            path, "mesh-too-large", "the mesh is too large or too deep to be read"
        ) from error


def _read_bytes(path: Path, largest: int) -> bytes:
    try:
        size = path.stat().st_size
        if not path.is_file():
            raise mesh_error(path, "mesh-missing", "this is not a file")
        if size > largest:
            raise mesh_error(
                path,
                "mesh-too-large",
                f"the mesh has {size / 2**20:.0f} MB, more than the "
                f"{largest / 2**20:.0f} MB that a browser can be expected to show",
                "reduce its triangles",
            )
        data = path.read_bytes()
    except FileNotFoundError as error:
        raise mesh_error(
            path, "mesh-missing", "there is no such file", "check name and folder"
        ) from error
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or str(error)
        raise mesh_error(
            path, "mesh-unreadable", f"the file cannot be read: {reason}"
        ) from error
    if is_lfs_pointer(data):
        raise mesh_error(
            path,
            "mesh-lfs-pointer",
            "this is a git-LFS pointer, not the mesh itself",
            "run 'git lfs pull' in its repository",
        )
    if not data:
        raise mesh_error(path, "mesh-empty", "the file is empty")
    return data


def _reader(path: Path) -> _Reader:
    """The reader for a file; each is imported when the first such file comes."""
    suffix = path.suffix.lower()
    reader = _READERS.get(suffix)
    if reader is not None:
        return reader
    raise mesh_error(
        path,
        "mesh-format-unknown",
        f"meshes of the kind '{suffix or path.name}' cannot be read",
        "convert it to one of .stl, .dae, .obj, .glb, .gltf, .ply",
    )


def _stl(data: bytes, findings: MeshFindings, images: TextureStore) -> list[Submesh]:
    from sambot_viz.meshes.formats.stl import read_stl

    return read_stl(data, findings)


def _collada(
    data: bytes, findings: MeshFindings, images: TextureStore
) -> list[Submesh]:
    from sambot_viz.meshes.formats.collada import read_collada

    return read_collada(data, findings, images)


def _obj(data: bytes, findings: MeshFindings, images: TextureStore) -> list[Submesh]:
    from sambot_viz.meshes.formats.obj import read_obj

    return read_obj(data, findings, images)


def _gltf(data: bytes, findings: MeshFindings, images: TextureStore) -> list[Submesh]:
    from sambot_viz.meshes.formats.gltf import read_gltf

    return read_gltf(data, findings, images)


def _ply(data: bytes, findings: MeshFindings, images: TextureStore) -> list[Submesh]:
    from sambot_viz.meshes.formats.ply import read_ply

    return read_ply(data, findings)


_READERS: dict[str, _Reader] = {
    ".stl": _stl,
    ".stlb": _stl,
    ".dae": _collada,
    ".obj": _obj,
    ".glb": _gltf,
    ".gltf": _gltf,
    ".ply": _ply,
}
