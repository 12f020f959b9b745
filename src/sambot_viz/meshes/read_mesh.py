"""Read a mesh file, whatever its format."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from importlib import import_module
from pathlib import Path

import numpy as np

from sambot_viz import limits
from sambot_viz.files import (
    FileTooLargeError,
    NotAFileError,
    is_below,
    is_lfs_pointer,
    read_limited,
    reason_of,
)
from sambot_viz.meshes.assembly.assemble import Submesh, assemble
from sambot_viz.meshes.content import other_content
from sambot_viz.meshes.mesh import Mesh, MeshError, mesh_error
from sambot_viz.meshes.mesh_source import MeshSource
from sambot_viz.meshes.textures import TextureStore

_Reader = Callable[[MeshSource], list[Submesh]]
_FORMATS = {
    ".stl": "stl",
    ".stlb": "stl",
    ".dae": "collada",
    ".obj": "obj",
    ".glb": "gltf",
    ".gltf": "gltf",
    ".ply": "ply",
}
"""Ending → module of `formats`, which has a function ``read_…`` of that name."""
_MAY_BE_OTHER = ("mesh-broken", "mesh-empty")
"""What readers say of a file that is of another format."""


def read_mesh(
    path: Path,
    *,
    images: TextureStore | None = None,
    largest: int | None = None,
    roots: Sequence[Path] | None = None,
) -> Mesh:
    """Read a mesh file: STL, COLLADA, OBJ, glTF, GLB or PLY.

    Args:
        path: the file; its ending gives the format, as in RViz.
        images: where textures are kept; give the same one for meshes that may share
            them.
        largest: refuse files above this size [bytes].
        roots: resolved folders that the file and all files it names must be in, as
            for a model that is not trusted; None for no limit.

    Raises:
        MeshError: missing, broken, empty, a git-LFS pointer, an unknown format, …;
            its one problem is a sentence that says so.
    """
    if roots is not None and not is_below(path, roots):
        raise mesh_error(
            path, "mesh-unreadable", "the file is outside the model's folder"
        )
    data = _read_bytes(path, largest)
    reader = _reader(path)
    source = MeshSource(path, data, images, roots)
    try:
        # Values that are not finite are dealt with in `assemble`.
        with np.errstate(all="ignore"):
            pieces = reader(source)
            if source.budget.cut_short:
                source.warn(
                    "mesh-polygons-tangled",
                    "the mesh has too many or too large polygons with inward corners "
                    "(n² + 1000 for n corners of each, together more than "
                    f"{limits.MESH_CUTTING.value:,}); some may be drawn wrongly",
                    "triangulate the mesh before exporting it",
                )
            return assemble(pieces, source)
    except (MemoryError, RecursionError) as error:
        raise mesh_error(
            path, "mesh-too-large", "the mesh is too large or too deep to be read"
        ) from error
    except MeshError as error:
        other = other_content(path, data)
        if other is None or error.problem.code not in _MAY_BE_OTHER:
            raise
        raise mesh_error(path, "mesh-other-content", *other) from error


def _read_bytes(path: Path, largest: int | None) -> bytes:
    largest = limits.MESH.value if largest is None else largest
    try:
        data = read_limited(path, largest)
    except FileNotFoundError as error:
        raise mesh_error(
            path, "mesh-missing", "there is no such file", "check name and folder"
        ) from error
    except NotAFileError as error:
        raise mesh_error(path, "mesh-missing", "this is not a file") from error
    except FileTooLargeError as error:
        raise mesh_error(
            path,
            "mesh-too-large",
            f"the mesh has more than the {largest:,} bytes that a browser can be "
            "expected to show",
            "reduce its triangles",
        ) from error
    except (OSError, ValueError) as error:
        raise mesh_error(
            path, "mesh-unreadable", f"the file cannot be read: {reason_of(error)}"
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
    """Return the reader for a file; each is imported when the first such file comes."""
    suffix = path.suffix.lower()
    name = _FORMATS.get(suffix)
    if name is not None:
        module = import_module(f"sambot_viz.meshes.formats.{name}")
        return getattr(module, f"read_{name}")
    raise mesh_error(
        path,
        "mesh-format-unknown",
        f"meshes of the kind '{suffix or path.name}' cannot be read",
        "convert it to one of .stl, .dae, .obj, .glb, .gltf, .ply",
    )
