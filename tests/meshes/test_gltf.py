"""glTF and GLB as RViz shows them."""

from __future__ import annotations

import base64
import json
import struct
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from sambot_viz.meshes.mesh import Mesh, MeshError
from sambot_viz.meshes.read_mesh import read_mesh

Write = Callable[..., Path]

POSITIONS = np.array([[0, 0, 0], [2, 0, 0], [2, 1, 0], [0, 1, 0]], dtype="<f4")
NORMALS = np.array([[0, 0, 1]] * 4, dtype="<f4")
UV = np.array([[0, 1], [1, 1], [1, 0], [0, 0]], dtype="<f4")
INDICES = np.array([0, 1, 2, 0, 2, 3], dtype="<u2")
BUFFER = POSITIONS.tobytes() + NORMALS.tobytes() + UV.tobytes() + INDICES.tobytes()


VIEW = {"buffer": 0, "byteLength": 140}
ACCESSOR = {"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"}


def document(**changes: Any) -> dict[str, Any]:
    base: dict[str, Any] = {
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}],
        "meshes": [
            {"primitives": [{"attributes": {"POSITION": 0, "NORMAL": 1}, "indices": 3}]}
        ],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"},
            {"bufferView": 1, "componentType": 5126, "count": 4, "type": "VEC3"},
            {"bufferView": 2, "componentType": 5126, "count": 4, "type": "VEC2"},
            {"bufferView": 3, "componentType": 5123, "count": 6, "type": "SCALAR"},
        ],
        "bufferViews": [
            {"buffer": 0, "byteOffset": 0, "byteLength": 48},
            {"buffer": 0, "byteOffset": 48, "byteLength": 48},
            {"buffer": 0, "byteOffset": 96, "byteLength": 32},
            {"buffer": 0, "byteOffset": 128, "byteLength": 12},
        ],
        "buffers": [{"byteLength": len(BUFFER)}],
    }
    return {**base, **changes}


def glb(content: dict[str, Any], binary: bytes = BUFFER) -> bytes:
    text = json.dumps(content).encode()
    text += b" " * (-len(text) % 4)
    binary += b"\0" * (-len(binary) % 4)
    total = 28 + len(text) + len(binary)
    head = struct.pack("<4sII", b"glTF", 2, total)
    chunk = struct.pack("<I4s", len(text), b"JSON") + text
    return head + chunk + struct.pack("<I4s", len(binary), b"BIN\0") + binary


def textured(image: dict[str, Any], **material: Any) -> dict[str, Any]:
    primitive = {
        "attributes": {"POSITION": 0, "NORMAL": 1, "TEXCOORD_0": 2},
        "indices": 3,
        "material": 0,
    }
    pbr = {"baseColorTexture": {"index": 0}, "baseColorFactor": [1, 0.5, 0.25, 0.5]}
    return document(
        meshes=[{"primitives": [primitive]}],
        materials=[{"pbrMetallicRoughness": pbr, **material}],
        textures=[{"source": 0}],
        images=[image],
    )


def data_uri(data: bytes, kind: str = "application/octet-stream") -> str:
    return f"data:{kind};base64," + base64.b64encode(data).decode()


def codes(mesh: Mesh) -> list[str]:
    return [problem.code for problem in mesh.problems]


def test_a_glb_is_white_smooth_and_stands_as_it_is_written(write: Write) -> None:
    mesh = read_mesh(write("a.glb", glb(document())))
    (part,) = mesh.parts
    assert mesh.triangles == 2 and part.rgba == (1, 1, 1, 1)
    assert part.normals is not None and np.allclose(part.normals, [0, 0, 1])
    assert np.array_equal(mesh.bounds, [[0, 0, 0], [2, 1, 0]])


def test_buffers_may_be_files_or_data_uris(write: Write) -> None:
    path = write("a.gltf", json.dumps(document(buffers=[{"uri": "the%20data.bin"}])))
    data = write("the data.bin", BUFFER)
    assert read_mesh(path).files == (path, data)
    inline = document(buffers=[{"uri": data_uri(BUFFER)}])
    assert read_mesh(write("b.gltf", json.dumps(inline))).triangles == 2


def test_the_triangles_of_a_strip_face_the_same_way(write: Write) -> None:
    content = document()
    content["meshes"][0]["primitives"][0]["mode"] = 5
    content["accessors"][3]["count"] = 4
    binary = BUFFER[:128] + np.array([0, 1, 3, 2], dtype="<u2").tobytes() + b"\0" * 4
    part = read_mesh(write("a.glb", glb(content, binary))).parts[0]
    a, b, c = part.vertices[part.faces].transpose(1, 0, 2)
    assert np.allclose(np.cross(b - a, c - a).sum(axis=0), [0, 0, 4])


def test_lines_and_points_are_no_triangles(write: Write) -> None:
    content = document()
    content["meshes"][0]["primitives"][0]["mode"] = 1
    with pytest.raises(MeshError, match="no triangles"):
        read_mesh(write("a.glb", glb(content)))


def test_nodes_are_baked_in(write: Write) -> None:
    half = 0.5**0.5
    nodes = [
        {"children": [1], "rotation": [0, 0, half, half], "translation": [1, 0, 0]},
        {"mesh": 0, "scale": [2, 1, 1]},
    ]
    mesh = read_mesh(write("a.glb", glb(document(nodes=nodes))))
    assert np.allclose(mesh.bounds, [[0, 0, 0], [1, 4, 0]], atol=1e-6)
    columns = [0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 7, 0, 0, 1]
    nodes = [{"mesh": 0, "matrix": columns}]
    mesh = read_mesh(write("b.glb", glb(document(nodes=nodes))))
    assert np.allclose(mesh.bounds, [[6, 0, 0], [7, 2, 0]])


SPARSE = {
    "count": 1,
    "indices": {"bufferView": 3, "componentType": 5123},
    "values": {"bufferView": 0},
}


def sparse_uv(content: dict[str, Any]) -> dict[str, Any]:
    content["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] = 2
    content["accessors"][2]["sparse"] = SPARSE
    return content


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        (lambda d: d["meshes"][0]["primitives"][0].update(mode=6), "triangle fans"),
        (lambda d: d["accessors"][0].update(sparse=SPARSE), "sparse numbers"),
        (lambda d: d["accessors"][3].update(sparse=SPARSE), "sparse numbers"),
        (lambda d: d.update(sparse_uv(d)), "sparse numbers"),
        (lambda d: d["accessors"][0].pop("bufferView"), "sparse numbers"),
        (lambda d: d.pop("scenes"), "nodes but no scene"),
        (lambda d: d["nodes"][0].update(camera=0), "a camera with parts below it"),
    ],
)
def test_what_trimesh_would_leave_out_in_silence_is_refused(
    write: Write, change: Callable[[dict[str, Any]], object], sentence: str
) -> None:
    content = document()
    change(content)
    with pytest.raises(MeshError, match=f"has {sentence}, which this") as caught:
        read_mesh(write("a.glb", glb(content)))
    assert caught.value.problem.code == "mesh-compressed"
    assert "export it again as plain triangles" in caught.value.problem.hint


@pytest.mark.parametrize(("mode", "alpha"), [("OPAQUE", 1.0), ("BLEND", 0.5)])
def test_the_look_is_factor_times_texture(
    write: Write, png: Callable[..., bytes], mode: str, alpha: float
) -> None:
    content = textured({"uri": data_uri(png(), "image/png")}, alphaMode=mode)
    (part,) = read_mesh(write("a.glb", glb(content))).parts
    assert part.rgba == (1, 0.5, 0.25, alpha)
    assert part.texture is not None and part.texture.data == png()
    corner = np.all(part.vertices == (0, 0, 0), axis=1)
    assert part.uv is not None and np.array_equal(part.uv[corner], [[0, 0]])


def test_images_may_lie_in_the_file_or_beside_it(
    write: Write, png: Callable[..., bytes]
) -> None:
    image = png()
    views = [*document()["bufferViews"]]
    views.append({"buffer": 0, "byteOffset": 140, "byteLength": len(image)})
    inside = {
        **textured({"bufferView": 4, "mimeType": "image/png"}),
        "bufferViews": views,
    }
    part = read_mesh(write("a.glb", glb(inside, BUFFER + image))).parts[0]
    assert part.texture is not None and part.texture.data == image
    write("skin.png", image)
    part = read_mesh(write("b.glb", glb(textured({"uri": "skin.png"})))).parts[0]
    assert part.texture is not None and part.texture.data == image


def test_a_texture_that_cannot_be_had_leaves_the_colour(write: Write) -> None:
    mesh = read_mesh(write("a.glb", glb(textured({"uri": "gone.png"}))))
    assert mesh.parts[0].texture is None and mesh.parts[0].rgba == (1, 0.5, 0.25, 1)
    assert codes(mesh) == ["mesh-texture-broken"]
    assert "'gone.png': there is no such file" in mesh.problems[0].message


@pytest.mark.parametrize(
    ("name", "method"),
    [
        ("KHR_draco_mesh_compression", "Draco"),
        ("EXT_meshopt_compression", "meshopt"),
    ],
)
def test_compressed_meshes_are_refused(write: Write, name: str, method: str) -> None:
    content = document(extensionsRequired=[name], extensionsUsed=[name])
    with pytest.raises(MeshError, match=f"compressed with {method}") as caught:
        read_mesh(write("a.glb", glb(content)))
    assert caught.value.problem.code == "mesh-compressed"
    assert "without mesh compression" in caught.value.problem.hint


def test_quantized_positions_are_read(write: Write) -> None:
    short = np.array([[0, 0, 0], [32767, 0, 0], [0, 32767, 0]], dtype="<i2")
    position = {"bufferView": 0, "componentType": 5122, "normalized": True}
    content = document(
        meshes=[{"primitives": [{"attributes": {"POSITION": 0}}]}],
        accessors=[{**position, "count": 3, "type": "VEC3"}],
        bufferViews=[{"buffer": 0, "byteLength": 18}],
    )
    mesh = read_mesh(write("a.glb", glb(content, short.tobytes())))
    assert np.allclose(mesh.bounds, [[0, 0, 0], [1, 1, 0]])


@pytest.mark.parametrize(
    ("changes", "sentence"),
    [
        ({"nodes": []}, r"trimesh cannot read it \(IndexError"),
        ({"nodes": [{"mesh": 7}]}, r"does not have or .* meshes \[7\]"),
        ({"nodes": [{"mesh": 0, "children": [0]}]}, "below itself"),
        ({"nodes": [{"mesh": 0, "scale": ["x", 1, 1]}]}, "trimesh cannot read it"),
        ({"nodes": 3}, r"of another kind \(TypeError"),
        ({"scenes": [{"nodes": [0, 0]}]}, "below two others"),
        ({"bufferViews": [{"buffer": 0, "byteLength": 999}]}, "byte 999 of 140"),
        ({"accessors": [{**ACCESSOR, "count": 5}]}, "5 entries does not fit"),
        ({"accessors": [{**ACCESSOR, "count": -1}]}, "-1 entries does not fit"),
        ({"accessors": [{**ACCESSOR, "count": 2**62}]}, "entries does not fit"),
        ({"accessors": [{**ACCESSOR, "byteOffset": -4}]}, "entries does not fit"),
        ({"accessors": [{**ACCESSOR, "type": "VEC9"}]}, "KeyError: 'VEC9'"),
        ({"accessors": [ACCESSOR] * 100_001}, "more than 100,000 accessors"),
        ({"bufferViews": [VIEW] * 100_001}, "more than 100,000 bufferViews"),
    ],
)
def test_a_file_that_contradicts_itself_is_refused(
    write: Write, changes: dict[str, Any], sentence: str
) -> None:
    with pytest.raises(MeshError, match=f"the glTF file is broken: .*{sentence}"):
        read_mesh(write("a.glb", glb(document(**changes))))


def test_a_missing_buffer_is_named_with_the_place_for_it(write: Write) -> None:
    path = write("a.gltf", json.dumps(document(buffers=[{"uri": "gone.bin"}])))
    with pytest.raises(MeshError, match=r"needs the file 'gone\.bin'") as caught:
        read_mesh(path)
    assert caught.value.problem.code == "mesh-buffer-missing"
    assert caught.value.problem.hint.startswith("put it beside the mesh")


@pytest.mark.parametrize("twice", ["bufferViews", "accessors"])
def test_a_file_that_announces_the_same_bytes_again_and_again_is_refused(
    write: Write, twice: str
) -> None:
    data = bytes(2**20)
    view = {"buffer": 0, "byteLength": len(data)}
    accessor = {**ACCESSOR, "count": len(data) // 12}
    content = document(bufferViews=[view], accessors=[accessor])
    content[twice] *= 200
    with pytest.raises(MeshError, match=r"announces .* bytes of numbers but has 10"):
        read_mesh(write("a.glb", glb(content, data)))


def test_old_and_cut_off_files_are_refused(write: Write) -> None:
    whole = glb(document())
    with pytest.raises(MeshError, match="it is of version 1"):
        read_mesh(write("a.glb", whole[:4] + struct.pack("<I", 1) + whole[8:]))
    with pytest.raises(MeshError, match=rf"{len(whole)} bytes but has"):
        read_mesh(write("b.glb", whole[:-20]))


def test_vertices_that_no_file_shares_are_shared(write: Write) -> None:
    soup = POSITIONS[INDICES]
    content = document(
        meshes=[{"primitives": [{"attributes": {"POSITION": 0, "NORMAL": 1}}]}]
    )
    content["accessors"][0]["count"] = content["accessors"][1]["count"] = 6
    content["bufferViews"][0]["byteLength"] = 72
    content["bufferViews"][1].update(byteOffset=72, byteLength=72)
    binary = soup.tobytes() + NORMALS[[0] * 6].tobytes()
    (part,) = read_mesh(write("a.glb", glb(content, binary))).parts
    assert len(part.faces) == 2 and len(part.vertices) == 4


@pytest.mark.parametrize(
    ("factor", "shown"),
    [([0, 0.8, 0.5], (0.2, 0.8, 1)), (["x"], (0.2, 0, 0.75)), (3, (0.2, 0, 0.75))],
)
def test_emission_adds_to_the_base_colour(
    write: Write, factor: object, shown: tuple[float, float, float]
) -> None:
    pbr = {"baseColorFactor": [0.2, 0, 0.75, 1]}
    material = {"pbrMetallicRoughness": pbr, "emissiveFactor": factor}
    content = document(materials=[material])
    content["meshes"][0]["primitives"][0]["material"] = 0
    mesh = read_mesh(write("a.glb", glb(content)))
    assert mesh.parts[0].rgba == (*shown, 1)


def test_nodes_may_be_cameras_and_have_any_name(write: Write) -> None:
    nodes = [
        {"name": "world", "children": [1, 2], "translation": [0, 0, 3]},
        {"name": "world", "mesh": 0},
        {"name": "world", "camera": 0, "translation": [9, 9, 9]},
    ]
    cameras = [{"type": "perspective", "perspective": {"yfov": 1, "znear": 1}}]
    content = document(nodes=nodes, cameras=cameras)
    mesh = read_mesh(write("a.glb", glb(content)))
    assert np.array_equal(mesh.bounds, [[0, 0, 3], [2, 1, 3]])


def test_a_thousand_equal_names_take_no_time_and_a_hostile_choice_is_refused(
    write: Write,
) -> None:
    nodes = [{"mesh": 0, "name": "bolt_1"}] * 1000
    content = document(nodes=nodes, scenes=[{"nodes": list(range(1000))}])
    assert read_mesh(write("a.glb", glb(content))).triangles == 2000
    nodes = [{"name": f"a_{' ' * (k % 10_000)}1"} for k in range(20_000)]
    with pytest.raises(MeshError, match="meshes have the same names"):
        read_mesh(write("b.glb", glb(document(nodes=[{"mesh": 0}, *nodes]))))


def test_a_mirrored_node_shows_its_outside(write: Write) -> None:
    nodes = [{"mesh": 0, "scale": [-1, 1, 1]}]
    part = read_mesh(write("a.glb", glb(document(nodes=nodes)))).parts[0]
    a, b, c = part.vertices[part.faces].transpose(1, 0, 2)
    assert np.allclose(np.cross(b - a, c - a).sum(axis=0), [0, 0, 4])
    assert part.normals is not None and np.allclose(part.normals, [0, 0, 1])


def test_a_last_triangle_that_is_not_complete_is_refused(write: Write) -> None:
    content = document()
    content["accessors"][3]["count"] = 5
    with pytest.raises(MeshError, match="a list of triangles has 5 corners"):
        read_mesh(write("a.glb", glb(content)))


def test_what_no_node_shows_is_compared_with_the_size_of_the_file_too(
    write: Write,
) -> None:
    content = document()
    content["accessors"].append({"componentType": 1, "count": 2**40, "type": "MAT4"})
    with pytest.raises(MeshError, match="more than 1,048,576 entries without data"):
        read_mesh(write("a.glb", glb(content)))
    content = document()
    content["meshes"] += [{"primitives": content["meshes"][0]["primitives"] * 200_000}]
    with pytest.raises(MeshError, match="more than 100,000 nodes"):
        read_mesh(write("b.glb", glb(content)))


def test_trimesh_opens_no_image_and_reads_no_file_by_itself(
    write: Write, monkeypatch: pytest.MonkeyPatch
) -> None:
    from PIL import Image

    def refuse(*_: object, **__: object) -> None:
        raise AssertionError("an image was opened")

    monkeypatch.setattr(Image, "open", refuse)
    content = document(images=[{"uri": "a.png"}, {"bufferView": 0}])
    assert read_mesh(write("a.glb", glb(content))).triangles == 2
