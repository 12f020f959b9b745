"""Nodes that the page draws in special ways.

viser has neither ribbons nor palettes nor coloured text. It does load GLB files, whose
`extras` reach the page's script: `drawAs` selects the way in which page/view/drawn.js
draws the file's vertices.
"""

from __future__ import annotations

import base64
import hashlib
from collections.abc import Callable, Mapping, Sequence
from typing import Any, cast

import numpy as np
import numpy.typing as npt
import viser

from sambot_viz.displays.scene.frame_nodes import placed
from sambot_viz.displays.scene.posed_node import PosedNode
from sambot_viz.geometry import IDENTITY, ORIGIN, Vector3, Wxyz
from sambot_viz.meshes.glb import glb_file
from sambot_viz.viser_private import send_file

Array = npt.NDArray[Any]
POINTS, LINES, LINE_STRIP, TRIANGLES = 0, 1, 3, 4
_UINT8, _UINT32, _FLOAT = 5121, 5125, 5126
ONE_PIXEL = base64.b64decode(
    "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAAAAAA6fptVAAAACklEQVR42mNg"
    "AAAAAgAB5Sfe/AAAAABJRU5ErkJggg=="
)
"""A PNG file: with it a part has a texture, whose picture the page makes."""
WHITE: Array = np.full(4, 255, np.uint8)
_LONG = 65_536
"""Files up to this size are sent uncompressed [bytes]."""
_TOGETHER = 16
_NO_LIMITS = {"min": [-1e9] * 3, "max": [1e9] * 3}
"""A file has to have some."""
_SHAPES = {1: "SCALAR", 2: "VEC2", 3: "VEC3", 4: "VEC4"}


class GlbNode(PosedNode[viser.GlbHandle]):
    """One node of viser made from a GLB file.

    Args:
        scene: where to draw.
        name: of the node; it is drawn in the frame of the node above.
    """

    def __init__(self, scene: viser.SceneApi, name: str) -> None:
        super().__init__(scene, name)
        self._digest = b""

    def show(
        self,
        content: Sequence[object],
        make: Callable[[], bytes],
        wxyz: Wxyz = IDENTITY,
        position: Vector3 = ORIGIN,
    ) -> None:
        """Send the file if its content has changed, and the pose if that has.

        Args:
            content: everything that the file depends on: arrays, and values that differ
                in their `repr`.
            make: returns the file.
            wxyz: rotation in the frame of the parent node.
            position: position there [m].
        """
        digest = digest_of(content)
        self.send(digest != self._digest, make, wxyz, position)
        self._digest = digest

    def send(
        self,
        is_new: bool,
        make: Callable[[], bytes],
        wxyz: Wxyz = IDENTITY,
        position: Vector3 = ORIGIN,
    ) -> None:
        """Send the file if it is new or nothing was sent, and the pose if it is new.

        Args:
            is_new: whether the file has another content.
            make: returns the file.
            wxyz: rotation in the frame of the node above.
            position: there [m].
        """
        pose = placed(wxyz, position)
        if self._handle is None or self.is_gone:
            handle = self._scene.add_glb(
                self._name,
                _as_sent(make()),
                cast_shadow=False,
                receive_shadow=False,
                wxyz=pose[0],
                position=pose[1],
            )
            self.has_made(handle, pose)
        else:
            if is_new:
                send_file(self._handle, _as_sent(make()))
            self.move(pose)


def _as_sent(file: bytes) -> bytes:
    """Return a long file as an array: viser compresses bytes, and arrays it does not.

    To compress floats takes longer than all else, for a fifth of their length.
    """
    return file if len(file) < _LONG else cast(bytes, np.frombuffer(file, np.uint8))


def digest_of(content: Sequence[object]) -> bytes:
    """Return a digest of arrays and of the `repr` of other values."""
    digest = hashlib.blake2b(digest_size=16)
    for part in content:
        if isinstance(part, np.ndarray):
            array = cast("Array", part)
            digest.update(repr((array.shape, str(array.dtype))).encode())
            digest.update(array.tobytes())
        else:
            digest.update(repr(part).encode())
    return digest.digest()


def single(values: npt.ArrayLike) -> npt.NDArray[np.float32]:
    """Return numbers with 32 bits, as browsers have them; too large ones become inf.

    Those that have them already are not copied.
    """
    with np.errstate(over="ignore", invalid="ignore"):
        return np.asarray(values).astype(np.float32, copy=False)


def rgba_rows(color: npt.ArrayLike, alpha: float, count: int) -> npt.NDArray[np.uint8]:
    """Return a colour for each of some vertices, (count, 4).

    Args:
        color: one colour (3,), or colours with alpha (count, 4); 0 to 255.
        alpha: 0 to 1; multiplies the alpha of the colours.
        count: of vertices.
    """
    given = np.asarray(color, np.float64)
    rows = np.full((count if given.ndim > 1 else 1, 4), 255.0)
    rows[:, : given.shape[-1]] = given
    rows[:, 3] *= alpha
    each = np.round(rows).clip(0, 255).astype(np.uint8)
    return each if given.ndim > 1 else np.repeat(each, count, axis=0)


def drawn_glb(
    draw_as: str,
    attributes: Mapping[str, Array],
    *,
    extras: Mapping[str, object] | None = None,
    mode: int = TRIANGLES,
    indices: Array | None = None,
    blended: bool = False,
    color: Array = WHITE,
    image: bytes | None = None,
    has_bounds: bool = True,
) -> bytes:
    """Return a GLB file with one unlit part that is seen from both sides.

    Args:
        draw_as: the way to draw it, a name of page/view/drawn.js.
        attributes: glTF's name → (N, 1 to 4) float32 or uint8, 0 to 255 for 0 to 1;
            none for a file that only carries `extras`.
        extras: further values for the page.
        mode: `POINTS`, `LINES`, `LINE_STRIP` or `TRIANGLES`.
        indices: of the corners of the triangles, uint32.
        blended: whether alpha is used; then it writes no depth.
        color: of all vertices, (4,) uint8, which those in the attributes multiply.
        image: a PNG file, the texture.
        has_bounds: whether the page uses the bounds of the positions to skip the node
            when it is out of sight.
    """
    body = _Body()
    said = {"drawAs": draw_as, **(extras or {})}
    document: dict[str, Any] = {
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
    }
    if not attributes:
        return glb_file({**document, "nodes": [{"extras": said}]}, b"")
    primitive: dict[str, Any] = {
        "attributes": {name: body.add(rows) for name, rows in attributes.items()},
        "mode": mode,
        "material": 0,
    }
    position, first = attributes["POSITION"], primitive["attributes"]["POSITION"]
    body.accessors[first] |= _limits(position) if has_bounds else _NO_LIMITS
    if indices is not None:
        primitive["indices"] = body.add(np.reshape(indices.astype("<u4"), (-1, 1)))
    surface: dict[str, Any] = {"baseColorFactor": (color / 255).tolist()}
    if image is not None:
        surface["baseColorTexture"] = {"index": 0}
        nearest, clamped = 9728, 33071
        document |= {
            "images": [{"bufferView": body.view(image), "mimeType": "image/png"}],
            "samplers": [
                {
                    "magFilter": nearest,
                    "minFilter": nearest,
                    "wrapS": clamped,
                    "wrapT": clamped,
                }
            ],
            "textures": [{"source": 0, "sampler": 0}],
        }
    material: dict[str, Any] = {
        "pbrMetallicRoughness": surface,
        "extensions": {"KHR_materials_unlit": {}},
        "doubleSided": True,
        "alphaMode": "BLEND" if blended else "OPAQUE",
    }
    document |= {
        "extensionsUsed": ["KHR_materials_unlit"],
        "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [primitive], "extras": said}],
        "materials": [material],
        "accessors": body.accessors,
        "bufferViews": body.views,
        "buffers": [{"byteLength": body.length}],
    }
    return glb_file(document, *body.parts)


def _limits(rows: Array) -> dict[str, list[float]]:
    """Return the least and the greatest value of each column, as glTF asks for."""
    width = rows.shape[1]
    whole = len(rows) // _TOGETHER * _TOGETHER
    found: dict[str, list[float]] = {}
    for name, reduce in (("min", np.min), ("max", np.max)):
        # Many rows side by side: along narrow ones it takes ten times as long.
        parts = [rows[whole:]]
        if whole:
            wide = reduce(np.reshape(rows[:whole], (-1, width * _TOGETHER)), axis=0)
            parts.append(np.reshape(wide, (_TOGETHER, width)))
        found[name] = reduce(np.concatenate(parts), axis=0).tolist()
    return found


def _bytes(rows: Array) -> memoryview:
    """Return the bytes of an array, without a copy if they are in one piece."""
    octets: npt.NDArray[np.uint8] = cast(Any, np.ravel(rows)).view(np.uint8)
    return octets.data


class _Body:
    """The one buffer of a file, its views and accessors."""

    def __init__(self) -> None:
        self.parts: list[bytes | memoryview] = []
        self.length = 0
        self.views: list[dict[str, int]] = []
        self.accessors: list[dict[str, Any]] = []

    def view(self, data: bytes | memoryview) -> int:
        """Append bytes, padded to four."""
        self.views.append(
            {"buffer": 0, "byteOffset": self.length, "byteLength": len(data)}
        )
        padding = b"\0" * (-len(data) % 4)
        self.parts += [data, padding]
        self.length += len(data) + len(padding)
        return len(self.views) - 1

    def add(self, rows: Array) -> int:
        """Append an array."""
        bytewise = rows.dtype == np.uint8
        index = rows.dtype == np.uint32
        data = rows if bytewise or index else rows.astype("<f4")
        self.accessors.append(
            {
                "bufferView": self.view(_bytes(data)),
                "componentType": _UINT8 if bytewise else _UINT32 if index else _FLOAT,
                "normalized": bytewise,
                "count": len(rows),
                "type": _SHAPES[rows.shape[1]],
            }
        )
        return len(self.accessors) - 1
