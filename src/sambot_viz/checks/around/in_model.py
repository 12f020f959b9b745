"""List the rules that need only the model, in their order.

They have a separate table because a model without a package needs no others: importing
those costs more than the check itself.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable

from sambot_viz.checks.around.control.copied import control_twice, joints_twice
from sambot_viz.checks.around.control.words import words_of_control
from sambot_viz.checks.around.gazebo.classic_plugins import (
    outside_of_sensors,
    unknown_libraries,
    words_of_plugins,
)
from sambot_viz.checks.around.gazebo.drives import misspelt_elements, wrong_sides
from sambot_viz.checks.around.gazebo.plugin_parts import (
    plugins_of_links,
    words_in_plugins,
)
from sambot_viz.checks.around.gazebo.sensors import (
    frames_of_sensors,
    lidars_of_the_other,
    misspelt_frames,
    sensor_values,
    sensors_twice,
    sensors_without_link,
    unknown_types,
)
from sambot_viz.checks.around.gazebo.systems import (
    both_generations,
    malformed_values,
    unknown_systems,
)
from sambot_viz.checks.around.gazebo.wheels import wheel_sizes
from sambot_viz.checks.around.joint_names import (
    unknown_joints,
    unknown_references,
)
from sambot_viz.errors import Problem
from sambot_viz.robot.model import Robot

IN_MODEL: tuple[Callable[[Robot], Iterable[Problem]], ...] = (
    unknown_joints,
    joints_twice,
    unknown_references,
    wheel_sizes,
    wrong_sides,
    misspelt_elements,
    both_generations,
    unknown_systems,
    malformed_values,
    sensors_without_link,
    unknown_types,
    lidars_of_the_other,
    sensor_values,
    sensors_twice,
    misspelt_frames,
    frames_of_sensors,
    unknown_libraries,
    outside_of_sensors,
    plugins_of_links,
    words_in_plugins,
    words_of_plugins,
    words_of_control,
    control_twice,
)
"""The rules."""

IN_MODEL_OF_ROS2: frozenset[Callable[[Robot], Iterable[Problem]]] = frozenset(
    {
        misspelt_elements,
        both_generations,
        unknown_systems,
        lidars_of_the_other,
        unknown_libraries,
        words_of_plugins,
    }
)
"""The rules that know only what Gazebo for ROS 2 reads."""
