"""Base of the displays that draw points: LaserScan, PointCloud2 and others."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, ClassVar

from sambot_viz.displays.data.cloud.cloud import Cloud
from sambot_viz.displays.data.cloud.cloud_properties import (
    CHANNEL,
    CLOUD_PROPERTIES,
    COORDINATES,
    INTENSITIES,
    PLACING,
    TRANSFORMER,
    color_options,
)
from sambot_viz.displays.data.cloud.colors import (
    Colors,
    bounds_of,
    colors_of,
    intensities_of,
    transformer_of,
    transformers_of,
)
from sambot_viz.displays.data.cloud.selected_points import (
    DOT,
    SelectedPoints,
    stamp_text,
)
from sambot_viz.displays.data.message_filter import MessageFilterDisplay
from sambot_viz.displays.data.topic_display import topic_property
from sambot_viz.displays.display import DisplayContext
from sambot_viz.displays.picking.placed import HERE, Placed
from sambot_viz.displays.picking.selectable import Selectable
from sambot_viz.displays.picking.selected import SelectedData
from sambot_viz.displays.scene.frame_nodes import position_of, short_id
from sambot_viz.displays.scene.points import PointNode, PointShape, PointStyle
from sambot_viz.frames import Transform
from sambot_viz.geometry import Matrix, wxyz_from_matrix
from sambot_viz.rviz import DisplayConfig, Property
from sambot_viz.sources.message import Recorded
from sambot_viz.topics.decoding import frame_and_stamp

_NS = 1_000_000_000
_LOOKS = ("Style", "Size (m)", "Size (Pixels)", "Alpha")
"""Properties that do not change the colours of points."""
POINTS = "Points"


@dataclass(slots=True)
class _Shown:
    """The points of one message.

    Attributes:
        cloud: the points.
        T_fixed_cloud: (4, 4), where they are drawn.
        came_ns: when they came [ns].
        node: draws them.
        colors: of each point.
        item: what they are to a selection.
        frame: in which the points are given.
        stamp_ns: of their message [ns]; None for the latest time.
        drawn: the colours and the style that they were drawn with last.
    """

    cloud: Cloud
    T_fixed_cloud: Matrix
    came_ns: int
    node: PointNode
    colors: Colors
    item: Selectable
    frame: str
    stamp_ns: int | None
    drawn: tuple[Colors, PointStyle] | None = None

    def draw(self, style: PointStyle) -> None:
        """Draw the points, unless they look like that already."""
        if self.drawn is not None and not self.node.is_gone:
            colors, before = self.drawn
            if colors is self.colors and before == style:
                return
        T = self.T_fixed_cloud
        place = wxyz_from_matrix(T), position_of(T)
        self.node.draw(self.cloud.points, self.colors, style, *place)
        self.drawn = self.colors, style


class CloudDisplay(MessageFilterDisplay[None]):
    """Draws the points of messages, of the newest one or of some seconds."""

    properties: ClassVar[tuple[Property, ...]] = (topic_property(), *CLOUD_PROPERTIES)
    points_of: ClassVar[Callable[[Any], Cloud]]
    """Reads the points of a message; for those that need no more than that."""
    in_fixed_frame: ClassVar[bool] = False
    """Whether its points are those in the fixed frame, not in that of the message."""

    def __init__(self, context: DisplayContext, config: DisplayConfig, key: str):
        """Make the display; nothing is drawn before `draw`."""
        super().__init__(context, config, key)
        self._clouds: list[_Shown] = []
        self._made = self._taken = 0

    def cloud_of(self, message: Any, T_fixed_frame: Transform) -> tuple[Cloud, Matrix]:
        """Return the points of a message, and the pose they are drawn at.

        Args:
            message: with its fields.
            T_fixed_frame: the pose of its frame in the fixed frame.

        Raises:
            MessageRefused: its points cannot be drawn.
        """
        return type(self).points_of(message), T_fixed_frame.matrix

    @property
    def needs_last_only(self) -> bool:
        """Whether points do not stay for some time."""
        return self._decay_s == 0.0

    @property
    def depth_s(self) -> float:
        """How far back points count after a jump in a recording [s]."""
        return max(1.0, self._decay_s)

    @property
    def _decay_s(self) -> float:
        return float(self.config.get("Decay Time"))

    def process(self, message: Any, T_fixed_frame: Transform, came: Recorded) -> None:
        """Take the points of a message."""
        cloud, T_fixed_cloud = self.cloud_of(message, T_fixed_frame)
        last_only = self.needs_last_only
        if last_only and self._clouds:
            # The same node gets other points.
            node = self._clouds.pop().node
            self._remove_clouds()
        else:
            self._made += 1
            name = f"/{self.key}p{short_id(self._made)}"
            node = PointNode(self.context.scene, name)
        self._choose_transformers(cloud)
        colors = colors_of(cloud, color_options(self.config), T_fixed_cloud)
        self._taken += 1
        item = Selectable("points", self.config.name, f"{self.key}/{self._taken}")
        frame, stamp_ns = frame_and_stamp(message)
        if self.in_fixed_frame:
            frame = self.context.fixed_frame
        shown = _Shown(
            cloud, T_fixed_cloud, came.log_ns, node, colors, item, frame, stamp_ns
        )
        self._clouds.append(shown)

    def _choose_transformers(self, cloud: Cloud) -> None:
        """Take RViz's choice where none is made."""
        self.config.assume(PLACING, "XYZ")
        chosen = transformer_of(cloud, str(self.config.get(TRANSFORMER)))
        self.config.assume(TRANSFORMER, chosen)

    def show_taken(self) -> None:
        """Draw the points whose look has changed, and drop points that are too old."""
        if not self._clouds:
            return
        self._let_decay()
        style = self.style()
        for shown in self._clouds:
            shown.draw(style)

    def placed(self) -> Iterator[Placed]:
        """Yield the points for rays."""
        for shown in self._clouds:
            if self.config.get("Selectable"):
                numbers = shown.cloud.numbers
                yield from shown.node.placed(HERE, shown.item, numbers)
            else:
                yield from shown.node.placed(HERE, None)

    def selected(self, item: Selectable) -> SelectedData | None:
        """Return the points of a message, while they are shown."""
        for shown in self._clouds:
            if shown.item == item and self.config.get("Selectable"):
                style = self.style()
                is_dot = style.shape == "Points"
                return SelectedPoints(
                    shown.cloud,
                    shown.T_fixed_cloud,
                    self.config.name,
                    shown.frame,
                    (("Topic", self.topic), ("Stamp", stamp_text(shown.stamp_ns))),
                    DOT if is_dot else style.size[0],
                    style.is_by_depth and not is_dot,
                )
        return None

    def drop(self) -> None:
        """Take all points out of the scene."""
        self._remove_clouds()
        self.status.remove(POINTS)

    def property_changed(self, path: str) -> None:
        """Colour the points again, where that is what has changed."""
        if self.shown and path not in _LOOKS:
            options = color_options(self.config)
            for shown in self._clouds:
                shown.colors = colors_of(shown.cloud, options, shown.T_fixed_cloud)
        super().property_changed(path)

    def time_passed(self) -> None:
        """Let points vanish after their time."""
        super().time_passed()
        if self.shown:
            self._let_decay()

    def options(self) -> Mapping[str, Sequence[str]]:
        """Return the topics, and what the points have fields for."""
        options = dict(super().options())
        if self._clouds:
            cloud = self._clouds[-1].cloud
            options[TRANSFORMER] = transformers_of(cloud)
            options[CHANNEL] = sorted((*"xyz", *cloud.fields))
        return options

    def notes(self) -> Mapping[str, str]:
        """Return how the points are coloured, where that is not what was set."""
        if not self._clouds:
            return super().notes()
        wanted = str(self.config.get(TRANSFORMER))
        shown = self._clouds[-1]
        cloud = shown.cloud
        chosen = transformer_of(cloud, wanted)
        if chosen != wanted:
            return {TRANSFORMER: f"{chosen}, by the fields of the points"}
        channel = str(self.config.get(CHANNEL))
        if chosen == "Intensity" and intensities_of(cloud, channel) is None:
            *others, last = sorted({*"xyz", *cloud.fields})
            known = f"they have {', '.join(others)} and {last}"
            return {CHANNEL: f"The points have no {channel}, so all are white; {known}"}
        bounds = bounds_of(cloud, color_options(self.config), shown.T_fixed_cloud)
        if bounds is None:
            return {}
        low, high = bounds
        path = COORDINATES if chosen == "AxisColor" else INTENSITIES
        unit = " m" if chosen == "AxisColor" else ""
        return {path: f"From {low:.6g} to {high:.6g}{unit}"}

    def style(self) -> PointStyle:
        """Return how all points look."""
        get = self.config.get
        shape: PointShape = self.config.acting("Style")
        edge = float(get("Size (Pixels)" if shape == "Points" else "Size (m)"))
        return PointStyle(shape, (edge, edge, edge), float(get("Alpha")))

    def _let_decay(self) -> None:
        messages, decay = self.context.messages, self._decay_s
        if messages is not None and decay > 0.0:
            oldest = messages.now_ns(self.topic) - round(decay * _NS)
            while self._clouds and self._clouds[0].came_ns < oldest:
                self._clouds.pop(0).node.remove()
        count = sum(len(shown.cloud.points) for shown in self._clouds)
        text = f"Showing [{count}] points from [{len(self._clouds)}] messages"
        self.status.set(POINTS, "Ok", text)

    def _remove_clouds(self) -> None:
        for shown in self._clouds:
            shown.node.remove()
        self._clouds.clear()
