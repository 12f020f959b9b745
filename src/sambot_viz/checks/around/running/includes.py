"""Find what a launch file includes."""

from __future__ import annotations

from collections.abc import Iterator

from sambot_viz.checks.around.launching.actions import (
    Action,
    FromFile,
    Given,
    LaunchArgument,
    StartNode,
    WrittenValue,
)
from sambot_viz.checks.around.running.known import KnownLaunch
from sambot_viz.checks.around.workspace import Package
from sambot_viz.errors import Place


def installed_as(package: Package, below: str) -> str | None:
    """Return the file at a path; its source may be in another folder."""
    if below in package.paths:
        return below
    last = below.rpartition("/")[2]
    alike = [path for path in package.paths if path.rpartition("/")[2] == last]
    return alike[0] if len(alike) == 1 else None


def actions_of_known(known: KnownLaunch, place: Place) -> Iterator[Action]:
    """Yield the nodes that a launch file of a well-known package starts."""
    clock = LaunchArgument("use_sim_time", known.sim_time)
    given: list[Given] = []
    if known.sim_time:
        given.append(WrittenValue("use_sim_time", (clock,), place))
    if known.parameters:
        given.append(FromFile(LaunchArgument(known.parameters), place))
    for package, program in known.nodes:
        yield StartNode(
            place,
            "true",
            package,
            program,
            "",
            LaunchArgument("namespace", ""),
            tuple(given),
            complete=False,
        )
