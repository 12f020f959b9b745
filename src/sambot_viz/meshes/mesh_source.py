"""A mesh file while it is read: its bytes, what it may use, what was found in it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from sambot_viz import limits
from sambot_viz.errors import Findings
from sambot_viz.geometry import Rgba
from sambot_viz.meshes.mesh import MeshError, Texture, mesh_error
from sambot_viz.meshes.named_files import NamedFileError, NamedFiles
from sambot_viz.meshes.textures import TextureError, TextureStore


class MeshBudget:
    """Counts the expanded shapes of a file: a few lines can name one a million times.

    Attributes:
        cut_short: whether the file had more polygons to cut than the limit.
    """

    def __init__(self, path: Path) -> None:
        self.cut_short = False
        self._path = path
        self._left = {
            "nodes": limits.MESH_NODES.value,
            "triangles": limits.TRIANGLES.value,
            "vertices": limits.MESH_VERTICES.value,
            "entries without data": limits.MESH_EMPTY.value,
        }
        self._cutting = limits.MESH_CUTTING.value

    def spend_nodes(self, count: int = 1) -> None:
        """Count nodes of the scene; raises MeshError when there are too many."""
        self._spend("nodes", count, limits.MESH_NODES.value)

    def spend_triangles(self, triangles: int, vertices: int) -> None:
        """Count what one primitive takes, before memory is taken for it.

        Raises:
            MeshError: more than a browser can be expected to show.
        """
        self._spend("triangles", triangles, limits.TRIANGLES.value)
        self._spend("vertices", vertices, limits.MESH_VERTICES.value)

    def spend_without_data(self, count: int) -> None:
        """Count rows that the file announces but does not contain.

        Raises:
            MeshError: more than any honest file has.
        """
        self._spend("entries without data", count, limits.MESH_EMPTY.value)

    def may_cut(self, corners: int) -> bool:
        """Take the time to cut a polygon with that many corners, if any is left."""
        self._cutting -= corners * corners + 1000
        self.cut_short = self.cut_short or self._cutting < 0
        return self._cutting >= 0

    def _spend(self, what: str, count: int, most: int) -> None:
        self._left[what] -= count
        if self._left[what] < 0:
            raise mesh_error(
                self._path,
                "mesh-too-large",
                f"the mesh has more than {most:,} {what}, too many for a browser",
                "reduce its triangles",
            )


class MeshSource:
    """A mesh file that is being read.

    Args:
        path: the file.
        data: its bytes.
        images: where textures are kept.
        roots: resolved folders that the files it names must be in; None for no limit.

    Attributes:
        files: finds and reads the files it names.
        budget: the rest of the allowed shapes.
        findings: the warnings about it.
    """

    def __init__(
        self,
        path: Path,
        data: bytes,
        images: TextureStore | None = None,
        roots: Sequence[Path] | None = None,
    ) -> None:
        self.path = path
        self.data = data
        self.images = images or TextureStore()
        self.files = NamedFiles(path, roots)
        self.budget = MeshBudget(path)
        self.findings = Findings()

    def warn(self, code: str, message: str, hint: str = "") -> None:
        """Note something doubtful, unless the same is noted already."""
        file = str(self.path)
        self.findings.add("warning", code, message, hint, file, cause=message)

    def broken(
        self,
        message: str,
        hint: str = "export the mesh again, or copy the file again if it was cut off",
    ) -> MeshError:
        """Return the error for a file that contradicts itself or is cut off."""
        return mesh_error(self.path, "mesh-broken", message, hint)


@dataclass(frozen=True, slots=True)
class MeshMaterial:
    """Colour and texture of a surface."""

    rgba: Rgba
    texture: Texture | None = None


def load_texture(name: str, source: MeshSource) -> Texture | None:
    """Read the image that a mesh names; None, with a warning, when that fails."""
    try:
        path = source.files.find(name)
    except NamedFileError as error:
        source.warn(
            "mesh-texture-missing",
            f"the texture '{name}' was not found: {error}; the surface is shown "
            "without it",
            "put the image beside the mesh",
        )
        return None
    source.files.note(path)
    try:
        return source.images.from_file(path)
    except TextureError as error:
        source.warn(
            "mesh-texture-broken",
            f"the texture '{name}' cannot be used: {error}; the surface is shown "
            "without it",
        )
        return None
