"""The table of all kinds of conditions. A new kind is a class and a line here."""

from __future__ import annotations

from collections.abc import Mapping

from sambot_viz.lessons.conditions.condition import Condition
from sambot_viz.lessons.conditions.files import (
    FileCondition,
    MacroCondition,
    NoErrorsCondition,
    NoProblemCondition,
    PropertyCondition,
)
from sambot_viz.lessons.conditions.gazebo import PluginCondition, SensorCondition
from sambot_viz.lessons.conditions.joints import (
    BetweenCondition,
    JointCondition,
    LinkCondition,
    RobotCondition,
    TransformCondition,
)
from sambot_viz.lessons.conditions.masses import (
    BalanceCondition,
    InertiaCondition,
    MassCondition,
)
from sambot_viz.lessons.conditions.recordings import (
    GoalCondition,
    MovedCondition,
    RecordedCondition,
)
from sambot_viz.lessons.conditions.running import (
    BridgeCondition,
    NodeCondition,
    ParameterCondition,
    StaticTransformCondition,
    TopicCondition,
)
from sambot_viz.lessons.conditions.rviz import RvizCondition
from sambot_viz.lessons.conditions.shapes import (
    CollisionCondition,
    ColorCondition,
    GroundCondition,
    ShapeCondition,
)

KINDS: Mapping[str, type[Condition]] = {
    "robot": RobotCondition,
    "link": LinkCondition,
    "joint": JointCondition,
    "transform": TransformCondition,
    "between": BetweenCondition,
    "shape": ShapeCondition,
    "color": ColorCondition,
    "collision": CollisionCondition,
    "ground": GroundCondition,
    "mass": MassCondition,
    "inertia": InertiaCondition,
    "balance": BalanceCondition,
    "property": PropertyCondition,
    "macro": MacroCondition,
    "file": FileCondition,
    "sensor": SensorCondition,
    "plugin": PluginCondition,
    "node": NodeCondition,
    "topic": TopicCondition,
    "bridge": BridgeCondition,
    "parameter": ParameterCondition,
    "static-transform": StaticTransformCondition,
    "rviz": RvizCondition,
    "recorded": RecordedCondition,
    "moved": MovedCondition,
    "goal-reached": GoalCondition,
    "no-problem": NoProblemCondition,
    "no-errors": NoErrorsCondition,
}
"""Name in the file → class."""
