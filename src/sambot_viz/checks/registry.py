"""All rules, in the order in which they run."""

from __future__ import annotations

from sambot_viz.checks.angles import limits_in_degrees, rpy_in_degrees
from sambot_viz.checks.ground import wheels_off_the_ground
from sambot_viz.checks.inertia import (
    impossible_inertia,
    inertia_on_root,
    missing_inertia,
    zero_mass,
)
from sambot_viz.checks.invisible_shapes import invisible_materials, sizes_not_positive
from sambot_viz.checks.launch_text import launch_text_as_yaml
from sambot_viz.checks.macros import unused_macros
from sambot_viz.checks.mesh_files import unusable_meshes
from sambot_viz.checks.mesh_size import meshes_of_wrong_size
from sambot_viz.checks.names import names_that_differ_in_case, names_with_spaces
from sambot_viz.checks.rule import Rule

RULES: tuple[Rule, ...] = (
    limits_in_degrees,
    rpy_in_degrees,
    sizes_not_positive,
    unusable_meshes,
    meshes_of_wrong_size,
    wheels_off_the_ground,
    names_that_differ_in_case,
    names_with_spaces,
    unused_macros,
    launch_text_as_yaml,
    inertia_on_root,
    missing_inertia,
    impossible_inertia,
    zero_mass,
    invisible_materials,
)
