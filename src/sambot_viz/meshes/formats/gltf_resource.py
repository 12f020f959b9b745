"""The bytes a glTF file refers to: its own chunk, data URIs, files beside it."""

from __future__ import annotations

import base64
import binascii
from typing import Any
from urllib.parse import unquote, unquote_to_bytes

from sambot_viz.meshes.formats.gltf_json import Broken, Json, entry
from sambot_viz.meshes.named_files import NamedFileError
from sambot_viz.meshes.source import MeshSource

_LARGEST = 500 * 2**20
"""Buffers and images above this size [bytes] are refused."""


class Resources:
    """Buffers by number and URIs, each read once."""

    def __init__(
        self, document: Json, binary: bytes | None, source: MeshSource
    ) -> None:
        self.document = document
        self.binary = binary
        self.source = source
        self._buffers: dict[int, bytes] = {}

    def buffer(self, number: int) -> bytes:
        """The bytes of a buffer.

        Raises:
            Broken: they are not there.
        """
        if number not in self._buffers:
            uri: Any = entry(self.document, "buffers", number).get("uri")
            if uri is None and self.binary is None:
                raise Broken("the binary part of the file with its numbers is missing")
            self._buffers[number] = self.binary or b"" if uri is None else self.uri(uri)
        return self._buffers[number]

    def uri(self, uri: object) -> bytes:
        """The bytes behind a data URI or a file name.

        Raises:
            Broken: there are none, or they may not be used.
        """
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
