"""URDF text to and from yourdfpy, for people who compute with it."""

from __future__ import annotations

import io
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import yourdfpy  # pyright: ignore[reportMissingTypeStubs]


def to_yourdfpy(text: str) -> yourdfpy.URDF:
    """A `yourdfpy.URDF` of a URDF text, meshes not loaded.

    Give it a validated text: yourdfpy silently repairs broken ones.
    """
    import yourdfpy  # pyright: ignore[reportMissingTypeStubs]

    return yourdfpy.URDF.load(  # pyright: ignore[reportUnknownMemberType]
        io.BytesIO(text.encode()), build_scene_graph=True, load_meshes=False
    )


def text_of(urdf: yourdfpy.URDF) -> str:
    """The XML that yourdfpy writes, with the mesh files that its own handler finds."""
    untyped: Any = urdf
    return untyped.write_xml_string().decode()
