"""COLLADA as RViz shows it, damaged files included."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from sambot_viz.meshes.mesh import Mesh, MeshError
from sambot_viz.meshes.read_mesh import read_mesh

Write = Callable[..., Path]

SQUARE = """
<source id="p"><float_array id="pa" count="12">0 0 0 2 0 0 2 1 0 0 1 0</float_array>
 <technique_common><accessor source="#pa" count="4" stride="3">
 <param name="X"/><param name="Y"/><param name="Z"/>
 </accessor></technique_common></source>
<source id="t"><float_array id="ta" count="8">0 0 1 0 1 1 0 1</float_array>
 <technique_common><accessor source="#ta" count="4" stride="2">
 <param name="S" type="float"/><param name="T" type="float"/>
 </accessor></technique_common></source>
<source id="n"><float_array id="na" count="3">0 0 1</float_array>
 <technique_common><accessor source="#na" count="1" stride="3">
 <param name="X"/><param name="Y"/><param name="Z"/>
 </accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
"""
FLAT = '<input semantic="VERTEX" source="#v" offset="0"/>'
TRIANGLES = f'<triangles material="m" count="2">{FLAT}<p>0 1 2 0 2 3</p></triangles>'
FULL = (
    '<polylist material="m" count="1"><input semantic="VERTEX" source="#v" offset="0"/>'
    '<input semantic="NORMAL" source="#n" offset="1"/>'
    '<input semantic="TEXCOORD" source="#t" offset="2" set="0"/>'
    "<vcount>4</vcount><p>0 0 0 1 0 1 2 0 2 3 0 3</p></polylist>"
)
INSTANCE = (
    '<instance_geometry url="#g"><bind_material><technique_common>'
    '<instance_material symbol="m" target="#mat"/>'
    "</technique_common></bind_material></instance_geometry>"
)
RED = "<diffuse><color>0.8 0.1 0.2 1</color></diffuse>"


def collada(
    *,
    primitives: str = TRIANGLES,
    node: str = f"<node>{INSTANCE}</node>",
    asset: str = "",
    effect: str = f"<lambert>{RED}</lambert>",
    extra: str = "",
) -> str:
    return f"""<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset>{asset}</asset>{extra}
<library_effects><effect id="fx"><profile_COMMON>
<newparam sid="surf"><surface type="2D"><init_from>img</init_from></surface></newparam>
<newparam sid="smp"><sampler2D><source>surf</source></sampler2D></newparam>
<technique sid="common">{effect}</technique></profile_COMMON></effect></library_effects>
<library_materials><material id="mat"><instance_effect url="#fx"/></material>
</library_materials>
<library_geometries><geometry id="g"><mesh>{SQUARE}{primitives}</mesh></geometry>
</library_geometries>
<library_visual_scenes><visual_scene id="s">{node}</visual_scene>
</library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene></COLLADA>"""


def codes(mesh: Mesh) -> list[str]:
    return [problem.code for problem in mesh.problems]


def normal_of_first_triangle(mesh: Mesh) -> list[float]:
    part = mesh.parts[0]
    a, b, c = part.vertices[part.faces[0]].astype(float)
    normal = np.cross(b - a, c - a)
    return list(np.round(normal / np.linalg.norm(normal), 6) + 0.0)


def test_colour_and_shape_come_from_the_file(write: Write) -> None:
    mesh = read_mesh(write("a.dae", collada()))
    assert mesh.triangles == 2 and len(mesh.parts) == 1
    assert mesh.parts[0].rgba == (0.8, 0.1, 0.2, 1.0)
    assert mesh.parts[0].normals is None
    assert mesh.problems == ()


@pytest.mark.parametrize("up", ["X_UP", "Y_UP", "Z_UP"])
def test_the_unit_is_applied_and_the_up_axis_is_not(write: Write, up: str) -> None:
    asset = f'<unit name="inch" meter="0.0254"/><up_axis>{up}</up_axis>'
    mesh = read_mesh(write("a.dae", collada(asset=asset)))
    assert np.allclose(mesh.bounds, [[0, 0, 0], [0.0508, 0.0254, 0]])


@pytest.mark.parametrize("meter", ["0", "-1", "cm", "nan"])
def test_a_unit_that_makes_no_sense_is_one_metre_with_a_warning(
    write: Write, meter: str
) -> None:
    mesh = read_mesh(write("a.dae", collada(asset=f'<unit meter="{meter}"/>')))
    assert np.allclose(mesh.bounds, [[0, 0, 0], [2, 1, 0]])
    assert codes(mesh) == ["mesh-unit-invalid"]
    assert (
        f'<unit meter="{meter}"> is not a positive number' in mesh.problems[0].message
    )


def test_node_transforms_are_applied_in_the_order_of_the_document(write: Write) -> None:
    node = f"""<node><translate>1 0 0</translate><rotate>0 0 1 90</rotate>
      <node><scale>2 1 1</scale>{INSTANCE}</node></node>"""
    mesh = read_mesh(write("a.dae", collada(node=node)))
    # (2, 1) → scaled (4, 1) → turned (-1, 4) → moved (0, 4)
    assert np.allclose(mesh.bounds, [[0, 0, 0], [1, 4, 0]], atol=1e-6)


def test_a_mirrored_node_still_shows_its_outside(write: Write) -> None:
    plain = read_mesh(write("a.dae", collada(primitives=FULL)))
    node = f"<node><scale>-1 1 1</scale>{INSTANCE}</node>"
    mirrored = read_mesh(write("b.dae", collada(primitives=FULL, node=node)))
    assert normal_of_first_triangle(plain) == [0, 0, 1]
    assert normal_of_first_triangle(mirrored) == [0, 0, 1]
    assert mirrored.parts[0].normals is not None
    assert np.allclose(mirrored.parts[0].normals, [0, 0, 1])


def test_a_geometry_used_twice_stands_twice(write: Write) -> None:
    node = f"""<node>{INSTANCE}</node>
      <node><translate>0 5 0</translate><instance_node url="#lib"/></node>"""
    extra = f'<library_nodes><node id="lib">{INSTANCE}</node></library_nodes>'
    mesh = read_mesh(write("a.dae", collada(node=node, extra=extra)))
    assert mesh.triangles == 4 and len(mesh.parts) == 1
    assert np.allclose(mesh.bounds[1], [2, 6, 0])


def test_nodes_that_contain_themselves_end_with_a_warning(write: Write) -> None:
    node = f'<node id="self">{INSTANCE}<instance_node url="#self"/></node>'
    mesh = read_mesh(write("a.dae", collada(node=node)))
    assert "mesh-nodes-too-deep" in codes(mesh)


@pytest.mark.parametrize(
    "primitives",
    [
        TRIANGLES,
        FULL,
        f'<polygons material="m" count="1">{FLAT}<p>0 1 2 3</p></polygons>',
        f'<tristrips material="m" count="1">{FLAT}<p>0 1 3 2</p></tristrips>',
        f'<trifans material="m" count="1">{FLAT}<p>0 1 2 3</p></trifans>',
    ],
)
def test_every_kind_of_primitive_faces_the_same_way(
    write: Write, primitives: str
) -> None:
    mesh = read_mesh(write("a.dae", collada(primitives=primitives)))
    part = mesh.parts[0]
    a, b, c = part.vertices[part.faces].transpose(1, 0, 2)
    area = np.cross(b - a, c - a)
    assert mesh.triangles == 2
    assert np.allclose(area.sum(axis=0), [0, 0, 4])


def test_a_polygon_with_a_dent_is_cut_properly(write: Write) -> None:
    arrow = "0 0 0 4 0 0 4 4 0 1 1 0 0 4 0"  # the dent is at (1, 1)
    text = collada(
        primitives=f'<polylist material="m" count="1">{FLAT}<vcount>5</vcount>'
        "<p>0 1 2 3 4</p></polylist>"
    ).replace("0 0 0 2 0 0 2 1 0 0 1 0", arrow)
    part = read_mesh(write("a.dae", text)).parts[0]
    a, b, c = part.vertices[part.faces].astype(float).transpose(1, 0, 2)
    areas = np.cross(b - a, c - a)[:, 2] / 2
    assert np.all(areas > 0)
    assert math.isclose(areas.sum(), 10)


def test_normals_of_the_file_make_it_smooth(write: Write) -> None:
    part = read_mesh(write("a.dae", collada(primitives=FULL))).parts[0]
    assert part.normals is not None and part.normals.dtype == np.float32
    assert np.allclose(part.normals, [0, 0, 1]) and len(part.vertices) == 4


@pytest.mark.parametrize(
    ("effect", "rgba"),
    [
        ("<phong/>", (0.6, 0.6, 0.6, 1)),
        ("", (0.6, 0.6, 0.6, 1)),
        ("<phong><diffuse><color>2 -1 0.5 1</color></diffuse></phong>", (1, 0, 0.5, 1)),
        (
            "<phong><emission><color>0 0 1 1</color></emission>"
            "<diffuse><color>0 0 0 1</color></diffuse></phong>",
            (0, 0, 1, 1),
        ),
        # RViz shows COLLADA opaque (golden case mesh_dae_yup_cm).
        (
            f"<phong>{RED}<transparent opaque='A_ONE'><color>1 1 1 0.4</color>"
            "</transparent><transparency><float>1</float></transparency></phong>",
            (0.8, 0.1, 0.2, 1),
        ),
    ],
)
def test_effects_are_read_as_rviz_reads_them(
    write: Write, effect: str, rgba: tuple[float, ...]
) -> None:
    assert read_mesh(write("a.dae", collada(effect=effect))).parts[0].rgba == rgba


def test_a_file_without_materials_is_grey_without_a_word(write: Write) -> None:
    text = collada(
        primitives=TRIANGLES.replace('material="m"', ""),
        node='<node><instance_geometry url="#g"/></node>',
    ).replace("library_materials", "library_unused")
    mesh = read_mesh(write("a.dae", text))
    assert mesh.parts[0].rgba == (0.6, 0.6, 0.6, 1.0)
    assert mesh.problems == ()


def test_a_broken_material_reference_is_drawn_with_a_warning(write: Write) -> None:
    text = collada().replace('target="#mat"', 'target="#nowhere"')
    mesh = read_mesh(write("a.dae", text))
    assert mesh.triangles == 2
    assert mesh.parts[0].rgba == (0.8, 0.1, 0.2, 1.0)
    assert codes(mesh) == ["mesh-material-broken"]


def test_a_diffuse_texture_is_white_times_the_image(
    write: Write, png: Callable[..., bytes]
) -> None:
    write("textures/Skin.PNG", png())
    extra = (
        '<library_images><image id="img"><init_from>file:///C:/export/skin.png'
        "</init_from></image></library_images>"
    )
    effect = '<phong><diffuse><texture texture="smp" texcoord="UV"/></diffuse></phong>'
    path = write("a.dae", collada(primitives=FULL, effect=effect, extra=extra))
    mesh = read_mesh(path)
    (part,) = mesh.parts
    assert part.rgba == (1, 1, 1, 1) and part.texture is not None
    assert part.texture.data == png() and part.uv is not None
    corner = np.all(part.vertices == (2, 1, 0), axis=1)
    assert np.array_equal(part.uv[corner], [[1, 1]])
    assert mesh.files == (path, path.parent / "textures" / "Skin.PNG")


@pytest.mark.parametrize(
    ("image", "code"),
    [
        ("<image id='img'><init_from>gone.png</init_from></image>", "missing"),
        ("<image id='img'><init_from>a.dae</init_from></image>", "broken"),
        ("<image id='img'/>", "missing"),
        ("", "missing"),
    ],
)
def test_a_texture_that_cannot_be_had_leaves_the_shape_white(
    write: Write, image: str, code: str
) -> None:
    effect = '<phong><diffuse><texture texture="smp" texcoord="UV"/></diffuse></phong>'
    extra = f"<library_images>{image}</library_images>"
    mesh = read_mesh(
        write("a.dae", collada(primitives=FULL, effect=effect, extra=extra))
    )
    assert mesh.parts[0].rgba == (1, 1, 1, 1) and mesh.parts[0].texture is None
    assert codes(mesh) == [f"mesh-texture-{code}"]


@pytest.mark.parametrize(
    "damage",
    [
        lambda text: text.replace("<node>", '<node id="<STL_BINARY>">'),
        lambda text: text + "junk",
        lambda text: text.replace("<asset>", '<asset xsi:type="x">'),
        lambda text: text.replace("</visual_scene>", "</visual_scene>&nbsp;"),
    ],
)
def test_broken_xml_is_recovered_with_a_warning(
    write: Write, damage: Callable[[str], str]
) -> None:
    mesh = read_mesh(write("a.dae", damage(collada())))
    assert mesh.triangles == 2
    assert codes(mesh) == ["mesh-recovered"]
    assert "not well-formed XML" in mesh.problems[0].message


def test_a_scene_that_shows_nothing_is_answered_with_the_geometries(
    write: Write,
) -> None:
    mesh = read_mesh(write("a.dae", collada(node="<node/>")))
    assert mesh.triangles == 2
    assert "mesh-scene-missing" in codes(mesh)


def test_the_same_ids_in_two_geometries_do_not_mix(write: Write) -> None:
    text = collada(node=f"<node>{INSTANCE}</node><node>{INSTANCE}</node>")
    other = text.replace('url="#g"', 'url="#h"', 1)
    start, end = other.index("<geometry"), other.index("</library_geometries>")
    copy = other[start:end].replace('id="g"', 'id="h"').replace("2 1 0", "2 7 0")
    mesh = read_mesh(write("a.dae", other[:end] + copy + other[end:]))
    assert mesh.triangles == 4
    assert mesh.bounds[1][1] == 7


def test_indices_that_point_nowhere_are_left_out_with_a_warning(write: Write) -> None:
    bad = TRIANGLES.replace("0 2 3", "0 2 9")
    mesh = read_mesh(write("a.dae", collada(primitives=TRIANGLES + bad)))
    assert mesh.triangles == 2
    assert codes(mesh) == ["mesh-geometry-broken"]


def test_a_skinned_mesh_stands_as_it_was_bound(write: Write) -> None:
    extra = """<library_controllers><controller id="c"><skin source="#g">
      <bind_shape_matrix>1 0 0 10 0 1 0 0 0 0 1 0 0 0 0 1</bind_shape_matrix>
      </skin></controller></library_controllers>"""
    node = '<node><instance_controller url="#c"/></node>'
    mesh = read_mesh(write("a.dae", collada(node=node, extra=extra)))
    assert np.allclose(mesh.bounds, [[10, 0, 0], [12, 1, 0]])


def test_a_few_lines_that_unfold_to_millions_of_nodes_are_refused(write: Write) -> None:
    levels = "".join(
        f'<node id="n{k}"><instance_node url="#n{k + 1}"/>'
        f'<instance_node url="#n{k + 1}"/></node>'
        for k in range(40)
    )
    extra = f"<library_nodes>{levels}</library_nodes>"
    node = '<node><instance_node url="#n0"/></node>'
    with pytest.raises(MeshError, match="more than 100,000 nodes"):
        read_mesh(write("a.dae", collada(node=node, extra=extra)))


@pytest.mark.parametrize(
    ("primitives", "inside", "times"),
    [
        # An empty geometry, one of many parts, and a node of many transforms.
        ("", '<instance_geometry url="#g"/>' * 1000, 1000),
        (TRIANGLES * 1000, '<instance_geometry url="#g"/>', 1000),
        ("", "<translate>1 0 0</translate>" * 2000, 10_000),
    ],
)
def test_a_few_nodes_that_are_named_very_often_are_refused(
    write: Write, primitives: str, inside: str, times: int
) -> None:
    one = f'<node id="all">{inside}</node>'
    many = "<node>" + '<instance_node url="#all"/>' * times + "</node>"
    text = collada(primitives=primitives, node=one + many)
    with pytest.raises(MeshError, match="more than 100,000 nodes"):
        read_mesh(write("a.dae", text))
