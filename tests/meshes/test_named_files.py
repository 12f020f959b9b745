"""Files that meshes name: where they are found, and which are refused."""

from __future__ import annotations

import base64
import json
from collections.abc import Callable
from pathlib import Path

import pytest

from sambot_viz import load_robot
from sambot_viz.meshes.mesh import Mesh, MeshError
from sambot_viz.meshes.named_files import NamedFileError, NamedFiles
from sambot_viz.meshes.read_mesh import read_mesh

Write = Callable[..., Path]

GLTF = {
    "asset": {"version": "2.0"},
    "scenes": [{"nodes": [0]}],
    "nodes": [{"mesh": 0}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "material": 0}]}],
    "materials": [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}],
    "textures": [{"source": 0}],
    "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}],
    "bufferViews": [{"buffer": 0, "byteLength": 36}],
}
BYTES = "data:;base64," + base64.b64encode(b"\0" * 36).decode()
OBJ = "mtllib {}\nusemtl a\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nf 1/1 2/1 3/1\n"
DAE = """<COLLADA><library_images><image id="i"><init_from>{}</init_from></image>
</library_images><library_effects><effect id="e"><profile_COMMON><technique><phong>
<diffuse><texture texture="i"/></diffuse></phong></technique></profile_COMMON></effect>
</library_effects><library_materials><material id="m"><instance_effect url="#e"/>
</material></library_materials><library_geometries><geometry id="g"><mesh>
<source id="p"><float_array>0 0 0 1 0 0 0 1 0</float_array></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles material="m"><input semantic="VERTEX" source="#v" offset="0"/><p>0 1 2</p>
</triangles></mesh></geometry></library_geometries></COLLADA>"""


@pytest.fixture
def secret(write: Write) -> Path:
    """A file beside the model's folder, which no mesh may use."""
    return write("secret.bin", b"\1" * 36)


@pytest.fixture
def inside(tmp_path: Path) -> tuple[Path, ...]:
    """The one folder that files may be in."""
    folder = tmp_path / "robot"
    folder.mkdir()
    return (folder,)


def sentences(path: Path, roots: tuple[Path, ...] | None) -> str:
    """All that is said about a mesh, whether it is drawn or not."""
    try:
        mesh: Mesh = read_mesh(path, roots=roots)
    except MeshError as error:
        return str(error)
    return "\n".join(str(problem) for problem in mesh.problems)


NAMES = [
    "model://secret.bin",
    "../secret.bin",
    "{}/secret.bin",
    "file://{}/secret.bin",
    "link.bin",
]


@pytest.mark.parametrize("name", [*NAMES, "../gone.bin", "/etc/gone.bin"])
@pytest.mark.parametrize("kind", ["buffer", "image", "mtl", "map_Kd", "dae"])
def test_a_mesh_of_an_untrusted_model_uses_no_file_outside_its_folder(
    write: Write,
    tmp_path: Path,
    secret: Path,
    inside: tuple[Path, ...],
    kind: str,
    name: str,
) -> None:
    name = name.format(tmp_path)
    (tmp_path / "robot" / "link.bin").symlink_to(secret)
    (tmp_path / "robot" / "pictures").mkdir()
    if kind in ("buffer", "image"):
        buffer = {"byteLength": 36, "uri": name if kind == "buffer" else BYTES}
        image = {"uri": name if kind == "image" else "data:,x"}
        document = {**GLTF, "buffers": [buffer], "images": [image]}
        path = write("robot/a.gltf", json.dumps(document))
    elif kind == "dae":
        path = write("robot/a.dae", DAE.format(name))
    else:
        write("robot/a.mtl", f"newmtl a\nmap_Kd {name}\n")
        path = write("robot/a.obj", OBJ.format(name if kind == "mtl" else "a.mtl"))
    said = sentences(path, inside)
    assert "outside the model's folder" in said
    assert "no such file" not in said


def test_a_mesh_of_an_untrusted_model_uses_the_files_beside_it(
    write: Write, png: Callable[..., bytes], inside: tuple[Path, ...]
) -> None:
    write("robot/skin.png", png())
    write("robot/a.mtl", "newmtl a\nmap_Kd /home/someone/skin.png\n")
    path = write("robot/a.obj", OBJ.format("a.mtl"))
    mesh = read_mesh(path, roots=inside)
    assert mesh.parts[0].texture is not None and not mesh.problems
    assert [file.name for file in mesh.files] == ["a.obj", "a.mtl", "skin.png"]


def test_a_mesh_that_is_a_link_out_of_the_folder_is_refused(
    write: Write, tmp_path: Path, inside: tuple[Path, ...]
) -> None:
    path = tmp_path / "robot" / "a.obj"
    path.symlink_to(write("secret.obj", OBJ))
    assert "outside the model's folder" in sentences(path, inside)


@pytest.mark.parametrize("name", ["../part.stl", "../gone.stl", "/etc/gone.stl"])
def test_an_untrusted_model_is_not_told_which_files_exist(
    write: Write, name: str
) -> None:
    write("part.stl", "solid")
    model = write(
        "robot/r.urdf",
        f'<robot name="r"><link name="a"><visual><geometry><mesh filename="{name}"/>'
        "</geometry></visual></link></robot>",
    )
    robot = load_robot(model, trusted=False)
    assert robot.file_roots == (model.parent.resolve(),)
    assert load_robot(model).file_roots is None
    (problem,) = [p for p in robot.problems if p.code == "mesh-not-found"]
    assert "outside the model's folder" in problem.message
    assert "no such file" not in problem.message


@pytest.mark.parametrize("kind", ["buffer", "mtl", "map_Kd"])
def test_files_that_meshes_name_are_not_read_when_they_are_too_large(
    write: Write, tmp_path: Path, kind: str
) -> None:
    with (tmp_path / "huge.bin").open("wb") as stream:
        stream.truncate(2**31)
    if kind == "buffer":
        buffers = [{"byteLength": 36, "uri": "huge.bin"}]
        path = write("a.gltf", json.dumps({**GLTF, "buffers": buffers}))
    else:
        write("a.mtl", "newmtl a\nmap_Kd huge.bin\n")
        path = write("a.obj", OBJ.format("huge.bin" if kind == "mtl" else "a.mtl"))
    assert "it has more than" in sentences(path, None)


@pytest.mark.parametrize(
    ("name", "there"),
    [
        ("skin.png", "meshes/skin.png"),
        ("./sub/skin.png", "meshes/sub/skin.png"),
        ("SKIN.PNG", "meshes/skin.png"),
        ("textures/skin.png", "meshes/textures/Skin.png"),
        (r"C:\export\skin.png", "meshes/skin.png"),
        ("file:///home/someone/skin.png", "meshes/textures/skin.png"),
        ("my%20skin.png", "meshes/my skin.png"),
        ("100%.png", "meshes/100%.png"),
        ("skin.png", "materials/textures/skin.png"),
        ("model://suv/materials/textures/skin.png", "suv/materials/textures/skin.png"),
        ("package://suv/a/my%20skin.png", "suv/a/my skin.png"),
        # Gazebo's models lie beside each other, and a mesh may name its own.
        ("model://car/meshes/skin.png", "meshes/skin.png"),
    ],
)
def test_textures_are_found_where_exporters_leave_them(
    write: Write, tmp_path: Path, name: str, there: str
) -> None:
    mesh = write("car/meshes/a.dae", "")
    image = write(there if there.startswith("suv") else f"car/{there}", b"x")
    assert NamedFiles(mesh).find(name).samefile(image)


@pytest.mark.parametrize("name", ["", "  ", "gone.png", "a\0b", "..", "/"])
def test_names_that_lead_nowhere_are_refused(write: Write, name: str) -> None:
    with pytest.raises(NamedFileError, match="there is no such file"):
        NamedFiles(write("meshes/a.dae", "")).find(name)
