"""Which robot_radius or footprint of Nav2 is held against the collision shapes."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import replace

from sambot_viz.checks.around.files.parameters import Parameter, YamlFile
from sambot_viz.checks.around.footprint_text import is_readable
from sambot_viz.checks.around.surroundings import Surroundings
from sambot_viz.checks.clues import severity
from sambot_viz.errors import Problem


def footprints(around: Surroundings) -> Iterator[Problem]:
    """Report footprints that the robot does not fit in, or is lost in.

    Where files contradict each other, they may be for several robots.
    """
    given = [one for file in around.yaml_files for one in _given(file)]
    sizes: dict[str, set[str]] = {}
    for node, _, said in given:
        sizes.setdefault(node, set()).add(said.fact.value)
    several = any(len(values) > 1 for values in sizes.values())
    clues = {"size"} if several else {"size", "only one"}
    for _, frame, said in given:
        if frame in around.robot.links:
            # The import is late: only what is compared here needs numpy.
            from sambot_viz.checks.around.footprint_size import compare

            for problem in compare(around.robot, frame, said):
                yield replace(problem, severity=severity(clues))


def _given(file: YamlFile) -> Iterator[tuple[str, str, Parameter]]:
    """Give each costmap with its base frame, and its footprint or radius."""
    for node in file.nodes:
        given = file.of(node)
        base, said = given.get("robot_base_frame"), _said(given)
        if said is not None and node.endswith("costmap"):
            yield node, base.fact.value if base else "base_link", said


def _said(given: Mapping[str, Parameter]) -> Parameter | None:
    """The parameter that counts: a footprint wins over a radius.

    None when there is none, or when Nav2 cannot read it.
    """
    footprint = given.get("footprint")
    if footprint is not None and not is_readable(footprint):
        return None
    if footprint is not None and re.search(r"\d", footprint.fact.value):
        return footprint
    return given.get("robot_radius")
