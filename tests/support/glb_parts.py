"""What is in a GLB file that a display draws."""

from __future__ import annotations

import json
import struct
from typing import Any

import numpy as np


def document_of(glb: bytes) -> dict[str, Any]:
    """The document of a GLB file."""
    return json.loads(glb[20 : 20 + struct.unpack_from("<I", glb, 12)[0]])


def numbers_of(glb: bytes, attribute: str) -> np.ndarray[Any, Any]:
    """An attribute of the vertices of a GLB file, or its "indices"."""
    document = document_of(glb)
    primitive = document["meshes"][0]["primitives"][0]
    all_of_them = {"indices": primitive.get("indices"), **primitive["attributes"]}
    accessor = document["accessors"][all_of_them[attribute]]
    view = document["bufferViews"][accessor["bufferView"]]
    kind = {5126: "<f4", 5125: "<u4", 5121: "u1"}[accessor["componentType"]]
    start = 28 + struct.unpack_from("<I", glb, 12)[0] + view["byteOffset"]
    data = np.frombuffer(glb[start : start + view["byteLength"]], kind)
    return data.reshape(accessor["count"], -1)
