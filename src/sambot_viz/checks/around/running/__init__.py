"""What launch files start, worked out without running them."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from sambot_viz.checks.around.files.launch import LaunchNode
from sambot_viz.checks.around.running.system import (
    Endpoint,
    GivenParameter,
    PublishedTransform,
    RunningNode,
    RunningSystem,
    Starts,
    UnknownStart,
)
from sambot_viz.checks.around.workspace import Workspace
from sambot_viz.errors import Place
from sambot_viz.robot.packages.package_index import package_around

__all__ = [
    "Endpoint",
    "GivenParameter",
    "PublishedTransform",
    "RunningNode",
    "RunningSystem",
    "Starts",
    "UnknownStart",
    "running_system",
]


def running_system(
    path: Path,
    *,
    package_path: Sequence[Path | str] = (),
    workspace: Sequence[Path | str] = (),
    trusted: bool = True,
) -> RunningSystem:
    """Return what a launch file starts, or the launch files of a package.

    Args:
        path: a launch file in a package, or a package.
        package_path: as for `check`.
        workspace: as for `check`.
        trusted: as for `check`.
    """
    is_folder = path.is_dir()
    start = path if is_folder else path.absolute().parent
    found = Workspace(
        start,
        package_path,
        workspace,
        relative=not path.is_absolute(),
        trusted=trusted,
    )
    package = found.at(package_around(start) or start)
    launches = package.launches if package is not None else ()
    if not is_folder and package is not None:
        launches = tuple(
            one for one in launches if (package.folder / one.path).samefile(path)
        )
    return RunningSystem(
        tuple(launch.shown for launch in launches),
        tuple(_node(node) for launch in launches for node in launch.nodes),
        tuple(UnknownStart("a launch file", Place(one.shown, 1)) for one in launches),
    )


def _node(node: LaunchNode) -> RunningNode:
    return RunningNode(
        node.package,
        node.executable,
        node.name or "",
        "/",
        "yes",
        (),
        False,
        node.remappings,
        node.arguments,
        node.place,
    )
