"""A foxglove.SceneUpdate is drawn as markers; foxglove-sdk writes it."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import foxglove.messages as fox
import pytest
from foreign_messages import Channel, in_json, in_protobuf

from sambot_viz.errors import DecodeError

Decode = Callable[[Channel], Any]
RED = fox.Color(r=1, g=0, b=0, a=0.5)
SIZE = fox.Vector3(x=1, y=2, z=3)
DELETE_ALL = 3


def markers(decode: Decode, **primitives: Any) -> list[Any]:
    """The markers of one entity; the first deletes what it had before."""
    entity = fox.SceneEntity(
        timestamp=fox.Timestamp(sec=12, nsec=34),
        frame_id="map",
        id="box",
        lifetime=fox.Duration(sec=2, nsec=5),
        frame_locked=True,
        **primitives,
    )
    return decode(in_protobuf(fox.SceneUpdate(entities=[entity]))).markers


def points(marker: Any) -> list[tuple[float, float, float]]:
    return [(p.x, p.y, p.z) for p in marker.points]


def test_an_entity_takes_the_place_of_the_one_of_its_id(decode: Decode) -> None:
    cubes = [fox.CubePrimitive(size=SIZE, color=RED), fox.CubePrimitive(size=SIZE)]
    before, first, second = markers(decode, cubes=cubes)
    assert (before.action, before.ns) == (DELETE_ALL, "box")
    assert [(one.action, one.ns, one.id) for one in (first, second)] == [
        (0, "box", 0),
        (0, "box", 1),
    ]
    assert (first.header.frame_id, first.header.stamp.sec) == ("map", 12)
    assert (first.lifetime.sec, first.lifetime.nanosec) == (2, 5)
    assert first.frame_locked
    assert (first.type, first.scale.y, first.pose.orientation.w) == (1, 2, 1)
    assert (first.color.r, first.color.a) == (1, 0.5)
    # One without a colour can be seen.
    assert second.color.a == 1


def test_deletions_name_an_entity_or_all_of_them(decode: Decode) -> None:
    kinds = fox.SceneEntityDeletionType
    update = fox.SceneUpdate(
        deletions=[
            fox.SceneEntityDeletion(type=kinds.MatchingId, id="box"),
            fox.SceneEntityDeletion(type=kinds.MatchingId, id=""),
            fox.SceneEntityDeletion(type=kinds.All, id="box"),
        ]
    )
    found = decode(in_protobuf(update)).markers
    assert {one.action for one in found} == {DELETE_ALL}
    # An empty namespace means all of them: no entity has it.
    assert [one.ns for one in found] == ["box", "(no id)", ""]


def test_solids_have_the_sizes_of_their_boxes(decode: Decode) -> None:
    _, sphere, cylinder, cone = markers(
        decode,
        spheres=[fox.SpherePrimitive(size=SIZE, color=RED)],
        cylinders=[
            fox.CylinderPrimitive(size=SIZE, bottom_scale=1, top_scale=1, color=RED),
            fox.CylinderPrimitive(size=SIZE, bottom_scale=1, top_scale=0, color=RED),
        ],
    )
    assert (sphere.type, sphere.scale.z) == (2, 3)
    assert (cylinder.type, cylinder.scale.x) == (3, 1)
    assert cone.type == 11 and len(cone.points) % 3 == 0
    x, y, z = zip(*points(cone), strict=True)
    assert (max(x), max(y), min(z), max(z)) == pytest.approx((0.5, 1, -1.5, 1.5))
    # It is pointed: nothing is beside the axis at its top.
    top = [(px, py) for px, py, pz in points(cone) if pz > 1.4]
    assert all(abs(px) + abs(py) < 1e-9 for px, py in top)


def test_an_arrow_is_as_long_as_its_shaft_and_its_head(decode: Decode) -> None:
    arrow = fox.ArrowPrimitive(
        shaft_length=2, shaft_diameter=0.1, head_length=0.5, head_diameter=0.3
    )
    _, marker = markers(decode, arrows=[arrow])
    assert (marker.type, points(marker)) == (0, [(0, 0, 0), (2.5, 0, 0)])
    assert (marker.scale.x, marker.scale.y, marker.scale.z) == (0.1, 0.3, 0.5)


LINE = [fox.Point3(x=x, y=0, z=0) for x in range(4)]


@pytest.mark.parametrize(
    ("kind", "indices", "marker_type", "xs"),
    [
        ("LineStrip", [], 4, [0, 1, 2, 3]),
        ("LineLoop", [], 4, [0, 1, 2, 3, 0]),
        ("LineList", [], 5, [0, 1, 2, 3]),
        ("LineList", [3, 0, 3, 1], 5, [3, 0, 3, 1]),
    ],
)
def test_lines_join_their_points_as_their_type_says(
    decode: Decode, kind: str, indices: list[int], marker_type: int, xs: list[float]
) -> None:
    line = fox.LinePrimitive(
        type=getattr(fox.LinePrimitiveLineType, kind),
        thickness=0.2,
        points=LINE,
        colors=[fox.Color(r=x / 3, g=0, b=0, a=1) for x in range(4)],
        indices=indices,
    )
    _, marker = markers(decode, lines=[line])
    assert (marker.type, marker.scale.x) == (marker_type, 0.2)
    assert [p[0] for p in points(marker)] == xs
    assert [one.r * 3 for one in marker.colors] == pytest.approx(xs)


def test_triangles_texts_and_models_are_markers(decode: Decode) -> None:
    triangles = fox.TriangleListPrimitive(points=LINE, indices=[0, 1, 2], color=RED)
    text = fox.TextPrimitive(text="hi", font_size=0.4, billboard=True, color=RED)
    own = fox.ModelPrimitive(url="package://lab/a.stl", scale=SIZE)
    red = fox.ModelPrimitive(url="package://lab/a.stl", color=RED, override_color=True)
    _, faces, word, kept, painted = markers(
        decode, triangles=[triangles], texts=[text], models=[own, red]
    )
    assert (faces.type, len(faces.points), faces.scale.x) == (11, 3, 1)
    assert (word.type, word.text, word.scale.z) == (9, "hi", 0.4)
    assert (kept.type, kept.mesh_resource) == (10, "package://lab/a.stl")
    assert kept.mesh_use_embedded_materials and kept.scale.y == 2
    assert not painted.mesh_use_embedded_materials and painted.color.r == 1


@pytest.mark.parametrize(
    ("fields", "why"),
    [
        ({"entities": 3}, "entities: it is not a list of fields"),
        ({"entities": ["a"]}, "entities: it is not a list of fields"),
        ({"entities": [{"cubes": [{"pose": 3}]}]}, "pose: it has no fields"),
        (
            {"entities": [{"cubes": [{"size": {"x": "big"}}]}]},
            "markers: scale: x: a text instead of a number",
        ),
        (
            {"entities": [{"lines": [{"points": [{}], "indices": [1]}]}]},
            "indices: there are 1 points",
        ),
    ],
)
def test_a_scene_of_wrong_parts_is_refused(
    decode: Decode, fields: object, why: str
) -> None:
    with pytest.raises(DecodeError, match=why):
        decode(in_json("foxglove.SceneUpdate", fields))
