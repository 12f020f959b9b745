"""A glTF file as JSON and bytes: its own chunk, data URIs, files beside it."""

from __future__ import annotations

import base64
import binascii
import json
import struct
from collections.abc import Iterator
from typing import Any, cast
from urllib.parse import unquote, unquote_to_bytes

from sambot_viz.meshes.formats.gltf_json import Broken, Json, entry, whole
from sambot_viz.meshes.named_files import NamedFileError
from sambot_viz.meshes.source import MeshSource

_LARGEST = 500 * 2**20
"""Buffers and images above this size [bytes] are refused."""


class GltfFile:
    """The JSON of a .gltf or .glb file, and the bytes that it names.

    Attributes:
        document: the JSON.
        source: the file.

    Raises:
        Broken: cut off, older than 2.0, or its JSON cannot be read.
    """

    def __init__(self, source: MeshSource) -> None:
        self.source = source
        self.document, self._binary = _split(source.data)
        self._buffers: dict[int, bytes] = {}

    def view(self, number: object) -> memoryview:
        """The bytes of a buffer view, not copied.

        Raises:
            Broken: they are not there.
        """
        view = entry(self.document, "bufferViews", number)
        data = self._buffer(whole(view, "buffer"))
        start = whole(view, "byteOffset", 0)
        end = start + whole(view, "byteLength")
        if end > len(data):
            raise Broken(f"a buffer view ends at byte {end} of {len(data)}")
        return memoryview(data)[start:end]

    def image(self, number: object) -> bytes:
        """The original bytes of an image, which trimesh would decode.

        Raises:
            Broken: there are none, or they may not be used.
        """
        image = entry(self.document, "images", number)
        if "uri" in image:
            return self._uri(image["uri"])
        return bytes(self.view(image.get("bufferView")))

    def _buffer(self, number: int) -> bytes:
        if number not in self._buffers:
            uri: Any = entry(self.document, "buffers", number).get("uri")
            if uri is None and self._binary is None:
                raise Broken("the binary part of the file with its numbers is missing")
            data = self._binary or b"" if uri is None else self._uri(uri)
            self._buffers[number] = data
        return self._buffers[number]

    def _uri(self, uri: object) -> bytes:
        text = str(uri)
        if text.startswith("data:"):
            head, _, body = text.partition(",")
            if not head.endswith(";base64"):
                return unquote_to_bytes(body)
            try:
                return base64.b64decode(unquote(body))
            except (binascii.Error, ValueError) as error:
                raise Broken("a data URI is not valid base64") from error
        try:
            return self.source.files.read(text, _LARGEST)
        except NamedFileError as error:
            raise Broken(f"'{text[:80]}': {error}") from error


def _split(data: bytes) -> tuple[Json, bytes | None]:
    """The JSON of a file and the binary chunk of a GLB."""
    binary: bytes | None = None
    text = data
    if data[:4] == b"glTF":
        if len(data) < 20:
            raise Broken(f"it has only {len(data)} bytes")
        version, total = struct.unpack_from("<II", data, 4)
        if version != 2:
            raise Broken(f"it is of version {version}, and only 2 can be read")
        if total > len(data):
            raise Broken(f"it announces {total} bytes but has {len(data)}")
        chunks = dict(reversed(list(_chunks(data[12:total]))))
        text = chunks.get(b"JSON", b"")
        binary = chunks.get(b"BIN\0")
    try:
        document: object = json.loads(text)
    except (ValueError, RecursionError) as error:
        raise Broken(f"its JSON cannot be read ({error})") from error
    if not isinstance(document, dict):
        raise Broken("its JSON is not an object")
    return cast(Json, document), binary


def _chunks(data: bytes) -> Iterator[tuple[bytes, bytes]]:
    start = 0
    while start + 8 <= len(data):
        (length,) = struct.unpack_from("<I", data, start)
        if start + 8 + length > len(data):
            raise Broken("a chunk is longer than the file")
        yield data[start + 4 : start + 8], data[start + 8 : start + 8 + length]
        start += 8 + length + -length % 4
