"""Which robot_radius or footprint of Nav2 is held against the collision shapes."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping

from sambot_viz.checks.around.files.parameters import Parameter
from sambot_viz.checks.around.footprint_text import is_readable
from sambot_viz.checks.around.surroundings import Surroundings
from sambot_viz.errors import Problem


def footprints(around: Surroundings) -> Iterator[Problem]:
    """Report footprints that the robot does not fit in, or is lost in."""
    for file in around.yaml_files:
        for node in file.nodes:
            given = file.of(node)
            if not node.endswith("costmap"):
                continue
            base = given.get("robot_base_frame")
            frame = base.fact.value if base else "base_link"
            said = _said(given)
            if said is None or frame not in around.robot.links:
                continue
            # The import is late: only what is compared here needs numpy.
            from sambot_viz.checks.around.footprint_size import compare

            yield from compare(around.robot, frame, said)


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
