"""Check which sensors robot_localization uses."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from sambot_viz.checks.around.parameters.known import known_parameters
from sambot_viz.checks.around.parameters.navigation import filters
from sambot_viz.checks.around.surroundings import Surroundings
from sambot_viz.errors import Problem

_USED = {"odom": (6, 7, 11), "imu": (5, 11), "pose": (0, 1, 5), "twist": (6, 7, 11)}
"""Kind of sensor → the values that filters usually use, by their numbers."""


def inputs_without_config(around: Surroundings) -> Iterator[Problem]:
    """Report sensors of a filter that uses none of their values."""
    said = {text for launch in around.launches for text in launch.strings}
    given = {(p.node, p.name) for p in around.parameters}
    for one in filters(around):
        if not any(name.endswith("_config") for name in one.given):
            # Another file may set the values.
            continue
        block = known_parameters().nodes["filter"]
        meant = {block.meant(name, one.given) for name in one.given}
        for kind, used in _USED.items():
            for parameter in one.inputs(kind):
                wanted = f"{parameter.name}_config"
                if (parameter.node, wanted) in given or wanted in said | meant:
                    continue
                yield Problem.at(
                    parameter.place,
                    "warning",
                    "ekf-config",
                    f"{one.node} has no {wanted} for {parameter.name}, and without it "
                    "uses no value of that sensor",
                    f"add {wanted}: [{', '.join(_values(used))}]",
                )


def _values(used: Sequence[int]) -> list[str]:
    return ["true" if n in used else "false" for n in range(15)]
