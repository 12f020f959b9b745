"""glTF 2.0 and GLB: read by trimesh, shown as in RViz.

Coordinates are taken as they are (y stays y), nodes are baked in, colours are base
colour factor plus emission, times base colour texture; vertex colours, skins and
morphs are ignored.

trimesh gets the original bytes once all that they announce fits them. What it does not
read, it leaves out or shows as zeros without a word: such files are refused. Looks are
read here, because it opens every image of a file and knows only one uv set.
"""

from __future__ import annotations

import io
from collections import Counter
from collections.abc import Iterator
from typing import Any

import numpy as np
import numpy.typing as npt

from sambot_viz import limits
from sambot_viz.geometry import Matrix
from sambot_viz.meshes.assembly.assemble import Submesh, placed
from sambot_viz.meshes.formats.gltf_file import GltfFile, GltfMaterials, Json
from sambot_viz.meshes.formats.trimesh_call import call_trimesh
from sambot_viz.meshes.mesh import MeshError, mesh_error
from sambot_viz.meshes.mesh_source import MeshSource
from sambot_viz.meshes.named_files import LfsPointerError, NamedFileError

_TRIANGLES, _FAN = 4, 6
_READ = (0, 1, _TRIANGLES, 5)
"""The kinds that trimesh reads: points, lines, triangles and strips of them."""
_COMPRESSED = {
    "KHR_draco_mesh_compression": "Draco",
    "EXT_meshopt_compression": "meshopt",
    "KHR_meshopt_compression": "meshopt",
}


def read_gltf(source: MeshSource) -> list[Submesh]:
    """Read the triangles of a .gltf or .glb file.

    Raises:
        MeshError: broken, older than 2.0, or written in a way that is not read.
    """
    try:
        file = GltfFile(source)
        unread = _check_nodes(file) or _check_meshes(file)
        if unread is None:
            loaded = call_trimesh(
                "gltf",
                "load_glb" if file.is_glb else "load_gltf",
                io.BytesIO(file.data),
                resolver=file,
                skip_materials=True,
            )
            return list(_pieces(file, loaded))
    except (LookupError, TypeError, AttributeError, ArithmeticError) as error:
        raise source.broken(
            "the glTF file is broken: it names something that it does not have or that "
            f"is of another kind ({type(error).__name__}: {error})"
        ) from error
    except ValueError as error:
        raise source.broken(f"the glTF file is broken: {error}") from error
    except NamedFileError as error:
        raise _without_buffer(source, error) from error
    raise mesh_error(
        source.path,
        "mesh-compressed",
        f"the glTF file {unread}, which this program does not read",
        "export it again as plain triangles without mesh compression",
    )


def _without_buffer(source: MeshSource, error: NamedFileError) -> MeshError:
    """Return the error for a glTF file whose numbers are in a file that is not here."""
    return mesh_error(
        source.path,
        "mesh-buffer-missing",
        f"the glTF file needs the file {error}",
        "run 'git lfs pull' in its repository"
        if isinstance(error, LfsPointerError)
        else "put it beside the mesh, or export the mesh as one file (.glb)",
    )


def _check_nodes(file: GltfFile) -> str | None:
    """Refuse nodes that are no tree; return what of them would be lost."""
    nodes: list[Json] = file.document.get("nodes", [])
    file.source.budget.spend_nodes(len(nodes))
    if "scenes" not in file.document:
        return "has nodes but no scene" if nodes else None
    scene = file.document["scenes"][file.document.get("scene", 0)]
    parents = Counter[int](scene.get("nodes", ()))
    for node in nodes:
        parents.update(node.get("children", ()))
        if "camera" in node and ("children" in node or "mesh" in node):
            return "has a camera with parts below it"
    if max(parents.values(), default=1) > 1:
        raise ValueError("a node of it is below itself, or below two others")
    return None


def _check_meshes(file: GltfFile) -> str | None:
    """Count all triangles before memory is taken; return what would be lost of them."""
    nodes, budget = file.document.get("nodes", []), file.source.budget
    names = [str(node.get("name")) for node in nodes]
    uses = Counter[int](node["mesh"] for node in nodes if "mesh" in node)
    extensions = set(file.document.get("extensionsRequired", ()))
    for number, mesh in enumerate(file.document.get("meshes", ())):
        names += [str(mesh.get("name"))] * len(mesh["primitives"])
        # trimesh reads all meshes, drawn or not.
        times = max(1, uses.pop(number, 0))
        budget.spend_nodes(times * len(mesh["primitives"]))
        for primitive in mesh["primitives"]:
            extensions.update(primitive.get("extensions", ()))
            for name in extensions & _COMPRESSED.keys():
                return f"is compressed with {_COMPRESSED[name]}"
            accessors = _accessors(file, primitive)
            if any("sparse" in each or "bufferView" not in each for each in accessors):
                return "has sparse numbers"
            corners = accessors[-1]["count"]
            budget.spend_triangles(times * corners // 3, times * accessors[0]["count"])
            if primitive.get("mode") == _FAN:
                return "has triangle fans"
            if primitive.get("mode", _TRIANGLES) == _TRIANGLES and corners % 3:
                raise ValueError(f"a list of triangles has {corners} corners")
    if uses:
        raise IndexError(f"meshes {sorted(uses)}")
    # trimesh tries numbers behind equal names until one is free.
    if (
        sum(n > 1 for n in Counter(names).values()) * len(names)
        > limits.MESH_NAMES.value
    ):
        raise ValueError("too many of its nodes and meshes have the same names")
    return None


def _accessors(file: GltfFile, primitive: Json) -> list[Json]:
    """Return those that are drawn: positions first, corners last."""
    every, attributes = file.document["accessors"], primitive["attributes"]
    more = [k for k in attributes if k == "NORMAL" or k.startswith("TEXCOORD_")]
    found = [every[attributes[name]] for name in ("POSITION", *more)]
    found.append(every[primitive["indices"]] if "indices" in primitive else found[0])
    return found


def _pieces(file: GltfFile, loaded: dict[str, Any]) -> Iterator[Submesh]:
    """Yield what the nodes show."""
    materials = GltfMaterials(file)
    primitives = (
        primitive
        for mesh in file.document.get("meshes", ())
        for primitive in mesh["primitives"]
        if primitive.get("mode", _TRIANGLES) in _READ
    )
    pieces = {
        name: _submesh(file, primitive, arrays, materials)
        for primitive, (name, arrays) in zip(
            primitives, loaded["geometry"].items(), strict=True
        )
        if "faces" in arrays
    }
    poses: dict[str, Matrix] = {loaded["base_frame"]: np.eye(4)}
    for edge in loaded["graph"]:
        T = poses[edge["frame_to"]] = poses[edge["frame_from"]] @ edge["matrix"]
        if edge.get("geometry") in pieces:
            yield placed(pieces[edge["geometry"]], T)


def _submesh(
    file: GltfFile, primitive: Json, arrays: dict[str, Any], materials: GltfMaterials
) -> Submesh:
    """Return the triangles of one look, from what trimesh has read."""
    every, attributes = file.document["accessors"], primitive["attributes"]
    vertices = _fractions(arrays["vertices"], every[attributes["POSITION"]])
    if vertices.shape[1:] != (3,):
        raise ValueError("positions are not made of three numbers")
    normals = arrays.get("vertex_normals")
    if normals is not None and normals.shape != vertices.shape:
        normals = None
    look, uv_set = materials.look(primitive.get("material"))
    accessor = every[attributes[uv_set]] if uv_set in attributes else None
    uv = None
    if (
        look.texture is not None
        and accessor is not None
        and accessor["count"] == len(vertices)
    ):
        uv = _fractions(file.array(accessor), accessor)
        # v = 0 is the first row of the image in glTF, and the last one here.
        uv = np.column_stack([uv[:, 0], 1 - uv[:, 1]])
    return Submesh(
        vertices=vertices,
        faces=arrays["faces"].astype(np.int64),
        normals=normals,
        rgba=look.rgba,
        uv=uv,
        texture=look.texture,
    )


def _fractions(table: npt.NDArray[Any], accessor: Json) -> npt.NDArray[np.float64]:
    """Return the numbers; trimesh does not know integers that mean fractions."""
    if accessor.get("normalized") is True and table.dtype.kind in "iu":
        return np.maximum(table / np.iinfo(table.dtype).max, -1.0)
    return table.astype(np.float64)
