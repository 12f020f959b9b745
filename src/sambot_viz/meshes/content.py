"""Find out the real content of a file that cannot be read as a mesh by its ending."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path

_HEAD = 4096
_EXPORT = "open it in the program it is from and export it as {wanted}"
_RENAME = "call the file {stem}{ending}, and write that name in the model"
_DOWNLOAD = "download the file itself (on GitHub: the button “Download raw file”)"
_UNPACK = "unpack it and use the mesh that is inside"
_REFUSAL = r"(?i)\b(?:40[0-9]|not found|forbidden|denied|bad request|moved)\b"
_FACET = 50
_STL_HEADER = 84


@dataclass(frozen=True, slots=True)
class _Kind:
    """A kind of file: how it begins, its name, its ending as a mesh, and what to do."""

    pattern: bytes
    name: str
    ending: str = ""
    hint: str = "use the file of the mesh itself"


_KINDS = (
    _Kind(rb"(?i)<!doctype\s+html|<html[\s>]", "a web page (HTML)", hint=_DOWNLOAD),
    _Kind(rb"(?s).{0,3000}<COLLADA[\s>]", "a COLLADA file", ".dae", _RENAME),
    _Kind(rb"(?s)(?:<\?xml.{0,1000})?<(?:robot|sdf)[\s>]", "a robot model"),
    _Kind(rb"<\?xml|<svg", "an XML file"),
    _Kind(rb"glTF", "a GLB file", ".glb", _RENAME),
    _Kind(rb'(?s)\{.*"asset"', "a glTF file", ".gltf", _RENAME),
    _Kind(rb"\{\s*\"", "a JSON file"),
    _Kind(rb"ply\r?\n", "a PLY file", ".ply", _RENAME),
    _Kind(rb"(?is)solid\b.*\bfacet\b", "an STL file", ".stl", _RENAME),
    _Kind(rb"(?s)PK\x03\x04.*3D/", "a 3MF file", hint=_EXPORT),
    _Kind(rb"PK\x03\x04", "a zip archive", hint=_UNPACK),
    _Kind(rb"\x1f\x8b", "a gzip archive", hint=_UNPACK),
    _Kind(rb"7z\xbc\xaf|Rar!", "an archive", hint=_UNPACK),
    _Kind(rb"ISO-10303-21", "a STEP file of a CAD program", hint=_EXPORT),
    _Kind(rb"Kaydara FBX", "an FBX file", hint=_EXPORT),
    _Kind(rb"BLENDER", "a file of Blender", hint=_EXPORT),
    _Kind(rb"\xd0\xcf\x11\xe0", "a file of a CAD program", hint=_EXPORT),
    _Kind(rb"\x89PNG|\xff\xd8\xff|GIF8|RIFF", "an image"),
    _Kind(rb"%PDF", "a PDF"),
    _Kind(rb"(?s)(?:[^\n]*\n){0,60}?v [-+.\d]", "an OBJ file", ".obj", _RENAME),
)
_NAMES = {
    ".stl": "STL",
    ".stlb": "STL",
    ".dae": "COLLADA",
    ".obj": "OBJ",
    ".glb": "glTF",
    ".gltf": "glTF",
    ".ply": "PLY",
}
_SAME = ({".glb", ".gltf"}, {".stl", ".stlb"})
"""Endings whose reader takes the content of each."""


def other_content(path: Path, data: bytes) -> tuple[str, str] | None:
    """Return the real format of a file with a wrong ending, and the remedy.

    Args:
        path: the file.
        data: its bytes, which its reader has refused.

    Returns:
        A sentence and a hint; None if the ending may be right and the file broken.
    """
    ending = path.suffix.lower()
    kind = _kind(data)
    if kind is None:
        return _as_text(data, ending)
    if kind.ending and any({ending, kind.ending} <= pair for pair in _SAME):
        return None
    if kind.ending == ending or ending not in _NAMES:
        return None
    facts = {"stem": path.stem, "ending": kind.ending, "wanted": _NAMES[ending]}
    return f"this is {kind.name}, not {_article(ending)} file", kind.hint.format(
        **facts
    )


def _article(ending: str) -> str:
    name = _NAMES[ending]
    return f"an {name}" if name[0] in "SO" else f"a {name}"


def _kind(data: bytes) -> _Kind | None:
    head = data[:_HEAD].removeprefix(b"\xef\xbb\xbf").lstrip()
    found = next((kind for kind in _KINDS if re.match(kind.pattern, head)), None)
    count = int.from_bytes(data[80:_STL_HEADER], "little")
    if count and len(data) == _STL_HEADER + _FACET * count:
        # Its first 80 bytes are free text.
        return _Kind(b"", "an STL file", ".stl", _RENAME)
    return found


def _as_text(data: bytes, ending: str) -> tuple[str, str] | None:
    """Quote a short message that was saved in place of a file ("404: Not Found")."""
    if len(data) > 200 or not data.isascii():
        return None
    text = " ".join(data.decode("ascii").split())
    if not re.search(_REFUSAL, text) or ending not in _NAMES:
        return None
    return f"this is a text (“{text[:60]}”), not {_article(ending)} file", _DOWNLOAD
