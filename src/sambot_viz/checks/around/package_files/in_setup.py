"""List the rules about setup.py, in their order.

They have a separate table because most packages have no setup.py.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable

from sambot_viz.checks.around.package_files.installed import misspelt_targets
from sambot_viz.checks.around.package_files.setup_cfg import programs_elsewhere
from sambot_viz.checks.around.package_files.setup_files import (
    joined_scripts,
    missing_data_files,
    missing_entry_points,
    missing_marks,
    unfound_modules,
)
from sambot_viz.checks.around.package_files.setup_words import (
    loose_texts,
    malformed_entry_points,
    misspelt_arguments,
    quoted_names,
    texts_for_lists,
    without_name,
)
from sambot_viz.checks.around.setup_file import SetupFile
from sambot_viz.checks.around.surroundings import Surroundings
from sambot_viz.errors import Problem

IN_SETUP: tuple[Callable[[SetupFile, Surroundings], Iterable[Problem]], ...] = (
    misspelt_arguments,
    joined_scripts,
    texts_for_lists,
    loose_texts,
    quoted_names,
    without_name,
    malformed_entry_points,
    missing_data_files,
    missing_marks,
    missing_entry_points,
    unfound_modules,
    programs_elsewhere,
    misspelt_targets,
)
"""The rules; they know only the build of ROS 2 packages."""
