"""All rules, in the order in which they look."""

from __future__ import annotations

from sambot_viz.checks.angles import LIMIT_IN_DEGREES, RPY_IN_DEGREES
from sambot_viz.checks.ground import WHEEL_NOT_ON_GROUND
from sambot_viz.checks.inertia import (
    INERTIA_IMPOSSIBLE,
    INERTIA_MISSING,
    INERTIA_ON_ROOT,
    MASS_ZERO,
)
from sambot_viz.checks.invisible_shapes import ALPHA_ZERO, SIZE_NOT_POSITIVE
from sambot_viz.checks.launch_text import LAUNCH_TEXT_AS_YAML
from sambot_viz.checks.macros import UNUSED_MACRO
from sambot_viz.checks.mesh_files import MESH_EMPTY, MESH_LFS_POINTER
from sambot_viz.checks.mesh_size import MESH_SIZE
from sambot_viz.checks.names import NAME_WITH_BLANK, NAMES_DIFFER_IN_CASE
from sambot_viz.checks.rule import Rule

RULES: tuple[Rule, ...] = (
    LIMIT_IN_DEGREES,
    RPY_IN_DEGREES,
    SIZE_NOT_POSITIVE,
    MESH_LFS_POINTER,
    MESH_EMPTY,
    MESH_SIZE,
    WHEEL_NOT_ON_GROUND,
    NAMES_DIFFER_IN_CASE,
    NAME_WITH_BLANK,
    UNUSED_MACRO,
    LAUNCH_TEXT_AS_YAML,
    INERTIA_ON_ROOT,
    INERTIA_MISSING,
    INERTIA_IMPOSSIBLE,
    MASS_ZERO,
    ALPHA_ZERO,
)
