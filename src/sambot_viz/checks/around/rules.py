"""List the rules about a model and the files around it, in their order.

The rules that need only the model are in `in_model.py`, the rules about setup.py in
`in_setup.py`.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable

from sambot_viz.checks.around.compiled import unusable_python
from sambot_viz.checks.around.control.controllers import (
    options_without_value,
    undeclared_controllers,
    unknown_controllers,
)
from sambot_viz.checks.around.control.interfaces import unfit_interfaces
from sambot_viz.checks.around.frames.names import (
    moved_twice,
    odometry_frames,
    planes,
    two_parents,
    unknown_frames,
    world_frames,
)
from sambot_viz.checks.around.frames.odometry import (
    frames_from_themselves,
    shared_frames,
    unpublished_odometry,
)
from sambot_viz.checks.around.gazebo.both import started_twice, variables_of_the_other
from sambot_viz.checks.around.gazebo.drives import wrong_sides_of_controllers
from sambot_viz.checks.around.gazebo.generations import (
    elements_of_the_other,
    hardware_of_the_other,
    plugins_of_the_other,
    xacro_py,
)
from sambot_viz.checks.around.gazebo.spawned_into import spawned_into
from sambot_viz.checks.around.gazebo.wheels import wheel_sizes_of_controllers
from sambot_viz.checks.around.gazebo.world_systems import (
    missing_systems,
    plugins_of_worlds,
    unreadable_worlds,
)
from sambot_viz.checks.around.gazebo.world_values import (
    models_of_classic,
    numbers_of_worlds,
    planes_that_fall,
    suns_from_below,
    values_of_worlds,
)
from sambot_viz.checks.around.joint_names import joints_of_controllers
from sambot_viz.checks.around.launch_files.arguments import undeclared_arguments
from sambot_viz.checks.around.launch_files.braces import missing_prefixes
from sambot_viz.checks.around.launch_files.called_modules import (
    called_modules,
    members_as_modules,
)
from sambot_viz.checks.around.launch_files.calls import (
    calls_without_argument,
    files_without_folder,
    paths_from_the_root,
    paths_of_no_text,
    sets_for_dicts,
)
from sambot_viz.checks.around.launch_files.choices import misspelt_truths, other_words
from sambot_viz.checks.around.launch_files.code import (
    empty_launch_files,
    missing_commas,
    missing_entries,
    unknown_names,
)
from sambot_viz.checks.around.launch_files.conditions import (
    bare_conditions,
    joined_conditions,
    plain_conditions,
)
from sambot_viz.checks.around.launch_files.containers import unknown_containers
from sambot_viz.checks.around.launch_files.events import (
    handlers_that_wait,
    periods,
    plain_handlers,
    texts_for_actions,
)
from sambot_viz.checks.around.launch_files.expressions import (
    uncomputable_expressions,
)
from sambot_viz.checks.around.launch_files.imports import wrong_imports
from sambot_viz.checks.around.launch_files.includes import (
    includes_without_argument,
    misplaced_includes,
)
from sambot_viz.checks.around.launch_files.joins import (
    joined_paths,
    joined_texts,
    joined_words,
    several_words,
)
from sambot_viz.checks.around.launch_files.kinds import (
    arguments_without_list,
    lists_of_actions,
    misspelt_time,
    plain_substitutions,
    remappings_without_pairs,
    reversed_remappings,
)
from sambot_viz.checks.around.launch_files.managed import unmanaged_nodes
from sambot_viz.checks.around.launch_files.members import (
    misspelt_members,
    names_before_values,
)
from sambot_viz.checks.around.launch_files.nodes import (
    described_in_xml,
    descriptions,
    namespaces,
    rviz_without_option,
    state_publishers,
)
from sambot_viz.checks.around.launch_files.options import unknown_options
from sambot_viz.checks.around.launch_files.order import late_declarations
from sambot_viz.checks.around.launch_files.parameters import launched_parameters
from sambot_viz.checks.around.launch_files.paths import (
    missing_files,
    missing_plugin_files,
    misspelt_endings,
)
from sambot_viz.checks.around.launch_files.processes import (
    started_again,
    targets_without_process,
)
from sambot_viz.checks.around.launch_files.programs import unknown_programs
from sambot_viz.checks.around.launch_files.substitutions import (
    substitutions_for_texts,
    substitutions_in_python,
)
from sambot_viz.checks.around.launch_files.text_values import (
    arguments_that_are_no_texts,
)
from sambot_viz.checks.around.launch_files.uses import (
    bridges_as_parameters,
    spawned_topics,
    times_as_text,
    unused_actions,
)
from sambot_viz.checks.around.launch_files.words import (
    unknown_commands,
    unknown_elements_of_launch,
    unknown_keywords,
)
from sambot_viz.checks.around.launch_files.worlds import world_names
from sambot_viz.checks.around.package_files.build_file import (
    commands_after_the_end,
    folders_as_files,
    malformed_installs,
    missing_commands,
    missing_folders,
    misspelt_keywords,
    project_name,
    unreadable_cmake,
)
from sambot_viz.checks.around.package_files.dependencies import (
    missing_dependencies,
    misspelt_dependencies,
    misspelt_packages,
    packages_of_ros1,
)
from sambot_viz.checks.around.package_files.found_packages import unfound_packages
from sambot_viz.checks.around.package_files.installed import not_installed
from sambot_viz.checks.around.package_files.manifest import (
    build_types,
    incomplete_manifest,
    unreadable_manifest,
)
from sambot_viz.checks.around.package_files.manifest_words import (
    malformed_values,
    unknown_elements,
)
from sambot_viz.checks.around.package_files.named_files import (
    missing_named_files,
    unknown_targets,
)
from sambot_viz.checks.around.package_files.own_names import (
    misspelt_shares,
    setup_name,
    unknown_packages,
)
from sambot_viz.checks.around.parameters.copied_inputs import copied_inputs
from sambot_viz.checks.around.parameters.files import unreadable_parameters
from sambot_viz.checks.around.parameters.filter_inputs import (
    gaps_in_numbers,
    inputs_without_config,
    values_without_source,
)
from sambot_viz.checks.around.parameters.footprint import (
    footprints,
    unreadable_footprints,
)
from sambot_viz.checks.around.parameters.layers import (
    inflation_before_layers,
    inflation_too_large,
    inflation_too_small,
    still_costmaps,
)
from sambot_viz.checks.around.parameters.levels import (
    lines_at_other_levels,
    values_beside_parameters,
)
from sambot_viz.checks.around.parameters.maps import (
    images_for_maps,
    maps_that_do_not_load,
)
from sambot_viz.checks.around.parameters.names import (
    unknown_parameters,
    unknown_plugins,
)
from sambot_viz.checks.around.parameters.nav2_sections import (
    misspelt_nodes,
    odd_clocks,
    unread_sections,
)
from sambot_viz.checks.around.parameters.node_parameters import (
    parameters_left_out,
    unread_parameters,
)
from sambot_viz.checks.around.parameters.sections import unknown_sections
from sambot_viz.checks.around.parameters.slips import (
    incomplete_nodes,
    parameters_of_nobody,
    texts_for_values,
)
from sambot_viz.checks.around.parameters.values import wrong_values
from sambot_viz.checks.around.surroundings import Surroundings
from sambot_viz.checks.around.topics.bridge_files import (
    empty_parameters,
    entries_outside_lists,
    entries_without_type,
    misspelt_entries,
    second_documents,
)
from sambot_viz.checks.around.topics.bridge_types import (
    bridge_types,
    topics_of_other_types,
    unknown_bridge_types,
    wrong_data_types,
)
from sambot_viz.checks.around.topics.bridges import (
    bridge_directions,
    bridge_topics,
    scoped_frames,
)
from sambot_viz.checks.around.topics.clocks import clock_not_bridged, different_clocks
from sambot_viz.checks.around.topics.display_values import unusable_values
from sambot_viz.checks.around.topics.display_words import (
    robots_without_source,
    switched_off,
    unknown_frames_of_views,
    unknown_settings,
)
from sambot_viz.checks.around.topics.displays import unseen_topics
from sambot_viz.checks.around.topics.ends import (
    exchanged_relays,
    topics_of_oneself,
    unheard_commands,
)
from sambot_viz.checks.around.topics.joint_states import (
    no_joint_states,
    unheard_joint_states,
    unsent_joint_states,
)
from sambot_viz.checks.around.topics.read import unknown_topics
from sambot_viz.checks.around.topics.shared import shared_topics
from sambot_viz.checks.around.topics.stamped import ends_of_other_types
from sambot_viz.checks.around.unreadable import (
    joined_entries,
    missing_key,
    misspelt_key,
    unreadable_launch_files,
    unreadable_models,
    unreadable_python,
    unreadable_yaml,
    unreadable_yaml_launches,
)
from sambot_viz.errors import Problem

Check = Callable[[Surroundings], Iterable[Problem]]
"""A rule about packages."""

OF_BUILD: tuple[Check, ...] = (
    unreadable_models,
    unreadable_cmake,
    unreadable_manifest,
    incomplete_manifest,
    misspelt_dependencies,
    missing_dependencies,
    unknown_elements,
    malformed_values,
    packages_of_ros1,
    misspelt_packages,
    build_types,
    misspelt_keywords,
    missing_commands,
    unfound_packages,
    commands_after_the_end,
    folders_as_files,
    malformed_installs,
    setup_name,
    xacro_py,
    project_name,
    missing_folders,
    missing_named_files,
    unknown_targets,
    not_installed,
)
"""The rules about the build and the installation of one package at a time."""

OF_FILES: tuple[Check, ...] = (
    unreadable_yaml,
    joined_entries,
    second_documents,
    entries_outside_lists,
    entries_without_type,
    misspelt_entries,
    empty_parameters,
    missing_key,
    misspelt_key,
    parameters_of_nobody,
    values_beside_parameters,
    lines_at_other_levels,
    texts_for_values,
    incomplete_nodes,
    images_for_maps,
    maps_that_do_not_load,
    wrong_values,
    unreadable_parameters,
    unknown_parameters,
    unknown_plugins,
    unknown_sections,
    inflation_before_layers,
    inflation_too_large,
    inflation_too_small,
    still_costmaps,
    unreadable_footprints,
    unread_sections,
    misspelt_nodes,
    odd_clocks,
    unreadable_python,
    unusable_python,
    unreadable_launch_files,
    unreadable_yaml_launches,
    empty_launch_files,
    missing_entries,
    wrong_imports,
    unknown_names,
    called_modules,
    members_as_modules,
    misspelt_members,
    names_before_values,
    missing_commas,
    unknown_keywords,
    unknown_commands,
    unknown_options,
    other_words,
    misspelt_truths,
    unknown_elements_of_launch,
    arguments_that_are_no_texts,
    calls_without_argument,
    sets_for_dicts,
    substitutions_for_texts,
    substitutions_in_python,
    paths_from_the_root,
    paths_of_no_text,
    files_without_folder,
    arguments_without_list,
    remappings_without_pairs,
    reversed_remappings,
    bare_conditions,
    joined_conditions,
    plain_conditions,
    uncomputable_expressions,
    lists_of_actions,
    plain_substitutions,
    joined_texts,
    missing_prefixes,
    several_words,
    joined_paths,
    handlers_that_wait,
    texts_for_actions,
    targets_without_process,
    started_again,
    plain_handlers,
    periods,
    misspelt_time,
    descriptions,
    described_in_xml,
    rviz_without_option,
    parameters_left_out,
    state_publishers,
    namespaces,
    unused_actions,
    undeclared_arguments,
    late_declarations,
    unknown_containers,
    unmanaged_nodes,
    includes_without_argument,
    misplaced_includes,
    unknown_programs,
    unknown_packages,
    misspelt_shares,
    no_joint_states,
    bridges_as_parameters,
    joined_words,
    times_as_text,
    launched_parameters,
    spawned_topics,
    planes,
    world_frames,
    shared_frames,
    frames_from_themselves,
    copied_inputs,
    inputs_without_config,
    values_without_source,
    gaps_in_numbers,
    ends_of_other_types,
    topics_of_oneself,
    unheard_commands,
    exchanged_relays,
    unknown_bridge_types,
    different_clocks,
    started_twice,
    variables_of_the_other,
    missing_files,
    misspelt_endings,
    unread_parameters,
    unknown_settings,
    unusable_values,
    switched_off,
    unknown_frames_of_views,
    options_without_value,
    undeclared_controllers,
    unknown_controllers,
    world_names,
    unreadable_worlds,
    plugins_of_worlds,
    values_of_worlds,
    numbers_of_worlds,
    planes_that_fall,
    spawned_into,
    suns_from_below,
    models_of_classic,
)
"""The rules about launch files and parameters, with or without a robot."""

OF_ROBOT: tuple[Check, ...] = (
    joints_of_controllers,
    unfit_interfaces,
    wheel_sizes_of_controllers,
    wrong_sides_of_controllers,
    unknown_frames,
    two_parents,
    moved_twice,
    odometry_frames,
    unpublished_odometry,
    topics_of_other_types,
    unknown_topics,
    unseen_topics,
    robots_without_source,
    wrong_data_types,
    bridge_types,
    bridge_directions,
    shared_topics,
    bridge_topics,
    unsent_joint_states,
    unheard_joint_states,
    scoped_frames,
    clock_not_bridged,
    plugins_of_the_other,
    hardware_of_the_other,
    elements_of_the_other,
    missing_systems,
    missing_plugin_files,
    footprints,
)
"""The rules about a robot and the files around it."""

OF_ROS2: frozenset[Callable[..., Iterable[Problem]]] = frozenset(
    (*OF_BUILD, *OF_FILES, *OF_ROBOT)
) - {
    unreadable_yaml,
    unreadable_cmake,
    unreadable_manifest,
    setup_name,
    unknown_packages,
    no_joint_states,
}
"""The rules that know only the plugins, parameters and launch files of ROS 2."""
