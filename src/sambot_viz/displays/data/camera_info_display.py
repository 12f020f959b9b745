"""CameraInfo: the field of view of a camera, as a pyramid from its eye."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from sambot_viz.displays.data.display_node import DisplayNode
from sambot_viz.displays.data.image.camera_info import projection_of
from sambot_viz.displays.data.kept import Taken
from sambot_viz.displays.data.message_filter import MessageFilterDisplay
from sambot_viz.displays.data.message_numbers import Floats, require_finite
from sambot_viz.displays.data.refused_messages import MessageRefused
from sambot_viz.displays.data.topic_display import topic_property
from sambot_viz.displays.picking.placed import PlacedMesh
from sambot_viz.displays.picking.selectable import Selectable
from sambot_viz.displays.picking.triangle_mesh import TriangleMesh
from sambot_viz.displays.scene.glb_node import GlbNode, drawn_glb, rgba_rows, single
from sambot_viz.displays.scene.ribbons import RibbonNode
from sambot_viz.geometry import Matrix
from sambot_viz.meanings import Meaning
from sambot_viz.meshes.glb import OPAQUE_FROM
from sambot_viz.rviz import BoolProperty, ColorProperty, FloatProperty

STATUS = "Camera Info"
_EDGE_WIDTH = 0.01
_EDGES = np.array([(0, 1), (0, 2), (0, 3), (0, 4), (1, 2), (2, 3), (3, 4), (4, 1)])
_SIDES = np.array([(0, 2, 1), (0, 3, 2), (0, 4, 3), (0, 1, 4)])
"""Of the eye, 0, and the four corners."""


class _SidesNode(GlbNode):
    """The sides of a pyramid, seen through from both sides."""

    corners: npt.NDArray[np.float32]
    """Those that were drawn last, three of each side, (N, 3) [m]."""

    def placed(
        self, T_fixed_above: Matrix, item: Selectable | None
    ) -> Iterator[PlacedMesh]:
        """Yield the sides for rays (see `scene.points.PointNode.placed`)."""
        if self.is_drawn:
            faces = np.reshape(np.arange(len(self.corners)), (-1, 3))
            sides = TriangleMesh.of(self.corners, faces).both_sides()
            yield PlacedMesh(item, sides, self.place(T_fixed_above), is_clear=True)


class CameraInfoDisplay(MessageFilterDisplay[Floats]):
    """The corners of the image of sensor_msgs/CameraInfo, seen from the camera."""

    kind = "rviz_default_plugins/CameraInfo"
    meanings = frozenset({Meaning.CAMERA})
    properties = (
        topic_property(),
        FloatProperty(
            "Far clip", default=1.0, unit="m", help="How far the base is from the eye."
        ),
        BoolProperty("Show edges", default=True, help="Draw the eight edges."),
        BoolProperty(
            "Show polygons",
            default=True,
            help="Draw the four sides, unless Not show side polygons leaves them out.",
        ),
        BoolProperty(
            "Not show side polygons",
            default=True,
            help="Leave the sides out; as in RViz nothing else has an area.",
            hidden_unless=("Show polygons", True),
        ),
        ColorProperty("Color", default=(85, 255, 255), help="The colour of the sides."),
        ColorProperty(
            "Edge color", default=(125, 125, 125), help="The colour of the edges."
        ),
        FloatProperty("Alpha", default=0.5, help="How opaque edges and sides are."),
    )
    _edges = DisplayNode(RibbonNode, "e")
    _sides = DisplayNode(_SidesNode, "s")

    def read(self, message: Any) -> Floats:
        """Return the corners of the image at a depth of 1 m, (4, 3) [m].

        A message that is wrong has none, (0, 3), and leaves nothing of the one before.
        """
        try:
            found = corners_of(message)
            require_finite(single(found).ravel().tolist())
        except MessageRefused as refused:
            self.status.set(STATUS, "Error", refused.text, refused.code)
            return np.zeros((0, 3))
        self.status.set(STATUS, "Ok", "OK")
        return found

    def draw_kept(self, kept: Sequence[Taken[Floats]]) -> None:
        """Draw the pyramid as it looks now."""
        read, (wxyz, position) = kept[-1].read, kept[-1].pose
        if not len(read):
            self.remove()
            return
        get = self.config.get
        at = single(np.vstack([np.zeros(3), read * float(get("Far clip"))]))
        alpha = min(max(float(get("Alpha")), 0.0), 1.0)
        if get("Show edges"):
            self._edges.draw(
                at[_EDGES.ravel()],
                _EDGE_WIDTH,
                get("Edge color"),
                counts=[2] * len(_EDGES),
                alpha=alpha,
                wxyz=wxyz,
                position=position,
            )
        else:
            self._edges.remove()
        if get("Show polygons") and not get("Not show side polygons"):
            corners = at[_SIDES.ravel()]
            rgba = rgba_rows(get("Color"), alpha, len(corners))
            drawn = {"POSITION": corners, "COLOR_0": rgba}
            blended = alpha < OPAQUE_FROM
            self._sides.corners = corners
            self._sides.show(
                (corners, rgba),
                lambda: drawn_glb("triangles", drawn, blended=blended),
                wxyz,
                position,
            )
        else:
            self._sides.remove()

    def drop(self) -> None:
        """Take the pyramid out of the scene, and forget the message."""
        super().drop()
        self.status.remove(STATUS)


def corners_of(message: Any) -> Floats:
    """Return the corners of the image of a camera at a depth of 1 m, (4, 3) [m].

    As in RViz they are those of an image without distortion, in pixels of the binned
    region of interest, which is taken to begin at the corner of the whole image.

    Args:
        message: a sensor_msgs/CameraInfo; of ROS 1, where P has a capital, too.

    Raises:
        MessageRefused: its focal lengths are 0.
    """
    P = np.reshape(np.array(projection_of(message), np.float64), (3, 4))
    if P[0, 0] == 0.0 or P[1, 1] == 0.0:
        raise MessageRefused("Invalid intrinsic matrix")
    region = message.roi
    width = int(region.width or message.width) // max(1, int(message.binning_x))
    height = int(region.height or message.height) // max(1, int(message.binning_y))
    pixels = np.array([(0, 0), (width, 0), (width, height), (0, height)])
    with np.errstate(over="ignore"):
        at = (pixels - P[:2, 2] - P[:2, 3]) / (P[0, 0], P[1, 1])
    return np.column_stack([at, np.ones(4)])
