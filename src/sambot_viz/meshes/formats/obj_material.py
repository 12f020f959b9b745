"""The materials of an OBJ file: its .mtl files."""

from __future__ import annotations

import re
from dataclasses import dataclass, field

from sambot_viz import limits
from sambot_viz.meshes.mesh import GREY, Texture
from sambot_viz.meshes.mesh_source import MeshMaterial, MeshSource, load_texture
from sambot_viz.meshes.named_files import LfsPointerError, NamedFileError


def read_libraries(names: list[str], source: MeshSource) -> dict[str, MeshMaterial]:
    """Return the materials of all .mtl files that an OBJ file names, by their name."""
    looks: dict[str, MeshMaterial] = {}
    for name in dict.fromkeys(names):
        try:
            data = source.files.read(name, limits.MATERIALS.value)
        except NamedFileError as error:
            pointer = isinstance(error, LfsPointerError)
            source.warn(
                "mesh-lfs-pointer" if pointer else "mesh-material-missing",
                f"the material file '{name}' cannot be used: {error}; grey is shown",
                "put it beside the mesh",
            )
            continue
        looks.update(_read_library(data, source))
    return looks


@dataclass(slots=True)
class _Material:
    """A material of an .mtl file while its lines are read."""

    diffuse: list[float] = field(default_factory=lambda: list(GREY[:3]))
    emission: list[float] = field(default_factory=lambda: [0.0, 0.0, 0.0])
    alpha: float = 1.0
    texture: Texture | None = None

    @property
    def look(self) -> MeshMaterial:
        """Colour and texture as shown: RViz adds emission to the diffuse colour."""
        red, green, blue = (
            min(1.0, own + light)
            for own, light in zip(self.diffuse, self.emission, strict=True)
        )
        return MeshMaterial((red, green, blue, self.alpha), self.texture)


def _read_library(data: bytes, source: MeshSource) -> dict[str, MeshMaterial]:
    materials: dict[str, _Material] = {}
    material: _Material | None = None
    for line in data.decode("utf-8", "replace").splitlines():
        keyword, _, rest = line.strip().replace("\t", " ").partition(" ")
        rest = rest.strip()
        if keyword == "newmtl":
            material = materials[rest] = _Material()
        elif material is not None and keyword == "map_Kd":
            material.texture = load_texture(_map_name(rest), source)
        elif material is not None and keyword in ("Kd", "Ke", "d", "Tr"):
            _set_numbers(material, keyword, rest)
    return {name: material.look for name, material in materials.items()}


def _set_numbers(material: _Material, keyword: str, rest: str) -> None:
    """Read a line of numbers; ignore a line with other words."""
    try:
        numbers = [min(1.0, max(0.0, float(word))) for word in rest.split()]
    except ValueError:
        return
    if not numbers:
        return
    # A single number is used for all three.
    colour = (numbers * 3)[:3]
    if keyword == "Kd":
        material.diffuse = colour
    elif keyword == "Ke":
        material.emission = colour
    else:
        alpha = numbers[0] if keyword == "d" else 1 - numbers[0]
        # Exporters write "d 0" for a part that is simply there.
        material.alpha = alpha or 1.0


def _map_name(rest: str) -> str:
    """Return the file name after options such as "-s 1 1 1 -bm 0.5"."""
    words = rest.split(" ")
    while len(words) > 1 and words[0].startswith("-"):
        option = words.pop(0)
        if option in ("-blendu", "-blendv", "-cc", "-clamp", "-imfchan", "-type"):
            words.pop(0)
            continue
        while len(words) > 1 and re.fullmatch(r"[-+.\deE]*", words[0]):
            words.pop(0)
    return " ".join(words).strip()
