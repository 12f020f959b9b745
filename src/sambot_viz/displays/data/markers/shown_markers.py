"""How markers that are no solids are drawn: lists of points, lines and texts."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from sambot_viz.displays.data.markers.checks import (
    CUBE_LIST,
    LINE_LIST,
    POINTS,
    SPHERE_LIST,
)
from sambot_viz.displays.data.markers.marker_fields import (
    MarkerPose,
    alpha_of,
    points_of,
    rgb_of,
    rgba_of,
)
from sambot_viz.displays.data.selected_pose import SelectedPose
from sambot_viz.displays.picking.selectable import Selectable
from sambot_viz.displays.picking.selected import SelectedData
from sambot_viz.displays.scene.points import PointNode, PointShape, PointStyle
from sambot_viz.displays.scene.ribbons import RibbonNode
from sambot_viz.displays.scene.text_node import TextNode
from sambot_viz.geometry import Matrix
from sambot_viz.meshes.glb import OPAQUE_FROM

_SHAPES: Mapping[int, PointShape] = {
    CUBE_LIST: "Boxes",
    SPHERE_LIST: "Spheres",
    POINTS: "Squares",
}


@dataclass(slots=True, eq=False)
class Shown:
    """A marker that is shown.

    Attributes:
        marker: the message.
        frame: the frame that it follows; None when it stays where it was.
        place: where the frame was; that frame itself when it follows it.
        until_ns: when it vanishes [ns]; None when it stays.
        slot: a small number that no other one has.
        is_fine: whether there was nothing to say of it.
    """

    marker: Any
    frame: str | None
    place: MarkerPose
    until_ns: int | None
    slot: int
    is_fine: bool = False


def draw_list(node: PointNode, one: Shown) -> None:
    """Draw the copies of a list, all along the axes of its pose."""
    marker = one.marker
    scale, alpha = marker.scale, 1.0
    if len(marker.colors) == len(marker.points):
        colors = rgba_of(marker.colors)
        if (colors[:, 3] == 255).all():
            colors = colors[:, :3]
    else:
        alpha = alpha_of(marker.color)
        colors = rgba_of([marker.color])
        colors = colors if alpha < OPAQUE_FROM else colors[:, :3]
    style = PointStyle(
        _SHAPES[int(marker.type)],
        (float(scale.x), float(scale.y), float(scale.z)),
        alpha,
        is_twice=True,
    )
    node.draw(points_of(marker), colors, style, *one.place.of(marker.pose))


def draw_lines(node: RibbonNode, one: Shown) -> None:
    """Draw the lines, which face the view."""
    marker = one.marker
    count = len(marker.points)
    own = len(marker.colors) == count
    wxyz, position = one.place.of(marker.pose)
    node.draw(
        points_of(marker),
        abs(float(marker.scale.x)),
        rgba_of(marker.colors) if own else np.array(rgb_of(marker.color)),
        counts=[2] * (count // 2) if int(marker.type) == LINE_LIST else None,
        alpha=1.0 if own else alpha_of(marker.color),
        wxyz=wxyz,
        position=position,
    )


def draw_text(node: TextNode, one: Shown) -> None:
    """Draw the text, which faces the view."""
    marker = one.marker
    _, position = one.place.of(marker.pose)
    node.draw(
        str(marker.text),
        float(marker.scale.z),
        rgb_of(marker.color),
        alpha=alpha_of(marker.color),
        space=float(marker.scale.x) / 2 if marker.scale.x else None,
        position=position,
    )


def selected_marker(
    item: Selectable, frame: str, one: Shown, T_fixed_above: Matrix
) -> SelectedData:
    """Return a marker as its message has it, for the Selection panel.

    Args:
        item: the marker.
        frame: of its message.
        one: the marker as it is shown.
        T_fixed_above: (4, 4), of what it hangs below.
    """
    pose = one.marker.pose
    here = T_fixed_above @ np.array([*one.place.of(pose)[1], 1.0])
    p, q = pose.position, pose.orientation
    return SelectedPose(
        f"Marker {item.name}",
        frame,
        (float(q.w), float(q.x), float(q.y), float(q.z)),
        (float(p.x), float(p.y), float(p.z)),
        here[:3],
    )
