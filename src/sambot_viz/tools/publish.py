"""The tools that send something to a robot: RViz's three, and Nav2's.

A press gives the place, and dragging from there the heading, on the ground of the fixed
frame. Without a drag RViz sends the heading of the last gesture; here nothing is sent.
"""

from __future__ import annotations

import math
from typing import Any, ClassVar

import numpy as np

from sambot_viz.displays.picking.rays import Array
from sambot_viz.displays.picking.selectable import Hit
from sambot_viz.displays.scene.solid_nodes import ArrowsNode
from sambot_viz.publishing.outbound import (
    COVARIANCE,
    GOAL_TOPIC,
    ClickedPoint,
    Goal,
    NavGoal,
    Outbound,
    PoseEstimate,
)
from sambot_viz.rviz import (
    BoolProperty,
    FloatProperty,
    Property,
    ToolConfig,
    TopicProperty,
)
from sambot_viz.tools.tool import Click, Tool, ToolContext

SHAFT, HEAD = (2.0, 0.2), (0.5, 0.35)
"""Length and diameter of the parts of RViz's arrow [m]."""
GREEN = (0, 255, 0)
FLATTEST = 0.0175
"""The smallest angle [rad] at which a point of the ground can be meant."""
SHORTEST = 0.01
"""A drag shorter than this part of the camera's distance has no heading."""
_DRAG = "Drag from the place towards the heading; Esc or a right click stops."
_FINGER = "Drag from the place towards the heading; a second finger stops."


def _topic(default: str) -> TopicProperty:
    return TopicProperty("Topic", default=default, help="Where it is sent.")


class PublishTool(Tool):
    """A tool that sends messages of one kind on the topic of its properties."""

    sends = True
    message: ClassVar[type[Outbound]]

    @property
    def topic(self) -> str:
        """Where it sends, as an absolute name."""
        return f"/{str(self.value('Topic')).strip().lstrip('/')}"

    def value(self, name: str) -> Any:
        """Return one of its settings."""
        if self.config is not None:
            return self.config.get(name)
        return next(one.default for one in self.properties if one.name == name)

    def chosen(self) -> None:
        """Announce the topic to the robot, and report what prevents sending."""
        self.context.show_status(self.context.publish_refusal(self.message.kind))
        self.property_changed()

    def property_changed(self) -> None:
        """Let the robot know of another topic."""
        kind, type_name = self.message.kind, self.message.type_name
        self.context.prepare(kind, self.topic, type_name)


class PoseTool(PublishTool):
    """Sends a place and a heading that are drawn with one drag."""

    touch = _FINGER
    drags = True
    takes_pose = True

    def __init__(self, context: ToolContext, config: ToolConfig | None) -> None:
        """Nothing is drawn at first."""
        super().__init__(context, config)
        self._start: Array | None = None
        self._yaw: float | None = None
        self._arrow: ArrowsNode | None = None

    def aim(self, begin: Click, click: Click) -> None:
        """Begin at what was pressed, and turn to where the pointer is now."""
        if self._start is None:
            self._start = _on_ground(begin)
        point = _on_ground(click)
        if point is None or self._start is None:
            return
        x, y = (point - self._start)[:2].tolist()
        far = abs(float(click.origin[2])) + math.hypot(*(point - click.origin)[:2])
        self._yaw = math.atan2(y, x) if math.hypot(x, y) > SHORTEST * far else None
        self._draw()

    def place(self, x: float, y: float, yaw: float, *, sends: bool) -> None:
        """Show a pose, or send it and leave the tool."""
        if sends:
            self.cancel()
            made = self.pose(self.context.fixed_frame, x, y, yaw)
            self.context.publish(made, self.topic)
            return
        self._start, self._yaw = np.array([x, y, 0.0]), yaw
        self._draw()

    def drop(self, begin: Click, click: Click) -> None:
        """Send the pose, if it has a heading; then the tool is left, as in RViz."""
        self.aim(begin, click)
        start, yaw = self._start, self._yaw
        self.cancel()
        if start is None:
            self.context.show_status(
                f"There is no ground; nothing was sent. {self.help}"
            )
        elif yaw is None:
            self.context.show_status(f"Nothing was sent without a heading. {self.help}")
        else:
            x, y = start[:2].tolist()
            made = self.pose(self.context.fixed_frame, x, y, yaw)
            self.context.publish(made, self.topic)

    def pose(self, frame: str, x: float, y: float, yaw: float) -> Outbound:
        """Return the message for a place [m] and a heading [rad]."""
        raise NotImplementedError

    def left(self) -> None:
        """Take the arrow away."""
        self.cancel()

    def cancel(self) -> None:
        """Forget what was drawn; nothing is sent."""
        self._start = self._yaw = None
        if self._arrow is not None:
            self._arrow.remove()

    def _draw(self) -> None:
        if self._start is None or self._yaw is None:
            return
        if self._arrow is None:
            self._arrow = ArrowsNode(self.context.scene, "/~pose")
        half = self._yaw / 2.0
        turn = (math.cos(half), 0.0, 0.0, math.sin(half))
        self._arrow.draw([turn], [self._start], SHAFT, HEAD, GREEN)


class SetGoalTool(PoseTool):
    """2D Goal Pose: where the robot is to go."""

    kind = "rviz_default_plugins/SetGoal"
    label = "2D Goal Pose"
    key = "G"
    help = _DRAG
    message = Goal
    properties: ClassVar[tuple[Property, ...]] = (_topic("goal_pose"),)

    def pose(self, frame: str, x: float, y: float, yaw: float) -> Outbound:
        """Return the goal."""
        return Goal(frame, x, y, yaw)


class NavGoalTool(SetGoalTool):
    """Nav2's own tool, which sends the same goal to its action."""

    kind = "nav2_rviz_plugins/GoalTool"
    label = "Nav2 Goal"
    only_listed = True
    message = NavGoal
    properties = ()

    def pose(self, frame: str, x: float, y: float, yaw: float) -> Outbound:
        """Return the goal."""
        return NavGoal(frame, x, y, yaw)

    @property
    def topic(self) -> str:
        """Where Nav2 takes goals."""
        return GOAL_TOPIC


class SetInitialPoseTool(PoseTool):
    """2D Pose Estimate: where the robot is."""

    kind = "rviz_default_plugins/SetInitialPose"
    label = "2D Pose Estimate"
    key = "P"
    help = _DRAG
    message = PoseEstimate
    properties = (
        _topic("initialpose"),
        *(
            FloatProperty(
                f"Covariance {name}",
                default=value,
                minimum=0.0,
                unit=unit,
                help=f"How uncertain {what} is.",
            )
            for name, value, unit, what in zip(
                ("x", "y", "yaw"),
                COVARIANCE,
                ("m²", "m²", "rad²"),
                ("x", "y", "the heading"),
                strict=True,
            )
        ),
    )

    def pose(self, frame: str, x: float, y: float, yaw: float) -> Outbound:
        """Return the estimate, with the covariance of the properties."""
        a, b, c = (float(self.value(f"Covariance {one}")) for one in ("x", "y", "yaw"))
        return PoseEstimate(frame, x, y, yaw, (a, b, c))


class PublishPointTool(PublishTool):
    """Publish Point: the point that is clicked on, of whatever is there."""

    kind = "rviz_default_plugins/PublishPoint"
    label = "Publish Point"
    key = "U"
    help = "Click a point of what is shown; Esc stops."
    touch = "Tap a point of what is shown."
    message = ClickedPoint
    clicks = True
    properties = (
        BoolProperty(
            "Single click", default=True, help="Whether one click leaves the tool."
        ),
        _topic("/clicked_point"),
    )

    @property
    def wants_hover(self) -> bool:
        """Whether it follows the mouse: the status shows the point under it."""
        return True

    def hover(self, click: Click, hit: Hit) -> None:
        """Say the point under the mouse, as RViz does."""
        del click
        if hit.point is not None:
            x, y, z = hit.point.tolist()
            frame = self.context.fixed_frame
            self.context.show_status(f"{x:.3f}, {y:.3f}, {z:.3f} [{frame}]")

    def click(self, click: Click, hit: Hit) -> None:
        """Send the point; with nothing under the mouse there is none."""
        del click
        if hit.point is None:
            self.context.show_status(f"Nothing is there to click on. {self.help}")
            return
        x, y, z = hit.point.tolist()
        made = ClickedPoint(self.context.fixed_frame, x, y, z)
        self.context.publish(made, self.topic, leave=bool(self.value("Single click")))


def _on_ground(click: Click) -> Array | None:
    """Return where a ray meets z = 0, (3,) [m]; None where it does not."""
    down = float(click.direction[2])
    if abs(down) < FLATTEST:
        return None
    reach = -float(click.origin[2]) / down
    return click.origin + reach * click.direction if reach > 0.0 else None
