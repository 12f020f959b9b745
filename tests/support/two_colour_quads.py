"""Square meshes with a texture, vertex colours, both or neither, in each file format.

The square is (0, 0) to (0.9, 0.9) in z = 0, and faces +z. Its texture is red on the
left and green on the right; its vertex colours are blue on the left, yellow on the
right.
"""

from __future__ import annotations

from itertools import product
from pathlib import Path

import numpy as np
import trimesh
from PIL import Image
from trimesh.visual.texture import TextureVisuals

CORNERS = np.array([[0, 0, 0], [0.9, 0, 0], [0.9, 0.9, 0], [0, 0.9, 0]])
FACES = np.array([[0, 1, 2], [0, 2, 3]])
COLOURS = np.array([[60, 60, 255], [255, 255, 60], [255, 255, 60], [60, 60, 255]])
ATTRIBUTES = ("uv", "colour", "both", "none")
FORMATS = {
    "obj": ("uv", "none"),
    "glb": ATTRIBUTES,
    "dae": ATTRIBUTES,
    "ply": ("colour", "none"),
    "stl": ("none",),
}
"""The attributes that each format can have here."""


def names() -> list[str]:
    """The files of `write`, such as "uv_flat.glb" and "uv_smooth.glb"."""
    return [
        f"{has}_{'smooth' if normals else 'flat'}.{kind}"
        for kind, all_have in FORMATS.items()
        for has, normals in product(all_have, (True, False))
        # An STL file always has normals; one is enough.
        if normals or kind != "stl"
    ]


def write(folder: Path) -> None:
    """Write all meshes, and the texture, into a folder."""
    image = Image.new("RGB", (8, 8), (255, 60, 60))
    image.paste((60, 255, 60), (4, 0, 8, 8))
    image.save(folder / "two.png")
    for name in names():
        has, rest = name.split("_")
        normals, kind = rest.split(".")
        uv, colour = has in ("uv", "both"), has in ("colour", "both")
        data = _WRITERS[kind](uv, colour, normals == "smooth", image)
        folder.joinpath(name).write_bytes(data)
    folder.joinpath("two.mtl").write_text("newmtl two\nKd 1 1 1\nmap_Kd two.png\n")


def _obj(uv: bool, colour: bool, normals: bool, image: Image.Image) -> bytes:
    lines = ["mtllib two.mtl"] if uv else []
    lines += [f"v {x} {y} {z}" for x, y, z in CORNERS]
    lines += ["vt 0 0", "vt 1 0", "vt 1 1", "vt 0 1", "vn 0 0 1"]
    lines += ["usemtl two"] if uv else []
    rest = [
        f"/{n if uv else ''}/{1 if normals else ''}".rstrip("/") for n in range(1, 5)
    ]
    corner = [f"{n}{after}" for n, after in enumerate(rest, 1)]
    lines += [f"f {' '.join(corner[n] for n in face)}" for face in FACES]
    return "\n".join([*lines, ""]).encode()


def _trimesh(uv: bool, colour: bool, image: Image.Image) -> trimesh.Trimesh:
    mesh = trimesh.Trimesh(CORNERS, FACES, process=False)
    rgba = np.hstack([COLOURS, np.full((4, 1), 255)]).astype(np.uint8)
    if uv:
        places = CORNERS[:, :2] / 0.9
        mesh.visual = TextureVisuals(uv=places, image=image)
        if colour:
            mesh.visual.vertex_attributes["color"] = rgba
    elif colour:
        mesh.visual.vertex_colors = rgba
    return mesh


def _glb(uv: bool, colour: bool, normals: bool, image: Image.Image) -> bytes:
    mesh = _trimesh(uv, colour, image)
    return trimesh.exchange.gltf.export_glb(mesh.scene(), include_normals=normals)


def _ply(uv: bool, colour: bool, normals: bool, image: Image.Image) -> bytes:
    mesh = _trimesh(uv, colour, image)
    return trimesh.exchange.ply.export_ply(mesh, vertex_normal=normals)


def _stl(uv: bool, colour: bool, normals: bool, image: Image.Image) -> bytes:
    return trimesh.exchange.stl.export_stl(_trimesh(uv, colour, image))


def _source(name: str, params: str, rows: np.ndarray) -> str:
    numbers = " ".join(f"{v:g}" for v in np.ravel(rows))
    accessors = "".join(f'<param name="{p}" type="float"/>' for p in params)
    return (
        f'<source id="{name}"><float_array id="{name}_a" count="{np.size(rows)}">'
        f"{numbers}</float_array><technique_common><accessor source='#{name}_a' "
        f'count="{len(rows)}" stride="{len(params)}">{accessors}</accessor>'
        "</technique_common></source>"
    )


def _dae(uv: bool, colour: bool, normals: bool, image: Image.Image) -> bytes:
    places = CORNERS[:, :2] / 0.9
    sources = _source("p", "XYZ", CORNERS)
    inputs = '<input semantic="VERTEX" source="#v" offset="0"/>'
    # Of each semantic: its values, and whether this mesh has them.
    for semantic, name, params, rows, wanted in (
        ("NORMAL", "n", "XYZ", np.tile([0, 0, 1], (4, 1)), normals),
        ("TEXCOORD", "t", "ST", places, uv),
        ("COLOR", "c", "RGB", COLOURS / 255, colour),
    ):
        if wanted:
            sources += _source(name, params, rows)
            inputs += f'<input semantic="{semantic}" source="#{name}" offset="0"/>'
    diffuse = (
        '<texture texture="sa" texcoord="UV"/>' if uv else "<color>1 1 1 1</color>"
    )
    return f"""<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit meter="1"/><up_axis>Z_UP</up_axis></asset>
<library_images><image id="im"><init_from>two.png</init_from></image></library_images>
<library_effects><effect id="e"><profile_COMMON>
<newparam sid="s"><surface type="2D"><init_from>im</init_from></surface></newparam>
<newparam sid="sa"><sampler2D><source>s</source></sampler2D></newparam>
<technique sid="c"><lambert><diffuse>{diffuse}</diffuse></lambert></technique>
</profile_COMMON></effect></library_effects>
<library_materials><material id="m"><instance_effect url="#e"/></material>
</library_materials>
<library_geometries><geometry id="g"><mesh>{sources}
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="2" material="mm">{inputs}<p>0 1 2 0 2 3</p></triangles>
</mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="vs"><node><instance_geometry url="#g">
<bind_material><technique_common><instance_material symbol="mm" target="#m">
<bind_vertex_input semantic="UV" input_semantic="TEXCOORD"/></instance_material>
</technique_common></bind_material></instance_geometry></node></visual_scene>
</library_visual_scenes><scene><instance_visual_scene url="#vs"/></scene></COLLADA>
""".encode()


_WRITERS = {"obj": _obj, "glb": _glb, "ply": _ply, "stl": _stl, "dae": _dae}
