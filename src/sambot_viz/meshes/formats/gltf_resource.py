"""The bytes a glTF file refers to: its own chunk, data URIs, files beside it."""

from __future__ import annotations

import base64
import binascii
from typing import Any
from urllib.parse import unquote, unquote_to_bytes

from sambot_viz.files import is_lfs_pointer
from sambot_viz.meshes.assembly.assemble import MeshFindings
from sambot_viz.meshes.formats.gltf_json import Broken, Json, entry
from sambot_viz.meshes.textures import find_beside


class Resources:
    """Buffers by number and URIs, each read once."""

    def __init__(
        self, document: Json, binary: bytes | None, findings: MeshFindings
    ) -> None:
        self.document = document
        self.binary = binary
        self.findings = findings
        self._buffers: dict[int, bytes] = {}

    def buffer(self, number: int) -> bytes:
        """The bytes of a buffer.

        Raises:
            Broken: they are not there.
        """
        if number not in self._buffers:
            uri: Any = entry(self.document, "buffers", number).get("uri")
            data = self.binary if uri is None else self.uri(str(uri))
            if data is None:
                what = "the binary part of the file" if uri is None else f"'{uri}'"
                raise Broken(f"{what[:80]} with its numbers is not there")
            self._buffers[number] = data
        return self._buffers[number]

    def uri(self, uri: str) -> bytes | None:
        """The bytes behind a data URI or a file name; None when there are none.

        Raises:
            Broken: the file is a git-LFS pointer.
        """
        if uri.startswith("data:"):
            head, _, body = uri.partition(",")
            if not head.endswith(";base64"):
                return unquote_to_bytes(body)
            try:
                return base64.b64decode(unquote(body))
            except (binascii.Error, ValueError):
                return None
        path = find_beside(self.findings.path, uri)
        if path is None:
            return None
        try:
            data = path.read_bytes()
        except OSError:
            return None
        if is_lfs_pointer(data):
            raise Broken(f"'{path.name}' is a git-LFS pointer; run 'git lfs pull'")
        self.findings.read(path)
        return data
