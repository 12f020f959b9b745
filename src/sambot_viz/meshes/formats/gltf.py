"""glTF 2.0 and GLB: read by trimesh, shown as in RViz.

Coordinates are taken as they are (y stays y), nodes are baked in, colours are base
colour factor plus emission, times base colour texture; vertex colours, skins and
morphs are ignored.

trimesh trusts the counts of a file, decodes every image, says nothing when one is
missing, and knows neither fans nor sparse or normalized numbers. So it is given a
checked copy of what is drawn, and looks are read here.
"""

from __future__ import annotations

import io
import json
from collections.abc import Iterator
from typing import Any, cast

import numpy as np

from sambot_viz.geometry import Matrix
from sambot_viz.meshes.assembly.assemble import Submesh
from sambot_viz.meshes.assembly.placing import placed
from sambot_viz.meshes.formats.gltf_copy import GltfCopy
from sambot_viz.meshes.formats.gltf_file import GltfFile
from sambot_viz.meshes.formats.gltf_json import Broken, Json, listing
from sambot_viz.meshes.formats.trimesh_call import TrimeshError, call_trimesh
from sambot_viz.meshes.mesh import mesh_error
from sambot_viz.meshes.source import MeshSource

_UNREADABLE = {
    "KHR_draco_mesh_compression": "Draco",
    "EXT_meshopt_compression": "meshopt",
    "KHR_meshopt_compression": "meshopt",
}


def read_gltf(source: MeshSource) -> list[Submesh]:
    """The triangles of a .gltf or .glb file.

    Raises:
        MeshError: broken, compressed in a way that is not read, or older than 2.0.
    """
    try:
        file = GltfFile(source)
        _refuse_compression(file.document, source)
        copy = GltfCopy(file)
        if not copy.meshes:
            return []
        loaded = call_trimesh(
            "gltf",
            "load_gltf",
            io.BytesIO(json.dumps(copy.document()).encode()),
            resolver=copy.numbers.data,
            skip_materials=True,
        )
        return list(_pieces(copy, loaded))
    except (Broken, TrimeshError) as error:
        raise source.broken(f"the glTF file is broken: {error}") from error


def _refuse_compression(document: Json, source: MeshSource) -> None:
    for name in listing(document, "extensionsRequired"):
        method = _UNREADABLE.get(str(name))
        if method is not None:
            raise mesh_error(
                source.path,
                "mesh-compressed",
                f"the glTF file is compressed with {method}, which RViz and this "
                "program do not read",
                "export it again without mesh compression",
            )


def _pieces(copy: GltfCopy, loaded: dict[str, Any]) -> Iterator[Submesh]:
    """What the nodes show, in the order of the file."""
    arrays = iter(loaded["geometry"].values())
    meshes = [[each.submesh(next(arrays)) for each in mesh] for mesh in copy.meshes]
    poses: dict[str, Matrix] = {loaded["base_frame"]: np.eye(4)}
    for edge in loaded["graph"]:
        poses[edge["frame_to"]] = poses[edge["frame_from"]] @ edge["matrix"]
    for number, node in enumerate(copy.nodes):
        if "mesh" in node:
            for piece in meshes[cast(int, node["mesh"])]:
                yield placed(piece, poses[str(number)])
